//! Splitting: a vertex into an edge, a polyline into a face.

use super::planar::{FaceId, Half, HalfEdgeId, PlanarMesh, Vertex, VertexId};
use super::predicates::{dist, dot, finite, foot, lerp, sub, P};
use crate::error::MeshError;
use geo_types::Coord;

/// Where a path that splits a face begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At a vertex of the face.
    Vertex(VertexId),
    /// At this point of an edge of the face, which is split there (or at the
    /// edge's end, if that is within [`PlanarMesh::snap`]). Either side of
    /// the edge may be named.
    Edge(HalfEdgeId, Coord<f64>),
}

/// What [`PlanarMesh::split_face`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Split {
    /// The face left of the path, then, if the face fell in two, the one
    /// right of it. If it did not (the path joined two loops), only the face.
    pub faces: Vec<FaceId>,
    /// The half-edges along the path, forwards.
    pub path: Vec<HalfEdgeId>,
    /// The vertex where the path starts.
    pub from: VertexId,
    /// The vertex where the path ends.
    pub to: VertexId,
}

/// An end that has been looked up: a vertex there is, or a cut to be made.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    At(VertexId),
    Cut(HalfEdgeId, P),
}

impl<E: Clone> PlanarMesh<E> {
    /// Inserts a vertex into an edge, at `at`. Both parts and both sides
    /// inherit the edge's attributes; `h` keeps the first part, and its
    /// twin the part on the same stretch.
    ///
    /// `at` should lie on the edge. If it is farther off than rounding, but
    /// within [`snap`](Self::snap) or a thousand times
    /// [`tolerance`](Self::tolerance), the vertex is put at the nearest point
    /// of the edge, so that the edge stays straight. If `at` is within
    /// `snap` of an end of the edge, that vertex is returned and nothing
    /// changes.
    ///
    /// # Errors
    ///
    /// [`MeshError::NoHalfEdge`], [`MeshError::NonFinitePoint`],
    /// [`MeshError::OffEdge`], [`MeshError::Full`].
    pub fn split_edge(&mut self, h: HalfEdgeId, at: Coord<f64>) -> Result<VertexId, MeshError> {
        match self.locate_on_edge(h, at, "split_edge")? {
            Place::At(v) => Ok(v),
            Place::Cut(h, at) => {
                self.room(1, 1, 0)?;
                Ok(self.cut(h, at))
            }
        }
    }

    /// Splits a face by a polyline.
    ///
    /// `path` holds the interior points only, possibly none; it runs from
    /// `from` to `to`, both on the face's boundary. If both are on the same
    /// loop the face falls in two: the face left of the path keeps the id
    /// `f`, the one on the right gets a new id (only the unbounded face
    /// always keeps its id, on whichever side it lies). If they are on
    /// different loops, the loops become one and no face is added. `left`
    /// and `right` are the attributes of the path's two sides.
    ///
    /// # Errors
    ///
    /// The mesh is unchanged and the error says why if an id is stale, an end
    /// is not on the face ([`MeshError::OffFace`], [`MeshError::OffEdge`]),
    /// or the path crosses, touches or comes within
    /// [`tolerance`](Self::tolerance) of the face's boundary or itself
    /// ([`MeshError::PathMeetsBoundary`], [`MeshError::PathMeetsItself`],
    /// [`MeshError::DegeneratePath`]).
    ///
    /// # Complexity
    ///
    /// O(n log m) for n edges of the face and m points of the path.
    pub fn split_face(
        &mut self,
        f: FaceId,
        path: &[Coord<f64>],
        from: End,
        to: End,
        left: E,
        right: E,
    ) -> Result<Split, MeshError> {
        if !self.has_face(f) {
            return Err(MeshError::NoFace(f));
        }
        let from = self.locate_end(f, from, 0)?;
        let to = self.locate_end(f, to, 1)?;
        let place = |p: Place| match p {
            Place::At(v) => self.point(v),
            Place::Cut(_, at) => at,
        };
        let mut points = Vec::with_capacity(path.len() + 2);
        points.push(place(from));
        points.extend_from_slice(path);
        points.push(place(to));
        self.check_path(f, &points, from, to)?;
        self.room(path.len() + 2, path.len() + 3, 1)?;

        let from = self.make(from);
        let to = self.make(to);
        let mut along = Vec::with_capacity(path.len() + 1);
        let mut at = from;
        for &p in path {
            let corner = self.corner(f, at, p);
            let h = self.add_spike(corner, p, &left, &right);
            along.push(h);
            at = self.dest(h);
        }
        let out = self.corner(f, at, self.point(to));
        let back = self.corner(f, to, self.point(at));
        along.push(self.close(out, back, left, right));
        let last = along[along.len() - 1];
        let faces = self.regroup_after_closing(f, last);
        Ok(Split {
            faces,
            path: along,
            from,
            to,
        })
    }

    /// Are there enough ids left?
    fn room(&self, vertices: usize, edges: usize, faces: usize) -> Result<(), MeshError> {
        let full = u32::MAX as usize - 1;
        if self.vertices.len() + vertices > full
            || self.halves.len() + 2 * edges > full
            || self.faces.len() + faces > full
        {
            return Err(MeshError::Full);
        }
        Ok(())
    }

    /// Looks up a point of an edge: one of its ends, or a cut that touches
    /// nothing.
    fn locate_on_edge(
        &self,
        h: HalfEdgeId,
        at: P,
        operation: &'static str,
    ) -> Result<Place, MeshError> {
        if !self.has_half_edge(h) {
            return Err(MeshError::NoHalfEdge(h));
        }
        if !finite(at) {
            let (x, y) = (at.x, at.y);
            return Err(MeshError::NonFinitePoint { operation, x, y });
        }
        let (a, b) = (self.start(h), self.end(h));
        let (da, db) = (dist(at, a), dist(at, b));
        if da.min(db) <= self.snap {
            let v = if da <= db {
                self.origin(h)
            } else {
                self.dest(h)
            };
            return Ok(Place::At(v));
        }
        let on = lerp(a, b, foot(at, a, b));
        let distance = dist(at, on);
        // Points are often found by tracing or intersecting; a millionth of
        // the extent is their error, not another place.
        let allowed = self.snap.max(1e3 * self.tolerance);
        if distance > allowed {
            return Err(MeshError::OffEdge {
                half_edge: h,
                x: at.x,
                y: at.y,
                distance,
                allowed,
            });
        }
        // The edge must not bend noticeably: what lies near it stays clear.
        let at = if distance <= self.tolerance / 16.0 {
            at
        } else {
            on
        };
        Ok(Place::Cut(h, at))
    }

    fn locate_end(&self, f: FaceId, end: End, number: usize) -> Result<Place, MeshError> {
        let off = |p: P| MeshError::OffFace {
            end: number,
            face: f,
            x: p.x,
            y: p.y,
        };
        let place = match end {
            End::Vertex(v) if !self.has_vertex(v) => return Err(MeshError::NoVertex(v)),
            End::Vertex(v) => Place::At(v),
            End::Edge(h, at) => {
                if !self.has_half_edge(h) {
                    return Err(MeshError::NoHalfEdge(h));
                }
                let side = if self.face(h) == f { h } else { h.twin() };
                if self.face(side) != f {
                    return Err(off(at));
                }
                self.locate_on_edge(side, at, "split_face")?
            }
        };
        if let Place::At(v) = place {
            if !self.outgoing(v).any(|o| self.face(o) == f) {
                return Err(off(self.point(v)));
            }
        }
        Ok(place)
    }

    /// As `find_corner`; a checked path always finds one.
    fn corner(&self, f: FaceId, v: VertexId, to: P) -> HalfEdgeId {
        let found = self.find_corner(f, v, to);
        debug_assert!(found.is_some(), "a checked path leaves through a corner");
        found.unwrap_or_else(|| {
            let out = self.outgoing(v).find(|&o| self.face(o) == f);
            self.prev(out.unwrap_or(self.vertices[v.0 as usize].half))
        })
    }

    /// Makes an end's vertex. A cut of an edge that was cut before looks for
    /// the part that holds it.
    fn make(&mut self, place: Place) -> VertexId {
        match place {
            Place::At(v) => v,
            Place::Cut(h, at) => {
                // Only the two ends of one path can cut one edge twice: then
                // the other part is next to this one.
                let (a, b) = (self.start(h), self.end(h));
                let part = if dot(sub(at, b), sub(b, a)) > 0.0 {
                    self.next(h)
                } else if dot(sub(at, a), sub(b, a)) < 0.0 {
                    self.prev(h)
                } else {
                    h
                };
                self.cut(part, at)
            }
        }
    }

    /// A new pair of half-edges; the caller links them.
    fn add_pair(
        &mut self,
        a: VertexId,
        b: VertexId,
        f: (FaceId, FaceId),
        l: E,
        r: E,
    ) -> HalfEdgeId {
        let h = HalfEdgeId(self.halves.len() as u32);
        for (origin, face, attr) in [(a, f.0, l), (b, f.1, r)] {
            self.halves.push(Half {
                origin,
                next: HalfEdgeId::NONE,
                prev: HalfEdgeId::NONE,
                face,
                live: true,
                attr,
            });
        }
        h
    }

    fn add_vertex(&mut self, point: P, half: HalfEdgeId) -> VertexId {
        let v = VertexId(self.vertices.len() as u32);
        let live = true;
        self.vertices.push(Vertex { point, half, live });
        v
    }

    /// Cuts an edge, unchecked: `h` becomes the part before `at`.
    fn cut(&mut self, h: HalfEdgeId, at: P) -> VertexId {
        let t = h.twin();
        let b = self.dest(h);
        let v = self.add_vertex(at, HalfEdgeId::NONE);
        let attrs = (self.attr(h).clone(), self.attr(t).clone());
        let n = self.add_pair(v, b, (self.face(h), self.face(t)), attrs.0, attrs.1);
        let nt = n.twin();
        // Around the far end: n leads on to what followed h, nt is preceded
        // by what preceded t; a dangling end turns around.
        let (after, before) = (self.next(h), self.prev(t));
        if after == t {
            self.link(n, nt);
        } else {
            self.link(n, after);
            self.link(before, nt);
        }
        self.link(h, n);
        self.link(nt, t);
        self.halves[t.0 as usize].origin = v;
        self.vertices[v.0 as usize].half = n;
        if self.vertices[b.0 as usize].half == t {
            self.vertices[b.0 as usize].half = nt;
        }
        v
    }

    /// Adds a dangling edge from the corner after `into` to a new vertex.
    fn add_spike(&mut self, into: HalfEdgeId, p: P, left: &E, right: &E) -> HalfEdgeId {
        let (v, f, after) = (self.dest(into), self.face(into), self.next(into));
        let n = self.add_vertex(p, HalfEdgeId::NONE);
        let h = self.add_pair(v, n, (f, f), left.clone(), right.clone());
        self.vertices[n.0 as usize].half = h.twin();
        self.link(into, h);
        self.link(h, h.twin());
        self.link(h.twin(), after);
        h
    }

    /// Adds an edge from the corner after `out` to the corner after `back`.
    fn close(&mut self, out: HalfEdgeId, back: HalfEdgeId, left: E, right: E) -> HalfEdgeId {
        let (a, b, f) = (self.dest(out), self.dest(back), self.face(out));
        let (after_a, after_b) = (self.next(out), self.next(back));
        let h = self.add_pair(a, b, (f, f), left, right);
        self.link(out, h);
        self.link(h, after_b);
        self.link(back, h.twin());
        self.link(h.twin(), after_a);
        h
    }
}
