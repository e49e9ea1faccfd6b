//! Which land of a region lies too far from a street to be a parcel's, and
//! whether the region's block would be too long.

use geo_types::Coord;

use crate::options::PlanOptions;
use crate::plane::{at, in_ring};
use crate::region::Region;
use crate::segments::SegmentGrid;

/// Sample points of a region and how deep they lie behind a frontage.
#[derive(Clone, Debug)]
pub(crate) struct Service {
    /// Points farther than the deepest acceptable parcel from any frontage.
    pub(crate) unserved: Vec<Coord<f64>>,
    /// Land a sample stands for, square metres.
    pub(crate) cell: f64,
    /// The block is longer than a walk around it should be.
    pub(crate) too_long: bool,
}

/// Deepest acceptable parcel over the ideal one.
const DEEPEST: f64 = 1.4;
/// Land that may stay unserved before a street is worth its cost: this share
/// of the region, and at least so many square metres.
const TOLERATED_SHARE: f64 = 0.03;
const TOLERATED_AREA: f64 = 400.0;

impl Service {
    pub(crate) fn of(region: &Region, options: &PlanOptions) -> Self {
        let step = (region.area / 1500.0).sqrt().clamp(4.0, 25.0);
        let deepest = DEEPEST * options.parcel_length;
        let access: Vec<_> = region
            .edges()
            .filter(|(_, _, s)| s.access)
            .map(|(a, b, s)| ((a, b), s.inset))
            .collect();
        let widest = access.iter().map(|a| a.1).fold(0.0, f64::max);
        let insets: Vec<f64> = access.iter().map(|a| a.1).collect();
        let grid = SegmentGrid::new(access.into_iter().map(|a| a.0).collect());
        let unserved = samples(region, step)
            .into_iter()
            .filter(|&p| {
                grid.nearest(p, deepest + widest)
                    .is_none_or(|h| h.distance > deepest + insets[h.segment])
            })
            .collect();
        let too_long = region.rectangle_length() > 1.25 * options.block_length;
        Self {
            unserved,
            cell: step * step,
            too_long,
        }
    }

    /// Whether enough land is out of reach to be worth a street.
    pub(crate) fn wants_street(&self, region: &Region) -> bool {
        let area = self.unserved.len() as f64 * self.cell;
        area > TOLERATED_AREA.max(TOLERATED_SHARE * region.area)
    }
}

/// Grid points inside a region.
fn samples(region: &Region, step: f64) -> Vec<Coord<f64>> {
    let Some(outer) = region.loops.first() else {
        return Vec::new();
    };
    let (mut low, mut high) = (
        at(f64::INFINITY, f64::INFINITY),
        at(f64::NEG_INFINITY, f64::NEG_INFINITY),
    );
    for p in &outer.points {
        low = at(low.x.min(p.x), low.y.min(p.y));
        high = at(high.x.max(p.x), high.y.max(p.y));
    }
    let mut out = Vec::new();
    let mut y = low.y + 0.5 * step;
    while y < high.y {
        // Crossings of the scan line, even-odd over all loops.
        let mut xs: Vec<f64> = region
            .edges()
            .filter(|(a, b, _)| (a.y > y) != (b.y > y))
            .map(|(a, b, _)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
            .collect();
        xs.sort_by(f64::total_cmp);
        for pair in xs.chunks_exact(2) {
            let mut x = low.x + ((pair[0] - low.x) / step).ceil().max(0.0) * step;
            while x < pair[1] {
                out.push(at(x, y));
                x += step;
            }
        }
        y += step;
    }
    debug_assert!(out.iter().take(3).all(|&p| in_ring(&outer.points, p)));
    out
}
