//! Union, intersection and difference of polygons, vertices of the source kept.

use geo_types::{Coord, LineString, Polygon};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};
use rstar::RTree;

use super::ring::{doubled_area, extent, ROUNDING};

type Contour = Vec<[f64; 2]>;
type Shape = Vec<Contour>;

/// The points of both operands, for putting results back onto them.
struct Source(RTree<[f64; 2]>);

/// Both operands as they are: what a boolean leaves of `subject`.
fn overlay(
    subject: &[Polygon<f64>],
    clip: &[Polygon<f64>],
    rule: OverlayRule,
    fill: FillRule,
    keep_collinear: bool,
) -> Vec<Polygon<f64>> {
    let subject: Vec<Shape> = subject.iter().map(shape).collect();
    let clip: Vec<Shape> = clip.iter().map(shape).collect();
    let mut options = OverlayOptions::<f64, i64>::ogc();
    options.preserve_output_collinear = keep_collinear;
    let result = FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(
        &subject,
        &clip,
        options,
        Solver::default(),
    )
    .overlay(rule, fill);
    let points: Vec<[f64; 2]> = subject
        .iter()
        .chain(&clip)
        .flatten()
        .flatten()
        .copied()
        .collect();
    let all: Vec<Coord<f64>> = points.iter().map(|&[x, y]| Coord { x, y }).collect();
    let extent = extent(&all);
    let source = Source(RTree::bulk_load(points));
    let mut polygons: Vec<Polygon<f64>> = result
        .iter()
        .filter_map(|shape| source.restore(shape, ROUNDING * extent))
        .collect();
    // Slivers of rounding along edges that both operands share.
    polygons.retain(|polygon| area(polygon) > ROUNDING * extent * extent * 1e-3);
    polygons
}

/// The union, joined along shared edges.
pub(crate) fn union(polygons: &[Polygon<f64>]) -> Vec<Polygon<f64>> {
    overlay(
        polygons,
        &[],
        OverlayRule::Subject,
        FillRule::NonZero,
        false,
    )
}

/// What lies in any of `a` and in any of `b`.
pub(crate) fn intersection(a: &[Polygon<f64>], b: &[Polygon<f64>]) -> Vec<Polygon<f64>> {
    overlay(a, b, OverlayRule::Intersect, FillRule::NonZero, false)
}

/// What lies in any of `a` and in none of `b`.
pub(crate) fn difference(a: &[Polygon<f64>], b: &[Polygon<f64>]) -> Vec<Polygon<f64>> {
    overlay(a, b, OverlayRule::Difference, FillRule::NonZero, false)
}

/// What a ring that touches itself encloses an odd number of times. Vertices on
/// an edge stay where they are.
pub(crate) fn odd(ring: &[Coord<f64>]) -> Vec<Polygon<f64>> {
    let polygon = Polygon::new(LineString(ring.to_vec()), Vec::new());
    overlay(
        &[polygon],
        &[],
        OverlayRule::Subject,
        FillRule::EvenOdd,
        true,
    )
}

/// [`difference`] that keeps vertices that lie on a straight edge.
pub(crate) fn difference_noded(a: &[Polygon<f64>], b: &[Polygon<f64>]) -> Vec<Polygon<f64>> {
    overlay(a, b, OverlayRule::Difference, FillRule::NonZero, true)
}

/// The area of a polygon whose rings are wound either way.
pub(crate) fn area(polygon: &Polygon<f64>) -> f64 {
    let ring = |line: &LineString<f64>| doubled_area(open(line)).abs() / 2.0;
    ring(polygon.exterior()) - polygon.interiors().iter().map(ring).sum::<f64>()
}

/// The sum of [`area`].
pub(crate) fn total_area(polygons: &[Polygon<f64>]) -> f64 {
    polygons.iter().map(area).sum()
}

/// The vertices of a ring without the closing one.
pub(crate) fn open(line: &LineString<f64>) -> &[Coord<f64>] {
    match line.0.as_slice() {
        [points @ .., last] if points.first() == Some(last) => points,
        points => points,
    }
}

/// A polygon from open rings, exterior counter-clockwise and holes clockwise.
pub(crate) fn oriented(exterior: Vec<Coord<f64>>, holes: Vec<Vec<Coord<f64>>>) -> Polygon<f64> {
    let wound = |mut ring: Vec<Coord<f64>>, sign: f64| {
        if doubled_area(&ring) * sign < 0.0 {
            // The first vertex stays the first.
            ring[1..].reverse();
        }
        LineString(ring)
    };
    let holes = holes.into_iter().map(|hole| wound(hole, -1.0)).collect();
    Polygon::new(wound(exterior, 1.0), holes)
}

/// A polygon as the boolean engine takes it, exterior counter-clockwise, so that
/// the non-zero rule sees its holes.
fn shape(polygon: &Polygon<f64>) -> Shape {
    let contour = |line: &LineString<f64>, sign: f64| {
        let mut contour: Contour = open(line).iter().map(|c| [c.x, c.y]).collect();
        if doubled_area(open(line)) * sign < 0.0 {
            contour.reverse();
        }
        contour
    };
    let mut shape = vec![contour(polygon.exterior(), 1.0)];
    shape.extend(polygon.interiors().iter().map(|ring| contour(ring, -1.0)));
    shape
}

impl Source {
    /// A result with each vertex that is one of the source (but for the
    /// engine's rounding) put back onto it to the last bit.
    fn restore(&self, shape: &Shape, tolerance: f64) -> Option<Polygon<f64>> {
        let mut rings = shape.iter().filter_map(|contour| {
            let mut ring: Vec<Coord<f64>> = contour
                .iter()
                .map(|&point| {
                    let [x, y] = match self.0.nearest_neighbor(&point) {
                        Some(near) if near_enough(*near, point, tolerance) => *near,
                        _ => point,
                    };
                    Coord { x, y }
                })
                .collect();
            ring.dedup();
            while ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            (ring.len() >= 3).then_some(ring)
        });
        let exterior = rings.next()?;
        Some(oriented(exterior, rings.collect()))
    }
}

fn near_enough(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) <= tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: f64, y: f64, w: f64, h: f64) -> Polygon<f64> {
        let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
        let ring = corners.map(|(x, y)| Coord { x, y }).to_vec();
        oriented(ring, Vec::new())
    }

    #[test]
    fn areas_add_up_and_vertices_come_back_to_the_bit() {
        // Numbers that no binary grid holds.
        let (a, b) = (
            rectangle(0.1, 0.2, 300.3, 200.7),
            rectangle(123.4, 50.6, 500.9, 70.1),
        );
        let (a, b) = (vec![a], vec![b]);
        let common = total_area(&intersection(&a, &b));
        let rest = total_area(&difference(&a, &b));
        assert!((common + rest - total_area(&a)).abs() < 1e-6);
        let both = [a.clone(), b.clone()].concat();
        let joined = union(&both);
        assert_eq!(joined.len(), 1);
        let sum = total_area(&both) - common;
        assert!((total_area(&joined) - sum).abs() < 1e-6);
        let kept = open(joined[0].exterior());
        for corner in open(a[0].exterior()) {
            assert!(kept.contains(corner), "{corner:?} is lost");
        }
    }

    #[test]
    fn a_ring_that_touches_itself_is_taken_apart() {
        // Two squares that share the corner (1, 1).
        let points = [
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (2.0, 1.0),
            (2.0, 2.0),
            (1.0, 2.0),
        ];
        let mut ring: Vec<Coord<f64>> = points.iter().map(|&(x, y)| Coord { x, y }).collect();
        ring.extend([Coord { x: 1.0, y: 1.0 }, Coord { x: 0.0, y: 1.0 }]);
        let parts = odd(&ring);
        assert_eq!(parts.len(), 2);
        assert!((total_area(&parts) - 2.0).abs() < 1e-9);
    }
}
