//! Geometry of faces: rings, polygons, areas.

use super::planar::{FaceId, HalfEdgeId, PlanarMesh};
use super::predicates::{cross, lexical, norm, orient, sub, P};
use geo_types::{Coord, LineString, Polygon};
use std::collections::HashMap;

/// Signed area of a closed ring, relative to its first point so that large
/// coordinates lose nothing.
pub(crate) fn signed_area(ring: &[P]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    ring.windows(2)
        .map(|w| cross(sub(w[0], o), sub(w[1], o)))
        .sum::<f64>()
        / 2.0
}

impl<E: Clone> PlanarMesh<E> {
    /// The points of the loop of `h`, from the start of `h` on, the first one
    /// not repeated. A vertex that the loop passes twice (the foot of a
    /// cul-de-sac) is there twice.
    pub fn ring(&self, h: HalfEdgeId) -> Vec<Coord<f64>> {
        self.walk(h).map(|h| self.start(h)).collect()
    }

    /// Length of an edge.
    pub fn length(&self, h: HalfEdgeId) -> f64 {
        norm(sub(self.end(h), self.start(h)))
    }

    /// Area of a face, its holes subtracted: infinite for the unbounded face,
    /// 0 if there is no such face.
    pub fn area(&self, f: FaceId) -> f64 {
        if self.is_outside(f) {
            return f64::INFINITY;
        }
        let loops = self.loops(f);
        let Some(&first) = loops.first() else {
            return 0.0;
        };
        let o = self.start(first);
        let twice: f64 = loops
            .iter()
            .flat_map(|&l| self.walk(l))
            .map(|h| cross(sub(self.start(h), o), sub(self.end(h), o)))
            .sum();
        twice / 2.0
    }

    /// The polygon that a bounded face covers: exterior counter-clockwise,
    /// holes clockwise. `None` for the unbounded face and stale ids.
    ///
    /// Edges with the face on both sides (dangling streets, bridges to an
    /// island) have no area and are left out; where the boundary touches
    /// itself at a vertex, the ring is cut into an exterior and a hole that
    /// touch there, as OGC simple features ask.
    pub fn polygon(&self, f: FaceId) -> Option<Polygon<f64>> {
        if self.is_outside(f) || !self.has_face(f) {
            return None;
        }
        let mut exterior = None;
        let mut holes = Vec::new();
        for ring in self.simple_rings(f) {
            if signed_area(&ring) > 0.0 && exterior.is_none() {
                exterior = Some(LineString(ring));
            } else {
                holes.push(LineString(ring));
            }
        }
        exterior.map(|exterior| Polygon::new(exterior, holes))
    }

    /// Closed rings around a face without its two-sided edges, cut where they
    /// pass a vertex twice.
    fn simple_rings(&self, f: FaceId) -> Vec<Vec<P>> {
        let two_sided = |h: HalfEdgeId| self.face(h) == self.face(h.twin());
        let sides: Vec<HalfEdgeId> = self
            .loops(f)
            .into_iter()
            .flat_map(|l| self.walk(l))
            .filter(|&h| !two_sided(h))
            .collect();
        // Position of each side in the order of the walk, for the marks.
        let mut order: Vec<(HalfEdgeId, usize)> =
            sides.iter().enumerate().map(|(i, &h)| (h, i)).collect();
        order.sort_unstable();
        let place = |h| {
            order
                .binary_search_by_key(&h, |e| e.0)
                .ok()
                .map(|i| order[i].1)
        };
        let mut used = vec![false; sides.len()];
        let mut rings = Vec::new();
        for start in 0..sides.len() {
            let mut stack: Vec<HalfEdgeId> = Vec::new();
            // Where each origin is on the stack; only looked up.
            let mut depth = HashMap::new();
            let mut at = start;
            while !used[at] {
                used[at] = true;
                let h = sides[at];
                depth.insert(self.origin(h), stack.len());
                stack.push(h);
                // Passing a vertex again closes a ring of its own.
                let end = self.dest(h);
                if let Some(&from) = depth.get(&end) {
                    let mut ring: Vec<P> = stack[from..].iter().map(|&s| self.start(s)).collect();
                    ring.push(self.point(end));
                    rings.push(ring);
                    for s in stack.drain(from..) {
                        depth.remove(&self.origin(s));
                    }
                }
                // Turn clockwise past the two-sided edges.
                let mut n = self.next(h);
                for _ in 0..self.halves.len() {
                    if !two_sided(n) {
                        break;
                    }
                    n = self.next(n.twin());
                }
                match place(n) {
                    Some(i) => at = i,
                    None => break,
                }
            }
        }
        rings
    }

    /// Does this loop run around something (a hole of its face, or the rim of
    /// the unbounded face) rather than around its face? Exact.
    pub(super) fn is_contour(&self, h: HalfEdgeId) -> bool {
        ring_is_contour(&self.ring(h))
    }
}

/// Does this open ring, its face on the left, run around the outside of
/// something? Exact, also for rings that touch themselves or enclose no area.
///
/// Decided at the westernmost (then lowest) point: the ring is a contour if at
/// some visit its wedge there opens to the west. All edges there point east
/// or straight north, so the wedge from the outgoing edge counter-clockwise
/// to the incoming one contains the west unless the ring turns left.
pub(crate) fn ring_is_contour(ring: &[P]) -> bool {
    let n = ring.len();
    let Some(west) = ring.iter().copied().min_by(|a, b| lexical(*a, *b)) else {
        return false;
    };
    (0..n).any(|i| ring[i] == west && orient(west, ring[(i + 1) % n], ring[(i + n - 1) % n]) <= 0.0)
}
