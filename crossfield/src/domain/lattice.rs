//! The points that a domain is triangulated on: subdivided rings, and a
//! triangular lattice inside.
//!
//! Refinement could place all inner points by itself, but a lattice gives
//! equilateral triangles over most of the domain at a fraction of the cost,
//! and leaves refinement only the seam along the boundary. The lattice is
//! laid along the longest edge through the centroid of the exterior, so that
//! a domain which is moved or turned gets the same mesh, up to rounding.

use super::ring::Ring;
use crate::plane::{segment_distance_squared, wedge, V2};

/// One straight piece of a subdivided ring edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// Index of the start among the points.
    pub(crate) from: u32,
    /// Index of the end among the points.
    pub(crate) to: u32,
    /// Ring it lies on.
    pub(crate) ring: u32,
    /// Edge of the (cleaned) ring it lies on.
    pub(crate) edge: u32,
}

/// Lattice points nearer to the boundary than this part of the edge length
/// are left out: closer ones make flat triangles, a wider gap makes refinement
/// fill it again.
const CLEARANCE: f64 = 0.62;

/// Points of all rings, subdivided to at most `step`, equal points merged.
pub(crate) fn boundary(rings: &[Ring], step: f64) -> (Vec<V2>, Vec<Segment>) {
    let mut points = Vec::new();
    let mut segments = Vec::new();
    for (index, ring) in rings.iter().enumerate() {
        let first = points.len() as u32;
        for k in 0..ring.len() {
            let (a, b) = ring.edge(k);
            let mut parts = ((b - a).norm() / step).ceil().max(1.0) as usize;
            // An edge between two corners gets a point of its own: at a corner
            // a field may be free (see `BoundaryField`), in between it is not.
            if ring.corner[k] && ring.corner[ring.next(k)] {
                parts = parts.max(2);
            }
            for part in 0..parts {
                let from = points.len() as u32;
                points.push(a + (b - a) * (part as f64 / parts as f64));
                segments.push(Segment {
                    from,
                    to: from + 1,
                    ring: index as u32,
                    edge: k as u32,
                });
            }
        }
        if let Some(last) = segments.last_mut() {
            last.to = first;
        }
    }
    merge(points, segments)
}

/// Gives equal points (rings that touch at a vertex) one index.
fn merge(points: Vec<V2>, mut segments: Vec<Segment>) -> (Vec<V2>, Vec<Segment>) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let key = |k: usize| (points[k].x, points[k].y);
    order.sort_by(|&a, &b| {
        let ((ax, ay), (bx, by)) = (key(a), key(b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by)).then(a.cmp(&b))
    });
    let mut first: Vec<usize> = (0..points.len()).collect();
    for pair in order.windows(2) {
        if points[pair[0]] == points[pair[1]] {
            first[pair[1]] = first[pair[0]];
        }
    }
    let mut merged = Vec::with_capacity(points.len());
    let mut index = vec![0_u32; points.len()];
    for k in 0..points.len() {
        if first[k] == k {
            index[k] = merged.len() as u32;
            merged.push(points[k]);
        } else {
            // Sorted by index among equals, so the first one comes earlier.
            index[k] = index[first[k]];
        }
    }
    for segment in &mut segments {
        segment.from = index[segment.from as usize];
        segment.to = index[segment.to as usize];
    }
    segments.retain(|segment| segment.from != segment.to);
    (merged, segments)
}

/// Lattice points strictly inside the rings, clear of the boundary.
///
/// One pass over the edges per lattice row they meet: O(boundary / step +
/// points), up to the sorting within rows.
pub(crate) fn interior(rings: &[Ring], points: &[V2], segments: &[Segment], step: f64) -> Vec<V2> {
    let frame = LatticeFrame::new(rings, step);
    let height = frame.row_height;
    let lowest = points
        .iter()
        .map(|&p| frame.to(p).y)
        .fold(f64::MAX, f64::min);
    let highest = points
        .iter()
        .map(|&p| frame.to(p).y)
        .fold(f64::MIN, f64::max);
    let first_row = (lowest / height).floor() as i64;
    let rows = ((highest / height).ceil() as i64 - first_row + 1).max(0) as usize;
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); rows];
    let mut blocked: Vec<Vec<i64>> = vec![Vec::new(); rows];
    let reach = CLEARANCE * step;
    for segment in segments {
        let a = frame.to(points[segment.from as usize]);
        let b = frame.to(points[segment.to as usize]);
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let from = ((low - reach) / height).ceil() as i64;
        let to = ((high + reach) / height).floor() as i64;
        for row in from..=to {
            let Some(slot) = usize::try_from(row - first_row).ok().filter(|&s| s < rows) else {
                continue;
            };
            let y = row as f64 * height;
            if (a.y > y) != (b.y > y) {
                crossings[slot].push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
            let shift = frame.shift(row);
            let left = ((a.x.min(b.x) - reach - shift) / step).ceil() as i64;
            let right = ((a.x.max(b.x) + reach - shift) / step).floor() as i64;
            for column in left..=right {
                let p = V2::new(column as f64 * step + shift, y);
                if segment_distance_squared(p, a, b) < reach * reach {
                    blocked[slot].push(column);
                }
            }
        }
    }
    let mut inside = Vec::new();
    for slot in 0..rows {
        let row = slot as i64 + first_row;
        let (cuts, holes) = (&mut crossings[slot], &mut blocked[slot]);
        cuts.sort_by(f64::total_cmp);
        holes.sort_unstable();
        holes.dedup();
        let shift = frame.shift(row);
        let mut hole = 0;
        for span in cuts.chunks_exact(2) {
            let left = ((span[0] - shift) / step).ceil() as i64;
            let right = ((span[1] - shift) / step).floor() as i64;
            for column in left..=right {
                while hole < holes.len() && holes[hole] < column {
                    hole += 1;
                }
                if holes.get(hole) != Some(&column) {
                    inside.push(frame.back(V2::new(
                        column as f64 * step + shift,
                        row as f64 * frame.row_height,
                    )));
                }
            }
        }
    }
    inside
}

/// A frame whose x axis runs along the lattice rows.
struct LatticeFrame {
    centre: V2,
    axis: V2,
    step: f64,
    row_height: f64,
}

impl LatticeFrame {
    fn new(rings: &[Ring], step: f64) -> Self {
        let exterior = &rings[0];
        let mut axis = V2::x();
        let mut longest = 0.0;
        for k in 0..exterior.len() {
            let (a, b) = exterior.edge(k);
            // A later edge must be clearly longer, so that a tie does not
            // depend on rounding.
            if (b - a).norm() > longest * (1.0 + 1e-9) {
                longest = (b - a).norm();
                axis = (b - a) / longest;
            }
        }
        Self {
            centre: centroid(&exterior.points),
            axis,
            step,
            row_height: step * 0.75_f64.sqrt(),
        }
    }

    fn to(&self, p: V2) -> V2 {
        let d = p - self.centre;
        V2::new(self.axis.dot(&d), wedge(self.axis, d))
    }

    fn back(&self, q: V2) -> V2 {
        self.centre + self.axis * q.x + crate::plane::left(self.axis) * q.y
    }

    /// Every other row is shifted by half a step.
    fn shift(&self, row: i64) -> f64 {
        if row.rem_euclid(2) == 1 {
            self.step / 2.0
        } else {
            0.0
        }
    }
}

/// Centroid of the area within a ring.
fn centroid(points: &[V2]) -> V2 {
    let origin = points[0];
    let mut moment = V2::zeros();
    let mut area = 0.0;
    for pair in points.windows(2) {
        let (a, b) = (pair[0] - origin, pair[1] - origin);
        moment += (a + b) * wedge(a, b);
        area += wedge(a, b);
    }
    // Rings without area are refused before.
    origin + moment / (3.0 * area)
}

#[cfg(test)]
mod tests {
    use super::super::ring::rings;
    use super::*;
    use geo_types::polygon;

    #[test]
    fn the_lattice_fills_a_ring_with_a_hole() {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)],
            interiors: [[(x: 30., y: 30.), (x: 60., y: 30.), (x: 60., y: 70.)]],
        );
        let (_, rings) = rings(&shape, 0.5).expect("valid");
        let (points, segments) = boundary(&rings, 2.0);
        assert_eq!(points.len(), segments.len());
        let inside = interior(&rings, &points, &segments, 2.0);
        let expected = (10_000.0 - 600.0 - 1.2 * (400.0 + 120.0)) / (4.0 * 0.75_f64.sqrt());
        assert!((inside.len() as f64 / expected - 1.0).abs() < 0.05);
        for p in &inside {
            assert!(rings[0].contains(*p) && !rings[1].contains(*p));
            for k in 0..rings[1].len() {
                let (a, b) = rings[1].edge(k);
                assert!(segment_distance_squared(*p, a, b) >= (CLEARANCE * 2.0).powi(2) * 0.999);
            }
        }
    }

    #[test]
    fn rings_that_touch_share_a_point() {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 10.), (x: 0., y: 10.)],
            interiors: [[(x: 0., y: 0.), (x: 4., y: 2.), (x: 2., y: 4.)]],
        );
        let (_, rings) = rings(&shape, 0.5).expect("valid");
        let (points, segments) = boundary(&rings, 100.0);
        // Four and three corners, a midpoint on each of the seven edges.
        assert_eq!((points.len(), segments.len()), (13, 14));
    }
}
