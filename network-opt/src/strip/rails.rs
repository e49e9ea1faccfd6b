//! Where a sliding junction may go: along its straight boundary edge.

use super::options::Freedom;
use crate::mesh::predicates::{dist_to_segment, dot, norm, sub, P};
use crate::mesh::{PlanarMesh, VertexId};

/// The straight stretch of boundary that a sliding vertex moves on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rail {
    /// The boundary vertices behind and ahead.
    pub(super) ends: [VertexId; 2],
    /// Unit direction, from the one behind to the one ahead.
    pub(super) along: P,
}

/// Finds the rail of a vertex: two of its edges that lie in one line, whose
/// far ends are not free to leave it. `None` at a bend of the boundary.
///
/// Of several candidates, edges on the unbounded face win, then the
/// straightest.
pub(super) fn rail<E: Clone>(
    mesh: &PlanarMesh<E>,
    v: VertexId,
    freedom: &[Freedom],
) -> Option<Rail> {
    let at = mesh.point(v);
    let edges: Vec<_> = mesh
        .outgoing(v)
        .filter(|&h| freedom[mesh.dest(h).0 as usize] != Freedom::Free)
        .collect();
    let mut best: Option<((bool, f64), Rail)> = None;
    for (i, &g) in edges.iter().enumerate() {
        for &h in &edges[i + 1..] {
            let (g, h) = (g.min(h), g.max(h));
            let (p, q) = (mesh.end(g), mesh.end(h));
            let span = sub(q, p);
            let length = norm(span);
            let off = dist_to_segment(at, p, q);
            // Rounding of a cut edge, or a millionth of a turn.
            let straight = off <= (16.0 * mesh.tolerance()).max(1e-6 * length);
            if !straight || dot(sub(p, at), sub(q, at)) >= 0.0 {
                continue;
            }
            let inside = ![g, g.twin(), h, h.twin()]
                .iter()
                .any(|&s| mesh.is_outside(mesh.face(s)));
            let key = (inside, off / length);
            if best.is_none_or(|b| key < b.0) {
                let rail = Rail {
                    ends: [mesh.dest(g), mesh.dest(h)],
                    along: P {
                        x: span.x / length,
                        y: span.y / length,
                    },
                };
                best = Some((key, rail));
            }
        }
    }
    best.map(|b| b.1)
}

/// How far a sliding vertex may go from where it is, behind (not positive)
/// and ahead (not negative): up to `clearance` or the fraction `margin` of
/// the gap short of a fixed neighbour, half as far where the neighbour
/// slides too, so that the two cannot pass each other.
pub(super) fn room(
    rail: &Rail,
    at: P,
    place: &dyn Fn(VertexId) -> P,
    slides: &dyn Fn(VertexId) -> bool,
    margin: f64,
    clearance: f64,
) -> (f64, f64) {
    let side = |end: VertexId, sign: f64| {
        let gap = sign * dot(sub(place(end), at), rail.along);
        let share = if slides(end) { 0.5 } else { 1.0 };
        (share * (gap * (1.0 - margin)).min(gap - clearance)).max(0.0)
    };
    (-side(rail.ends[0], -1.0), side(rail.ends[1], 1.0))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn room_ends_before_the_neighbours() {
        let rail = Rail {
            ends: [VertexId(0), VertexId(1)],
            along: P { x: 1., y: 0. },
        };
        let place = |v: VertexId| P {
            x: if v.0 == 0 { 0. } else { 100. },
            y: 0.,
        };
        let at = P { x: 40., y: 0. };
        assert_eq!(
            room(&rail, at, &place, &|v| v.0 == 1, 0.1, 0.0),
            (-36., 27.)
        );
        assert_eq!(room(&rail, at, &place, &|_| false, 0.0, 50.0), (-0., 10.));
    }
}
