//! The inside of the lattice, triangulated without asking anyone.
//!
//! Far from the boundary the Delaunay triangulation of a triangular lattice is
//! the lattice's own triangles. So only a band along the boundary goes through
//! the general triangulation, with the rim of the core as a constraint; the
//! core is then put back. On a large mesh that leaves a few per cent of the
//! vertices to the general algorithm.

use crate::plane::V2;

/// Triangles of a lattice, away from the boundary.
#[derive(Clone, Debug, Default)]
pub(crate) struct Core {
    /// Points on the rim first, then those inside it.
    pub(crate) points: Vec<V2>,
    /// How many points lie on the rim.
    pub(crate) rim: usize,
    /// Counter-clockwise.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Entry `k`: the triangle across the edge from corner `k` to `k + 1`, or
    /// `NONE` on the rim.
    pub(crate) neighbours: Vec<[u32; 3]>,
}

/// No triangle there.
pub(crate) const NONE: u32 = u32::MAX;

/// Neighbouring columns of one row, whose points follow each other.
#[derive(Clone, Copy, Debug)]
struct Run {
    left: i64,
    right: i64,
    first: u32,
}

/// Lattice points by row, as runs of columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Points {
    first_row: i64,
    rows: Vec<Vec<Run>>,
    places: Vec<(i64, i64)>,
    points: Vec<V2>,
}

impl Points {
    pub(crate) fn new(first_row: i64, rows: usize) -> Self {
        Self {
            first_row,
            rows: vec![Vec::new(); rows],
            ..Self::default()
        }
    }

    /// Adds a point; within a row they come in ascending order.
    pub(crate) fn push(&mut self, row: i64, column: i64, p: V2) {
        let index = self.points.len() as u32;
        self.points.push(p);
        self.places.push((row, column));
        let runs = &mut self.rows[(row - self.first_row) as usize];
        match runs.last_mut() {
            Some(run) if run.right + 1 == column => run.right = column,
            _ => runs.push(Run {
                left: column,
                right: column,
                first: index,
            }),
        }
    }

    fn index(&self, row: i64, column: i64) -> Option<usize> {
        let slot = usize::try_from(row - self.first_row).ok()?;
        let runs = self.rows.get(slot)?;
        let run = runs[..runs.partition_point(|run| run.left <= column)].last()?;
        (column <= run.right).then(|| run.first as usize + (column - run.left) as usize)
    }

    /// The triangles between these points, and the points that are in none.
    pub(crate) fn triangulate(self) -> (Core, Vec<V2>) {
        let count = self.points.len();
        // By the left one of its two points in a row: the triangle above
        // them, and the one below.
        let (mut above, mut below) = (vec![NONE; count], vec![NONE; count]);
        let mut triangles = Vec::with_capacity(2 * count);
        let mut left_of = Vec::with_capacity(count);
        for (v, &(row, column)) in self.places.iter().enumerate() {
            left_of.push(self.index(row, column - 1));
            let Some(w) = self.index(row, column + 1) else {
                continue;
            };
            // Odd rows are shifted by half a step.
            let between = column + row.rem_euclid(2);
            if let Some(apex) = self.index(row + 1, between) {
                above[v] = triangles.len() as u32;
                triangles.push([v, w, apex]);
            }
            if let Some(foot) = self.index(row - 1, between) {
                below[v] = triangles.len() as u32;
                triangles.push([v, foot, w]);
            }
        }
        let left = |list: &[u32], v: usize| left_of[v].map_or(NONE, |u| list[u]);
        let neighbours: Vec<[u32; 3]> = triangles
            .iter()
            .enumerate()
            .map(|(t, &[v, a, b])| {
                if above[v] == t as u32 {
                    [below[v], below[b], left(&below, b)]
                } else {
                    [left(&above, a), above[a], above[v]]
                }
            })
            .collect();
        // 0 for points in no triangle, 1 on the rim, 2 inside.
        let mut kind = vec![0_u8; count];
        for &v in triangles.iter().flatten() {
            kind[v] = 2;
        }
        for (triangle, neighbours) in triangles.iter().zip(&neighbours) {
            for k in (0..3).filter(|&k| neighbours[k] == NONE) {
                kind[triangle[k]] = 1;
                kind[triangle[(k + 1) % 3]] = 1;
            }
        }
        let mut number = vec![NONE; count];
        let mut points = Vec::with_capacity(count);
        let mut rim = 0;
        for wanted in [1, 2] {
            for v in (0..count).filter(|&v| kind[v] == wanted) {
                number[v] = points.len() as u32;
                points.push(self.points[v]);
            }
            if wanted == 1 {
                rim = points.len();
            }
        }
        let alone = (0..count).filter(|&v| kind[v] == 0);
        let alone = alone.map(|v| self.points[v]).collect();
        let core = Core {
            points,
            rim,
            triangles: triangles.iter().map(|t| t.map(|v| number[v])).collect(),
            neighbours,
        };
        (core, alone)
    }
}

impl Core {
    /// Edges of the rim with the core on their left: from, to, triangle and
    /// which edge of it; in order of the ends.
    pub(crate) fn rim_edges(&self) -> Vec<(u32, u32, u32, u32)> {
        let mut edges = Vec::new();
        for (t, neighbours) in self.neighbours.iter().enumerate() {
            for k in (0..3).filter(|&k| neighbours[k] == NONE) {
                let triangle = self.triangles[t];
                edges.push((triangle[k], triangle[(k + 1) % 3], t as u32, k as u32));
            }
        }
        edges.sort_unstable();
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::orient;

    #[test]
    fn a_patch_of_lattice_is_triangulated() {
        let height = 0.75_f64.sqrt();
        let mut points = Points::new(-3, 9);
        for row in -3..6_i64 {
            for column in -4..5_i64 {
                // A hole, a tail that is in no triangle.
                let hole = row == 1 && column == 1;
                if hole || (row == -3 && column > -2) {
                    continue;
                }
                let x = column as f64 + 0.5 * row.rem_euclid(2) as f64;
                points.push(row, column, V2::new(x, row as f64 * height));
            }
        }
        points.push(5, 9, V2::new(9.5, 5.0 * height));
        let count = points.points.len();
        let (core, alone) = points.triangulate();
        assert_eq!(alone, [V2::new(9.5, 5.0 * height)]);
        assert_eq!(core.points.len(), count - 1);
        for (t, triangle) in core.triangles.iter().enumerate() {
            let corners = triangle.map(|v| core.points[v as usize]);
            assert!((orient(corners[0], corners[1], corners[2]) - height).abs() < 1e-12);
            for k in 0..3 {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                let across = core.neighbours[t][k];
                // Whoever has the edge the other way round is the neighbour.
                let other = core
                    .triangles
                    .iter()
                    .position(|o| (0..3).any(|j| (o[j], o[(j + 1) % 3]) == (b, a)));
                assert_eq!(other.map_or(NONE, |o| o as u32), across);
                assert!(across != NONE || (a as usize) < core.rim.min(b as usize + core.rim));
            }
        }
        // Euler: a disc with one hole.
        let edges = (3 * core.triangles.len() + core.rim_edges().len()) / 2;
        assert_eq!(core.points.len() + core.triangles.len(), edges);
    }
}
