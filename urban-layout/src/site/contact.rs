//! Where the rings of one polygon cross or touch each other or themselves.

use geo_types::Coord;
use robust::{orient2d, Coord as Exact};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

use super::ring::Ring;
use super::sweep::clearly_apart;

/// An edge: its ring, and the position of its first vertex in the cleaned ring.
pub(crate) type Edge = (usize, usize);

/// Two edges that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    pub(crate) first: Edge,
    pub(crate) second: Edge,
    pub(crate) at: Coord<f64>,
}

/// A vertex that lies on an edge that is not its own, within the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Ring and position of the vertex.
    pub(crate) vertex: Edge,
    pub(crate) edge: Edge,
}

/// All that [`contacts`] finds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts {
    /// The first true crossing in the order of the edges.
    pub(crate) crossing: Option<Meeting>,
    /// All touches, in the order of the edges.
    pub(crate) touches: Vec<Touch>,
}

/// Finds the first crossing and, if there is none, all touches.
pub(crate) fn contacts(rings: &[Ring], tolerance: f64) -> Contacts {
    if clearly_apart(rings, tolerance) {
        return Contacts::default();
    }
    contacts_by_index(rings, tolerance)
}

/// [`contacts`], for rings that have some.
///
/// Orientation is decided exactly, on the coordinates given; a vertex that
/// overshoots an edge by no more than the tolerance touches it, as do vertices that
/// stop short by as much. Edges that follow each other on a clean ring meet
/// only at their common vertex.
///
/// O(n log n) for outlines of real places. The index stores boxes, which fit
/// slanted edges badly, so it works in that one of eight rotated frames in
/// which the boxes are smallest: a comb of any direction stays cheap.
pub(crate) fn contacts_by_index(rings: &[Ring], tolerance: f64) -> Contacts {
    let edges: Vec<Edge> = rings
        .iter()
        .enumerate()
        .flat_map(|(r, ring)| (0..ring.points.len()).map(move |k| (r, k)))
        .collect();
    let ends = |(r, k): Edge| {
        let points = &rings[r].points;
        (points[k], points[(k + 1) % points.len()])
    };
    let turn = best_rotation(edges.iter().map(|&edge| ends(edge)));
    let bounds = |edge: Edge| {
        let (a, b) = ends(edge);
        let (a, b) = (rotate(a, turn), rotate(b, turn));
        AABB::from_corners(
            [a.x.min(b.x) - tolerance, a.y.min(b.y) - tolerance],
            [a.x.max(b.x) + tolerance, a.y.max(b.y) + tolerance],
        )
    };
    let tree = RTree::bulk_load(
        edges
            .iter()
            .enumerate()
            .map(|(id, &edge)| {
                let bounds = bounds(edge);
                GeomWithData::new(Rectangle::from_aabb(bounds), id)
            })
            .collect(),
    );

    let mut found = Contacts::default();
    let mut near = Vec::new();
    for (i, &first) in edges.iter().enumerate() {
        near.clear();
        let envelope = bounds(first);
        near.extend(
            tree.locate_in_envelope_intersecting(&envelope)
                .map(|candidate| candidate.data)
                .filter(|&j| j > i && !neighbours(rings, first, edges[j])),
        );
        near.sort_unstable();
        for &j in &near {
            let second = edges[j];
            match meet(ends(first), ends(second), tolerance) {
                Meet::Apart => {}
                Meet::Cross(at) => {
                    // Crossings are errors, so nothing after one is of use.
                    found.crossing = Some(Meeting { first, second, at });
                    return found;
                }
                Meet::Touch(which) => {
                    let next = |(r, k): Edge| (r, (k + 1) % rings[r].points.len());
                    let vertices = [
                        (second, first),
                        (next(second), first),
                        (first, second),
                        (next(first), second),
                    ];
                    for (touches, (vertex, edge)) in which.into_iter().zip(vertices) {
                        // A vertex is an end of two edges: one mention is enough.
                        let touch = Touch { vertex, edge };
                        if touches && !neighbours_vertex(rings, vertex, edge) {
                            found.touches.push(touch);
                        }
                    }
                }
            }
        }
    }
    found.touches.sort_unstable_by_key(|t| (t.edge, t.vertex));
    found.touches.dedup();
    found
}

/// Whether two edges follow each other on their ring.
pub(crate) fn neighbours(rings: &[Ring], a: Edge, b: Edge) -> bool {
    let n = rings[a.0].points.len();
    a.0 == b.0 && ((a.1 + 1) % n == b.1 || (b.1 + 1) % n == a.1)
}

/// Whether the vertex is an end of the edge.
fn neighbours_vertex(rings: &[Ring], vertex: Edge, edge: Edge) -> bool {
    let n = rings[edge.0].points.len();
    vertex.0 == edge.0 && (vertex.1 == edge.1 || vertex.1 == (edge.1 + 1) % n)
}

/// How two edges lie to each other.
enum Meet {
    Apart,
    Cross(Coord<f64>),
    /// Which of `c d` (on `a b`) and `a b` (on `c d`) touch.
    Touch([bool; 4]),
}

fn meet((a, b): (Coord<f64>, Coord<f64>), (c, d): (Coord<f64>, Coord<f64>), tol: f64) -> Meet {
    let touches = [
        distance(c, a, b) <= tol,
        distance(d, a, b) <= tol,
        distance(a, c, d) <= tol,
        distance(b, c, d) <= tol,
    ];
    if touches.contains(&true) {
        return Meet::Touch(touches);
    }
    let (s, t) = (side(a, b, c), side(a, b, d));
    let (u, v) = (side(c, d, a), side(c, d, b));
    if (s > 0.0) != (t > 0.0) && (u > 0.0) != (v > 0.0) {
        let f = s / (s - t);
        return Meet::Cross(c + (d - c) * f);
    }
    Meet::Apart
}

/// Whether two edges neither cross nor come within the tolerance.
pub(crate) fn apart(
    first: (Coord<f64>, Coord<f64>),
    second: (Coord<f64>, Coord<f64>),
    tolerance: f64,
) -> bool {
    matches!(meet(first, second, tolerance), Meet::Apart)
}

/// Positive when `c` lies to the left of `a b`, exactly.
pub(crate) fn side(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    let exact = |c: Coord<f64>| Exact { x: c.x, y: c.y };
    orient2d(exact(a), exact(b), exact(c))
}

/// The distance from a point to a segment.
pub(crate) fn distance(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let q = nearest(p, a, b).1;
    (p - q).x.hypot((p - q).y)
}

/// The point of a segment nearest to `p`, and its parameter from 0 to 1.
pub(crate) fn nearest(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> (f64, Coord<f64>) {
    let d = b - a;
    let square = d.x * d.x + d.y * d.y;
    if square <= 0.0 {
        return (0.0, a);
    }
    let t = ((p - a).x * d.x + (p - a).y * d.y) / square;
    // The ends themselves, not the ends recomputed.
    if t <= 0.0 {
        (0.0, a)
    } else if t >= 1.0 {
        (1.0, b)
    } else {
        (t, a + d * t)
    }
}

/// Whether a point lies inside an open ring; on the ring itself, either.
pub(crate) fn inside(points: &[Coord<f64>], p: Coord<f64>) -> bool {
    let mut inside = false;
    let mut a = match points.last() {
        Some(&last) => last,
        None => return false,
    };
    for &b in points {
        if (a.y > p.y) != (b.y > p.y) {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            if side(low, high, p) > 0.0 {
                inside = !inside;
            }
        }
        a = b;
    }
    inside
}

/// Cosine and sine of the rotation that makes the boxes of the edges smallest.
fn best_rotation(edges: impl Iterator<Item = (Coord<f64>, Coord<f64>)> + Clone) -> (f64, f64) {
    const TURNS: u32 = 8;
    let mut best = (f64::INFINITY, (1.0, 0.0));
    for k in 0..TURNS {
        let angle = f64::from(k) / f64::from(TURNS) * std::f64::consts::FRAC_PI_2;
        let turn = (angle.cos(), angle.sin());
        let total: f64 = edges
            .clone()
            .map(|(a, b)| {
                let d = rotate(b - a, turn);
                (d.x * d.y).abs()
            })
            .sum();
        // Not worth a turn for a difference in rounding only.
        if total < 0.9 * best.0 {
            best = (total, turn);
        }
    }
    best.1
}

fn rotate(c: Coord<f64>, (cos, sin): (f64, f64)) -> Coord<f64> {
    Coord {
        x: cos * c.x - sin * c.y,
        y: sin * c.x + cos * c.y,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        Ring {
            points: points.iter().map(|&(x, y)| Coord { x, y }).collect(),
            source: (0..points.len()).collect(),
        }
    }

    #[test]
    fn a_bow_tie_crosses_where_its_edges_do() {
        let rings = [ring(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)])];
        let crossing = contacts(&rings, 1e-9).crossing.unwrap();
        assert_eq!((crossing.first, crossing.second), ((0, 0), (0, 2)));
        assert_eq!(crossing.at, Coord { x: 2.0, y: 2.0 });
    }

    #[test]
    fn a_vertex_on_an_edge_touches_and_does_not_cross() {
        let outer = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
        for overshoot in [0.0, 1e-10, -1e-10] {
            let hole = ring(&[(5.0, overshoot), (6.0, 3.0), (4.0, 3.0)]);
            let found = contacts(&[outer.clone(), hole], 1e-9);
            assert_eq!(found.crossing, None);
            let touch = Touch {
                vertex: (1, 0),
                edge: (0, 0),
            };
            assert_eq!(found.touches, [touch]);
        }
        let hole = ring(&[(5.0, -1e-6), (6.0, 3.0), (4.0, 3.0)]);
        assert!(contacts(&[outer, hole], 1e-9).crossing.is_some());
    }

    #[test]
    fn a_slanted_comb_of_many_teeth_takes_no_quadratic_time() {
        // Teeth of 1 km at 45 degrees, 1 cm apart: every box overlaps every other.
        let n = 20_000;
        let mut points = Vec::new();
        for k in 0..n {
            let x = f64::from(k) * 0.02;
            points.push((x, 0.0));
            points.push((x + 1000.0, 1000.0));
            points.push((x + 1000.01, 1000.0));
            points.push((x + 0.01, 0.0));
        }
        points.push((f64::from(n) * 0.02 + 500.0, -10.0));
        points.push((0.0, -10.0));
        let start = std::time::Instant::now();
        let found = contacts_by_index(&[ring(&points)], 1e-9);
        assert!(found.crossing.is_none() && found.touches.is_empty());
        assert!(start.elapsed().as_secs_f64() < 20.0, "quadratic");
    }

    #[test]
    fn inside_counts_crossings() {
        let square = ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]).points;
        assert!(inside(&square, Coord { x: 1.0, y: 1.0 }));
        assert!(!inside(&square, Coord { x: 3.0, y: 1.0 }));
        assert!(!inside(&square, Coord { x: -1.0, y: 0.0 }));
        assert!(!inside(&[], Coord { x: 0.0, y: 0.0 }));
    }
}
