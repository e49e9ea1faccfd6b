//! The points that a domain is triangulated on: subdivided rings, and a
//! triangular lattice inside.
//!
//! Refinement could place all inner points by itself, but a lattice gives
//! equilateral triangles over most of the domain at a fraction of the cost,
//! and leaves refinement only the seam along the boundary. The lattice is
//! laid along the longest edge through the centroid of the exterior, so that
//! a domain which is moved or turned gets the same mesh, up to rounding.

use std::collections::BTreeSet;

use super::core::{Core, Points};
use super::lines::Lines;
use super::ring::Ring;
use super::sizing::Sizing;
use crate::footpoint::{Bound, Tree};
use crate::plane::{segment_distance_squared, wedge, V2};

/// One straight piece of a subdivided ring edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// Index of the start among the points.
    pub(crate) from: u32,
    /// Index of the end among the points.
    pub(crate) to: u32,
    /// Ring it lies on; for a constraint line, `LINE` and its number.
    pub(crate) ring: u32,
    /// Edge of the (cleaned) ring it lies on.
    pub(crate) edge: u32,
}

/// Set in the ring of a segment when it is part of a constraint line.
pub(crate) const LINE: u32 = 1 << 31;

impl Segment {
    pub(crate) fn is_line(&self) -> bool {
        self.ring & LINE != 0
    }
}

/// Lattice points nearer to the boundary than this part of the edge length
/// are left out: closer ones make flat triangles, a wider gap makes refinement
/// fill it again.
const CLEARANCE: f64 = 0.62;

/// Lattice points farther from the boundary than this many steps belong to
/// the core. Refinement works within about two.
const BAND: f64 = 3.5;

/// Points of all rings and lines, subdivided as `sizing` says, equal points
/// merged.
///
/// Ends early, with rings that are not whole, once there are more points than
/// `allowed`.
pub(crate) fn boundary(
    rings: &[Ring],
    lines: &Lines,
    sizing: &Sizing,
    allowed: usize,
) -> (Vec<V2>, Vec<Segment>) {
    let mut points = Vec::new();
    let mut segments = Vec::new();
    let mut chain = |points: &mut Vec<V2>, a: V2, b: V2, least: usize, ring: u32, edge: u32| {
        let room = allowed.saturating_sub(points.len()) + 1;
        let inner = sizing.subdivide(a, b, least, room);
        for p in std::iter::once(a).chain(inner) {
            let from = points.len() as u32;
            points.push(p);
            segments.push(Segment {
                from,
                to: from + 1,
                ring,
                edge,
            });
        }
        segments.len() - 1
    };
    let mut ends = Vec::new();
    for (index, ring) in rings.iter().enumerate() {
        let first = points.len() as u32;
        let mut last = 0;
        for k in 0..ring.len() {
            let (mut a, b) = ring.edge(k);
            let cuts = lines.cuts(index, k);
            // An edge between two corners gets a point of its own: at a corner
            // a field may be free (see `BoundaryField`), in between it is not.
            let corners = ring.corner[k] && ring.corner[ring.next(k)] && cuts.is_empty();
            let least = if corners { 2 } else { 1 };
            for end in cuts.iter().map(|cut| cut.2).chain([b]) {
                last = chain(&mut points, a, end, least, index as u32, k as u32);
                a = end;
            }
        }
        ends.push((last, first));
    }
    for piece in &lines.pieces {
        let last = chain(&mut points, piece.from, piece.to, 1, LINE | piece.line, 0);
        ends.push((last, points.len() as u32));
        points.push(piece.to);
    }
    for (last, to) in ends {
        segments[last].to = to;
    }
    let (points, mut segments) = merge(points, segments);
    if !lines.pieces.is_empty() {
        // What two lines share is there once.
        let mut seen = BTreeSet::new();
        segments.retain(|s| !s.is_line() || seen.insert((s.from.min(s.to), s.from.max(s.to))));
    }
    (points, segments)
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

/// Lattice points strictly inside the rings, clear of the boundary and of
/// constraint lines.
///
/// Where the mesh is graded, finer lattices, each of half the step, fill the
/// neighbourhood of shorter segments. Each holds the points of the coarser
/// ones, so that triangles in between have no angle below 30 degrees.
///
/// With `cored`, the points that are far from all segments are triangulated
/// apart. Ends early once there are more than `allowed`.
pub(crate) fn interior(
    rings: &[Ring],
    points: &[V2],
    segments: &[Segment],
    sizing: &Sizing,
    cored: bool,
    allowed: usize,
) -> (Vec<V2>, Core) {
    let clear = Clear::new(points, segments, sizing);
    let mut inside = Vec::new();
    let mut core = Core::default();
    for level in 0..=sizing.levels {
        let step = sizing.step * 0.5_f64.powi(level as i32);
        let frame = LatticeFrame::new(rings, step);
        let rows = Rows::new(&frame, points, segments, sizing, level, cored);
        if cored && level == 0 {
            let mut far = Points::new(rows.first, rows.crossings.len());
            rows.fill(&frame, level, |row, column, near, p| {
                if near {
                    inside.push(p);
                } else {
                    far.push(row, column, p);
                }
            });
            let (triangulated, alone) = far.triangulate();
            core = triangulated;
            inside.extend(alone);
        } else {
            rows.fill(&frame, level, |_, _, _, p| {
                if level == 0 || clear.of(p) {
                    inside.push(p);
                }
            });
        }
        // Too many: the caller says so.
        if inside.len() > allowed {
            break;
        }
    }
    (inside, core)
}

/// Segments by how far lattice points keep off each.
struct Clear {
    segments: Vec<(V2, V2)>,
    tree: Tree,
}

impl Clear {
    fn new(points: &[V2], segments: &[Segment], sizing: &Sizing) -> Self {
        let ends = |s: &Segment| (points[s.from as usize], points[s.to as usize]);
        let segments: Vec<(V2, V2)> = if sizing.levels > 0 {
            segments.iter().map(ends).collect()
        } else {
            Vec::new()
        };
        let bounds: Vec<Bound> = segments
            .iter()
            .map(|&(a, b)| Bound::of_segment(a, b, (b - a).norm()))
            .collect();
        Self {
            tree: Tree::new(&bounds),
            segments,
        }
    }

    /// Whether `p` keeps off all segments, from each by a part of its length.
    fn of(&self, p: V2) -> bool {
        let parts = |k: usize| {
            let (a, b) = self.segments[k];
            Some(segment_distance_squared(p, a, b).sqrt() / (b - a).norm())
        };
        self.tree.nearest(p, CLEARANCE, parts).is_none()
    }
}

/// What the segments say about the rows of one lattice.
struct Rows {
    first: i64,
    /// Where the boundary crosses the row.
    crossings: Vec<Vec<f64>>,
    /// Columns too near to a segment.
    blocked: Vec<Vec<i64>>,
    /// Columns near to a segment: on the coarsest lattice those that are not
    /// of the core, on finer ones those that are wanted.
    near: Vec<Vec<i64>>,
}

impl Rows {
    /// One pass over the rows that each segment meets: O(boundary / step),
    /// and O(reach^2) a segment on finer lattices.
    fn new(
        frame: &LatticeFrame,
        points: &[V2],
        segments: &[Segment],
        sizing: &Sizing,
        level: u32,
        cored: bool,
    ) -> Self {
        let height = frame.row_height;
        let heights = || points.iter().map(|&p| frame.to(p).y);
        let lowest = heights().fold(f64::MAX, f64::min);
        let highest = heights().fold(f64::MIN, f64::max);
        let first = (lowest / height).floor() as i64;
        let count = ((highest / height).ceil() as i64 - first + 1).max(0) as usize;
        let mut rows = Self {
            first,
            crossings: vec![Vec::new(); count],
            blocked: vec![Vec::new(); count],
            near: vec![Vec::new(); count],
        };
        for segment in segments {
            let a = frame.to(points[segment.from as usize]);
            let b = frame.to(points[segment.to as usize]);
            let length = (b - a).norm();
            if !segment.is_line() {
                rows.cross(frame, a, b);
            }
            // On an even mesh the lattice keeps its own distance, on a graded
            // one that of the segment; points of finer lattices are asked one
            // by one, since few of them are wanted beside a long segment.
            if level == 0 {
                let part = if sizing.levels > 0 {
                    length
                } else {
                    frame.step
                };
                rows.around(frame, a, b, CLEARANCE * part, |rows, slot, column| {
                    rows.blocked[slot].push(column);
                });
            }
            let reach = match level {
                0 if cored => {
                    let graded = if sizing.levels > 0 {
                        sizing.reach(length, 1)
                    } else {
                        None
                    };
                    Some(BAND * frame.step + graded.unwrap_or(0.0))
                }
                0 => None,
                _ => sizing.reach(length, level),
            };
            if let Some(reach) = reach {
                rows.around(frame, a, b, reach, |rows, slot, column| {
                    rows.near[slot].push(column);
                });
            }
        }
        rows
    }

    fn slot(&self, row: i64) -> Option<usize> {
        let slot = usize::try_from(row - self.first).ok()?;
        (slot < self.crossings.len()).then_some(slot)
    }

    fn cross(&mut self, frame: &LatticeFrame, a: V2, b: V2) {
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let from = (low / frame.row_height).ceil() as i64;
        let to = (high / frame.row_height).floor() as i64;
        for row in from..=to {
            let y = row as f64 * frame.row_height;
            if let (true, Some(slot)) = ((a.y > y) != (b.y > y), self.slot(row)) {
                self.crossings[slot].push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
    }

    /// Calls `visit` for the lattice points within `reach` of a segment.
    fn around(
        &mut self,
        frame: &LatticeFrame,
        a: V2,
        b: V2,
        reach: f64,
        mut visit: impl FnMut(&mut Self, usize, i64),
    ) {
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let from = ((low - reach) / frame.row_height).ceil() as i64;
        let to = ((high + reach) / frame.row_height).floor() as i64;
        for row in from..=to {
            let Some(slot) = self.slot(row) else {
                continue;
            };
            let y = row as f64 * frame.row_height;
            let shift = frame.shift(row);
            let left = ((a.x.min(b.x) - reach - shift) / frame.step).ceil() as i64;
            let right = ((a.x.max(b.x) + reach - shift) / frame.step).floor() as i64;
            for column in left..=right {
                let p = V2::new(column as f64 * frame.step + shift, y);
                if segment_distance_squared(p, a, b) < reach * reach {
                    visit(self, slot, column);
                }
            }
        }
    }

    /// Calls `visit` with the points of this lattice that lie inside and are
    /// not blocked, and whether they are near to a segment.
    fn fill(mut self, frame: &LatticeFrame, level: u32, mut visit: impl FnMut(i64, i64, bool, V2)) {
        for slot in 0..self.crossings.len() {
            let row = slot as i64 + self.first;
            let shift = frame.shift(row);
            let cuts = &mut self.crossings[slot];
            cuts.sort_by(f64::total_cmp);
            let mut blocked = Marks::new(&mut self.blocked[slot]);
            let near = &mut self.near[slot];
            let mut push = |column: i64, near: bool| {
                if !blocked.has(column) {
                    let p = V2::new(
                        column as f64 * frame.step + shift,
                        row as f64 * frame.row_height,
                    );
                    visit(row, column, near, frame.back(p));
                }
            };
            let spans = cuts.chunks_exact(2).map(|span| {
                let left = ((span[0] - shift) / frame.step).ceil() as i64;
                let right = ((span[1] - shift) / frame.step).floor() as i64;
                (left, right)
            });
            if level == 0 {
                let mut near = Marks::new(near);
                for (left, right) in spans {
                    (left..=right).for_each(|column| push(column, near.has(column)));
                }
                continue;
            }
            near.sort_unstable();
            near.dedup();
            for (left, right) in spans {
                let from = near.partition_point(|&column| column < left);
                let to = near.partition_point(|&column| column <= right);
                near[from..to.max(from)]
                    .iter()
                    .filter(|&&column| !is_coarser(row, column))
                    .for_each(|&column| push(column, true));
            }
        }
    }
}

/// A set of columns that is asked in ascending order.
struct Marks<'a> {
    columns: &'a [i64],
    next: usize,
}

impl<'a> Marks<'a> {
    fn new(columns: &'a mut Vec<i64>) -> Self {
        columns.sort_unstable();
        columns.dedup();
        Self { columns, next: 0 }
    }

    fn has(&mut self, column: i64) -> bool {
        while self.next < self.columns.len() && self.columns[self.next] < column {
            self.next += 1;
        }
        self.columns.get(self.next) == Some(&column)
    }
}

/// Whether a lattice point belongs to the lattice of twice the step as well.
fn is_coarser(row: i64, column: i64) -> bool {
    row.rem_euclid(2) == 0 && (column - row.div_euclid(2)).rem_euclid(2) == 0
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

/// Centroid of the area within a ring; for one that crosses itself, whose
/// centroid can be anywhere, the middle of its bounding box. (It is refused
/// later, by name.)
fn centroid(points: &[V2]) -> V2 {
    let origin = points[0];
    let mut moment = V2::zeros();
    let mut area = 0.0;
    let (mut low, mut high) = (origin, origin);
    for pair in points.windows(2) {
        let (a, b) = (pair[0] - origin, pair[1] - origin);
        moment += (a + b) * wedge(a, b);
        area += wedge(a, b);
        (low, high) = (low.inf(&pair[1]), high.sup(&pair[1]));
    }
    // Rings without area are refused before.
    let centre = origin + moment / (3.0 * area);
    let within = |k: usize| (low[k]..=high[k]).contains(&centre[k]);
    if within(0) && within(1) {
        centre
    } else {
        low + (high - low) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::ring::rings;
    use super::super::DomainOptions;
    use super::*;
    use geo_types::polygon;

    #[test]
    fn the_lattice_fills_a_ring_with_a_hole() {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)],
            interiors: [[(x: 30., y: 30.), (x: 60., y: 30.), (x: 60., y: 70.)]],
        );
        let (_, rings) = rings(&shape, 0.5).expect("valid");
        let sizing = Sizing::new(&rings, 2.0, &DomainOptions::default());
        let (points, segments) = boundary(&rings, &Lines::default(), &sizing, 1_000_000);
        assert_eq!(points.len(), segments.len());
        let (inside, _) = interior(&rings, &points, &segments, &sizing, false, 1_000_000);
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
    fn lattices_of_half_the_step_hold_the_coarser_ones() {
        let shape = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 90.), (x: 0., y: 90.)];
        let (_, rings) = rings(&shape, 0.5).expect("valid");
        let (fine, coarse) = (
            LatticeFrame::new(&rings, 1.0),
            LatticeFrame::new(&rings, 2.0),
        );
        let at = |frame: &LatticeFrame, row: i64, column: i64| {
            V2::new(
                column as f64 * frame.step + frame.shift(row),
                row as f64 * frame.row_height,
            )
        };
        for row in -5..=5 {
            for column in -5..=5 {
                let p = at(&fine, row, column);
                let found = (-9..=9)
                    .flat_map(|r| (-9..=9).map(move |c| (r, c)))
                    .any(|(r, c)| (at(&coarse, r, c) - p).norm() < 1e-9);
                assert_eq!(found, is_coarser(row, column));
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
        let sizing = Sizing::new(&rings, 100.0, &DomainOptions::default());
        let (points, segments) = boundary(&rings, &Lines::default(), &sizing, 1_000_000);
        // Four and three corners, a midpoint on each of the seven edges.
        assert_eq!((points.len(), segments.len()), (13, 14));
    }
}
