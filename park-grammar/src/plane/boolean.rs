//! Polygon booleans, by i_overlay.

use geo_types::Coord;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::{Precision, Solver};
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};
use i_overlay::float::slice::FloatSlice;

use super::{Area, Ring};

/// Smaller pieces, as a share of the square of the size of the operands, are
/// rounding along shared edges.
const SLIVER: f64 = 1e-13;

/// How near to an end an edge may pass before it is led through it: 2^12 of the
/// integers' units at first, twice as far in each round.
///
/// Coordinates have 53 bits, i_overlay's integers 60. With its own precision, one
/// unit at first, edges that coincide but for the last bits of their coordinates
/// cross each other in ever more points, round by round, before ends that differ by
/// rounding alone are taken for the same: minutes, and all memory, for a strip
/// that was peeled twice. 2^12 units are 4e-15 of the operands' size.
const PRECISION: Precision = Precision {
    start: 24,
    progression: 2,
};

fn solver() -> Solver {
    Solver::with_precision(PRECISION)
}

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
        .map(|line| line.iter().map(within).collect())
        .collect();
    let mut options = OverlayOptions::default();
    options.preserve_output_collinear = true;
    let found =
        vec![shape(area)].slice_custom_by_as::<i64>(&lines, FillRule::NonZero, options, solver());
    areas(&found, std::slice::from_ref(area))
}

fn shape(area: &Area) -> Vec<Vec<[f64; 2]>> {
    let ring = |ring: &Ring| ring.iter().map(within).collect();
    area.rings().map(ring).collect()
}

/// Coordinates beyond this, metres, are as good as this: a hedge may be wider than
/// the world, but i_overlay has no integers for that, and panics.
pub(crate) const FARTHEST: f64 = 1e9;

fn within(at: &Coord<f64>) -> [f64; 2] {
    [at.x, at.y].map(|x| {
        if x.is_nan() {
            0.0
        } else {
            x.clamp(-FARTHEST, FARTHEST)
        }
    })
}

fn overlay(a: &[Area], b: &[Area], rule: OverlayRule) -> Vec<Area> {
    let subject: Vec<_> = a.iter().map(shape).collect();
    let clip: Vec<_> = b.iter().map(shape).collect();
    let run = |mut options: OverlayOptions<f64, i64>| {
        // A vertex that several regions share stays one of each.
        options.preserve_output_collinear = true;
        FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(&subject, &clip, options, solver())
            .overlay(rule, FillRule::NonZero)
    };
    let plain = run(OverlayOptions::default());
    // Rings that touch themselves are taken apart, as polygons must be. Where holes
    // touch each other in a ring i_overlay 9.1 may lose one of them that way (see
    // the test): then the rings stay as they are.
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

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn sum(areas: &[Area]) -> f64 {
        areas.iter().map(Area::size).sum()
    }

    /// Of these eight holes, which touch each other up to rounding, the small one
    /// in the middle was lost when rings were taken apart, 4.67 square metres. It
    /// takes all the digits.
    #[test]
    fn no_hole_is_lost() {
        let land = area(&[
            (3.2914, -3.2914),
            (23.23316678352059, -1.7662975274838655),
            (27.808474201068993, -61.59159787804565),
            (7.866707417548403, -63.11670035056178),
        ]);
        let holes = [
            area(&[
                (9.187507347861695, -33.576651774490855),
                (10.431910572093587, -41.41131701480552),
                (8.12801999245506, -41.79278396602414),
                (8.975313787366346, -33.61878334970353),
            ]),
            area(&[
                (11.148592664508225, -33.18727325930932),
                (19.422475105153925, -31.544472697713005),
                (18.638047482003007, -40.0525849396056),
                (10.293740112980581, -41.43419460467552),
            ]),
            area(&[
                (10.064588386669211, -43.6448638711679),
                (18.434621780821875, -42.25899461648894),
                (17.446499543939236, -52.97643323286207),
                (9.171638289441352, -52.25931931616295),
            ]),
            area(&[
                (22.592852900086758, 2.842294586364065),
                (24.775832248838167, 3.4122574627918127),
                (24.569090166472815, 1.1698774267327041),
                (22.38611081772141, 0.5999145503049538),
            ]),
            area(&[
                (10.235938806525743, -21.45729964069445),
                (12.39306479579029, -21.18161945989904),
                (12.165473543706156, -23.37723454167798),
                (10.008347554441606, -23.652914722473387),
            ]),
            area(&[
                (8.315936973909153, -41.76166958992007),
                (10.431910572093589, -41.41131701480552),
                (10.768168177803316, -43.52836856525581),
                (8.652194579618877, -43.87872114037037),
            ]),
            area(&[
                (8.128019992455057, -41.79278396602414),
                (10.293740112980583, -41.43419460467552),
                (10.064588386669215, -43.6448638711679),
                (7.898868266143686, -44.00345323251653),
            ]),
            area(&[
                (7.062039291337138, -52.07649778554541),
                (9.171638289441352, -52.25931931616295),
                (8.952676722260959, -54.37168222479312),
                (6.84307772415674, -54.18886069417559),
            ]),
        ];
        let all = sum(&difference(std::slice::from_ref(&land), &holes));
        // One after the other none is lost.
        let mut left = vec![land];
        for hole in &holes {
            left = difference(&left, std::slice::from_ref(hole));
        }
        assert!((all - sum(&left)).abs() < 1e-6, "{all} {}", sum(&left));
    }
}
