//! Keeps a step of the optimisation from turning a face inside out.

use super::target::TargetShape;
use crate::mesh::predicates::{cross, dot, sub, P};
use crate::mesh::sound::{face_fault, Ring};
use crate::mesh::{FaceId, PlanarMesh, VertexId};

/// A block as positions in the mesh: its ring, and its corners in the ring.
#[derive(Clone, Debug)]
pub(super) struct BlockRing {
    pub(super) face: FaceId,
    pub(super) ring: Vec<VertexId>,
    pub(super) corners: Option<[usize; 4]>,
}

impl BlockRing {
    pub(super) fn points(&self, points: &[P]) -> Vec<P> {
        self.ring.iter().map(|v| points[v.0 as usize]).collect()
    }
}

/// A face that moves, with all that its soundness depends on.
#[derive(Debug)]
struct Watched {
    face: FaceId,
    bounded: bool,
    loops: Vec<Vec<VertexId>>,
    /// (back, junction, out) of its junction corners, with the largest cosine
    /// that the corner may have.
    corners: Vec<([VertexId; 3], f64)>,
    block: Option<usize>,
}

/// After so many halvings a step is taken back whole.
const ROUNDS: usize = 8;

/// The faces around all vertices that move.
#[derive(Debug)]
pub(super) struct Guard {
    faces: Vec<Watched>,
    /// Per vertex id, which of `faces` it is on.
    at_vertex: Vec<Vec<u32>>,
    tolerance: f64,
}

impl Guard {
    /// Watches the faces around the vertices of `moving`. A junction's corner
    /// may not become sharper than `min_angle` (radians), or than it was.
    pub(super) fn new<E: Clone>(
        mesh: &PlanarMesh<E>,
        moving: &[bool],
        blocks: &[BlockRing],
        target: &dyn TargetShape,
        points: &[P],
        min_angle: f64,
    ) -> Self {
        let mut guard = Self {
            faces: Vec::new(),
            at_vertex: vec![Vec::new(); moving.len()],
            tolerance: mesh.tolerance(),
        };
        // The first block of each face that is acceptable to begin with.
        let mut block_of = vec![None; mesh.face_bound()];
        for (i, block) in blocks.iter().enumerate().rev() {
            if target.accepts(&block.points(points), block.corners) {
                block_of[block.face.0 as usize] = Some(i);
            }
        }
        for face in mesh.faces() {
            let loops: Vec<Vec<VertexId>> = mesh
                .loops(face)
                .into_iter()
                .map(|l| mesh.walk(l).map(|h| mesh.origin(h)).collect())
                .collect();
            if !loops.iter().flatten().any(|v| moving[v.0 as usize]) {
                continue;
            }
            let mut corners = Vec::new();
            for ring in &loops {
                let n = ring.len();
                for i in 0..n {
                    let c = [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
                    if c[0] != c[2] && mesh.degree(c[1]) > 2 {
                        let now = sharpness(c, points);
                        corners.push((c, now.max(min_angle.cos()) + 1e-9));
                    }
                }
            }
            let index = guard.faces.len() as u32;
            let mut on: Vec<VertexId> = loops.iter().flatten().copied().collect();
            on.sort_unstable();
            on.dedup();
            for v in on {
                guard.at_vertex[v.0 as usize].push(index);
            }
            guard.faces.push(Watched {
                face,
                bounded: !mesh.is_outside(face),
                loops,
                corners,
                block: block_of[face.0 as usize],
            });
        }
        guard
    }

    /// The geometric fault of a face, if it has one.
    fn fault(&self, face: &Watched, points: &[P], tol: f64) -> Option<(&'static str, P)> {
        let rings: Vec<Ring> = face
            .loops
            .iter()
            .map(|l| l.iter().map(|&v| (v, points[v.0 as usize])).collect())
            .collect();
        face_fault(&rings, face.bounded, tol)
    }

    /// The first face that is not sound to begin with.
    pub(super) fn first_fault(&self, points: &[P]) -> Option<(FaceId, &'static str, P)> {
        self.faces.iter().find_map(|f| {
            self.fault(f, points, self.tolerance / 2.0)
                .map(|(what, p)| (f.face, what, p))
        })
    }

    fn accepts(
        &self,
        index: u32,
        points: &[P],
        blocks: &[BlockRing],
        target: &dyn TargetShape,
    ) -> bool {
        let face = &self.faces[index as usize];
        face.corners
            .iter()
            .all(|&(c, max)| sharpness(c, points) <= max)
            && self.fault(face, points, self.tolerance / 2.0).is_none()
            && face
                .block
                .is_none_or(|b| target.accepts(&blocks[b].points(points), blocks[b].corners))
    }

    /// Shortens the steps from `old` to `new` around faces that would break,
    /// halving them there until all faces are sound. Returns how many
    /// vertices were held back. `old` must be sound.
    pub(super) fn damp(
        &self,
        old: &[P],
        new: &mut [P],
        blocks: &[BlockRing],
        target: &dyn TargetShape,
    ) -> usize {
        let full = new.to_vec();
        let mut share = vec![1.0_f64; new.len()];
        let mut pending: Vec<u32> = (0..self.faces.len() as u32).collect();
        // A round slows all of a broken face to half of its slowest vertex.
        // From the last round on steps are taken back whole, so that the
        // rounds end: at the latest with nothing moved.
        let mut round = 0;
        while !pending.is_empty() {
            let mut slowed: Vec<(usize, f64)> = Vec::new();
            for &f in &pending {
                if self.accepts(f, new, blocks, target) {
                    continue;
                }
                let on = || self.faces[f as usize].loops.iter().flatten();
                let least = on().map(|v| share[v.0 as usize]).fold(1.0, f64::min);
                let next = if round < ROUNDS { 0.5 * least } else { 0.0 };
                slowed.extend(on().map(|v| (v.0 as usize, next)));
            }
            pending.clear();
            for (i, next) in slowed {
                if full[i] != old[i] && next < share[i] {
                    share[i] = next;
                    new[i] = between(old[i], full[i], next);
                    pending.extend(&self.at_vertex[i]);
                }
            }
            pending.sort_unstable();
            pending.dedup();
            round += 1;
        }
        share.iter().filter(|&&s| s < 1.0).count()
    }

    /// Are all faces sound and acceptable?
    pub(super) fn all_accept(
        &self,
        points: &[P],
        blocks: &[BlockRing],
        target: &dyn TargetShape,
    ) -> bool {
        (0..self.faces.len() as u32).all(|f| self.accepts(f, points, blocks, target))
    }
}

/// `old + (new - old) share`, exact at both ends.
pub(super) fn between(old: P, new: P, share: f64) -> P {
    if share >= 1.0 {
        new
    } else if share <= 0.0 {
        old
    } else {
        P {
            x: old.x + (new.x - old.x) * share,
            y: old.y + (new.y - old.y) * share,
        }
    }
}

/// Cosine of the angle that a face has at a corner; -1 for straight and
/// reflex ones, which are never too sharp.
fn sharpness([back, at, out]: [VertexId; 3], points: &[P]) -> f64 {
    let p = |v: VertexId| points[v.0 as usize];
    let (d, e) = (sub(p(out), p(at)), sub(p(back), p(at)));
    let c = cross(d, e);
    if c > 0.0 {
        dot(d, e) / c.hypot(dot(d, e))
    } else {
        -1.0
    }
}
