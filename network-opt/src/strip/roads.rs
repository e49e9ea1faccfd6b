//! Roads (chains that run straight through crossings) and streets (chains
//! from junction to junction) of a mesh.

use crate::mesh::predicates::{dot, norm, sub};
use crate::mesh::{HalfEdgeId, PlanarMesh, VertexId};

/// The maximal roads of a mesh: chains of street edges that continue through
/// vertices by the smallest turn.
///
/// At each vertex the street edges are paired up, straightest pair first, as
/// long as the turn is at most `max_turn_deg` degrees; a road runs on through
/// its pairs. An edge is a street if `is_street` holds for the attribute of
/// either side. A closed road repeats its first vertex at the end. Each
/// street edge is in exactly one road; roads come in the order of their
/// lowest half-edge, so the result is the same for the same mesh.
///
/// # Examples
///
/// ```
/// use geo_types::line_string;
/// use network_opt::{roads, PlanarMesh, Wire};
///
/// let wire = |line| Wire { line, left: true, right: true, priority: 0 };
/// let cross = [
///     wire(line_string![(x: 0., y: 0.), (x: 10., y: 1.), (x: 20., y: 0.)]),
///     wire(line_string![(x: 10., y: -9.), (x: 10., y: 11.)]),
/// ];
/// let mesh = PlanarMesh::from_linework(&cross, 0.01)?;
/// let roads = roads(&mesh, |&street| street, 40.0);
/// assert_eq!(roads.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
/// # Ok::<(), network_opt::MeshError>(())
/// ```
///
/// # References
///
/// Urban Pattern, section 6: "We extract all roads"; how is left open there.
pub fn roads<E: Clone>(
    mesh: &PlanarMesh<E>,
    is_street: impl Fn(&E) -> bool,
    max_turn_deg: f64,
) -> Vec<Vec<VertexId>> {
    let street = street_edges(mesh, is_street);
    // Which half-edge goes on after each: the other way back is its twin's.
    let mut after = vec![HalfEdgeId::NONE; mesh.half_edge_bound()];
    let limit = max_turn_deg.to_radians().cos();
    for v in mesh.vertices() {
        let star: Vec<HalfEdgeId> = mesh
            .outgoing(v)
            .filter(|h| street[h.edge().0 as usize])
            .collect();
        let at = mesh.point(v);
        let mut pairs: Vec<(f64, HalfEdgeId, HalfEdgeId)> = Vec::new();
        for (i, &g) in star.iter().enumerate() {
            for &h in &star[i + 1..] {
                let (d, e) = (sub(mesh.end(g), at), sub(mesh.end(h), at));
                let straight = -dot(d, e) / (norm(d) * norm(e));
                if straight >= limit {
                    pairs.push((straight, g.min(h), g.max(h)));
                }
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, g, h) in pairs {
            let free = |x: HalfEdgeId| after[x.twin().0 as usize] == HalfEdgeId::NONE;
            if free(g) && free(h) {
                after[g.twin().0 as usize] = h;
                after[h.twin().0 as usize] = g;
            }
        }
    }
    chains(mesh, &street, |h| {
        Some(after[h.0 as usize]).filter(|&n| n != HalfEdgeId::NONE)
    })
}

/// The streets of a mesh: chains of street edges between junctions, dead ends
/// included. A junction is a vertex whose number of street edges is not two.
/// A closed chain without any junction repeats its first vertex at the end.
/// Each street edge is in exactly one street; order as for [`roads`].
pub fn streets<E: Clone>(
    mesh: &PlanarMesh<E>,
    is_street: impl Fn(&E) -> bool,
) -> Vec<Vec<VertexId>> {
    let street = street_edges(mesh, is_street);
    chains(mesh, &street, |h| {
        let mut on = mesh
            .outgoing(mesh.dest(h))
            .filter(|g| street[g.edge().0 as usize]);
        let two = [on.next(), on.next()];
        match (two, on.next()) {
            ([Some(a), Some(b)], None) => Some(if a == h.twin() { b } else { a }),
            _ => None,
        }
    })
}

/// Per half-edge id, whether its edge (the even id) is a street.
fn street_edges<E: Clone>(mesh: &PlanarMesh<E>, is_street: impl Fn(&E) -> bool) -> Vec<bool> {
    let mut street = vec![false; mesh.half_edge_bound()];
    for h in mesh.edges() {
        street[h.0 as usize] = is_street(mesh.attr(h)) || is_street(mesh.attr(h.twin()));
    }
    street
}

/// Follows `after` from every street edge not yet in a chain, both ways.
fn chains<E: Clone>(
    mesh: &PlanarMesh<E>,
    street: &[bool],
    after: impl Fn(HalfEdgeId) -> Option<HalfEdgeId>,
) -> Vec<Vec<VertexId>> {
    let mut used = vec![false; street.len()];
    let mut all = Vec::new();
    for start in mesh.edges().filter(|h| street[h.0 as usize]) {
        if used[start.0 as usize] {
            continue;
        }
        // Back to the chain's beginning, or once around.
        let mut first = start;
        while let Some(before) = after(first.twin()).map(HalfEdgeId::twin) {
            if before == start {
                first = start;
                break;
            }
            first = before;
        }
        let mut chain = vec![mesh.origin(first)];
        let mut h = first;
        loop {
            used[h.edge().0 as usize] = true;
            chain.push(mesh.dest(h));
            match after(h) {
                Some(n) if n != first => h = n,
                _ => break,
            }
        }
        all.push(chain);
    }
    all
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::mesh::Wire;
    use geo_types::{line_string, LineString};

    fn mesh(lines: Vec<LineString<f64>>) -> PlanarMesh<bool> {
        let wires: Vec<_> = lines
            .into_iter()
            .map(|line| Wire {
                line,
                left: true,
                right: false,
                priority: 0,
            })
            .collect();
        PlanarMesh::from_linework(&wires, 0.01).unwrap()
    }

    #[test]
    fn a_ring_is_closed_and_a_corner_ends_a_road() {
        let ring = mesh(vec![
            line_string![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.), (x: 0., y: 0.)],
        ]);
        let closed = roads(&ring, |&s| s, 100.0);
        assert_eq!(closed.len(), 1);
        assert_eq!((closed[0].len(), closed[0][0]), (5, closed[0][4]));
        assert_eq!(streets(&ring, |&s| s).len(), 1);
        assert_eq!(roads(&ring, |&s| s, 60.0).len(), 4);
    }

    #[test]
    fn streets_end_at_junctions_and_roads_run_through() {
        let tee = mesh(vec![
            line_string![(x: 0., y: 0.), (x: 5., y: 1.), (x: 10., y: 0.), (x: 20., y: 0.)],
            line_string![(x: 10., y: 0.), (x: 10., y: 9.)],
        ]);
        assert_eq!(streets(&tee, |&s| s).len(), 3);
        let mut lengths: Vec<usize> = roads(&tee, |&s| s, 45.0).iter().map(Vec::len).collect();
        lengths.sort_unstable();
        assert_eq!(lengths, [2, 4]);
    }
}
