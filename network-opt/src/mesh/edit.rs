//! Removing edges and vertices, collapsing edges.

use super::planar::{FaceId, HalfEdgeId, PlanarMesh, VertexId};
use super::predicates::{finite, P};
use super::sound::{face_fault, Ring};
use crate::error::MeshError;
use geo_types::Coord;

impl<E: Clone> PlanarMesh<E> {
    /// Removes an edge. The faces on its sides become one: the one left of
    /// `h` survives, or the unbounded face if it is one of the two. Vertices
    /// that lose their last edge go too. Returns the surviving face.
    ///
    /// # Errors
    ///
    /// [`MeshError::NoHalfEdge`].
    pub fn remove_edge(&mut self, h: HalfEdgeId) -> Result<FaceId, MeshError> {
        if !self.has_half_edge(h) {
            return Err(MeshError::NoHalfEdge(h));
        }
        let t = h.twin();
        let (mut keep, mut gone) = (self.face(h), self.face(t));
        if self.is_outside(gone) {
            std::mem::swap(&mut keep, &mut gone);
        }
        let mut candidates = self.loops(keep);
        if gone != keep {
            candidates.extend(self.loops(gone));
        }
        candidates.extend([self.prev(h), self.next(h), self.prev(t), self.next(t)]);
        candidates.retain(|&c| c != h && c != t);
        for (h, t) in [(h, t), (t, h)] {
            // At the origin of h: what comes before h goes on where t would.
            let v = self.origin(h).0 as usize;
            let (before, after) = (self.prev(h), self.next(t));
            if before == t {
                self.vertices[v].live = false;
            } else {
                self.link(before, after);
                self.vertices[v].half = after;
            }
        }
        self.halves[h.0 as usize].live = false;
        self.halves[t.0 as usize].live = false;
        if gone != keep {
            self.faces[gone.0 as usize].live = false;
            self.faces[gone.0 as usize].loops.clear();
        }
        let (outers, holes) = self.sort_loops(&candidates);
        self.set_loops(keep, &outers, &holes);
        Ok(keep)
    }

    /// Removes a vertex with exactly two edges, joining them into one. The
    /// attributes of both sides are those of the edge of the vertex's
    /// [first](Self::outgoing) half-edge, which stays; returned is that
    /// half-edge, now leaving the other neighbour.
    ///
    /// # Errors
    ///
    /// [`MeshError::NoVertex`], [`MeshError::NotDegreeTwo`], and
    /// [`MeshError::WouldBreak`] if the straight edge is there already or
    /// would cross or touch anything.
    pub fn remove_vertex_of_degree_2(&mut self, v: VertexId) -> Result<HalfEdgeId, MeshError> {
        if !self.has_vertex(v) {
            return Err(MeshError::NoVertex(v));
        }
        let degree = self.degree(v);
        if degree != 2 {
            return Err(MeshError::NotDegreeTwo { vertex: v, degree });
        }
        // v -> b stays as a -> b.
        let out = self.vertices[v.0 as usize].half;
        let into = self.prev(out);
        let a = self.origin(into);
        self.check_merge(v, a, self.point(a), into, "remove_vertex_of_degree_2")?;
        self.unlink_collapsed(into, v, a);
        Ok(out)
    }

    /// Collapses an edge into one vertex at `at`: the origin of `h` survives
    /// and moves there, the other end goes.
    ///
    /// # Errors
    ///
    /// [`MeshError::NoHalfEdge`], [`MeshError::NonFinitePoint`], and
    /// [`MeshError::WouldBreak`] if a face around would lose its area, cross
    /// itself or turn inside out, or if the edge is all there is of its
    /// connected part.
    pub fn collapse_edge(&mut self, h: HalfEdgeId, at: Coord<f64>) -> Result<VertexId, MeshError> {
        if !self.has_half_edge(h) {
            return Err(MeshError::NoHalfEdge(h));
        }
        if !finite(at) {
            return Err(MeshError::NonFinitePoint {
                operation: "collapse_edge",
                x: at.x,
                y: at.y,
            });
        }
        let (a, b) = (self.origin(h), self.dest(h));
        self.check_merge(b, a, at, h, "collapse_edge")?;
        self.unlink_collapsed(h, b, a);
        self.vertices[a.0 as usize].point = at;
        Ok(a)
    }

    /// Would the mesh stay sound if `gone` became `kept`, at `at`, and the
    /// edge `h` between them went?
    fn check_merge(
        &self,
        gone: VertexId,
        kept: VertexId,
        at: P,
        h: HalfEdgeId,
        operation: &'static str,
    ) -> Result<(), MeshError> {
        let refuse = |face| MeshError::WouldBreak {
            operation,
            face,
            x: at.x,
            y: at.y,
        };
        if self.degree(gone) == 1 && self.degree(kept) == 1 {
            return Err(refuse(self.face(h)));
        }
        // A common neighbour would get two edges to one vertex.
        let mut around: Vec<VertexId> = self.outgoing(kept).map(|o| self.dest(o)).collect();
        around.sort_unstable();
        if let Some(o) = self
            .outgoing(gone)
            .find(|&o| around.binary_search(&self.dest(o)).is_ok())
        {
            return Err(refuse(self.face(o)));
        }
        let mut faces: Vec<FaceId> = [gone, kept]
            .into_iter()
            .flat_map(|v| self.outgoing(v))
            .map(|o| self.face(o))
            .collect();
        faces.sort_unstable();
        faces.dedup();
        // A vertex of degree two that goes in place moves one edge only: the
        // faces that it does not touch cannot change.
        if at == self.point(kept) {
            faces.retain(|&f| self.outgoing(gone).any(|o| self.face(o) == f));
        }
        for f in faces {
            let rings: Vec<Ring> = self
                .loops(f)
                .into_iter()
                .map(|l| {
                    self.walk(l)
                        .filter(|g| g.edge() != h.edge())
                        .map(|g| self.origin(g))
                        .map(|v| {
                            if v == gone || v == kept {
                                (kept, at)
                            } else {
                                (v, self.point(v))
                            }
                        })
                        .collect()
                })
                .collect();
            if face_fault(&rings, !self.is_outside(f), self.tolerance).is_some() {
                return Err(refuse(f));
            }
        }
        Ok(())
    }

    /// Takes the edge `h` out and gives all edges of `gone` to `kept`.
    fn unlink_collapsed(&mut self, h: HalfEdgeId, gone: VertexId, kept: VertexId) {
        let t = h.twin();
        let moved: Vec<HalfEdgeId> = self.outgoing(gone).collect();
        for o in moved {
            self.halves[o.0 as usize].origin = kept;
        }
        for g in [h, t] {
            let (before, after) = (self.prev(g), self.next(g));
            self.link(before, after);
            let f = self.face(g);
            // Another half-edge of the loop stands for it; the loop has one,
            // or it would have been refused.
            let stand_in = [before, after, self.prev(before), self.next(after)]
                .into_iter()
                .find(|&s| s != h && s != t);
            for l in &mut self.faces[f.0 as usize].loops {
                if *l == g {
                    *l = stand_in.unwrap_or(before);
                }
            }
        }
        // A half-edge that leaves the merged vertex.
        let live = [
            self.next(h),
            self.next(t),
            self.prev(h).twin(),
            self.prev(t).twin(),
        ]
        .into_iter()
        .find(|&s| s != h && s != t && self.origin(s) == kept);
        self.vertices[kept.0 as usize].half = live.unwrap_or(HalfEdgeId::NONE);
        self.vertices[gone.0 as usize].live = false;
        self.halves[h.0 as usize].live = false;
        self.halves[t.0 as usize].live = false;
    }
}
