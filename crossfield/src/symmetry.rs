//! Directions with any of the usual symmetries, and what represents them.
//!
//! A field of N-fold directions has at every point N unit arms, a N-th of a
//! turn apart. With one arm at angle `u`, its representation vector is
//! `D = (cos Nu, sin Nu)`, the same for all arms (Palacios and Zhang 2007).
//! Crosses, N = 4, are what streets want and what this crate is about; the
//! other symmetries come at no cost, since everything is computed on D.

use std::f64::consts::TAU;

use geo_types::Coord;

use crate::cross::{Cross, SINGULAR};
use crate::plane::{coord, fourth_power, vector, V2};

/// How many arms a direction has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Symmetry {
    /// One arm: a unit vector, N = 1. Aligned with the boundary, it runs
    /// with the domain on its left.
    Vector,
    /// Two arms: a line without orientation, N = 2.
    Line,
    /// Four arms: a cross, N = 4.
    #[default]
    Cross,
    /// Six arms, N = 6: for triangular and hexagonal patterns.
    Hexagon,
}

impl Symmetry {
    /// All symmetries, by the number of their arms.
    pub const ALL: [Self; 4] = [Self::Vector, Self::Line, Self::Cross, Self::Hexagon];

    /// The number N of arms: 1, 2, 4 or 6.
    #[must_use]
    pub const fn folds(self) -> u32 {
        match self {
            Self::Vector => 1,
            Self::Line => 2,
            Self::Cross => 4,
            Self::Hexagon => 6,
        }
    }

    /// The symmetry with `folds` arms; `None` unless that is 1, 2, 4 or 6.
    #[must_use]
    pub fn from_folds(folds: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.folds() == folds)
    }

    /// The angle between neighbouring arms, radians: `2 pi / N`.
    #[must_use]
    pub fn period(self) -> f64 {
        TAU / self.number()
    }

    /// N as a number to compute with.
    pub(crate) fn number(self) -> f64 {
        f64::from(self.folds())
    }

    /// The representation vector of what has an arm along `direction`: its
    /// N-th power as a complex number, at unit length; zero for zero.
    pub(crate) fn power(self, direction: V2) -> V2 {
        let square = |v: V2| V2::new(v.x * v.x - v.y * v.y, 2.0 * v.x * v.y);
        let unit = |v: V2| {
            // By the larger component first: no square may leave the range of
            // exponents.
            let larger = v.amax();
            if larger > 0.0 {
                (v / larger).normalize()
            } else {
                V2::zeros()
            }
        };
        match self {
            Self::Vector => unit(direction),
            Self::Line => square(unit(direction)),
            Self::Cross => fourth_power(direction),
            Self::Hexagon => {
                let d = unit(direction);
                let cube = product(square(d), d);
                square(cube)
            }
        }
    }

    /// How many of the arms lie on different lines.
    pub(crate) fn lines(self) -> u32 {
        self.folds().div_ceil(2)
    }
}

/// The product of two vectors as complex numbers.
pub(crate) fn product(a: V2, b: V2) -> V2 {
    V2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// The product of `a` with the complex conjugate of `b`: their quotient if
/// `b` has unit length.
pub(crate) fn quotient(a: V2, b: V2) -> V2 {
    V2::new(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y)
}

/// N arms, evenly spaced (in the literature an N-RoSy, for rotational
/// symmetry): what a [`Cross`] is for N = 4, for any [`Symmetry`].
///
/// ```
/// use crossfield::{Rosy, Symmetry};
///
/// // A line at 0.3 and one at 0.3 + pi are the same line.
/// let line = Rosy::from_angle(Symmetry::Line, 0.3);
/// let other = Rosy::from_angle(Symmetry::Line, 0.3 + std::f64::consts::PI);
/// assert!(line.deviation(&other) < 1e-12);
/// assert_eq!(line.arms().len(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rosy {
    symmetry: Symmetry,
    /// The representation vector, of unit length.
    representative: Coord<f64>,
}

impl Rosy {
    /// The arms of which one is at `angle` radians, counter-clockwise from
    /// east.
    #[must_use]
    pub fn from_angle(symmetry: Symmetry, angle: f64) -> Self {
        let (y, x) = (symmetry.number() * angle).sin_cos();
        Self {
            symmetry,
            representative: Coord { x, y },
        }
    }

    /// The arms of which one is along `direction`, of any length.
    ///
    /// `None` if `direction` is zero or not finite.
    #[must_use]
    pub fn from_direction(symmetry: Symmetry, direction: Coord<f64>) -> Option<Self> {
        Self::from_vector(symmetry, symmetry.power(vector(direction)))
    }

    /// The arms that `representative` stands for, of any length.
    ///
    /// `None` if the vector is shorter than 1e-9 or not finite.
    #[must_use]
    pub fn from_representative(symmetry: Symmetry, representative: Coord<f64>) -> Option<Self> {
        Self::from_vector(symmetry, vector(representative))
    }

    pub(crate) fn from_vector(symmetry: Symmetry, representative: V2) -> Option<Self> {
        let length = representative.norm();
        (length >= SINGULAR && length.is_finite()).then(|| Self {
            symmetry,
            representative: coord(representative / length),
        })
    }

    /// How many arms there are.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// The representation vector `(cos Nu, sin Nu)`, of unit length.
    #[must_use]
    pub fn representative(&self) -> Coord<f64> {
        self.representative
    }

    /// The angle of one arm, radians, between `-pi / N` and `pi / N`.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.representative.y.atan2(self.representative.x) / self.symmetry.number()
    }

    /// The arms, unit vectors in counter-clockwise order, the one at
    /// [`Rosy::angle`] first.
    #[must_use]
    pub fn arms(&self) -> Vec<Coord<f64>> {
        let first = self.angle();
        (0..self.symmetry.folds())
            .map(|k| {
                let (y, x) = (first + f64::from(k) * self.symmetry.period()).sin_cos();
                Coord { x, y }
            })
            .collect()
    }

    /// The arm that turns least from `heading`, of any length.
    ///
    /// Where two arms turn equally, one of them; for a zero heading, any.
    #[must_use]
    pub fn arm_towards(&self, heading: Coord<f64>) -> Coord<f64> {
        if let Some(cross) = self.as_cross() {
            return cross.arm_towards(heading);
        }
        let first = self.angle();
        let turn = heading.y.atan2(heading.x) - first;
        let step = (turn / self.symmetry.period()).round();
        let (y, x) = (first + step * self.symmetry.period()).sin_cos();
        Coord { x, y }
    }

    /// The angle between the nearest arms, radians, between 0 and `pi / N`.
    ///
    /// Symmetries that differ are compared on the arms of `self`: its nearest
    /// one to the first arm of `other`.
    #[must_use]
    pub fn deviation(&self, other: &Self) -> f64 {
        let a = self.representative;
        let b = if self.symmetry == other.symmetry {
            other.representative
        } else {
            Self::from_angle(self.symmetry, other.angle()).representative
        };
        (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y).abs() / self.symmetry.number()
    }

    /// The same turned by `angle` radians, counter-clockwise.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        Self::from_angle(self.symmetry, self.angle() + angle)
    }

    /// As a cross; `None` for any other symmetry.
    #[must_use]
    pub fn as_cross(&self) -> Option<Cross> {
        match self.symmetry {
            Symmetry::Cross => Some(Cross::from_unit(self.representative)),
            _ => None,
        }
    }
}

impl From<Cross> for Rosy {
    fn from(cross: Cross) -> Self {
        Self {
            symmetry: Symmetry::Cross,
            representative: cross.representative(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_the_multiples_of_the_angle() {
        for symmetry in Symmetry::ALL {
            assert_eq!(Symmetry::from_folds(symmetry.folds()), Some(symmetry));
            for k in 0..50 {
                let angle = 0.37 * f64::from(k);
                let d = V2::new(angle.cos(), angle.sin());
                for size in [1e-200, 1.0, 1e200] {
                    let found = symmetry.power(d * size);
                    let (y, x) = (symmetry.number() * angle).sin_cos();
                    // Six roundings of the powers and that of N times 18.
                    assert!(
                        (found - V2::new(x, y)).norm() < 1e-13,
                        "{symmetry:?} {angle}"
                    );
                }
            }
            assert_eq!(symmetry.power(V2::zeros()), V2::zeros());
        }
        assert_eq!(Symmetry::from_folds(3), None);
    }

    #[test]
    fn the_arm_towards_a_heading_turns_least() {
        for symmetry in Symmetry::ALL {
            for k in 0..40 {
                let rosy = Rosy::from_angle(symmetry, 0.61 * f64::from(k));
                let (y, x) = (0.23 * f64::from(k)).sin_cos();
                let heading = Coord {
                    x: 3.0 * x,
                    y: 3.0 * y,
                };
                let towards = |arm: Coord<f64>| arm.x * x + arm.y * y;
                let best = rosy.arms().into_iter().map(towards).fold(-2.0, f64::max);
                assert!((towards(rosy.arm_towards(heading)) - best).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_cross_is_a_fourfold_rosy() {
        let cross = Cross::from_angle(0.3);
        let rosy = Rosy::from(cross);
        assert_eq!(rosy.as_cross(), Some(cross));
        assert!(Rosy::from_angle(Symmetry::Line, 0.3).as_cross().is_none());
        let other = Rosy::from_angle(Symmetry::Cross, 1.1);
        let wanted = cross.deviation(&Cross::from_angle(1.1));
        assert!((rosy.deviation(&other) - wanted).abs() < 1e-12);
    }
}
