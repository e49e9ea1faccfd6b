//! How far combinations of a family leave the bent parts of the boundary, as
//! a smooth function of the coefficients.
//!
//! Where the boundary is straight, H-fields follow it by construction. Where
//! it bends, a constant flux does not suffice (the curvature times the
//! tangential slope is missing in equation 1 of the supplement), and low
//! divergence alone would rather ignore the boundary than follow it. So the
//! search is charged for sin^2 of twice the angle between arm and boundary,
//! `Im(F t^2)^2 / |F|^2` with the unit tangent t, averaged over the whole
//! boundary: between 0 and 1.

use nalgebra::DMatrix;

use super::family::{Family, C};

/// The misfit at the borders of bent pieces.
pub(crate) struct Misfit {
    /// Share of each border in the boundary, times the charge.
    weights: Vec<f64>,
    /// i conj(t)^2.
    normals: Vec<C>,
    /// Real and imaginary parts of F for each member of the search space, as
    /// in the objective.
    parts: [Vec<f64>; 2],
}

impl Misfit {
    /// Of the family's charged borders, with F in units of `unit`.
    pub(crate) fn new(family: &Family, unit: f64) -> Self {
        let inner = &*family.domain.inner;
        let count = family.charged.len();
        let dimension = family.dimension();
        let perimeter: f64 = inner.rings.iter().map(|ring| ring.perimeter()).sum();
        let mut misfit = Self {
            weights: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            parts: [0, 1].map(|_| vec![0.0; count * dimension]),
        };
        for (s, &border) in family.charged.iter().enumerate() {
            let border = inner.mesh.borders[border as usize];
            let [a, b] = [border.from, border.to].map(|v| inner.mesh.points[v as usize]);
            let along = inner.rings[border.ring as usize].direction(border.edge as usize);
            let back = C::new(along.x, -along.y);
            misfit
                .weights
                .push(family.charge * (b - a).norm() / perimeter);
            misfit.normals.push(C::new(0.0, 1.0) * back * back);
            for j in 0..dimension {
                let mut sum = C::new(0.0, 0.0);
                for i in 0..family.count {
                    let at = |v: u32| family.columns[v as usize * family.count + i];
                    let root = at(border.from) + at(border.to);
                    sum += C::new(root.x, -root.y) * (family.space[(i, j)] / 2.0 / unit);
                }
                misfit.parts[0][j * count + s] = sum.re;
                misfit.parts[1][j * count + s] = sum.im;
            }
        }
        misfit
    }

    /// The charge times |F|^2, for |F| of even size, as a quadratic form.
    pub(crate) fn form(&self, dimension: usize) -> DMatrix<f64> {
        let count = self.weights.len();
        let off = DMatrix::from_fn(count, dimension, |s, j| {
            let f = C::new(self.parts[0][j * count + s], self.parts[1][j * count + s]);
            (self.normals[s].conj() * f).re * self.weights[s].sqrt()
        });
        off.tr_mul(&off)
    }

    /// The charge for a combination; its slope is added to `gradient`.
    pub(crate) fn add(&self, y: &[f64], gradient: &mut [f64]) -> f64 {
        let count = self.weights.len();
        let mut total = 0.0;
        for s in 0..count {
            let mut f = C::new(0.0, 0.0);
            for (j, y) in y.iter().enumerate() {
                f += C::new(self.parts[0][j * count + s], self.parts[1][j * count + s]) * *y;
            }
            let x = f.norm_sqr();
            if !x.is_normal() {
                continue;
            }
            // Im(F t^2) = Re(conj(n) F).
            let off = (self.normals[s].conj() * f).re;
            let value = self.weights[s] * off * off / x;
            total += value;
            let slope = self.normals[s] * (2.0 * self.weights[s] * off / x) - f * (2.0 * value / x);
            for (j, g) in gradient.iter_mut().enumerate() {
                *g += slope.re * self.parts[0][j * count + s]
                    + slope.im * self.parts[1][j * count + s];
            }
        }
        total
    }
}
