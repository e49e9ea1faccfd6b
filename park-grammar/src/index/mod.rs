//! Which edges make a side: the logical sides of regions that come without.

use geo_types::Coord;

use crate::plane::{cross, dot, unit};
use crate::shape::Region;

/// Numbers the sides of a region by the local directions that its outer edges
/// face: 0 where x is low, 1 where y is high, 2 and 3 opposite. Edges that face
/// between two of them join the longer neighbour.
pub(crate) fn by_local(region: &mut Region) {
    let [a, b, _, d] = region.local.corners;
    let (x, y) = (unit(d - a), unit(b - a));
    // The land lies on the right of an edge, so that it faces to the left.
    let faces = |p: Coord<f64>, q: Coord<f64>| {
        let out = {
            let along = unit(q - p);
            Coord {
                x: -along.y,
                y: along.x,
            }
        };
        // Solved for local axes that need not be at right angles.
        let det = cross(x, y);
        let (u, v) = if det.abs() > 1e-9 {
            (cross(out, y) / det, cross(x, out) / det)
        } else {
            (dot(out, x), dot(out, y))
        };
        if u.abs() >= v.abs() {
            if u < 0.0 {
                0
            } else {
                2
            }
        } else if v > 0.0 {
            1
        } else {
            3
        }
    };
    let sides: Vec<usize> = region.edges(0).map(|(p, q, _)| faces(p, q)).collect();
    for (edge, side) in region.edges[0].iter_mut().zip(sides) {
        edge.side = Some(side);
    }
    region.sides = 4;
}

/// Numbers the sides of the park itself, and makes each of its edges a part of
/// the boundary.
pub(crate) fn park(region: &mut Region) {
    by_local(region);
    for edges in &mut region.edges {
        for edge in edges {
            edge.origin.boundary = Some(edge.side.unwrap_or(region.sides));
            edge.origin.descent = edge.side;
        }
    }
}
