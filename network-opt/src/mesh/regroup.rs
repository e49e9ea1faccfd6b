//! Sorting loops into faces after an edit.

use super::planar::{Face, FaceId, HalfEdgeId, PlanarMesh};
use super::predicates::{in_ring, P};

impl<E: Clone> PlanarMesh<E> {
    /// Sorts loops into faces after `h` has closed a path in `f`; returns
    /// the face left of `h` and, if another, the one right of it.
    pub(super) fn regroup_after_closing(&mut self, f: FaceId, h: HalfEdgeId) -> Vec<FaceId> {
        let t = h.twin();
        let mut candidates = self.loops(f);
        candidates.extend([h, t]);
        let (outers, holes) = self.sort_loops(&candidates);
        let joined = self.walk(h).any(|g| g == t);
        if joined {
            self.set_loops(f, &outers, &holes);
            return vec![f];
        }
        // The face fell in two. One side is an outer loop, bounded by the
        // path: `inner`. It takes the holes inside it; the other side, an
        // outer loop too or a rim around it, keeps the rest.
        let sides = |side| {
            let mut all: Vec<HalfEdgeId> = self.walk(side).collect();
            all.sort_unstable();
            all
        };
        let (left, right) = (sides(h), sides(t));
        let on = |side: &[HalfEdgeId], l: HalfEdgeId| side.binary_search(&l).is_ok();
        let left_is_rim = holes.iter().any(|&l| on(&left, l));
        let (inner, inner_side, other_side) = if left_is_rim {
            (t, &right, &left)
        } else {
            (h, &left, &right)
        };
        let edges: Vec<(P, P)> = self
            .walk(inner)
            .map(|g| (self.start(g), self.end(g)))
            .collect();
        let (inside, beside): (Vec<_>, Vec<_>) = holes
            .iter()
            .copied()
            .partition(|&l| !on(other_side, l) && in_ring(self.start(l), edges.iter().copied()));
        let (inner_outer, other): (Vec<_>, Vec<_>) =
            outers.iter().copied().partition(|&l| on(inner_side, l));

        let fresh = FaceId(self.faces.len() as u32);
        self.faces.push(Face {
            loops: Vec::new(),
            live: true,
        });
        // The left side keeps the id, unless that would give the unbounded
        // face's id to a bounded one.
        let (inner_id, other_id) = if inner == h && !self.is_outside(f) {
            (f, fresh)
        } else {
            (fresh, f)
        };
        self.set_loops(inner_id, &inner_outer, &inside);
        self.set_loops(other_id, &other, &beside);
        vec![self.face(h), self.face(t)]
    }

    /// The different loops among those of `candidates`, each by its first
    /// candidate: outer loops, and contours.
    pub(super) fn sort_loops(
        &self,
        candidates: &[HalfEdgeId],
    ) -> (Vec<HalfEdgeId>, Vec<HalfEdgeId>) {
        let mut wanted: Vec<(HalfEdgeId, usize)> = candidates
            .iter()
            .copied()
            .enumerate()
            .map(|(i, h)| (h, i))
            .collect();
        wanted.sort_unstable();
        let mut done = vec![false; candidates.len()];
        let (mut outers, mut holes) = (Vec::new(), Vec::new());
        for (i, &rep) in candidates.iter().enumerate() {
            if done[i] {
                continue;
            }
            for h in self.walk(rep) {
                let from = wanted.partition_point(|w| w.0 < h);
                for w in wanted[from..].iter().take_while(|w| w.0 == h) {
                    done[w.1] = true;
                }
            }
            if self.is_contour(rep) {
                holes.push(rep);
            } else {
                outers.push(rep);
            }
        }
        (outers, holes)
    }

    /// Makes these the loops of a face, and it the face of their half-edges.
    pub(super) fn set_loops(&mut self, f: FaceId, outers: &[HalfEdgeId], holes: &[HalfEdgeId]) {
        let loops: Vec<HalfEdgeId> = outers.iter().chain(holes).copied().collect();
        for &l in &loops {
            let sides: Vec<HalfEdgeId> = self.walk(l).collect();
            for h in sides {
                self.halves[h.0 as usize].face = f;
            }
        }
        self.faces[f.0 as usize].loops = loops;
    }
}
