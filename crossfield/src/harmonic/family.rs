//! A linear family of holomorphic functions whose arguments are cross fields.
//!
//! With F = f' = z_xx - i z_xy for H-fields, or F = f = z_x - i z_y for
//! gradient-aligned ones, F is holomorphic and linear in the coefficients, and
//! an arm of the cross lies at u = -arg F / p, p = 2 or 1. What is stored at
//! the vertices is the conjugate of F as a vector: the paper's tensor
//! (a, b) = ((z_xx - z_yy) / 2, z_xy), or the gradient.

use nalgebra::{Complex, DMatrix};

use super::discs::Discs;
use crate::domain::Domain;
use crate::field::Field;
use crate::operators::gradient;
use crate::plane::{orient, V2};
use crate::FieldError;

pub(crate) type C = Complex<f64>;

/// How a cross is read off the stored vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Trace-free Hessians: u is half the vector's angle.
    Hessian,
    /// Gradients: u is the vector's angle.
    Gradient,
}

impl Kind {
    /// p of the module's documentation.
    pub(crate) fn fold(self) -> i32 {
        match self {
            Self::Hessian => 2,
            Self::Gradient => 1,
        }
    }

    /// The power of the stored unit vector that is D.
    pub(crate) fn power(self) -> u8 {
        match self {
            Self::Hessian => 2,
            Self::Gradient => 4,
        }
    }
}

/// How closely a field follows the boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Alignment {
    /// Mean angle between the boundary and the nearest arm, by length,
    /// radians.
    pub mean: f64,
    /// The largest such angle away from the discs that the energy leaves out,
    /// radians.
    pub max: f64,
    /// Mean of sin^2 of twice the angle, by length: 0 where the field follows
    /// the boundary, 1 where it crosses it at 45 degrees.
    pub misfit: f64,
}

/// A basis of fields, each a vector at every vertex.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    pub(crate) domain: Domain,
    pub(crate) kind: Kind,
    /// Number of members.
    pub(crate) count: usize,
    /// Member `i` at vertex `v` is entry `v * count + i`.
    pub(crate) columns: Vec<V2>,
    /// Orthonormal basis of the coefficients to search, one a column.
    pub(crate) space: DMatrix<f64>,
    /// Radius of the discs that the energy leaves out, metres.
    pub(crate) radius: f64,
    /// Discs on the boundary that it leaves out as well.
    pub(crate) discs: Discs,
    /// Borders where the search charges for leaving the boundary.
    pub(crate) charged: Vec<u32>,
    /// What it charges for a boundary that is left altogether.
    pub(crate) charge: f64,
}

impl Family {
    /// The stored vectors of a linear combination.
    pub(crate) fn combine(&self, coefficients: &[f64]) -> Vec<V2> {
        self.columns
            .chunks_exact(self.count)
            .map(|row| {
                row.iter()
                    .zip(coefficients)
                    .fold(V2::zeros(), |sum, (column, &c)| sum + column * c)
            })
            .collect()
    }

    /// The field of a linear combination.
    pub(crate) fn field(&self, coefficients: &[f64]) -> Result<Field, FieldError> {
        Field::from_roots(&self.domain, self.combine(coefficients), self.kind.power())
    }

    /// Coefficients of the members from those of the search space.
    pub(crate) fn lift(&self, reduced: &[f64]) -> Vec<f64> {
        (0..self.count)
            .map(|i| {
                reduced
                    .iter()
                    .enumerate()
                    .map(|(j, y)| self.space[(i, j)] * y)
                    .sum()
            })
            .collect()
    }

    /// Dimension of the search space.
    pub(crate) fn dimension(&self) -> usize {
        self.space.ncols()
    }

    /// The energies of the two arms of a field of this family: the integral
    /// of div(d1)^2 and of div(d2)^2 outside the discs around singularities
    /// and boundary centres.
    ///
    /// With q = F' / F, div(d1)^2 = (|q|^2 + Re(q^2 e^{2iu})) / (2 p^2); for
    /// the other arm the second term changes its sign.
    pub(crate) fn energies(&self, field: &Field) -> [f64; 2] {
        let inner = &*self.domain.inner;
        let (roots, _) = field.roots();
        let discs = self.discs.with(self.zeros(field), self.radius);
        let fold = self.kind.fold();
        let mut sums = [0.0; 2];
        for triangle in &inner.mesh.triangles {
            let points = triangle.map(|v| inner.mesh.points[v as usize]);
            let values = triangle.map(|v| roots[v as usize]);
            let Some(slope) = holomorphic_slope(points, values) else {
                continue;
            };
            let area = orient(points[0], points[1], points[2]) / 2.0;
            for k in 0..3 {
                // The rule with three points inside is exact for quadratic
                // functions.
                let at = |x: [V2; 3]| (x[0] + x[1] + x[2] + x[k] * 3.0) / 6.0;
                let root = at(values);
                if root == V2::zeros() || discs.contain(at(points)) {
                    continue;
                }
                let q = slope / C::new(root.x, -root.y);
                // e^{2iu} of a unit root e^{ipu}.
                let unit = C::new(root.x, root.y).unscale(root.norm());
                let arm = if fold == 2 { unit } else { unit * unit };
                let (both, apart) = (q.norm_sqr(), (q * q * arm).re);
                let share = area / (6.0 * f64::from(fold * fold));
                sums[0] += share * (both + apart);
                sums[1] += share * (both - apart);
            }
        }
        sums
    }

    /// Where a field of this family is singular, inside and on the boundary.
    ///
    /// On a straight side the field is the real function |F| times a constant
    /// cross, whose zeros may lie on the side itself. Whether the triangle
    /// there counts as singular is then a matter of rounding; a root that
    /// turns over along a border is not.
    fn zeros(&self, field: &Field) -> Vec<V2> {
        let mesh = &self.domain.inner.mesh;
        let (roots, _) = field.roots();
        // Three roots within a half-plane do not turn around.
        let turns = |t: &usize| {
            let [a, b, c] = mesh.triangles[*t].map(|v| roots[v as usize]);
            a.dot(&b) < 0.0 || b.dot(&c) < 0.0 || c.dot(&a) < 0.0
        };
        let mut zeros: Vec<V2> = (0..mesh.triangles.len())
            .filter(|t| turns(t) && field.triangle_index(*t) != 0)
            .map(|t| field.zero(t))
            .collect();
        for border in &mesh.borders {
            let ends = [border.from as usize, border.to as usize];
            let [r, s] = ends.map(|v| roots[v]);
            if r.dot(&s) < 0.0 {
                // The point of the border at which the root is shortest.
                let t = r.dot(&(r - s)) / (r - s).norm_squared();
                let [a, b] = ends.map(|v| mesh.points[v]);
                zeros.push(a + (b - a) * t);
            }
        }
        zeros
    }

    /// How a field of this family follows the boundary.
    pub(crate) fn alignment(&self, field: &Field) -> Alignment {
        let inner = &*self.domain.inner;
        let (roots, power) = field.roots();
        let (mut sum, mut squares, mut length, mut max) = (0.0, 0.0, 0.0, 0.0_f64);
        for border in &inner.mesh.borders {
            let ends = [border.from as usize, border.to as usize];
            let [a, b] = ends.map(|v| inner.mesh.points[v]);
            let root = roots[ends[0]] + roots[ends[1]];
            let along = inner.rings[border.ring as usize].direction(border.edge as usize);
            // Both as four times their angle.
            let phase = f64::from(power) * root.y.atan2(root.x) - 4.0 * along.y.atan2(along.x);
            let off = phase.sin().atan2(phase.cos()).abs() / 4.0;
            sum += off * (b - a).norm();
            squares += (2.0 * off).sin().powi(2) * (b - a).norm();
            length += (b - a).norm();
            if !self.discs.contain((a + b) / 2.0) {
                max = max.max(off);
            }
        }
        Alignment {
            mean: sum / length,
            max,
            misfit: squares / length,
        }
    }
}

/// F' in a triangle from the conjugates of F at its corners; `None` for a
/// triangle without area.
///
/// dF/dw = (F_x - i F_y) / 2, the part of the slope that is holomorphic: it
/// takes half of what interpolation has added.
pub(crate) fn holomorphic_slope(points: [V2; 3], values: [V2; 3]) -> Option<C> {
    let a = gradient(points, values.map(|v| v.x))?;
    let b = gradient(points, values.map(|v| v.y))?;
    Some(C::new((a.x - b.y) / 2.0, -(b.x + a.y) / 2.0))
}

/// An orthonormal basis of the vectors of dimension `count` orthogonal to
/// all of `constraints`.
///
/// The unit vectors are projected and taken up by the size of what is left of
/// them. A complement that depends on the constraints' span alone.
pub(crate) fn complement(count: usize, constraints: &[Vec<f64>]) -> DMatrix<f64> {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let deflate = |v: &mut [f64], by: &[f64]| {
        let along = dot(v, by);
        v.iter_mut().zip(by).for_each(|(x, y)| *x -= along * y);
    };
    let normalise = |v: &mut [f64]| {
        let norm = dot(v, v).sqrt();
        v.iter_mut().for_each(|x| *x /= norm);
    };
    let mut normals: Vec<Vec<f64>> = Vec::new();
    for constraint in constraints {
        let mut v = constraint.clone();
        let size = dot(&v, &v).sqrt();
        // Twice, so that rounding leaves them orthogonal.
        for _ in 0..2 {
            normals.iter().for_each(|normal| deflate(&mut v, normal));
        }
        if dot(&v, &v).sqrt() > 1e-9 * size {
            normalise(&mut v);
            normals.push(v);
        }
    }
    let mut rest: Vec<Vec<f64>> = (0..count)
        .map(|i| {
            let mut v = vec![0.0; count];
            v[i] = 1.0;
            normals.iter().for_each(|normal| deflate(&mut v, normal));
            v
        })
        .collect();
    let dimension = count.saturating_sub(normals.len());
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(dimension);
    for _ in 0..dimension {
        let largest = (0..count).fold(0, |best, i| {
            if dot(&rest[i], &rest[i]) > dot(&rest[best], &rest[best]) {
                i
            } else {
                best
            }
        });
        let mut v = rest[largest].clone();
        for _ in 0..2 {
            normals.iter().for_each(|normal| deflate(&mut v, normal));
            basis.iter().for_each(|other| deflate(&mut v, other));
        }
        normalise(&mut v);
        rest.iter_mut().for_each(|other| deflate(other, &v));
        basis.push(v);
    }
    DMatrix::from_fn(count, dimension, |i, j| basis[j][i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_complement_is_orthonormal_and_orthogonal() {
        let constraints = [
            vec![3.0, 1.0, 2.0, 5.0, 1.0],
            vec![0.0, 1.0, 0.0, -1.0, 0.0],
            // Depends on the two before.
            vec![3.0, 2.0, 2.0, 4.0, 1.0],
        ];
        let basis = complement(5, &constraints);
        assert_eq!(basis.ncols(), 3);
        assert!((basis.transpose() * &basis - DMatrix::identity(3, 3)).norm() < 1e-12);
        for constraint in constraints {
            let row = DMatrix::from_row_slice(1, 5, &constraint);
            assert!((row * &basis).norm() < 1e-12);
        }
        assert_eq!(complement(2, &[vec![1.0, 0.0], vec![1.0, 1.0]]).ncols(), 0);
    }

    #[test]
    fn the_slope_of_a_linear_function_is_exact() {
        // F = (2 - i) w + 1, stored as its conjugate.
        let points = [V2::new(0.3, 0.1), V2::new(1.0, 0.2), V2::new(0.4, 0.9)];
        let values = points.map(|p| {
            let f = C::new(2.0, -1.0) * C::new(p.x, p.y) + 1.0;
            V2::new(f.re, -f.im)
        });
        let slope = holomorphic_slope(points, values).expect("area");
        assert!((slope - C::new(2.0, -1.0)).norm() < 1e-12);
        assert!(holomorphic_slope([points[0]; 3], values).is_none());
    }
}
