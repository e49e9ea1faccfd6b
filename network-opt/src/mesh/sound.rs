//! Is a face's geometry sound? The one kernel behind the check of the mesh,
//! of edits before they happen, and of the optimiser's steps.
//!
//! A mesh is a proper subdivision of the plane when every face on its own is
//! sound: bounded faces positively oriented and simple, holes inside and
//! apart, and the unbounded face's rims simple and apart. (The faces then
//! cover each point the same number of times, and far away that is once.)

use super::planar::{FaceId, HalfEdgeId, PlanarMesh, VertexId};
use super::predicates::{dist, dist_to_segment, in_ring, in_wedge, near_segments, within, P};
use super::rings::ring_is_contour;

/// A loop as vertices and their (perhaps only proposed) positions, open.
pub(crate) type Ring = Vec<(VertexId, P)>;

/// What is wrong with a face of the given loops (outer first if `bounded`),
/// and where.
pub(crate) fn face_fault(rings: &[Ring], bounded: bool, tol: f64) -> Option<(&'static str, P)> {
    for (i, ring) in rings.iter().enumerate() {
        let points: Vec<P> = ring.iter().map(|c| c.1).collect();
        let at = points.first().copied().unwrap_or(P {
            x: f64::NAN,
            y: f64::NAN,
        });
        if ring.len() < 2 {
            return Some(("a loop has fewer than two edges", at));
        }
        if ring_is_contour(&points) == (bounded && i == 0) {
            return Some(("a loop runs the wrong way around", at));
        }
    }
    edges_meet(rings, tol)
        .or_else(|| wedges_overlap(rings))
        .or_else(|| holes_misplaced(rings, bounded))
}

/// Two edges that cross, or come within `tol` of each other anywhere but at
/// a shared vertex.
fn edges_meet(rings: &[Ring], tol: f64) -> Option<(&'static str, P)> {
    struct Edge {
        ids: (VertexId, VertexId),
        ends: (P, P),
        west: f64,
        east: f64,
    }
    let mut edges: Vec<Edge> = Vec::new();
    for ring in rings {
        for (i, &(v, p)) in ring.iter().enumerate() {
            let (w, q) = ring[(i + 1) % ring.len()];
            if within(dist(p, q), tol) {
                return Some(("an edge is too short", p));
            }
            edges.push(Edge {
                ids: (v, w),
                ends: (p, q),
                west: p.x.min(q.x) - tol,
                east: p.x.max(q.x),
            });
        }
    }
    // Sweep from west to east over the edges' boxes.
    edges.sort_by(|e, f| e.west.total_cmp(&f.west).then(e.ids.cmp(&f.ids)));
    for (i, e) in edges.iter().enumerate() {
        let (a, b) = e.ends;
        let (south, north) = (a.y.min(b.y) - tol, a.y.max(b.y) + tol);
        for f in &edges[i + 1..] {
            if f.west > e.east {
                break;
            }
            let (c, d) = f.ends;
            if c.y.max(d.y) < south || c.y.min(d.y) > north {
                continue;
            }
            let same = |x: VertexId, y: VertexId| x == y;
            let ((va, vb), (vc, vd)) = (e.ids, f.ids);
            let fault = if same(va, vd) && same(vb, vc) {
                false // both sides of one edge
            } else if same(va, vc) && same(vb, vd) {
                true
            } else if same(va, vc) {
                dist_to_segment(b, c, d) <= tol || dist_to_segment(d, a, b) <= tol
            } else if same(va, vd) {
                dist_to_segment(b, c, d) <= tol || dist_to_segment(c, a, b) <= tol
            } else if same(vb, vc) {
                dist_to_segment(a, c, d) <= tol || dist_to_segment(d, a, b) <= tol
            } else if same(vb, vd) {
                dist_to_segment(a, c, d) <= tol || dist_to_segment(c, a, b) <= tol
            } else {
                near_segments(a, b, c, d, tol)
            };
            if fault {
                return Some(("two edges cross or touch", a));
            }
        }
    }
    None
}

/// Visits of one vertex whose wedges overlap: the loops pass through each
/// other there.
fn wedges_overlap(rings: &[Ring]) -> Option<(&'static str, P)> {
    // (vertex, position, back, out)
    let mut visits: Vec<(VertexId, P, P, P)> = Vec::new();
    for ring in rings {
        let n = ring.len();
        for i in 0..n {
            let (v, p) = ring[i];
            visits.push((v, p, ring[(i + n - 1) % n].1, ring[(i + 1) % n].1));
        }
    }
    visits.sort_by_key(|v| v.0);
    for same in visits.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() > 1) {
        for (i, x) in same.iter().enumerate() {
            for (j, y) in same.iter().enumerate() {
                let inside = |d: P| in_wedge(x.1, x.3, x.2, d);
                if i != j && (inside(y.2) || inside(y.3)) {
                    return Some(("the boundary passes through itself at a vertex", x.1));
                }
            }
        }
    }
    None
}

/// A hole outside the outer loop, or inside another hole.
fn holes_misplaced(rings: &[Ring], bounded: bool) -> Option<(&'static str, P)> {
    let edges = |r: &'_ Ring| -> Vec<(P, P)> {
        (0..r.len())
            .map(|i| (r[i].1, r[(i + 1) % r.len()].1))
            .collect()
    };
    let holes = if bounded { rings.get(1..)? } else { rings };
    if bounded {
        let outer = edges(rings.first()?);
        for hole in holes {
            if !in_ring(hole[0].1, outer.iter().copied()) {
                return Some(("a hole lies outside its face", hole[0].1));
            }
        }
    }
    if holes.len() < 2 {
        return None;
    }
    // Only boxes that meet can nest; sweep over them from west to east.
    let mut boxes: Vec<(f64, f64, f64, f64, usize)> = holes
        .iter()
        .enumerate()
        .map(|(i, ring)| {
            ring.iter()
                .fold((f64::MAX, f64::MIN, f64::MAX, f64::MIN, i), |b, &(_, p)| {
                    (b.0.min(p.x), b.1.max(p.x), b.2.min(p.y), b.3.max(p.y), i)
                })
        })
        .collect();
    boxes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.4.cmp(&b.4)));
    for (i, a) in boxes.iter().enumerate() {
        for b in boxes[i + 1..].iter().take_while(|b| b.0 <= a.1) {
            if a.2 > b.3 || b.2 > a.3 {
                continue;
            }
            for (x, y) in [(a.4, b.4), (b.4, a.4)] {
                let p = holes[x][0].1;
                if in_ring(p, edges(&holes[y]).into_iter()) {
                    return Some(("a hole lies inside another hole", p));
                }
            }
        }
    }
    None
}

impl<E: Clone> PlanarMesh<E> {
    /// The loop of `h` with each vertex where `place` puts it.
    pub(crate) fn placed_ring(&self, h: HalfEdgeId, place: &dyn Fn(VertexId) -> P) -> Ring {
        self.walk(h)
            .map(|h| self.origin(h))
            .map(|v| (v, place(v)))
            .collect()
    }

    /// What would be wrong with a face if `place` gave the positions.
    pub(crate) fn face_fault_at(
        &self,
        f: FaceId,
        tol: f64,
        place: &dyn Fn(VertexId) -> P,
    ) -> Option<(&'static str, P)> {
        let rings: Vec<Ring> = self
            .loops(f)
            .into_iter()
            .map(|l| self.placed_ring(l, place))
            .collect();
        face_fault(&rings, !self.is_outside(f), tol)
    }

    /// Is the geometry of this face sound: loops simple and properly turned,
    /// nothing within [`tolerance`](Self::tolerance) of anything else, holes
    /// inside and apart? Call it for the faces around after
    /// [`set_point`](Self::set_point). `false` for a stale id.
    pub fn face_is_sound(&self, f: FaceId) -> bool {
        self.has_face(f)
            && self
                .face_fault_at(f, self.tolerance() / 2.0, &|v| self.point(v))
                .is_none()
    }
}
