//! First and second derivatives at the vertices from nodal values, by least
//! squares on the patch of elements around each vertex.
//!
//! Quadratic elements: z = Re sum alpha_k w^k up to degree four, w the complex
//! place relative to the vertex. These are the harmonic polynomials, nine
//! unknowns against the nineteen nodes of a ring of six triangles: a fit that
//! cannot see what is not harmonic. On the boundary the fit knows the
//! condition: at a vertex of a straight piece, reflection leaves only the
//! polynomials that obey it, so that the crosses follow the boundary exactly;
//! elsewhere the flux through the borders of the patch enters as rows.
//!
//! Linear elements: the paper's full quadric on two rings.
//!
//! The result is linear in the nodal values and in the constants of the
//! pieces, so one fit serves all right-hand sides.

use nalgebra::{Complex, DMatrix};

use super::elements::{Elements, Nodes};
use super::pieces::Pieces;
use crate::domain::Domain;
use crate::plane::{left, V2};

type C = Complex<f64>;

/// Which derivative is wanted, as a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Derivative {
    /// (z_x, z_y).
    Gradient,
    /// ((z_xx - z_yy) / 2, z_xy), the trace-free Hessian.
    Hessian,
}

/// What the boundary condition says about the solution near a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reflection {
    /// Nothing that a reflection could use.
    None,
    /// A straight border along the unit vector with the constant flux of a
    /// piece: even in the distance from it, but for that flux.
    Even(C, Option<usize>),
    /// A straight border along the unit vector with a constant value: odd in
    /// the distance from it, but for that value.
    Odd(C),
}

/// How a piece of the boundary is constrained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Condition {
    /// The flux is the piece's constant.
    Flux,
    /// There is no flux.
    Closed,
    /// The value is constant.
    Value,
}

/// The derivative at one vertex as a linear function.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stencil {
    /// Weights of nodal values.
    pub(crate) nodes: Vec<(u32, V2)>,
    /// Weights of the fluxes of pieces.
    pub(crate) fluxes: Vec<(u32, V2)>,
}

/// Makes stencils for all vertices of a domain.
pub(crate) struct Recovery<'a> {
    domain: &'a Domain,
    nodes: &'a Nodes,
    pieces: &'a Pieces,
    conditions: Vec<Condition>,
    /// Triangles at each vertex, in compressed rows.
    starts: Vec<u32>,
    incident: Vec<u32>,
    /// The border that arrives at each vertex and the one that leaves it.
    borders: Vec<[u32; 2]>,
    derivative: Derivative,
}

const NONE: u32 = u32::MAX;

/// Borders that turn by less than this at a vertex are straight there; the
/// reflection is then wrong by no more than that.
const STRAIGHT: f64 = 1e-7;

impl<'a> Recovery<'a> {
    pub(crate) fn new(
        domain: &'a Domain,
        nodes: &'a Nodes,
        pieces: &'a Pieces,
        conditions: Vec<Condition>,
        derivative: Derivative,
    ) -> Self {
        let mesh = &domain.inner.mesh;
        let mut starts = vec![0_u32; mesh.points.len() + 1];
        for &v in mesh.triangles.iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..mesh.points.len() {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut incident = vec![0; 3 * mesh.triangles.len()];
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for &v in triangle {
                incident[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        let mut borders = vec![[NONE; 2]; mesh.points.len()];
        for (k, border) in mesh.borders.iter().enumerate() {
            borders[border.to as usize][0] = k as u32;
            borders[border.from as usize][1] = k as u32;
        }
        Self {
            domain,
            nodes,
            pieces,
            conditions,
            starts,
            incident,
            borders,
            derivative,
        }
    }

    fn triangles_at(&self, v: usize) -> &[u32] {
        &self.incident[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// Piece and unit direction of a border, as a complex number.
    fn border(&self, border: u32) -> (usize, C) {
        let inner = &*self.domain.inner;
        let border = inner.mesh.borders[border as usize];
        let direction = inner.rings[border.ring as usize].direction(border.edge as usize);
        let piece = self.pieces.of(border.ring, border.edge);
        (piece, C::new(direction.x, direction.y))
    }

    fn reflection(&self, v: usize) -> Reflection {
        let [arriving, leaving] = self.borders[v];
        if arriving == NONE || leaving == NONE || self.nodes.elements() == Elements::Linear {
            return Reflection::None;
        }
        let ((piece, along), (next, after)) = (self.border(arriving), self.border(leaving));
        if (along - after).norm() > STRAIGHT {
            return Reflection::None;
        }
        let tangent = (along + after).unscale((along + after).norm());
        match (self.conditions[piece], self.conditions[next]) {
            (Condition::Value, Condition::Value) if piece == next => Reflection::Odd(tangent),
            (Condition::Closed, Condition::Closed) => Reflection::Even(tangent, None),
            (Condition::Flux, Condition::Flux) if piece == next => {
                Reflection::Even(tangent, Some(piece))
            }
            _ => Reflection::None,
        }
    }

    /// The stencil of vertex `v`; empty if no patch around it fixes the
    /// derivative, which takes a mesh of a few flat triangles.
    pub(crate) fn stencil(&self, v: usize, patch: &mut Patch) -> Stencil {
        let reflection = self.reflection(v);
        let boundary = self.domain.is_boundary(v);
        let tries: &[(usize, usize)] = match self.nodes.elements() {
            Elements::Linear => &[(2, 2), (3, 2), (4, 2)],
            // One-sided patches lean on a second ring.
            _ if boundary && reflection == Reflection::None => &[(2, 4), (3, 4), (2, 3), (2, 2)],
            Elements::Quadratic => &[(1, 4), (2, 4), (2, 3), (2, 2)],
        };
        tries
            .iter()
            .find_map(|&(rings, degree)| {
                self.collect(v, rings, patch);
                self.fit(v, degree, reflection, patch)
            })
            .unwrap_or_default()
    }

    /// Nodes and borders of the triangles within so many rings around `v`.
    fn collect(&self, v: usize, rings: usize, patch: &mut Patch) {
        patch.begin(self.nodes.count(), self.domain.triangles().len());
        let mut front = vec![v as u32];
        for ring in 0..rings {
            let mut reached = Vec::new();
            for &at in &front {
                for &t in self.triangles_at(at as usize) {
                    if !patch.take_triangle(t) {
                        continue;
                    }
                    for &node in self.nodes.of(t as usize) {
                        patch.take_node(node);
                    }
                    reached.extend(self.domain.triangles()[t as usize]);
                }
            }
            if ring + 1 < rings {
                reached.sort_unstable();
                reached.dedup();
                front = reached;
            }
        }
        for &t in &patch.triangles {
            for &entry in &self.domain.inner.mesh.neighbours[t as usize] {
                if entry & crate::domain::BORDER != 0 {
                    patch.borders.push(entry & !crate::domain::BORDER);
                }
            }
        }
    }

    fn fit(&self, v: usize, degree: usize, side: Reflection, patch: &Patch) -> Option<Stencil> {
        let centre = self.nodes.points[v];
        let turn = match side {
            Reflection::None => C::new(1.0, 0.0),
            Reflection::Even(tangent, _) | Reflection::Odd(tangent) => tangent.conj(),
        };
        let offset = |node: u32| {
            let d = self.nodes.points[node as usize] - centre;
            C::new(d.x, d.y) * turn
        };
        let radius = patch
            .nodes
            .iter()
            .fold(0.0_f64, |r, &node| r.max(offset(node).norm()));
        if radius <= 0.0 {
            return None;
        }
        let mut rows: Vec<Vec<f64>> = patch
            .nodes
            .iter()
            .map(|&node| self.columns(offset(node).unscale(radius), degree, side))
            .collect();
        let mut fluxes = Vec::new();
        let with_fluxes = self.nodes.elements() == Elements::Quadratic && side == Reflection::None;
        for &border in patch.borders.iter().filter(|_| with_fluxes) {
            let (piece, along) = self.border(border);
            if self.conditions[piece] == Condition::Value {
                continue;
            }
            let border = self.domain.inner.mesh.borders[border as usize];
            let middle = (offset(border.from) + offset(border.to)).unscale(2.0 * radius);
            let normal = along * C::new(0.0, -1.0);
            rows.push(flux_columns(middle, normal, degree));
            fluxes.push(piece);
        }
        let unknowns = rows.first()?.len();
        if rows.len() < unknowns {
            return None;
        }
        let mut normal = DMatrix::<f64>::zeros(unknowns, unknowns);
        for row in &rows {
            for i in 0..unknowns {
                for j in 0..=i {
                    normal[(i, j)] += row[i] * row[j];
                }
            }
        }
        let least = 1e-8 * rows.len() as f64;
        let factor = normal.cholesky()?;
        // A small pivot means that the nodes lie on the zeros of a polynomial.
        if (0..unknowns).any(|k| factor.l_dirty()[(k, k)].powi(2) < least) {
            return None;
        }
        let (unit, scales) = self.wanted(unknowns, radius, side);
        let solved = factor.solve(&unit);
        let weight = |row: &[f64]| {
            let sum = |column: usize| -> f64 {
                row.iter()
                    .enumerate()
                    .map(|(k, value)| value * solved[(k, column)])
                    .sum()
            };
            scales[0] * sum(0) + scales[1] * sum(1)
        };
        let mut stencil = Stencil::default();
        for (&node, row) in patch.nodes.iter().zip(&rows) {
            stencil.nodes.push((node, weight(row)));
        }
        match side {
            Reflection::Even(_, Some(piece)) => {
                // The values less those of the flux times the distance
                // outward, which is to the right of the border.
                let total = stencil
                    .nodes
                    .iter()
                    .fold(V2::zeros(), |sum, &(node, w)| sum + w * offset(node).im);
                stencil.fluxes.push((piece as u32, total));
            }
            _ => {
                for (piece, row) in fluxes.into_iter().zip(&rows[patch.nodes.len()..]) {
                    // Flux in units of the scaled patch.
                    if self.conditions[piece] == Condition::Flux {
                        stencil.fluxes.push((piece as u32, weight(row) * radius));
                    }
                }
            }
        }
        Some(stencil)
    }

    /// The columns of the fit at the scaled place `w`.
    fn columns(&self, w: C, degree: usize, side: Reflection) -> Vec<f64> {
        if self.nodes.elements() == Elements::Linear {
            return vec![1.0, w.re, w.im, w.re * w.re, w.im * w.im, w.re * w.im];
        }
        let mut columns = vec![1.0];
        let mut power = C::new(1.0, 0.0);
        for _ in 0..degree {
            power *= w;
            if !matches!(side, Reflection::Odd(_)) {
                columns.push(power.re);
            }
            if !matches!(side, Reflection::Even(..)) {
                columns.push(power.im);
            }
        }
        columns
    }

    /// The sums of unknowns that the result is made of, one a column, and the
    /// vectors that they are multiplied with.
    fn wanted(&self, unknowns: usize, radius: f64, side: Reflection) -> (DMatrix<f64>, [V2; 2]) {
        let mut unit = DMatrix::zeros(unknowns, 2);
        let order = match self.derivative {
            Derivative::Gradient => 1,
            Derivative::Hessian => 2,
        };
        let scale = radius.powi(-order);
        if self.nodes.elements() == Elements::Linear {
            let [x, y] = [V2::new(scale, 0.0), V2::new(0.0, scale)];
            match self.derivative {
                Derivative::Gradient => (unit[(1, 0)], unit[(2, 1)]) = (1.0, 1.0),
                // Of 1, x, y, x^2, y^2, x y.
                Derivative::Hessian => {
                    (unit[(3, 0)], unit[(4, 0)], unit[(5, 1)]) = (1.0, -1.0, 1.0);
                }
            }
            return (unit, [x, y]);
        }
        // z = Re((p - i q) w^k): its k-th derivative as a vector is (p, q)
        // times k! over radius^k, turned back by k times the tangent.
        let (back, places) = match side {
            Reflection::None => (C::new(1.0, 0.0), [2 * order - 1, 2 * order].map(Some)),
            Reflection::Even(tangent, _) => (tangent.powi(order), [Some(order), None]),
            Reflection::Odd(tangent) => (tangent.powi(order), [None, Some(order)]),
        };
        for (column, place) in places.into_iter().enumerate() {
            if let Some(place) = place {
                unit[(place as usize, column)] = 1.0;
            }
        }
        let factorial = f64::from(order);
        let p = V2::new(back.re, back.im) * (factorial * scale);
        (unit, [p, left(p)])
    }
}

/// The flux through `normal` of each column at the scaled place `w`.
fn flux_columns(w: C, normal: C, degree: usize) -> Vec<f64> {
    let mut columns = vec![0.0];
    let mut slope = normal;
    for k in 1..=degree {
        // d/dn of w^k = k w^(k-1) n.
        let value = slope * k as f64;
        columns.extend([value.re, value.im]);
        slope *= w;
    }
    columns
}

/// The nodes, triangles and borders around a vertex; reused from one to the
/// next.
#[derive(Default)]
pub(crate) struct Patch {
    nodes: Vec<u32>,
    triangles: Vec<u32>,
    borders: Vec<u32>,
    stamp: u32,
    node_stamps: Vec<u32>,
    triangle_stamps: Vec<u32>,
}

impl Patch {
    fn begin(&mut self, nodes: usize, triangles: usize) {
        self.nodes.clear();
        self.triangles.clear();
        self.borders.clear();
        self.node_stamps.resize(nodes, 0);
        self.triangle_stamps.resize(triangles, 0);
        self.stamp += 1;
    }

    /// Whether the triangle is new.
    fn take_triangle(&mut self, triangle: u32) -> bool {
        let fresh = self.triangle_stamps[triangle as usize] != self.stamp;
        if fresh {
            self.triangle_stamps[triangle as usize] = self.stamp;
            self.triangles.push(triangle);
        }
        fresh
    }

    fn take_node(&mut self, node: u32) {
        if self.node_stamps[node as usize] != self.stamp {
            self.node_stamps[node as usize] = self.stamp;
            self.nodes.push(node);
        }
    }
}
