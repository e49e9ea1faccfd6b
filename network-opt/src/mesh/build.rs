//! Edges that meet only at points in, linked loops and faces out.

use super::arrange::{Arrangement, Piece};
use super::index::SegmentIndex;
use super::planar::{Face, FaceId, Half, HalfEdgeId, PlanarMesh, Vertex, VertexId};
use super::predicates::{by_angle, east_of, lexical, west_of, P};
use crate::error::MeshError;

/// Links an arrangement into a mesh. The unbounded face gets id 0, bounded
/// faces follow in the order of their lowest half-edge.
pub(super) fn build<E: Clone>(
    lines: &Arrangement,
    attrs: impl Fn(&Piece) -> (E, E),
) -> Result<PlanarMesh<E>, MeshError> {
    if lines.pieces.len() >= (u32::MAX / 2) as usize {
        return Err(MeshError::Full);
    }
    let mut mesh = PlanarMesh {
        vertices: lines
            .points
            .iter()
            .map(|&point| Vertex {
                point,
                half: HalfEdgeId::NONE,
                live: true,
            })
            .collect(),
        halves: Vec::with_capacity(2 * lines.pieces.len()),
        faces: Vec::new(),
        tolerance: lines.tolerance,
        snap: lines.snap,
    };
    for piece in &lines.pieces {
        let (left, right) = attrs(piece);
        for (v, attr) in [(piece.a, left), (piece.b, right)] {
            let h = HalfEdgeId(mesh.halves.len() as u32);
            mesh.halves.push(Half {
                origin: VertexId(v),
                next: h.twin(),
                prev: h.twin(),
                face: FaceId::NONE,
                live: true,
                attr,
            });
        }
    }
    link_around_vertices(&mut mesh);
    find_faces(&mut mesh);
    Ok(mesh)
}

/// Sorts the edges around each vertex and links what follows what.
fn link_around_vertices<E: Clone>(mesh: &mut PlanarMesh<E>) {
    let mut spokes: Vec<HalfEdgeId> = mesh.half_edges().collect();
    spokes.sort_by(|&a, &b| {
        let (u, v) = (mesh.origin(a), mesh.origin(b));
        u.cmp(&v)
            .then_with(|| by_angle(mesh.point(u), mesh.end(a), mesh.end(b)))
    });
    let mut from = 0;
    while from < spokes.len() {
        let v = mesh.origin(spokes[from]);
        let count = spokes[from..]
            .iter()
            .take_while(|&&h| mesh.origin(h) == v)
            .count();
        let star = &spokes[from..from + count];
        mesh.vertices[v.0 as usize].half = star[0];
        for (i, &h) in star.iter().enumerate() {
            // Arriving along h's twin with the face on the left, the loop
            // leaves by the next spoke clockwise.
            let clockwise = star[(i + count - 1) % count];
            mesh.link(h.twin(), clockwise);
        }
        from += count;
    }
}

/// Makes faces of the loops and gives holes to the faces around them.
fn find_faces<E: Clone>(mesh: &mut PlanarMesh<E>) {
    // Loops, by their lowest half-edge.
    let none = usize::MAX;
    let mut loop_of = vec![none; mesh.halves.len()];
    let mut reps: Vec<HalfEdgeId> = Vec::new();
    for h in mesh.half_edges() {
        if loop_of[h.0 as usize] == none {
            for g in mesh.walk(h) {
                loop_of[g.0 as usize] = reps.len();
            }
            reps.push(h);
        }
    }
    // A loop is a contour (the outside of its connected part) or the outer
    // loop of a face.
    let mut face_of = vec![FaceId::NONE; reps.len()];
    mesh.faces.push(Face {
        loops: Vec::new(),
        live: true,
    });
    let mut contours: Vec<(P, usize)> = Vec::new();
    for (i, &rep) in reps.iter().enumerate() {
        if mesh.is_contour(rep) {
            let west = mesh
                .walk(rep)
                .map(|h| mesh.start(h))
                .min_by(|a, b| lexical(*a, *b));
            contours.push((west.unwrap_or(mesh.start(rep)), i));
        } else {
            face_of[i] = FaceId(mesh.faces.len() as u32);
            mesh.faces.push(Face {
                loops: vec![rep],
                live: true,
            });
        }
    }
    // West to east, so that what lies west of a part has its face already.
    contours.sort_by(|a, b| lexical(a.0, b.0).then(a.1.cmp(&b.1)));
    let index = (contours.len() > 1)
        .then(|| SegmentIndex::new(mesh.edges().map(|h| (h.0, mesh.start(h), mesh.end(h)))));
    let far_west = contours.first().map_or(0.0, |c| c.0.x);
    let mut near = Vec::new();
    for &(west, i) in &contours {
        let mut hit = None;
        if let Some(index) = &index {
            index.near(
                P {
                    x: far_west,
                    y: west.y,
                },
                west,
                0.0,
                &mut near,
            );
            hit = first_west(
                mesh,
                west,
                near.iter()
                    .map(|&h| HalfEdgeId(h))
                    .filter(|h| loop_of[h.0 as usize] != i && loop_of[h.twin().0 as usize] != i),
            );
        }
        face_of[i] = hit.map_or(FaceId(0), |h| face_of[loop_of[h.0 as usize]]);
        mesh.faces[face_of[i].0 as usize].loops.push(reps[i]);
    }
    for (half, &l) in mesh.halves.iter_mut().zip(&loop_of) {
        half.face = face_of[l];
    }
}

/// The side, facing east, of the first edge met from `p` towards -x: the
/// half-edge that runs south. Exact.
pub(super) fn first_west<E: Clone>(
    mesh: &PlanarMesh<E>,
    p: P,
    edges: impl Iterator<Item = HalfEdgeId>,
) -> Option<HalfEdgeId> {
    let mut best: Option<(HalfEdgeId, P, P)> = None;
    for h in edges {
        let (a, b) = (mesh.start(h), mesh.end(h));
        if west_of(p, a, b) && best.is_none_or(|(_, c, d)| east_of(a, b, c, d)) {
            best = Some((h, a, b));
        }
    }
    best.map(|(h, a, b)| if a.y > b.y { h } else { h.twin() })
}
