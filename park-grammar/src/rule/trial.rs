//! What tests of rules have in common: regions of any shape, moved, and places in
//! them.

use geo_types::{coord, Coord};
use proptest::prelude::*;

use crate::derive::Spot;
use crate::plane::{Area, Ring};
use crate::shape::Region;

/// An outer ring, and whether there is a hole in its middle.
pub(super) type Outline = (Ring, bool);

/// Few cases, or with `URBAN_LAYOUT_LONG` many.
pub(super) fn config(few: u32, many: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { many } else { few })
}

/// A region of any shape around the middle, concave as a rule, with or without a
/// hole there.
pub(super) fn outline() -> impl Strategy<Value = Outline> {
    let ring = proptest::collection::vec((0.2..1.0_f64, 15.0..90.0_f64), 4..=40);
    (ring, 0.0..6.3_f64, any::<bool>()).prop_map(|(steps, start, hole)| {
        let whole: f64 = steps.iter().map(|s| s.0).sum();
        let mut angle = start;
        let points = steps.iter().map(|(step, radius)| {
            angle += step / whole * std::f64::consts::TAU;
            coord! { x: radius * angle.cos(), y: radius * angle.sin() }
        });
        // The hole of radius 3 lies inside if no step is more than 150 degrees.
        let steep = steps.iter().any(|(step, _)| step / whole > 0.41);
        (points.collect(), hole && !steep)
    })
}

/// Turned, mirrored if wanted, and moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) angle: f64,
    pub(super) mirror: bool,
    pub(super) by: Coord<f64>,
}

impl Motion {
    pub(super) const NONE: Self = Self {
        angle: 0.0,
        mirror: false,
        by: Coord { x: 0.0, y: 0.0 },
    };

    pub(super) fn of(self, p: Coord<f64>) -> Coord<f64> {
        let x = if self.mirror { -p.x } else { p.x };
        let (sin, cos) = self.angle.sin_cos();
        let turned = coord! { x: x * cos - p.y * sin, y: x * sin + p.y * cos };
        turned + self.by
    }
}

/// The park of an outline, whose hole if there is one has corners 3 m from the
/// middle at angles, moved.
pub(super) fn region((points, holed): &Outline, hole: [f64; 6], motion: Motion) -> Region {
    let moved = |p: Coord<f64>| motion.of(p);
    let corner = |a: f64| moved(coord! { x: 3.0 * a.cos(), y: 3.0 * a.sin() });
    let holes = if *holed {
        vec![hole.map(corner).to_vec()]
    } else {
        Vec::new()
    };
    let outer = points.iter().copied().map(moved).collect();
    let mut region = Region::bare(Area::new(outer, holes));
    crate::index::park(&mut region);
    region
}

/// Those places that lie inside, more than so far from the boundary.
pub(super) fn spots(region: &Region, at: &[(f64, f64)], motion: Motion, far: f64) -> Vec<Spot> {
    let all = at.iter().map(|&(x, y)| motion.of(coord! { x: x, y: y }));
    let inside = all.filter(|&p| region.area.contains(p) && region.area.nearest(p).1 > far);
    inside.map(|at| Spot::new(at, 0.0)).collect()
}
