//! Laying one street through a region: the step that the planner takes, and
//! that a splitter may try on a copy of the network.

use geo_types::Coord;
use network_opt::{End, FaceId, VertexId};

use crate::network::{Network, SideKind, StreetInfo};
use crate::plane::dist;
use crate::region::{Place, Region};
use crate::splitter::Cut;

/// Least distance of a street's end from a junction along the street it meets,
/// over the street's width.
pub(crate) const KEEP_OFF: f64 = 1.7;

/// The same as the crow flies, over the distance along the street: notches of
/// the boundary bring far places together.
const LEAST_SPACING: f64 = 0.85;

/// Lays `cut` through the face of `region`, its ends at least `clear` metres
/// from junctions. Returns the faces that the region's has become; `None`, and
/// the network as it was, if there is no room for it.
pub(crate) fn lay(
    network: &mut Network,
    region: &Region,
    cut: &Cut,
    info: StreetInfo,
    clear: f64,
) -> Option<Vec<FaceId>> {
    let first = cut.path.first().copied().unwrap_or(cut.to.at);
    let last = cut.path.last().copied().unwrap_or(cut.from.at);
    let from = end(network, region, &cut.from, first, clear)?;
    let to = end(network, region, &cut.to, last, clear)?;
    let side = network.add_street(info);
    let split = network
        .mesh
        .split_face(region.face, &cut.path, from, to, side, side);
    if split.is_err() {
        network.streets.pop();
    }
    split.ok().map(|split| split.faces)
}

/// Where a cut's end lies on the region's boundary now; `None` if a junction
/// has come too close since the cut was proposed.
fn end(
    network: &Network,
    region: &Region,
    place: &Place,
    towards: Coord<f64>,
    clear: f64,
) -> Option<End> {
    let Place { ring, edge, at } = region.place_facing(place.at, towards);
    if dist(at, place.at) > 1e-3 {
        return None;
    }
    let l = &region.loops[ring];
    let position = l.position(edge, at);
    let (a, b) = l.edge(edge);
    let vertex = if dist(a, at) < 1e-3 {
        Some(l.vertices[edge])
    } else if dist(b, at) < 1e-3 {
        Some(l.vertices[(edge + 1) % l.vertices.len()])
    } else {
        None
    };
    let crowded = l
        .nodes
        .iter()
        .any(|n| Some(n.vertex) != vertex && n.junction && l.between(n.position, position) < clear);
    if crowded {
        return None;
    }
    let mesh = &network.mesh;
    let near = |v: VertexId| Some(v) != vertex && dist(mesh.point(v), at) < LEAST_SPACING * clear;
    if l.sides[edge].kind == SideKind::Boundary && network.mouths().any(near) {
        return None;
    }
    // A vertex takes at most four streets.
    match vertex {
        Some(v) if network.streets_at(v).len() > 3 => None,
        Some(v) => Some(End::Vertex(v)),
        None => Some(End::Edge(l.half_edges[edge], at)),
    }
}
