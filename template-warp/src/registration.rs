//! Registration of a face within its deformation class, in closed form.
//!
//! Paper, section 4.1, equation 1: minimise the (weighted) sum of
//! |alpha(p_i) - p_i*|^2 over the maps alpha of a class. Every class here keeps
//! orientation; barycentre goes to barycentre in all of them, so what is left is
//! a 2x2 matrix.

use crate::geometry::{dot, exceeds, norm, p, P};
use nalgebra::Matrix2;

mod principal;

pub use principal::PrincipalAffine;

/// An affine map of the plane: x -> `linear` x + `translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// The 2x2 matrix, by rows.
    pub linear: [[f64; 2]; 2],
    /// What is added afterwards, metres.
    pub translation: P,
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        linear: [[1.0, 0.0], [0.0, 1.0]],
        translation: P { x: 0.0, y: 0.0 },
    };

    /// Image of a point.
    #[must_use]
    pub fn apply(&self, q: P) -> P {
        let [[a, b], [c, d]] = self.linear;
        p(a * q.x + b * q.y, c * q.x + d * q.y) + self.translation
    }

    /// Area scale: the determinant of the matrix.
    #[must_use]
    pub fn determinant(&self) -> f64 {
        let [[a, b], [c, d]] = self.linear;
        a * d - b * c
    }

    /// Weighted sum of squared distances from the images of `from` to `to`
    /// (square metres): the paper's equation 1 with weights.
    #[must_use]
    pub fn residual(&self, from: &[P], to: &[P], weights: &[f64]) -> f64 {
        let mut sum = 0.0;
        for ((&a, &b), &w) in from.iter().zip(to).zip(weights) {
            let r = self.apply(a) - b;
            sum += w * dot(r, r);
        }
        sum
    }
}

/// A class of maps within which a face may deform.
///
/// # Duties of an implementor
///
/// Return the map of the class with the least [`Affine::residual`], or one near
/// it; never a map outside the class; for degenerate input (no points, all in
/// one place) some map of the class that takes barycentre to barycentre. The
/// warp keeps a face's last map where a new one is worse, so an approximate
/// minimiser cannot raise its energy.
pub trait Deformation: std::fmt::Debug + Send + Sync {
    /// Registers the points `from` to the points `to` (same length) with
    /// positive `weights`.
    fn register(&self, from: &[P], to: &[P], weights: &[f64]) -> Affine;
}

/// Rotation and translation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rigid;

/// Rotation, translation and one scale within a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// Least scale, positive.
    pub min_scale: f64,
    /// Greatest scale.
    pub max_scale: f64,
}

/// Any affine map whose area scale lies in [1 / `max_area_ratio`,
/// `max_area_ratio`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaAffine {
    /// Greatest area scale, and the inverse of the least; at least 1.
    pub max_area_ratio: f64,
}

/// Barycentres and second moments of a weighted point correspondence.
struct Moments {
    from: P,
    to: P,
    /// Sum of w x_from (x_to, y_to) and of w y_from (x_to, y_to), centred.
    mx: P,
    my: P,
    sxx: f64,
    sxy: f64,
    syy: f64,
}

impl Moments {
    fn new(from: &[P], to: &[P], weights: &[f64]) -> Self {
        let (mut a, mut b, mut sum) = (p(0.0, 0.0), p(0.0, 0.0), 0.0);
        for ((&f, &t), &w) in from.iter().zip(to).zip(weights) {
            a = a + f * w;
            b = b + t * w;
            sum += w;
        }
        if sum > 0.0 {
            a = a / sum;
            b = b / sum;
        }
        let mut m = Self {
            from: a,
            to: b,
            mx: p(0.0, 0.0),
            my: p(0.0, 0.0),
            sxx: 0.0,
            sxy: 0.0,
            syy: 0.0,
        };
        for ((&f, &t), &w) in from.iter().zip(to).zip(weights) {
            let (f, t) = (f - a, t - b);
            m.mx = m.mx + t * (w * f.x);
            m.my = m.my + t * (w * f.y);
            m.sxx += w * f.x * f.x;
            m.sxy += w * f.x * f.y;
            m.syy += w * f.y * f.y;
        }
        m
    }

    /// Cosine and sine parts of the best rotation, as one complex number whose
    /// length is the un-normalised scale.
    fn complex(&self) -> P {
        p(self.mx.x + self.my.y, self.mx.y - self.my.x)
    }

    fn map(&self, linear: [[f64; 2]; 2]) -> Affine {
        let [[a, b], [c, d]] = linear;
        let f = self.from;
        Affine {
            linear,
            translation: self.to - p(a * f.x + b * f.y, c * f.x + d * f.y),
        }
    }

    fn scaled_rotation(&self, scale: f64) -> Affine {
        let z = self.complex();
        let l = norm(z);
        let (c, s) = if l > 0.0 {
            (z.x / l, z.y / l)
        } else {
            (1.0, 0.0)
        };
        self.map([[scale * c, -scale * s], [scale * s, scale * c]])
    }
}

impl Deformation for Rigid {
    fn register(&self, from: &[P], to: &[P], weights: &[f64]) -> Affine {
        Moments::new(from, to, weights).scaled_rotation(1.0)
    }
}

impl Deformation for Similarity {
    fn register(&self, from: &[P], to: &[P], weights: &[f64]) -> Affine {
        let m = Moments::new(from, to, weights);
        let spread = m.sxx + m.syy;
        // The residual is a parabola in the scale for the best rotation, which
        // does not depend on the scale: clamping is exact.
        let free = if spread > 0.0 {
            norm(m.complex()) / spread
        } else {
            1.0
        };
        m.scaled_rotation(clamp(free, [self.min_scale, self.max_scale]))
    }
}

impl Deformation for AreaAffine {
    /// The unconstrained minimiser if its area scale is allowed. Otherwise the
    /// bound is active: with the moments whitened away the problem is to find
    /// the nearest matrix of given determinant, which shares singular vectors
    /// with the unconstrained one and whose singular values x, y = d / x solve
    /// the quartic x^4 - s1 x^3 + s2 d x - d^2 = 0.
    fn register(&self, from: &[P], to: &[P], weights: &[f64]) -> Affine {
        let m = Moments::new(from, to, weights);
        let det_s = m.sxx * m.syy - m.sxy * m.sxy;
        let spread = m.sxx + m.syy;
        let ratio = self.max_area_ratio.max(1.0);
        if !exceeds(det_s, 1e-14 * spread * spread) {
            // All points on a line: no area to bound; stay a similarity.
            let s = ratio.sqrt();
            return Similarity {
                min_scale: 1.0 / s,
                max_scale: s,
            }
            .register(from, to, weights);
        }
        let moments = Matrix2::new(m.sxx, m.sxy, m.sxy, m.syy);
        let mixed = Matrix2::new(m.mx.x, m.my.x, m.mx.y, m.my.y);
        let inverse = Matrix2::new(m.syy, -m.sxy, -m.sxy, m.sxx) / det_s;
        let free = mixed * inverse;
        let det = free.determinant();
        let bound = det.clamp(1.0 / ratio, ratio);
        if det == bound {
            return m.map([[free.m11, free.m12], [free.m21, free.m22]]);
        }
        // Square root of a 2x2 positive matrix: (S + sqrt(det) I) / sqrt(trace + 2 sqrt(det)).
        let q = det_s.sqrt();
        let root = (moments + Matrix2::identity() * q) / (spread + 2.0 * q).sqrt();
        let root_inverse = root.try_inverse().unwrap_or_else(Matrix2::identity);
        let (u, s1, s2, vt) = signed_svd(&(free * root));
        let x = nearest_hyperbola_point(s1, s2, bound * q);
        let middle = Matrix2::new(x, 0.0, 0.0, bound * q / x);
        let a = u * middle * vt * root_inverse;
        m.map([[a.m11, a.m12], [a.m21, a.m22]])
    }
}

fn clamp(value: f64, [lo, hi]: [f64; 2]) -> f64 {
    value.max(lo).min(hi.max(lo))
}

/// Singular values with rotations on both sides: s1 >= |s2|, s2 carrying the
/// sign of the determinant.
fn signed_svd(b: &Matrix2<f64>) -> (Matrix2<f64>, f64, f64, Matrix2<f64>) {
    // b = scaled rotation (e, h) + scaled reflection (f, g), Blinn 1996.
    let (e, f) = ((b.m11 + b.m22) / 2.0, (b.m11 - b.m22) / 2.0);
    let (g, h) = ((b.m21 + b.m12) / 2.0, (b.m21 - b.m12) / 2.0);
    let (q, r) = (e.hypot(h), f.hypot(g));
    let (a1, a2) = (g.atan2(f), h.atan2(e));
    let (phi, theta) = ((a2 + a1) / 2.0, (a2 - a1) / 2.0);
    let turn = |t: f64| Matrix2::new(t.cos(), -t.sin(), t.sin(), t.cos());
    (turn(phi), q + r, q - r, turn(theta))
}

/// The x > 0 for which (x, d / x) is nearest to (s1, s2), d > 0.
fn nearest_hyperbola_point(s1: f64, s2: f64, d: f64) -> f64 {
    let scale = d.sqrt();
    let (a, b) = (s1 / scale, s2 / scale);
    // In units of sqrt(d): minimise (x - a)^2 + (1 / x - b)^2. With a >= |b| the
    // best point has x >= 1 / x, so it lies in [1, a + 1 + |b|].
    let cost = |x: f64| (x - a).powi(2) + (1.0 / x - b).powi(2);
    let slope = |x: f64| x.powi(4) - a * x.powi(3) + b * x - 1.0;
    let top = a.max(1.0) + 1.0 + b.abs();
    let mut best = (cost(1.0), 1.0);
    let steps = 32;
    let mut x0 = 1.0;
    for i in 1..=steps {
        let x1 = 1.0 + (top - 1.0) * f64::from(i) / f64::from(steps);
        if slope(x0) <= 0.0 && slope(x1) >= 0.0 {
            let (mut lo, mut hi) = (x0, x1);
            for _ in 0..80 {
                let mid = 0.5 * (lo + hi);
                if slope(mid) > 0.0 {
                    hi = mid;
                } else {
                    lo = mid;
                }
            }
            let root = 0.5 * (lo + hi);
            if cost(root) < best.0 {
                best = (cost(root), root);
            }
        }
        x0 = x1;
    }
    best.1 * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    const W: [f64; 4] = [1.0; 4];

    fn square() -> Vec<P> {
        vec![p(0., 0.), p(2., 0.), p(2., 1.), p(0., 1.)]
    }

    fn mapped(a: &Affine) -> Vec<P> {
        square().iter().map(|&q| a.apply(q)).collect()
    }

    #[test]
    fn each_class_finds_a_map_of_its_own_exactly() {
        let (s, c) = 0.7f64.sin_cos();
        let rigid = Affine {
            linear: [[c, -s], [s, c]],
            translation: p(5e5, -3.0),
        };
        let principal = Affine {
            linear: [[1.2 * c, -0.8 * s], [1.2 * s, 0.8 * c]],
            translation: p(1.0, 2.0),
        };
        let classes: [(&dyn Deformation, &Affine); 4] = [
            (&Rigid, &rigid),
            (
                &Similarity {
                    min_scale: 0.5,
                    max_scale: 2.0,
                },
                &rigid,
            ),
            (
                &PrincipalAffine {
                    x: [0.5, 2.0],
                    y: [0.5, 2.0],
                },
                &principal,
            ),
            (
                &AreaAffine {
                    max_area_ratio: 1.1,
                },
                &principal,
            ),
        ];
        for (class, map) in classes {
            let found = class.register(&square(), &mapped(map), &W);
            assert!(
                found.residual(&square(), &mapped(map), &W) < 1e-12,
                "{class:?} {found:?}"
            );
        }
    }

    #[test]
    fn bounds_hold() {
        let big = Affine {
            linear: [[3.0, 0.0], [0.0, 3.0]],
            translation: p(0.0, 0.0),
        };
        let similar = Similarity {
            min_scale: 0.9,
            max_scale: 1.1,
        }
        .register(&square(), &mapped(&big), &W);
        assert!((similar.determinant().sqrt() - 1.1).abs() < 1e-12);
        let area = AreaAffine {
            max_area_ratio: 2.0,
        }
        .register(&square(), &mapped(&big), &W);
        assert!(
            (area.determinant() - 2.0).abs() < 1e-9,
            "{}",
            area.determinant()
        );
        let mirror = Affine {
            linear: [[-1.0, 0.0], [0.0, 1.0]],
            translation: p(0.0, 0.0),
        };
        let area = AreaAffine {
            max_area_ratio: 2.0,
        }
        .register(&square(), &mapped(&mirror), &W);
        assert!(
            (area.determinant() - 0.5).abs() < 1e-9,
            "{}",
            area.determinant()
        );
    }

    #[test]
    fn degenerate_input_gives_a_finite_map() {
        let classes: [&dyn Deformation; 4] = [
            &Rigid,
            &Similarity {
                min_scale: 0.5,
                max_scale: 2.0,
            },
            &PrincipalAffine {
                x: [0.5, 2.0],
                y: [0.5, 2.0],
            },
            &AreaAffine {
                max_area_ratio: 1.1,
            },
        ];
        let one = [p(1.0, 1.0); 4];
        let line = [p(0., 0.), p(1., 0.), p(2., 0.), p(3., 0.)];
        for class in classes {
            for (from, to) in [
                (&[][..], &[][..]),
                (&one[..], &square()[..]),
                (&square()[..], &one[..]),
                (&line[..], &square()[..]),
            ] {
                let map = class.register(from, to, &W[..from.len()]);
                assert!(
                    map.linear.iter().flatten().all(|v| v.is_finite()),
                    "{class:?}"
                );
                assert!(map.determinant() > 0.0, "{class:?} {map:?}");
            }
        }
    }
}
