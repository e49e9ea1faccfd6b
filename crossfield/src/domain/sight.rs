//! Whether a point of the boundary is seen from a point inside.

use super::{Inner, Ring};
use crate::footpoint::EdgeTree;
use crate::plane::{orient_exact, wedge, V2};

impl Inner {
    /// Whether the straight way from `p`, a point inside, to `target` on the
    /// boundary stays inside. It may touch the boundary on the way.
    ///
    /// `target` lies on edge `edge` of ring `ring`, or `at_vertex` it is the
    /// vertex that this edge leaves: its own edges hide nothing.
    ///
    /// Expected O(log e) for e edges, more where the way runs along many.
    pub(crate) fn sees(&self, p: V2, target: V2, ring: u32, edge: u32, at_vertex: bool) -> bool {
        // A computed footpoint may lie beyond its edge, and beyond a
        // neighbour that ends there, by rounding.
        let end = target + (p - target) * 1e-9;
        let previous = self.rings[ring as usize].previous(edge as usize) as u32;
        let own = |r: u32, e: u32| r == ring && (e == edge || (at_vertex && e == previous));
        let tree = self.edges.get_or_init(|| EdgeTree::new(&self.rings));
        !tree.any_along(p, end, |r, e| {
            if own(r, e) {
                return false;
            }
            let points = &self.rings[r as usize];
            let (a, b) = points.edge(e as usize);
            let (start, stop) = (orient_exact(p, end, a), orient_exact(p, end, b));
            if start == 0.0 && between(p, end, a) {
                return leaves(points, e as usize, end - p);
            }
            let across = (start > 0.0 && stop < 0.0) || (start < 0.0 && stop > 0.0);
            across && {
                let (here, there) = (orient_exact(a, b, p), orient_exact(a, b, end));
                (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0)
            }
        })
    }
}

/// Whether `c`, on the line through both, lies strictly between `a` and `b`.
fn between(a: V2, b: V2, c: V2) -> bool {
    (b - a).dot(&(c - a)) > 0.0 && (a - b).dot(&(c - b)) > 0.0
}

/// Whether a line through vertex `k` along `direction` is outside just before
/// or just after it.
fn leaves(ring: &Ring, k: usize, direction: V2) -> bool {
    let (before, after) = (ring.direction(ring.previous(k)), ring.direction(k));
    let inside = |d: V2| {
        let (left_of_after, left_of_before) = (wedge(after, d) >= 0.0, wedge(before, d) >= 0.0);
        if ring.turn[k] >= 0.0 {
            left_of_after && left_of_before
        } else {
            left_of_after || left_of_before
        }
    };
    !(inside(direction) && inside(-direction))
}

#[cfg(test)]
mod tests {
    use crate::plane::V2;
    use crate::{Domain, DomainOptions};
    use geo_types::polygon;

    #[test]
    fn holes_and_reflex_corners_hide() {
        // An L with its corner at (4, 4) and a hole in the lower arm;
        // coordinates relative to (5, 5) below.
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 4.), (x: 4., y: 4.), (x: 4., y: 10.), (x: 0., y: 10.)],
            interiors: [[(x: 6., y: 1.), (x: 7., y: 1.), (x: 7., y: 3.), (x: 6., y: 3.)]],
        );
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let at = |x: f64, y: f64| V2::new(x - 5.0, y - 5.0);
        let sees = |p: V2, target: V2, edge| domain.inner.sees(p, target, 0, edge, false);
        // The east side, edge 1, from the west: the hole is in the way.
        assert!(!sees(at(2.0, 2.0), at(10.0, 2.0), 1));
        assert!(sees(at(2.0, 3.5), at(10.0, 3.5), 1));
        // Along the hole's north side: touching is seen.
        assert!(sees(at(2.0, 3.0), at(10.0, 3.0), 1));
        // Through its corner from corner to corner: not seen.
        assert!(!sees(at(5.75, 3.5), at(7.5, 0.0), 0));
        // The top of the upper arm, edge 4, past the reflex corner.
        assert!(sees(at(4.5, 2.0), at(2.0, 10.0), 4));
        assert!(!sees(at(8.0, 3.5), at(2.0, 10.0), 4));
        // Grazing the reflex corner is seen.
        assert!(sees(at(6.0, 2.0), at(0.0, 8.0), 5));
    }
}
