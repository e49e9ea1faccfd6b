//! Collapsing short street edges before the optimisation.

use crate::mesh::{HalfEdgeId, PlanarMesh, VertexId};

/// Collapses edges shorter than `length` (metres), shortest first, and
/// returns how many. Two junctions closer than that become one.
///
/// A vertex for which `pinned` holds keeps its place; an edge between two of
/// them stays. Of two others, the one with more edges keeps its place (a
/// junction does not follow a bend); equals meet in the middle. An edge whose
/// collapse would break a face around it
/// ([`MeshError::WouldBreak`](crate::MeshError::WouldBreak)) stays.
///
/// # References
///
/// Urban Pattern, section 6, figure 8: "we collapse short road edges. This
/// avoids continuity problems at intersections".
pub fn collapse_short_edges<E: Clone>(
    mesh: &mut PlanarMesh<E>,
    length: f64,
    pinned: &dyn Fn(VertexId) -> bool,
) -> usize {
    let mut count = 0;
    // An edge that was refused may be possible once its neighbours are gone.
    loop {
        let mut short: Vec<(f64, HalfEdgeId)> = mesh
            .edges()
            .map(|h| (mesh.length(h), h))
            .filter(|&(l, _)| l < length)
            .collect();
        short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let before = count;
        for (_, h) in short {
            // Earlier collapses may have removed, moved or stretched it.
            if mesh.has_half_edge(h) && mesh.length(h) < length && collapse(mesh, h, pinned) {
                count += 1;
            }
        }
        if count == before {
            return count;
        }
    }
}

/// Collapses one edge towards the end that should stay.
fn collapse<E: Clone>(
    mesh: &mut PlanarMesh<E>,
    h: HalfEdgeId,
    pinned: &dyn Fn(VertexId) -> bool,
) -> bool {
    let rank = |v: VertexId| (pinned(v), mesh.degree(v));
    let (a, b) = (rank(mesh.origin(h)), rank(mesh.dest(h)));
    if a.0 && b.0 {
        return false;
    }
    // The origin of the half-edge survives: let it be the one that stays.
    let side = if b > a { h.twin() } else { h };
    let p = mesh.point(mesh.origin(side));
    let at = if a == b {
        let q = mesh.point(mesh.dest(side));
        geo_types::coord! { x: p.x + (q.x - p.x) / 2.0, y: p.y + (q.y - p.y) / 2.0 }
    } else {
        p
    };
    mesh.collapse_edge(side, at).is_ok()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::mesh::Wire;
    use geo_types::{coord, line_string};

    #[test]
    fn a_staggered_crossing_becomes_one() {
        let wire = |line, priority| Wire {
            line,
            left: (),
            right: (),
            priority,
        };
        let lines = [
            wire(
                line_string![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.), (x: 0., y: 0.)],
                1,
            ),
            wire(line_string![(x: 0., y: 30.), (x: 90., y: 30.)], 0),
            wire(line_string![(x: 44., y: 0.), (x: 44., y: 30.)], 0),
            wire(line_string![(x: 46., y: 30.), (x: 46., y: 60.)], 0),
        ];
        let mut mesh = PlanarMesh::from_linework(&lines, 0.01).unwrap();
        let rim: Vec<VertexId> = mesh
            .walk(mesh.loops(mesh.outside())[0])
            .map(|h| mesh.origin(h))
            .collect();
        let got = collapse_short_edges(&mut mesh, 5.0, &|v| rim.contains(&v));
        assert_eq!(got, 1);
        mesh.validate().unwrap();
        let middle = coord! { x: 45., y: 30. };
        let v = mesh.vertices().find(|&v| mesh.point(v) == middle).unwrap();
        assert_eq!(mesh.degree(v), 4);
        assert_eq!(mesh.bounded_faces().count(), 4);
        assert_eq!(collapse_short_edges(&mut mesh, 5.0, &|_| false), 0);
    }
}
