//! The triangles of a mesh as a walk wants them: small, and along a curve.
//!
//! A stage of the integrator looks at a triangle a few triangles away from the
//! last. On a large mesh the time goes into fetching them: so triangles take 24
//! bytes and vertices 32, and those that are near each other in the plane are
//! so in memory (D. Hilbert, *Ueber die stetige Abbildung einer Linie auf ein
//! Flaechenstueck*, Math. Ann. 38 (1891)).

use super::mesh::Mesh;
use crate::vector::{cross, point, Point};

/// Barycentric coordinate above which a point is inside a triangle beyond
/// doubt, whichever way it was reached.
pub(super) const INSIDE: f64 = 1e-9;
/// Triangles walked through from the last one before the raster is asked for a
/// nearer start.
const STROLL: usize = 2;
/// Triangles walked through from there before the walk is given up: enough for
/// a mesh that is finer in places by a factor of a thousand in area.
const WALK: usize = 64;
/// Beyond the border.
const NONE: u32 = u32::MAX;

/// A vertex, half a line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Node {
    point: Point,
    vector: Point,
}

/// A triangle: its corners, and where the triangle beyond the side opposite to
/// each is, or [`NONE`].
#[derive(Clone, Copy, Debug)]
struct Cell {
    corners: [u32; 3],
    beyond: [u32; 3],
}

/// All triangles of a mesh, and where each of them is.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    cells: Vec<Cell>,
    nodes: Vec<Node>,
    /// Position in the mesh of each cell, and the other way round.
    triangle: Vec<u32>,
    place: Vec<u32>,
    starts: Starts,
}

impl Cells {
    /// Of the first 2^32 - 1 triangles and vertices, which no memory holds.
    pub(super) fn new(mesh: &Mesh) -> Self {
        let triangle = along_curve(mesh);
        let mut place = vec![NONE; mesh.triangles.len()];
        for (i, &t) in triangle.iter().enumerate() {
            place[t as usize] = i as u32;
        }
        // Vertices in the order in which the triangles first meet them.
        let mut number = vec![NONE; mesh.points.len()];
        let mut nodes = Vec::with_capacity(mesh.points.len());
        let mut node = |v: usize| {
            if number[v] == NONE {
                number[v] = nodes.len() as u32;
                nodes.push(Node {
                    point: mesh.points[v],
                    vector: mesh.vectors[v],
                });
            }
            number[v]
        };
        let cells = triangle
            .iter()
            .map(|&t| {
                let t = t as usize;
                let beyond = |local: usize| {
                    let other = mesh.beyond(mesh.edges_of[t][local], t);
                    place.get(other).copied().unwrap_or(NONE)
                };
                Cell {
                    corners: mesh.triangles[t].map(&mut node),
                    beyond: [beyond(1), beyond(2), beyond(0)],
                }
            })
            .collect();
        let starts = Starts::new(mesh, &place);
        Self {
            cells,
            nodes,
            triangle,
            place,
            starts,
        }
    }

    /// Where a triangle of the mesh is.
    pub(super) fn place(&self, triangle: usize) -> usize {
        self.place[triangle] as usize
    }

    /// The position in the mesh of the triangle at a place.
    pub(super) fn triangle(&self, place: usize) -> usize {
        self.triangle[place] as usize
    }

    /// The representation vectors of its corners.
    #[inline]
    pub(super) fn vectors(&self, place: usize) -> [Point; 3] {
        self.cells[place]
            .corners
            .map(|v| self.nodes[v as usize].vector)
    }

    /// How the vector changes along `way` within the triangle, per metre.
    pub(super) fn slope(&self, place: usize, way: Point) -> Point {
        let corners = self.cells[place].corners.map(|v| self.nodes[v as usize]);
        let [a, b, c] = corners.map(|node| node.point);
        let area = cross(b - a, c - a);
        // A barycentric coordinate grows across the opposite side.
        let sum = corners[0].vector * cross(c - b, way)
            + corners[1].vector * cross(a - c, way)
            + corners[2].vector * cross(b - a, way);
        sum / area
    }

    /// Barycentric coordinates in it.
    pub(super) fn weights(&self, place: usize, at: Point) -> [f64; 3] {
        let (parts, whole) = self.areas(&self.cells[place], at);
        parts.map(|part| part / whole)
    }

    /// Twice the areas of the triangles that `at` forms with the sides opposite
    /// to the corners, and that of the whole.
    #[inline]
    fn areas(&self, cell: &Cell, at: Point) -> ([f64; 3], f64) {
        let [a, b, c] = cell.corners.map(|v| self.nodes[v as usize].point);
        let parts = [
            cross(c - b, at - b),
            cross(a - c, at - c),
            cross(b - a, at - a),
        ];
        (parts, cross(b - a, c - a))
    }

    /// The place of the triangle that holds `p`, with its barycentric
    /// coordinates; looked for from the place `hint` on. `None` if the way leads
    /// over the border, or far, or to a point on a side, to rounding.
    #[inline]
    pub(super) fn find(&self, p: Point, hint: usize) -> Option<(usize, [f64; 3])> {
        match self.walk(p, hint, STROLL) {
            Walk::There(found) => return Some(found),
            Walk::Doubt => return None,
            Walk::Lost => {}
        }
        match self.walk(p, self.starts.near(p)?, WALK) {
            Walk::There(found) => Some(found),
            Walk::Doubt | Walk::Lost => None,
        }
    }

    /// Goes from triangle to triangle towards `p`, each time across the side
    /// that it lies farthest beyond.
    #[inline]
    fn walk(&self, p: Point, from: usize, most: usize) -> Walk {
        let mut place = from;
        for _ in 0..most {
            let Some(cell) = self.cells.get(place) else {
                return Walk::Lost;
            };
            let (parts, whole) = self.areas(cell, p);
            let [u, v, w] = parts;
            let least = u.min(v).min(w);
            if least > INSIDE * whole {
                let weights = parts.map(|part| part / whole);
                if weights.iter().all(|&w| w > INSIDE) {
                    return Walk::There((place, weights));
                }
                return Walk::Doubt;
            }
            if least.is_nan() || least >= -INSIDE * whole {
                return Walk::Doubt;
            }
            let side = if u == least {
                0
            } else if v == least {
                1
            } else {
                2
            };
            place = cell.beyond[side] as usize;
        }
        Walk::Lost
    }
}

/// Where a walk led to.
enum Walk {
    There((usize, [f64; 3])),
    /// On a side, to rounding.
    Doubt,
    /// Beyond the border, or not there yet.
    Lost,
}

/// For each square of a raster a triangle nearby.
#[derive(Clone, Debug)]
struct Starts {
    low: Point,
    scale: f64,
    columns: usize,
    rows: usize,
    place: Vec<u32>,
}

impl Starts {
    /// About as many squares as triangles.
    fn new(mesh: &Mesh, place: &[u32]) -> Self {
        let (low, high) = extent(mesh);
        let (width, height) = (high.x - low.x, high.y - low.y);
        let count = mesh.triangles.len() as f64;
        let side = (width * height / count)
            .sqrt()
            .max(width.max(height) / count);
        let scale = if side > 0.0 { 1.0 / side } else { 0.0 };
        let mut starts = Self {
            low,
            scale,
            columns: (width * scale) as usize + 1,
            rows: (height * scale) as usize + 1,
            place: Vec::new(),
        };
        starts.place = vec![NONE; starts.columns * starts.rows];
        for (triangle, &corners) in mesh.triangles.iter().enumerate() {
            if let Some(square) = starts.square(middle(mesh, corners)) {
                starts.place[square] = place[triangle];
            }
        }
        starts.fill();
        starts
    }

    /// Empty squares take after the nearest full ones, roughly: along rows both
    /// ways, then from row to row.
    fn fill(&mut self) {
        let mut pass = |from: usize, to: usize| {
            if self.place[to] == NONE {
                self.place[to] = self.place[from];
            }
        };
        for row in 0..self.rows {
            let first = row * self.columns;
            (first + 1..first + self.columns).for_each(|i| pass(i - 1, i));
            (first + 1..first + self.columns)
                .rev()
                .for_each(|i| pass(i, i - 1));
        }
        let (columns, all) = (self.columns, self.columns * self.rows);
        (columns..all).for_each(|i| pass(i - columns, i));
        (columns..all).rev().for_each(|i| pass(i, i - columns));
    }

    #[inline]
    fn square(&self, p: Point) -> Option<usize> {
        let q = (p - self.low) * self.scale;
        if !(q.x >= 0.0 && q.y >= 0.0) {
            return None;
        }
        let (x, y) = (q.x as usize, q.y as usize);
        (x < self.columns && y < self.rows).then_some(y * self.columns + x)
    }

    #[inline]
    fn near(&self, p: Point) -> Option<usize> {
        Some(self.place[self.square(p)?] as usize)
    }
}

fn middle(mesh: &Mesh, corners: [usize; 3]) -> Point {
    let [a, b, c] = corners.map(|v| mesh.points[v]);
    (a + b + c) / 3.0
}

/// The box of the middles of all triangles.
fn extent(mesh: &Mesh) -> (Point, Point) {
    let mut low = point(f64::INFINITY, f64::INFINITY);
    let mut high = low * -1.0;
    for p in mesh.triangles.iter().map(|&corners| middle(mesh, corners)) {
        low = point(low.x.min(p.x), low.y.min(p.y));
        high = point(high.x.max(p.x), high.y.max(p.y));
    }
    (low, high)
}

/// Triangles in the order in which Hilbert's curve meets their middles.
fn along_curve(mesh: &Mesh) -> Vec<u32> {
    let (low, high) = extent(mesh);
    let side = (high.x - low.x).max(high.y - low.y);
    let scale = if side > 0.0 { 65535.0 / side } else { 0.0 };
    let mut keyed: Vec<(u32, u32)> = mesh
        .triangles
        .iter()
        .zip(0..NONE)
        .map(|(&corners, triangle)| {
            let p = (middle(mesh, corners) - low) * scale;
            (curve(p.x as u32, p.y as u32), triangle)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, triangle)| triangle).collect()
}

/// How far along Hilbert's curve the square at column `x` and row `y` of 65,536
/// is.
fn curve(mut x: u32, mut y: u32) -> u32 {
    const LAST: u32 = 65535;
    let mut along = 0;
    for bit in (0..16).rev() {
        let (right, up) = (x >> bit & 1, y >> bit & 1);
        along = along << 2 | ((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                (x, y) = (LAST - x, LAST - y);
            }
            std::mem::swap(&mut x, &mut y);
        }
    }
    along
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_steps_from_square_to_neighbour() {
        // The first 4^4 squares of the curve fill 16 x 16 squares.
        let mut squares: Vec<(u32, u32, u32)> = (0..256)
            .map(|i| (curve(i % 16, i / 16), i % 16, i / 16))
            .collect();
        squares.sort_unstable();
        for (i, pair) in squares.windows(2).enumerate() {
            let ((at, x, y), (_, u, v)) = (pair[0], pair[1]);
            assert_eq!(at as usize, i);
            assert_eq!(x.abs_diff(u) + y.abs_diff(v), 1);
        }
    }
}
