//! The proof that a mesh is sound.

use super::build::first_west;
use super::index::SegmentIndex;
use super::planar::{FaceId, HalfEdgeId, PlanarMesh};
use super::predicates::{by_angle, P};
use crate::error::MeshFault;

impl<E: Clone> PlanarMesh<E> {
    /// Proves that the mesh is a proper subdivision of the plane.
    ///
    /// - Links: twins, `next` and `prev`, origins, every half-edge in exactly
    ///   one loop of its face, every vertex's star complete and sorted
    ///   counter-clockwise (exactly);
    /// - Euler: V - E + F = 1 + C, for C connected parts;
    /// - geometry: every bounded face simple, of positive area, its holes
    ///   inside and apart; no vertex within half of
    ///   [`tolerance`](Self::tolerance) of an edge that it does not end; no
    ///   repeated edges.
    ///
    /// An empty mesh (every edge removed) is sound.
    ///
    /// # Errors
    ///
    /// The first [`MeshFault`] found.
    ///
    /// # Complexity
    ///
    /// About O(n log n) for faces of street-network size.
    pub fn validate(&self) -> Result<(), MeshFault> {
        self.check_links()?;
        self.check_loops()?;
        self.check_stars()?;
        self.check_euler()?;
        for f in self.faces() {
            if let Some((what, p)) = self.face_fault_at(f, self.tolerance / 2.0, &|v| self.point(v))
            {
                return Err(MeshFault::Face {
                    face: f,
                    what,
                    x: p.x,
                    y: p.y,
                });
            }
        }
        self.check_nesting()
    }

    fn check_links(&self) -> Result<(), MeshFault> {
        for h in self.half_edges() {
            let fault = |what| Err(MeshFault::Links { half_edge: h, what });
            let (n, p) = (self.next(h), self.prev(h));
            if !self.has_half_edge(h.twin()) {
                return fault("its twin does not exist");
            }
            if !self.has_half_edge(n) || self.prev(n) != h {
                return fault("the one before its next is another");
            }
            if !self.has_half_edge(p) || self.next(p) != h {
                return fault("the one after its previous is another");
            }
            if self.origin(n) != self.dest(h) {
                return fault("its next starts elsewhere");
            }
            if !self.has_vertex(self.origin(h)) {
                return fault("its origin does not exist");
            }
            if self.origin(h) == self.dest(h) {
                return fault("it starts where it ends");
            }
            if !self.has_face(self.face(h)) || self.face(n) != self.face(h) {
                return fault("its face does not exist or changes along the loop");
            }
        }
        Ok(())
    }

    fn check_loops(&self) -> Result<(), MeshFault> {
        let mut seen = vec![false; self.halves.len()];
        for f in self.faces() {
            let at = |h: Option<&HalfEdgeId>| {
                h.map_or(
                    P {
                        x: f64::NAN,
                        y: f64::NAN,
                    },
                    |&h| self.start(h),
                )
            };
            let loops = self.loops(f);
            let fault = |what| {
                let P { x, y } = at(loops.first());
                Err(MeshFault::Face {
                    face: f,
                    what,
                    x,
                    y,
                })
            };
            if loops.is_empty() && !self.is_outside(f) {
                return fault("it has no loop");
            }
            for &l in &loops {
                for h in self.walk(l) {
                    if std::mem::replace(&mut seen[h.0 as usize], true) {
                        return fault("a half-edge is in two loops");
                    }
                    if self.face(h) != f {
                        return fault("a half-edge of its loop names another face");
                    }
                }
            }
        }
        match self.half_edges().find(|h| !seen[h.0 as usize]) {
            Some(half_edge) => Err(MeshFault::Links {
                half_edge,
                what: "it is in no loop of its face",
            }),
            None => Ok(()),
        }
    }

    fn check_stars(&self) -> Result<(), MeshFault> {
        let mut degree = vec![0_usize; self.vertices.len()];
        for h in self.half_edges() {
            degree[self.origin(h).0 as usize] += 1;
        }
        for v in self.vertices() {
            let fault = |what| Err(MeshFault::Vertex { vertex: v, what });
            let star: Vec<HalfEdgeId> = self.outgoing(v).collect();
            if star.is_empty() || star.iter().any(|&h| !self.has_half_edge(h)) {
                return fault("it has no edge");
            }
            if star.len() != degree[v.0 as usize] || star.iter().any(|&h| self.origin(h) != v) {
                return fault("walking around it does not meet all its edges");
            }
            // Once around, angles grow except at one place.
            let at = self.point(v);
            let descents = (0..star.len())
                .filter(|&i| {
                    let (a, b) = (star[i], star[(i + 1) % star.len()]);
                    by_angle(at, self.end(a), self.end(b)).is_ge()
                })
                .count();
            if descents != 1 {
                return fault("its edges are not in counter-clockwise order");
            }
        }
        Ok(())
    }

    fn check_euler(&self) -> Result<(), MeshFault> {
        let mut part = vec![false; self.vertices.len()];
        let mut components = 0;
        let mut stack = Vec::new();
        for v in self.vertices() {
            if part[v.0 as usize] {
                continue;
            }
            components += 1;
            part[v.0 as usize] = true;
            stack.push(v);
            while let Some(v) = stack.pop() {
                for h in self.outgoing(v) {
                    let w = self.dest(h);
                    if !std::mem::replace(&mut part[w.0 as usize], true) {
                        stack.push(w);
                    }
                }
            }
        }
        let (vertices, edges, faces) = (
            self.vertices().count(),
            self.edges().count(),
            self.faces().count(),
        );
        if vertices + faces == edges + 1 + components {
            return Ok(());
        }
        Err(MeshFault::Euler {
            vertices,
            edges,
            faces,
            components,
        })
    }

    /// Each hole lies in the face that lists it: seen from its westernmost
    /// point, which the check of single faces cannot tell for the unbounded
    /// face.
    fn check_nesting(&self) -> Result<(), MeshFault> {
        let holes: Vec<(FaceId, HalfEdgeId)> = self
            .faces()
            .flat_map(|f| {
                let skip = usize::from(!self.is_outside(f));
                self.loops(f).into_iter().skip(skip).map(move |l| (f, l))
            })
            .collect();
        if holes.len() < 2 {
            return Ok(());
        }
        let index = SegmentIndex::new(self.edges().map(|h| (h.0, self.start(h), self.end(h))));
        let far = self
            .vertices()
            .map(|v| self.point(v).x)
            .fold(f64::INFINITY, f64::min);
        let mut near = Vec::new();
        for (f, l) in holes {
            let west = self
                .walk(l)
                .map(|h| self.start(h))
                .min_by(|a, b| super::predicates::lexical(*a, *b));
            let Some(west) = west else { continue };
            index.near(P { x: far, y: west.y }, west, 0.0, &mut near);
            let seen = first_west(self, west, near.iter().map(|&h| HalfEdgeId(h)));
            if seen.map_or(self.outside(), |h| self.face(h)) != f {
                return Err(MeshFault::Face {
                    face: f,
                    what: "a hole lies in another face",
                    x: west.x,
                    y: west.y,
                });
            }
        }
        Ok(())
    }
}
