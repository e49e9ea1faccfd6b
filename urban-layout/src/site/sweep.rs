//! A quick proof that rings neither cross nor touch.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::ops::Bound::{Excluded, Unbounded};

use geo_types::Coord;
use rstar::{RTree, AABB};

use super::contact::{apart, neighbours, side, Edge};
use super::ring::Ring;

/// Whether no two edges of the rings come within the tolerance of each other,
/// but for those that share a vertex of their ring. In O(n log n) whatever the
/// shape: most outlines need no more than this answer, and an index over boxes takes many times
/// as long for a ring of long thin teeth in all directions.
///
/// The sweep of Shamos and Hoey ("Geometric intersection problems", FOCS 1976,
/// section 3): a line moves from left to right over the edges that it meets in their
/// order from below, and only edges that become neighbours are compared. If any
/// two cross, the two that do so first are neighbours before. Orientations are exact,
/// and a vertical line is taken to lean right by less than any number, so
/// ties need no tolerance. Edges begin before others end at the same point,
/// so that rings which touch there are seen together.
///
/// What comes near without meeting may never be neighbours: two vertices on
/// both sides of the moving line, and a vertex beside a steep edge. The first are
/// looked up apart; for the second the line moves once more, upwards.
pub(crate) fn clearly_apart(rings: &[Ring], tolerance: f64) -> bool {
    let points = rings.iter().flat_map(|ring| &ring.points);
    !vertices_meet(points.map(|p| [p.x, p.y]).collect(), tolerance)
        && swept(rings, tolerance, |c| c)
        && swept(rings, tolerance, |c| Coord { x: c.y, y: c.x })
}

/// Whether no two edges become neighbours that meet; `turn` gives coordinates
/// in which the line moves along x.
fn swept(rings: &[Ring], tolerance: f64, turn: fn(Coord<f64>) -> Coord<f64>) -> bool {
    let mut events: Vec<(Coord<f64>, bool, Chord)> = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        let n = ring.points.len();
        for (k, &a) in ring.points.iter().enumerate() {
            let (a, b) = (turn(a), turn(ring.points[(k + 1) % n]));
            let (left, right) = if lexical(a, b).is_lt() {
                (a, b)
            } else {
                (b, a)
            };
            let edge = (r, k);
            let chord = Chord { left, right, edge };
            events.push((left, false, chord));
            events.push((right, true, chord));
        }
    }
    events.sort_unstable_by(|a, b| {
        let order = lexical(a.0, b.0).then(a.1.cmp(&b.1));
        order.then(a.2.edge.cmp(&b.2.edge))
    });
    let free = |a: Option<&Chord>, b: Option<&Chord>| match (a, b) {
        (Some(a), Some(b)) => {
            neighbours(rings, a.edge, b.edge)
                || apart((a.left, a.right), (b.left, b.right), tolerance)
        }
        _ => true,
    };
    let mut active: BTreeSet<Chord> = BTreeSet::new();
    for (_, ends, chord) in events {
        if ends && !active.remove(&chord) {
            return false;
        }
        let below = active.range(..&chord).next_back();
        let above = active.range((Excluded(&chord), Unbounded)).next();
        let clear = if ends {
            free(below, above)
        } else {
            free(below, Some(&chord)) && free(Some(&chord), above)
        };
        if !clear || (!ends && !active.insert(chord)) {
            return false;
        }
    }
    true
}

/// An edge, left end first, ordered from below where the moving line meets it.
#[derive(Clone, Copy, Debug)]
struct Chord {
    left: Coord<f64>,
    right: Coord<f64>,
    edge: Edge,
}

impl Ord for Chord {
    fn cmp(&self, other: &Self) -> Ordering {
        if self.edge == other.edge {
            return Ordering::Equal;
        }
        if lexical(self.left, other.left).is_gt() {
            return other.cmp(self).reverse();
        }
        // The other begins no earlier: is it above?
        let mut left_of = side(self.left, self.right, other.left);
        if left_of == 0.0 {
            left_of = side(self.left, self.right, other.right);
        }
        if left_of > 0.0 {
            Ordering::Less
        } else if left_of < 0.0 {
            Ordering::Greater
        } else {
            self.edge.cmp(&other.edge)
        }
    }
}

impl PartialOrd for Chord {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Chord {
    fn eq(&self, other: &Self) -> bool {
        self.edge == other.edge
    }
}

impl Eq for Chord {}

/// Left to right, and upwards; coordinates are finite here.
fn lexical(a: Coord<f64>, b: Coord<f64>) -> Ordering {
    let order = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
    order(a.x, b.x).then(order(a.y, b.y))
}

/// Whether any two vertices lie within the tolerance of each other.
fn vertices_meet(points: Vec<[f64; 2]>, tolerance: f64) -> bool {
    let tree = RTree::bulk_load(points);
    let meet = tree.iter().any(|&[x, y]| {
        let near = AABB::from_corners(
            [x - tolerance, y - tolerance],
            [x + tolerance, y + tolerance],
        );
        // One is the point itself.
        tree.locate_in_envelope(&near).nth(1).is_some()
    });
    meet
}

#[cfg(test)]
mod tests {
    use super::super::contact::contacts_by_index;
    use super::*;
    use proptest::prelude::*;

    fn ring(points: Vec<(f64, f64)>) -> Ring {
        let mut ring = Ring {
            source: (0..points.len()).collect(),
            points: points.into_iter().map(|(x, y)| Coord { x, y }).collect(),
        };
        ring.clean();
        ring
    }

    /// Small grids, where touches of every sort abound, and free points.
    fn rings() -> impl Strategy<Value = Vec<Ring>> {
        let point = prop_oneof![
            4 => (0..6_i32, 0..6_i32).prop_map(|(x, y)| (f64::from(x), f64::from(y))),
            1 => (0.0..6.0_f64, 0.0..6.0_f64),
            1 => (0..6_i32, 0..6_i32).prop_map(|(x, y)| (f64::from(x) + 3e-9, f64::from(y))),
        ];
        let one = prop::collection::vec(point, 3..8).prop_map(ring);
        prop::collection::vec(one, 1..4)
            .prop_map(|rings| rings.into_iter().filter(|r| r.points.len() > 2).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        /// The sweep and the index, which share no more than the test of two edges,
        /// agree; the sweep may refuse vertices that nearly coincide.
        #[test]
        fn the_index_agrees(rings in rings()) {
            let found = contacts_by_index(&rings, 1e-8);
            let none = found.crossing.is_none() && found.touches.is_empty();
            let clear = clearly_apart(&rings, 1e-8);
            prop_assert!(none || !clear, "{:?}", rings);
            let points = rings.iter().flat_map(|ring| &ring.points);
            if none && !vertices_meet(points.map(|p| [p.x, p.y]).collect(), 1e-8) {
                prop_assert!(clear, "{:?}", rings);
            }
        }
    }

    #[test]
    fn teeth_in_all_directions_take_no_quadratic_time() {
        let n = 100_000;
        let points = (0..n)
            .map(|k| {
                let angle = f64::from(k) / f64::from(n) * std::f64::consts::TAU;
                let r = 800.0 + 50.0 * f64::from(k % 2);
                (r * angle.cos(), r * angle.sin())
            })
            .collect();
        let rings = [ring(points)];
        let start = std::time::Instant::now();
        assert!(clearly_apart(&rings, 1e-6));
        assert!(
            start.elapsed().as_secs_f64() < 20.0,
            "{:?}",
            start.elapsed()
        );
    }
}
