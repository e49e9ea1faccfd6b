//! Finite elements for harmonic functions: linear (P1) and quadratic (P2).
//!
//! Nodes are the vertices of the mesh, and for quadratic elements the middles
//! of its edges after them. The stiffness of both comes from the scalar
//! products of the gradients of the barycentric coordinates, which are minus
//! half the cotangents (Pinkall and Polthier 1993).

use sprs::{CsMat, CsMatI};

use crate::domain::Domain;
use crate::factor;
use crate::plane::{wedge, V2};
use crate::FieldError;

/// Finite elements by which harmonic functions are approximated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Elements {
    /// Quadratic elements, and derivatives from a local fit of harmonic
    /// polynomials of degree four. Derivatives converge on every mesh, and
    /// the field of a rectangle is exact.
    #[default]
    Quadratic,
    /// The paper's: linear elements ("cotan weights"), and second derivatives
    /// from a quadric fitted to two rings of neighbours. These do not
    /// converge: on a rectangle that lies askew to the mesh an error of some
    /// tenths of a degree stays however fine the mesh is. For comparison.
    Linear,
}

/// The nodes of all elements.
pub(crate) struct Nodes {
    /// Positions: the vertices first.
    pub(crate) points: Vec<V2>,
    /// Six nodes a triangle, three for linear elements: its corners, then the
    /// middles of its edges from corner `k` to corner `k + 1`.
    triangles: Vec<[u32; 6]>,
    /// Start, end and middle of each border of the mesh.
    borders: Vec<[u32; 3]>,
    elements: Elements,
}

/// Marks the middles that linear elements do not have.
const NONE: u32 = u32::MAX;

impl Nodes {
    pub(crate) fn new(domain: &Domain, elements: Elements) -> Self {
        let inner = &*domain.inner;
        let mesh = &inner.mesh;
        let mut points = mesh.points.clone();
        // The number of the middle of each edge, where it starts at its lower
        // vertex.
        let mut middle = vec![NONE; inner.adjacency.len()];
        if elements == Elements::Quadratic {
            for v in 0..mesh.points.len() {
                for (slot, &w) in inner.adjacency.row(v).zip(inner.adjacency.of(v)) {
                    if w as usize > v {
                        middle[slot] = points.len() as u32;
                        points.push((mesh.points[v] + mesh.points[w as usize]) / 2.0);
                    }
                }
            }
        }
        let between = |v: u32, w: u32| {
            let slot = inner.adjacency.slot(v.min(w), v.max(w));
            slot.map_or(NONE, |slot| middle[slot])
        };
        let triangles = mesh
            .triangles
            .iter()
            .map(|&[a, b, c]| [a, b, c, between(a, b), between(b, c), between(c, a)])
            .collect();
        let borders = mesh
            .borders
            .iter()
            .map(|border| [border.from, border.to, between(border.from, border.to)])
            .collect();
        Self {
            points,
            triangles,
            borders,
            elements,
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn elements(&self) -> Elements {
        self.elements
    }

    /// Nodes of a triangle.
    pub(crate) fn of(&self, triangle: usize) -> &[u32] {
        let nodes = &self.triangles[triangle];
        match self.elements {
            Elements::Quadratic => nodes,
            Elements::Linear => &nodes[..3],
        }
    }

    /// The nodes of a border with the share of a constant flux that each of
    /// them carries (Simpson's rule, exact).
    pub(crate) fn border_shares(&self, border: usize) -> impl Iterator<Item = (usize, f64)> {
        let [from, to, middle] = self.borders[border];
        let shares = match self.elements {
            Elements::Quadratic => [(from, 1.0 / 6.0), (to, 1.0 / 6.0), (middle, 2.0 / 3.0)],
            Elements::Linear => [(from, 0.5), (to, 0.5), (middle, 0.0)],
        };
        shares
            .into_iter()
            .filter(|&(node, _)| node != NONE)
            .map(|(node, share)| (node as usize, share))
    }

    /// The stiffness matrix, positive semidefinite with the constants as its
    /// null space, in compressed columns.
    fn stiffness(&self) -> CsMat<f64> {
        let count = self.count();
        let mut starts = vec![0_usize; count + 1];
        for t in 0..self.triangles.len() {
            let nodes = self.of(t);
            for &node in nodes {
                starts[node as usize + 1] += nodes.len();
            }
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0_u32, 0.0_f64); starts[count]];
        for t in 0..self.triangles.len() {
            let nodes = self.of(t);
            let local = local_stiffness(self.corners(t), self.elements);
            for (j, &column) in nodes.iter().enumerate() {
                for (i, &row) in nodes.iter().enumerate() {
                    let slot = &mut next[column as usize];
                    entries[*slot] = (row, local[i][j]);
                    *slot += 1;
                }
            }
        }
        // Equal entries of a column are added in the order of the triangles:
        // the sort is stable.
        let mut pointers = Vec::with_capacity(count + 1);
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        pointers.push(0);
        for k in 0..count {
            let column = &mut entries[starts[k]..starts[k + 1]];
            column.sort_by_key(|&(row, _)| row);
            let first = rows.len();
            for &(row, value) in column.iter() {
                match values.last_mut() {
                    Some(last) if rows.len() > first && rows.last() == Some(&(row as usize)) => {
                        *last += value;
                    }
                    _ => {
                        rows.push(row as usize);
                        values.push(value);
                    }
                }
            }
            pointers.push(rows.len());
        }
        CsMatI::new_csc((count, count), pointers, rows, values)
    }

    fn corners(&self, triangle: usize) -> [V2; 3] {
        [0, 1, 2].map(|k| self.points[self.triangles[triangle][k] as usize])
    }

    /// Solves the Neumann problem for each column of loads, in place.
    ///
    /// Each column must sum to zero (Gauss): node 0 is tied to zero by a
    /// spring which then carries no force, so that the solution is exact.
    pub(crate) fn neumann(&self, loads: &mut [Vec<f64>]) -> Result<(), FieldError> {
        let mut matrix = self.stiffness();
        if let Some(entry) = matrix.get_mut(0, 0) {
            *entry += 1.0;
        }
        factor::solve(&matrix, loads)
    }

    /// Solves Laplace's equation with the given values at `fixed` nodes (one
    /// column of values for each right-hand side) and no flux through the
    /// rest of the boundary. Returns all nodal values of each column.
    pub(crate) fn mixed(
        &self,
        fixed: &[bool],
        values: &[Vec<f64>],
    ) -> Result<Vec<Vec<f64>>, FieldError> {
        let matrix = self.stiffness();
        let count = self.count();
        let mut number = vec![usize::MAX; count];
        let free: Vec<usize> = (0..count).filter(|&k| !fixed[k]).collect();
        for (k, &node) in free.iter().enumerate() {
            number[node] = k;
        }
        let mut loads = vec![vec![0.0; free.len()]; values.len()];
        let (mut pointers, mut rows, mut data) = (vec![0], Vec::new(), Vec::new());
        for (column, row) in matrix.outer_iterator().enumerate() {
            for (node, &entry) in row.iter().filter(|&(node, _)| !fixed[node]) {
                if fixed[column] {
                    for (load, value) in loads.iter_mut().zip(values) {
                        load[number[node]] -= entry * value[column];
                    }
                } else {
                    rows.push(number[node]);
                    data.push(entry);
                }
            }
            if !fixed[column] {
                pointers.push(rows.len());
            }
        }
        let reduced = CsMatI::new_csc((free.len(), free.len()), pointers, rows, data);
        factor::solve(&reduced, &mut loads)?;
        Ok(values
            .iter()
            .zip(loads)
            .map(|(value, load)| {
                let mut all = value.clone();
                for (&node, solved) in free.iter().zip(load) {
                    all[node] = solved;
                }
                all
            })
            .collect())
    }
}

/// Stiffness of one triangle, in the order of [`Nodes::of`].
fn local_stiffness(points: [V2; 3], elements: Elements) -> [[f64; 6]; 6] {
    // Scalar products of the gradients of the barycentric coordinates, times
    // the area.
    let mut g = [[0.0; 3]; 3];
    for k in 0..3 {
        let [b, c] = [(k + 1) % 3, (k + 2) % 3];
        let (p, q) = (points[b] - points[k], points[c] - points[k]);
        // As in the Laplacian of the B-field: flattened triangles are cut at
        // angles of 1e-8.
        let sine = wedge(p, q).max(1e-8 * p.norm() * q.norm());
        let half = if sine > 0.0 {
            p.dot(&q) / sine / 2.0
        } else {
            0.0
        };
        (g[b][c], g[c][b]) = (-half, -half);
    }
    for k in 0..3 {
        g[k][k] = -g[k][(k + 1) % 3] - g[k][(k + 2) % 3];
    }
    let mut local = [[0.0; 6]; 6];
    if elements == Elements::Linear {
        for (row, g) in local.iter_mut().zip(&g) {
            row[..3].copy_from_slice(g);
        }
        return local;
    }
    // Integrals of (4 a - 1)^2 = 1, (4 a - 1)(4 b - 1) = -1/3,
    // (4 a - 1) 4 a = 4/3, (4 a - 1) 4 b = 0, a^2 = 1/6 and a b = 1/12 over
    // the unit of area, for barycentric coordinates a and b.
    for i in 0..3 {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        local[i][i] = g[i][i];
        (local[i][j], local[j][i]) = (-g[i][j] / 3.0, -g[i][j] / 3.0);
        // Middle i lies between corners i and j.
        let middle = 3 + i;
        for corner in [i, j] {
            let value = g[i][j] * 4.0 / 3.0;
            (local[corner][middle], local[middle][corner]) = (value, value);
        }
        local[middle][middle] = (g[i][i] + g[j][j] + g[i][j]) * 8.0 / 3.0;
        // Middles i (of corners i, j) and j (of corners j, k) share corner j.
        let value = g[i][k] * 8.0 / 3.0;
        (local[middle][3 + j], local[3 + j][middle]) = (value, value);
    }
    local
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;

    fn domain() -> Domain {
        let shape = polygon![(x: 0., y: 0.), (x: 9., y: 1.), (x: 7., y: 6.), (x: 2., y: 5.)];
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    /// Quadratic elements reproduce quadratic harmonic functions exactly, so
    /// that the stiffness times their nodal values is the load of their flux:
    /// zero inside.
    #[test]
    fn quadratic_functions_are_harmonic() {
        let domain = domain();
        let nodes = Nodes::new(&domain, Elements::Quadratic);
        let matrix = nodes.stiffness();
        let value = |p: V2| p.x * p.x - p.y * p.y + 3.0 * p.x * p.y - p.y;
        let mut image = vec![0.0; nodes.count()];
        let mut ones = vec![0.0; nodes.count()];
        for (column, entries) in matrix.outer_iterator().enumerate() {
            for (row, &entry) in entries.iter() {
                image[row] += entry * value(nodes.points[column]);
                ones[row] += entry;
            }
        }
        let on_border: Vec<bool> = (0..nodes.count())
            .map(|node| nodes.borders.iter().flatten().any(|&b| b as usize == node))
            .collect();
        for node in 0..nodes.count() {
            assert!(ones[node].abs() < 1e-10);
            assert!(on_border[node] || image[node].abs() < 1e-9);
        }
    }

    #[test]
    fn mixed_problems_have_linear_solutions() {
        // z = x on a rectangle: fixed left and right, no flux elsewhere.
        let shape = polygon![(x: 0., y: 0.), (x: 8., y: 0.), (x: 8., y: 5.), (x: 0., y: 5.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        for elements in [Elements::Quadratic, Elements::Linear] {
            let nodes = Nodes::new(&domain, elements);
            let fixed: Vec<bool> = nodes
                .points
                .iter()
                .map(|p| p.x.abs() > 4.0 - 1e-9)
                .collect();
            let values: Vec<f64> = nodes.points.iter().map(|p| p.x.signum()).collect();
            let solved = nodes.mixed(&fixed, &[values]).expect("definite");
            for (p, z) in nodes.points.iter().zip(&solved[0]) {
                assert!((z - p.x / 4.0).abs() < 1e-9);
            }
        }
    }
}
