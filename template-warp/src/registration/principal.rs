//! Affine maps of bounded principal distortion, registered to the global minimum.
//!
//! With a rotation u and scales (s, t) the residual, less its constant part, is
//! s^2 Sxx + t^2 Syy - 2 u . (s v + t w), where v and w come from the moments.
//! The best rotation for given scales turns u along s v + t w, which leaves
//!
//! F(s, t) = s^2 Sxx + t^2 Syy - 2 |s v + t w|
//!
//! on a rectangle of scales. F can have several local minima there, so a descent
//! from one rotation may end above the best (the paper's two steps end up to 3 %
//! above). All its minima are found instead: those inside in closed form, those on
//! the four sides as roots of a monotone equation, the four corners as they are.

use super::{clamp, Affine, Deformation, Moments};
use crate::geometry::{dot, norm, p, P};

/// Scales along the axes of the template's own frame, each within its range,
/// then a rotation: rectangles stay rectangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalAffine {
    /// Range of the scale along x.
    pub x: [f64; 2],
    /// Range of the scale along y.
    pub y: [f64; 2],
}

impl Deformation for PrincipalAffine {
    fn register(&self, from: &[P], to: &[P], weights: &[f64]) -> Affine {
        let m = Moments::new(from, to, weights);
        let fit = ScaleFit {
            x: Axis {
                spread: m.sxx,
                pull: m.mx,
                range: ordered(self.x),
            },
            y: Axis {
                spread: m.syy,
                // A rotation turns the second axis a quarter ahead of the first.
                pull: p(m.my.y, -m.my.x),
                range: ordered(self.y),
            },
        };
        let (sx, sy) = fit.minimum();
        let u = fit.x.pull * sx + fit.y.pull * sy;
        let l = norm(u);
        let (c, s) = if l > 0.0 {
            (u.x / l, u.y / l)
        } else {
            (1.0, 0.0)
        };
        m.map([[sx * c, -sy * s], [sx * s, sy * c]])
    }
}

/// One axis of the template's frame: how far its points spread along it, where
/// the registration pulls it (length is spread times wanted scale), and the range
/// of its scale.
#[derive(Clone, Copy)]
struct Axis {
    spread: f64,
    pull: P,
    range: [f64; 2],
}

/// F of the module's page.
struct ScaleFit {
    x: Axis,
    y: Axis,
}

impl ScaleFit {
    fn cost(&self, sx: f64, sy: f64) -> f64 {
        sx * sx * self.x.spread + sy * sy * self.y.spread
            - 2.0 * norm(self.x.pull * sx + self.y.pull * sy)
    }

    /// The scales of least cost.
    fn minimum(&self) -> (f64, f64) {
        let mut best = (
            self.x.nearest_to_one(),
            self.y.nearest_to_one(),
            f64::INFINITY,
        );
        best.2 = self.cost(best.0, best.1);
        let mut offer = |sx: f64, sy: f64| {
            let cost = self.cost(sx, sy);
            if cost < best.2 {
                best = (sx, sy, cost);
            }
        };
        if let Some((sx, sy)) = self.inside() {
            offer(sx, sy);
        }
        for sy in self.y.range {
            for sx in self.x.minima(self.y.pull * sy) {
                offer(sx, sy);
            }
        }
        for sx in self.x.range {
            for sy in self.y.minima(self.x.pull * sx) {
                offer(sx, sy);
            }
        }
        (best.0, best.1)
    }

    /// The minimum over all scales where it lies within the rectangle. As a
    /// function of the rotation u it is the least -(u.v)^2 / Sxx - (u.w)^2 / Syy:
    /// the first principal axis of two vectors.
    fn inside(&self) -> Option<(f64, f64)> {
        if self.x.spread <= 0.0 || self.y.spread <= 0.0 {
            return None;
        }
        let (v, w) = (
            self.x.pull / self.x.spread.sqrt(),
            self.y.pull / self.y.spread.sqrt(),
        );
        let twice =
            (2.0 * (v.x * v.y + w.x * w.y)).atan2(v.x * v.x + w.x * w.x - v.y * v.y - w.y * w.y);
        let (s, c) = (0.5 * twice).sin_cos();
        let (sx, sy) = (
            dot(p(c, s), self.x.pull) / self.x.spread,
            dot(p(c, s), self.y.pull) / self.y.spread,
        );
        // The opposite rotation changes both signs.
        [(sx, sy), (-sx, -sy)]
            .into_iter()
            .find(|&(sx, sy)| self.x.allows(sx) && self.y.allows(sy))
    }
}

impl Axis {
    fn allows(&self, scale: f64) -> bool {
        scale >= self.range[0] && scale <= self.range[1]
    }

    fn nearest_to_one(&self) -> f64 {
        clamp(1.0, self.range)
    }

    /// Where s^2 `spread` - 2 |s `pull` + `other`| can be least on the range.
    ///
    /// Half its slope is spread s - N'(s) with the norm's slope N', a sigmoid that
    /// is convex up to `turn`, where the vector is shortest, and concave after. So
    /// beyond `turn` half the slope is convex, and before it concave: on each side
    /// at most one minimum, on which Newton's steps from the far end close in
    /// without passing it.
    fn minima(&self, other: P) -> [f64; 4] {
        let [lo, hi] = self.range;
        let length_sq = dot(self.pull, self.pull);
        let turn = if length_sq > 0.0 {
            -dot(self.pull, other) / length_sq
        } else {
            lo
        };
        let root = |start: f64, sign: f64| {
            let mut s = start;
            for _ in 0..60 {
                let at = self.pull * s + other;
                let n = norm(at);
                if n <= 0.0 {
                    break;
                }
                let along = dot(self.pull, at) / n;
                let half_slope = self.spread * s - along;
                let bend = self.spread - (length_sq - along * along).max(0.0) / n;
                // Past the minimum already, or so flat that none lies ahead.
                if sign * half_slope <= 0.0 || bend <= 0.0 {
                    break;
                }
                let next = clamp(s - half_slope / bend, self.range);
                if next == s || sign * (s - next) <= 1e-15 * s.abs() {
                    break;
                }
                s = next;
            }
            s
        };
        let right = if turn < hi { root(hi, 1.0) } else { hi };
        let left = if turn > lo { root(lo, -1.0) } else { lo };
        [lo, left, right, hi]
    }
}

/// A range whose ends are given in the wrong order holds its lower end alone, as
/// in [`clamp`].
fn ordered([lo, hi]: [f64; 2]) -> [f64; 2] {
    [lo, hi.max(lo)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A case whose residual has two minima in the rotation: a descent from the
    /// nearest of eight directions ended in the worse one.
    #[test]
    fn regression_the_better_of_two_minima_is_found() {
        let from = [
            p(16.8538037660289, 12.805132108005226),
            p(-25.57664864855506, -12.021686449181551),
            p(0.0, 0.0),
            p(22.2208373309341, -27.896719252430554),
            p(6.973787251239357, 0.0),
            p(-17.94533963944366, -15.480379985821894),
        ];
        let to = [
            p(-23.859916125353273, 31.59745357192682),
            p(45.929796322390246, -41.91845747762249),
            p(7.0, -3.0),
            p(14.059875933302173, -39.472905074106855),
            p(-0.11961161865445646, 1.6027802747284134),
            p(41.82680567021794, -43.222014736579084),
        ];
        let w = [
            4.2436297134812495,
            3.274208243221806,
            0.2,
            3.6270952114394124,
            0.2,
            2.065533208080038,
        ];
        let (x, y, range) = (0.7237500675858756, 0.5, 1.5883915420282853);
        let class = PrincipalAffine {
            x: [x, x * range],
            y: [y, y * range],
        };
        let best = class.register(&from, &to, &w).residual(&from, &to, &w);
        let m = Moments::new(&from, &to, &w);
        for i in 0..3600 {
            let (s, c) = (f64::from(i) / 1800.0 * std::f64::consts::PI).sin_cos();
            for j in 0..=20 {
                for k in 0..=20 {
                    let at = |lo: f64, i: i32| lo * (1.0 + (range - 1.0) * f64::from(i) / 20.0);
                    let (sx, sy) = (at(x, j), at(y, k));
                    let other = m.map([[sx * c, -sy * s], [sx * s, sy * c]]);
                    assert!(best <= other.residual(&from, &to, &w) + 1e-9);
                }
            }
        }
    }

    /// Along one side the cost may have a minimum on either side of its turn.
    #[test]
    fn both_minima_of_a_side_are_listed() {
        // s^2 - 2 |4 s - 4 + small|: minima near s = 4 and s = -4.
        let axis = Axis {
            spread: 1.0,
            pull: p(4.0, 0.0),
            range: [-6.0, 6.0],
        };
        let [_, left, right, _] = axis.minima(p(-4.0, 1e-3));
        assert!(
            (left + 4.0).abs() < 1e-6 && (right - 4.0).abs() < 1e-6,
            "{left} {right}"
        );
    }
}
