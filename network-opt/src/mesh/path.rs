//! May a polyline be laid into a face? Looked at before anything changes.

use super::index::SegmentIndex;
use super::planar::{FaceId, HalfEdgeId, PlanarMesh, VertexId};
use super::predicates::{
    dist, dist_to_segment, dot, finite, in_wedge, near_segments, sub, within, P,
};
use super::split::Place;
use crate::error::MeshError;

impl<E: Clone> PlanarMesh<E> {
    /// May the path be laid into the face?
    pub(super) fn check_path(
        &self,
        f: FaceId,
        points: &[P],
        from: Place,
        to: Place,
    ) -> Result<(), MeshError> {
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
        if let Some(i) = points
            .windows(2)
            .position(|w| within(dist(w[0], w[1]), tol))
        {
            return Err(degenerate(i));
        }
        if closed && last < 3 {
            return Err(degenerate(last - 1));
        }
        if !closed && within(dist(points[0], points[last]), tol) {
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
                    self.face(h.twin()) == f || in_wedge(at, self.end(h), self.start(h), toward)
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
        let (a, b) = (self.start(g), self.end(g));
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
    pub(super) fn find_corner(&self, f: FaceId, v: VertexId, to: P) -> Option<HalfEdgeId> {
        let at = self.point(v);
        self.outgoing(v)
            .filter(|&o| self.face(o) == f)
            .map(|o| (o, self.prev(o)))
            .find(|&(o, back)| in_wedge(at, self.end(o), self.start(back), to))
            .map(|(_, back)| back)
    }
}
