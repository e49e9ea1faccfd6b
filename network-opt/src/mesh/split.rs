//! Splitting: a vertex into an edge, a polyline into a face.

use super::index::SegmentIndex;
use super::planar::{Face, FaceId, Half, HalfEdgeId, PlanarMesh, Vertex, VertexId};
use super::predicates::{
    dist, dist_to_segment, dot, finite, foot, in_ring, in_wedge, lerp, near_segments, sub, P,
};
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
enum Place {
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
        let (a, b) = (self.from_point(h), self.to_point(h));
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
        if !(distance <= allowed) {
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

    /// May the path be laid into the face?
    fn check_path(&self, f: FaceId, points: &[P], from: Place, to: Place) -> Result<(), MeshError> {
        let tol = self.tolerance;
        let last = points.len() - 1;
        let closed = matches!((from, to), (Place::At(a), Place::At(b)) if a == b);
        let degenerate = |segment| MeshError::DegeneratePath {
            segment,
            tolerance: tol,
        };
        if let Some(p) = points.iter().find(|&&p| !finite(p)) {
            return Err(MeshError::NonFinitePoint {
                operation: "split_face",
                x: p.x,
                y: p.y,
            });
        }
        if let Some(i) = points.windows(2).position(|w| !(dist(w[0], w[1]) > tol)) {
            return Err(degenerate(i));
        }
        if closed && last < 3 {
            return Err(degenerate(last - 1));
        }
        if !closed && !(dist(points[0], points[last]) > tol) {
            return Err(degenerate(last - 1));
        }

        // The path against itself.
        let index = (last > 8)
            .then(|| SegmentIndex::new((0..last).map(|i| (i as u32, points[i], points[i + 1]))));
        let mut near = Vec::new();
        for i in 0..last {
            let (a, b) = (points[i], points[i + 1]);
            match &index {
                Some(index) => index.near(a, b, tol, &mut near),
                None => {
                    near.clear();
                    near.extend(0..last as u32);
                }
            }
            for &j in near.iter().filter(|&&j| j as usize > i) {
                let j = j as usize;
                let (c, d) = (points[j], points[j + 1]);
                let wraps = closed && i == 0 && j + 1 == last;
                let bad = if j == i + 1 {
                    dist_to_segment(d, a, b) <= tol || dist_to_segment(a, c, d) <= tol
                } else if wraps {
                    dist_to_segment(c, a, b) <= tol || dist_to_segment(b, c, d) <= tol
                } else {
                    near_segments(a, b, c, d, tol)
                };
                if bad {
                    let (first, second) = (i, j);
                    let (x, y) = (c.x, c.y);
                    return Err(MeshError::PathMeetsItself {
                        first,
                        second,
                        x,
                        y,
                    });
                }
            }
        }

        // The path against the boundary. Edges to be cut count as cut, and
        // an end's own vertex or cut is shared with it.
        let meets_boundary = |c: P, d: P, ends: (VertexId, VertexId), i: usize| {
            let (a, b) = (points[i], points[i + 1]);
            let shared_from = i == 0
                && match from {
                    Place::At(v) => ends.0 == v || ends.1 == v,
                    Place::Cut(_, at) => c == at || d == at,
                };
            let shared_to = i + 1 == last
                && match to {
                    Place::At(v) => ends.0 == v || ends.1 == v,
                    Place::Cut(_, at) => c == at || d == at,
                };
            match (shared_from, shared_to) {
                // A straight path along an edge that is there already.
                (true, true) => true,
                (true, false) => {
                    let far = if c == a { d } else { c };
                    dist_to_segment(b, c, d) <= tol || dist_to_segment(far, a, b) <= tol
                }
                (false, true) => {
                    let far = if c == b { d } else { c };
                    dist_to_segment(a, c, d) <= tol || dist_to_segment(far, a, b) <= tol
                }
                (false, false) => near_segments(a, b, c, d, tol),
            }
        };
        let mut parts: Vec<(P, P, VertexId, VertexId)> = Vec::new();
        for g in self.loops(f).into_iter().flat_map(|l| self.walk(l)) {
            self.parts_of(g, from, to, &mut parts);
            for &(c, d, vc, vd) in &parts {
                match &index {
                    Some(index) => index.near(c, d, tol, &mut near),
                    None => {
                        near.clear();
                        near.extend(0..last as u32);
                    }
                }
                for &i in &near {
                    let i = i as usize;
                    let (a, b) = (points[i], points[i + 1]);
                    if a.x.max(b.x) + tol < c.x.min(d.x)
                        || c.x.max(d.x) + tol < a.x.min(b.x)
                        || a.y.max(b.y) + tol < c.y.min(d.y)
                        || c.y.max(d.y) + tol < a.y.min(b.y)
                    {
                        continue;
                    }
                    if meets_boundary(c, d, (vc, vd), i) {
                        let p = if dist_to_segment(c, a, b) < dist_to_segment(d, a, b) {
                            c
                        } else {
                            d
                        };
                        return Err(MeshError::PathMeetsBoundary {
                            segment: i,
                            face: f,
                            x: p.x,
                            y: p.y,
                        });
                    }
                }
            }
        }
        // Without contact the path is in the face if it starts into it.
        for (end, place, toward) in [(0, from, points[1]), (1, to, points[last - 1])] {
            let inside = match place {
                Place::At(v) => self.find_corner(f, v, toward).is_some(),
                Place::Cut(h, at) => {
                    self.face(h.twin()) == f
                        || in_wedge(at, self.to_point(h), self.from_point(h), toward)
                }
            };
            if !inside {
                let p = points[if end == 0 { 0 } else { last }];
                return Err(MeshError::OffFace {
                    end,
                    face: f,
                    x: p.x,
                    y: p.y,
                });
            }
        }
        Ok(())
    }

    /// A half-edge as it will be once the ends' cuts are made: up to three
    /// segments, each with the vertices it ends at (none for a cut).
    fn parts_of(
        &self,
        g: HalfEdgeId,
        from: Place,
        to: Place,
        parts: &mut Vec<(P, P, VertexId, VertexId)>,
    ) {
        parts.clear();
        let (a, b) = (self.from_point(g), self.to_point(g));
        let mut cuts: Vec<P> = [from, to]
            .into_iter()
            .filter_map(|place| match place {
                Place::Cut(h, at) if h.edge() == g.edge() => Some(at),
                _ => None,
            })
            .collect();
        cuts.sort_by(|p, q| dot(sub(*p, a), sub(b, a)).total_cmp(&dot(sub(*q, a), sub(b, a))));
        let (mut p, mut v) = (a, self.origin(g));
        for q in cuts {
            parts.push((p, q, v, VertexId::NONE));
            (p, v) = (q, VertexId::NONE);
        }
        parts.push((p, b, v, self.dest(g)));
    }

    /// The half-edge of `f` that arrives at `v` before the direction of `to`.
    fn find_corner(&self, f: FaceId, v: VertexId, to: P) -> Option<HalfEdgeId> {
        let at = self.point(v);
        self.outgoing(v)
            .filter(|&o| self.face(o) == f)
            .map(|o| (o, self.prev(o)))
            .find(|&(o, back)| in_wedge(at, self.to_point(o), self.from_point(back), to))
            .map(|(_, back)| back)
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
                let (a, b) = (self.from_point(h), self.to_point(h));
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

    /// Sorts loops into faces after `h` has closed a path in `f`; returns
    /// the face left of `h` and, if another, the one right of it.
    fn regroup_after_closing(&mut self, f: FaceId, h: HalfEdgeId) -> Vec<FaceId> {
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
            .map(|g| (self.from_point(g), self.to_point(g)))
            .collect();
        let (inside, beside): (Vec<_>, Vec<_>) = holes.iter().copied().partition(|&l| {
            !on(other_side, l) && in_ring(self.from_point(l), edges.iter().copied())
        });
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
