//! Polygon booleans, by i_overlay.

use geo_types::Coord;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};
use i_overlay::float::slice::FloatSlice;

use super::{Area, Ring};

/// Smaller pieces, as a share of the square of the size of the operands, are
/// rounding along shared edges.
const SLIVER: f64 = 1e-13;

/// What lies in any of `a` and in none of `b`.
pub(crate) fn difference(a: &[Area], b: &[Area]) -> Vec<Area> {
    overlay(a, b, OverlayRule::Difference)
}

/// What lies in any of `a` and in any of `b`.
pub(crate) fn intersection(a: &[Area], b: &[Area]) -> Vec<Area> {
    overlay(a, b, OverlayRule::Intersect)
}

/// What lies in any of `a`.
pub(crate) fn union(a: &[Area]) -> Vec<Area> {
    overlay(a, &[], OverlayRule::Subject)
}

/// An area cut along lines, which may cross it, each other and themselves. A line
/// that ends inside cuts no farther than it separates something.
pub(crate) fn slice(area: &Area, lines: &[Vec<Coord<f64>>]) -> Vec<Area> {
    let lines: Vec<Vec<[f64; 2]>> = lines
        .iter()
        .map(|line| line.iter().map(|c| [c.x, c.y]).collect())
        .collect();
    let mut options = OverlayOptions::default();
    options.preserve_output_collinear = true;
    let found = vec![shape(area)].slice_custom_by_as::<i64>(
        &lines,
        FillRule::NonZero,
        options,
        Solver::default(),
    );
    areas(&found, std::slice::from_ref(area))
}

fn shape(area: &Area) -> Vec<Vec<[f64; 2]>> {
    let ring = |ring: &Ring| ring.iter().map(|c| [c.x, c.y]).collect();
    area.rings().map(ring).collect()
}

fn overlay(a: &[Area], b: &[Area], rule: OverlayRule) -> Vec<Area> {
    let subject: Vec<_> = a.iter().map(shape).collect();
    let clip: Vec<_> = b.iter().map(shape).collect();
    let run = |mut options: OverlayOptions<f64, i64>| {
        // A vertex that several regions share stays one of each.
        options.preserve_output_collinear = true;
        FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(
            &subject,
            &clip,
            options,
            Solver::default(),
        )
        .overlay(rule, FillRule::NonZero)
    };
    let plain = run(OverlayOptions::default());
    // Rings that touch themselves are taken apart, as polygons must be. Where many
    // holes touch each other that may lose some of them: then the rings stay as
    // they are.
    let found = if plain.iter().flatten().any(|ring| touches_itself(ring)) {
        let valid = run(OverlayOptions::ogc());
        let (is, must) = (whole(&valid), whole(&plain));
        if (is - must).abs() <= ROUNDING * must.abs() {
            valid
        } else {
            plain
        }
    } else {
        plain
    };
    areas(&found, a)
}

/// What came of areas, without slivers.
fn areas(found: &Shapes, of: &[Area]) -> Vec<Area> {
    let points: Vec<Coord<f64>> = of.iter().flat_map(|x| x.outer.iter().copied()).collect();
    let (low, high) = super::extent(&points);
    let least = SLIVER * (high.x - low.x).max(high.y - low.y).powi(2);
    let coords =
        |ring: &Vec<[f64; 2]>| -> Ring { ring.iter().map(|&[x, y]| Coord { x, y }).collect() };
    let areas = found.iter().filter_map(|rings| {
        let (outer, holes) = rings.split_first()?;
        let area = Area::new(coords(outer), holes.iter().map(coords).collect());
        (area.size() > least).then_some(area)
    });
    areas.collect()
}

/// Areas that differ by less, as a share, differ by rounding.
const ROUNDING: f64 = 1e-10;

type Shapes = [Vec<Vec<[f64; 2]>>];

/// Sum of all areas, holes left out.
fn whole(shapes: &Shapes) -> f64 {
    let ring = |ring: &Vec<[f64; 2]>| {
        let points: Ring = ring.iter().map(|&[x, y]| Coord { x, y }).collect();
        super::signed_area(&points)
    };
    shapes.iter().flatten().map(ring).sum()
}

/// Whether a ring passes a point twice.
fn touches_itself(ring: &[[f64; 2]]) -> bool {
    let mut bits: Vec<[u64; 2]> = ring.iter().map(|p| p.map(f64::to_bits)).collect();
    bits.sort_unstable();
    bits.windows(2).any(|pair| pair[0] == pair[1])
}
