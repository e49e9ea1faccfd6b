//! Who is whose neighbour, and what shape the triangles have.

use super::mesh::Mesh;
use crate::plane::wedge;

/// For each vertex the vertices it shares an edge with, ascending, in
/// compressed rows.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    starts: Vec<u32>,
    vertices: Vec<u32>,
}

impl Adjacency {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let count = mesh.points.len();
        let mut starts = vec![0_u32; count + 1];
        for &v in mesh.triangles.iter().flatten() {
            starts[v as usize + 1] += 2;
        }
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut all = vec![0_u32; starts[count] as usize];
        for triangle in &mesh.triangles {
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|j| triangle[(k + j) % 3]);
                let slot = &mut next[a as usize];
                all[*slot as usize] = b;
                all[*slot as usize + 1] = c;
                *slot += 2;
            }
        }
        // Inner edges were met from both of their triangles.
        let mut vertices = Vec::with_capacity(all.len() / 2 + mesh.borders.len());
        let mut compact = Vec::with_capacity(count + 1);
        compact.push(0);
        for v in 0..count {
            let row = &mut all[starts[v] as usize..starts[v + 1] as usize];
            row.sort_unstable();
            let first = vertices.len();
            for &w in row.iter() {
                if vertices.len() == first || vertices.last() != Some(&w) {
                    vertices.push(w);
                }
            }
            compact.push(vertices.len() as u32);
        }
        Self {
            starts: compact,
            vertices,
        }
    }

    /// Positions of row `v` in arrays that run parallel to the rows.
    pub(crate) fn row(&self, v: usize) -> std::ops::Range<usize> {
        self.starts[v] as usize..self.starts[v + 1] as usize
    }

    pub(crate) fn of(&self, v: usize) -> &[u32] {
        &self.vertices[self.row(v)]
    }

    /// Position of the entry `w` of row `v`. Rows are short: by trying all.
    pub(crate) fn slot(&self, v: u32, w: u32) -> Option<usize> {
        let place = self.of(v as usize).iter().position(|&u| u == w)?;
        Some(self.starts[v as usize] as usize + place)
    }

    /// Number of entries in all rows: twice the number of edges.
    pub(crate) fn len(&self) -> usize {
        self.vertices.len()
    }
}

/// Smallest angle of any triangle, radians.
pub(crate) fn min_angle(mesh: &Mesh) -> f64 {
    let mut smallest = f64::INFINITY;
    for triangle in &mesh.triangles {
        let points = triangle.map(|v| mesh.points[v as usize]);
        for k in 0..3 {
            let (p, q) = (
                points[(k + 1) % 3] - points[k],
                points[(k + 2) % 3] - points[k],
            );
            smallest = smallest.min(wedge(p, q).atan2(p.dot(&q)));
        }
    }
    smallest
}
