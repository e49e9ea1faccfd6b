//! Which face is here, and which edge is nearest?

use super::build::first_west;
use super::index::SegmentIndex;
use super::planar::{FaceId, HalfEdgeId, PlanarMesh};
use super::predicates::{dist, finite, foot, lerp, sub, P};
use geo_types::Coord;

impl<E: Clone> PlanarMesh<E> {
    /// The face that contains a point: [`outside`](Self::outside) for points
    /// outside of everything and for a point that is not finite. A point
    /// exactly on an edge gets one of the edge's two faces, always the same.
    ///
    /// Exact, and linear in the number of edges: for many points make a
    /// [`Locator`].
    pub fn face_at(&self, p: Coord<f64>) -> FaceId {
        if !finite(p) {
            return self.outside();
        }
        first_west(self, p, self.edges()).map_or(self.outside(), |h| self.face(h))
    }

    /// The edge nearest to a point, the nearest point on it, and its
    /// distance. Of the edge's two sides it is the one with the point on its
    /// left, so that its face is the one that contains the point whenever
    /// the point is not on an edge. `None` if the mesh is empty or the point
    /// not finite.
    ///
    /// Linear in the number of edges: for many points make a [`Locator`].
    pub fn nearest_edge(&self, p: Coord<f64>) -> Option<(HalfEdgeId, Coord<f64>, f64)> {
        if !finite(p) {
            return None;
        }
        let mut best: Option<(f64, HalfEdgeId)> = None;
        for h in self.edges() {
            best = self.nearer(p, h, best);
        }
        best.map(|(d, h)| self.facing(p, h, d))
    }

    fn nearer(
        &self,
        p: P,
        h: HalfEdgeId,
        best: Option<(f64, HalfEdgeId)>,
    ) -> Option<(f64, HalfEdgeId)> {
        let (a, b) = (self.start(h), self.end(h));
        let d = dist(p, lerp(a, b, foot(p, a, b)));
        if best.is_none_or(|(d0, h0)| d < d0 || (d == d0 && h < h0)) {
            Some((d, h))
        } else {
            best
        }
    }

    /// The side of an edge that faces `p`. Where the nearest point is a
    /// vertex, the side of the corner that holds `p` decides, not the line of
    /// the edge.
    fn facing(&self, p: P, h: HalfEdgeId, d: f64) -> (HalfEdgeId, P, f64) {
        let (a, b) = (self.start(h), self.end(h));
        let t = foot(p, a, b);
        let at = if t <= 0.0 {
            a
        } else if t >= 1.0 {
            b
        } else {
            lerp(a, b, t)
        };
        let mut side = h;
        if t > 0.0 && t < 1.0 {
            if super::predicates::orient(a, b, p) < 0.0 {
                side = h.twin();
            }
        } else if at != p {
            let v = if t <= 0.0 {
                self.origin(h)
            } else {
                self.dest(h)
            };
            let corner = self.outgoing(v).find(|&o| {
                let back = self.start(self.prev(o));
                super::predicates::in_wedge(at, self.end(o), back, p)
            });
            if let Some(o) = corner {
                side = o;
            }
        }
        (side, at, d)
    }

    /// A snapshot of the mesh's edges in a spatial index, for many queries.
    pub fn locator(&self) -> Locator<'_, E> {
        let west = self
            .vertices()
            .map(|v| self.point(v).x)
            .fold(f64::INFINITY, f64::min);
        Locator {
            mesh: self,
            west,
            index: SegmentIndex::new(self.edges().map(|h| (h.0, self.start(h), self.end(h)))),
        }
    }
}

/// Answers [`PlanarMesh::face_at`] and [`PlanarMesh::nearest_edge`] in about
/// O(sqrt n) and O(log n); made by [`PlanarMesh::locator`].
#[derive(Clone, Debug)]
pub struct Locator<'a, E> {
    mesh: &'a PlanarMesh<E>,
    west: f64,
    index: SegmentIndex,
}

impl<E: Clone> Locator<'_, E> {
    /// See [`PlanarMesh::face_at`]: the same answer.
    pub fn face_at(&self, p: Coord<f64>) -> FaceId {
        if !finite(p) || p.x < self.west {
            return self.mesh.outside();
        }
        let mut near = Vec::new();
        self.index.near(
            P {
                x: self.west,
                y: p.y,
            },
            p,
            0.0,
            &mut near,
        );
        first_west(self.mesh, p, near.into_iter().map(HalfEdgeId))
            .map_or(self.mesh.outside(), |h| self.mesh.face(h))
    }

    /// See [`PlanarMesh::nearest_edge`]: the same answer.
    pub fn nearest_edge(&self, p: Coord<f64>) -> Option<(HalfEdgeId, Coord<f64>, f64)> {
        if !finite(p) {
            return None;
        }
        let mut best: Option<(f64, HalfEdgeId)> = None;
        for (h, box2) in self.index.by_distance(p) {
            // Boxes are no farther than their edges; the slack covers the
            // rounding of the square.
            if best.is_some_and(|(d, _)| box2 > d * d * (1.0 + 1e-9)) {
                break;
            }
            best = self.mesh.nearer(p, HalfEdgeId(h), best);
        }
        best.map(|(d, h)| self.mesh.facing(p, h, d))
    }

    /// All edges that come within `radius` of a point, ascending, as
    /// their even half-edges.
    pub fn edges_near(&self, p: Coord<f64>, radius: f64) -> Vec<HalfEdgeId> {
        let mut near = Vec::new();
        if finite(p) && radius >= 0.0 {
            self.index.near(p, p, radius, &mut near);
        }
        near.into_iter()
            .map(HalfEdgeId)
            .filter(|&h| {
                let (a, b) = (self.mesh.start(h), self.mesh.end(h));
                let q = sub(p, lerp(a, b, foot(p, a, b)));
                q.x.hypot(q.y) <= radius
            })
            .collect()
    }
}
