//! A cross, and the vector that represents it.
//!
//! A cross is a pair of orthogonal lines through a point: four unit arms, a
//! quarter turn apart. With one arm at angle `u`, its representation vector is
//! `D = (cos 4u, sin 4u)`, the same for all four arms (supplement of Yang et
//! al. 2013, section 2, after Palacios and Zhang 2007). Crosses are averaged,
//! interpolated and smoothed on `D`, never on `u`.

use std::f64::consts::FRAC_PI_2;

use geo_types::Coord;

use crate::plane::{coord, fourth_power, vector, V2};

/// Four arms a quarter turn apart.
///
/// ```
/// use crossfield::{geo_types::coord, Cross};
///
/// let cross = Cross::from_angle(0.1);
/// let arm = cross.arm_towards(coord! { x: -0.2, y: 5.0 });
/// assert!((arm.y.atan2(arm.x) - (0.1 + std::f64::consts::FRAC_PI_2)).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cross {
    /// The representation vector, of unit length.
    representative: Coord<f64>,
}

impl Cross {
    /// The cross with an arm at `angle` radians, counter-clockwise from east.
    #[must_use]
    pub fn from_angle(angle: f64) -> Self {
        let (y, x) = (4.0 * angle).sin_cos();
        Self {
            representative: Coord { x, y },
        }
    }

    /// The cross with an arm along `direction`, of any length.
    ///
    /// `None` if `direction` is zero or not finite.
    #[must_use]
    pub fn from_direction(direction: Coord<f64>) -> Option<Self> {
        Self::from_vector(fourth_power(vector(direction)))
    }

    /// The cross that `representative` stands for, of any length.
    ///
    /// `None` if the vector is shorter than 1e-9 (a singularity has no cross)
    /// or not finite.
    #[must_use]
    pub fn from_representative(representative: Coord<f64>) -> Option<Self> {
        Self::from_vector(vector(representative))
    }

    pub(crate) fn from_vector(representative: V2) -> Option<Self> {
        let length = representative.norm();
        (length >= SINGULAR && length.is_finite()).then(|| Self {
            representative: coord(representative / length),
        })
    }

    /// The cross of a representation vector that has unit length.
    pub(crate) fn from_unit(representative: Coord<f64>) -> Self {
        Self { representative }
    }

    /// The representation vector `(cos 4u, sin 4u)`, of unit length.
    #[must_use]
    pub fn representative(&self) -> Coord<f64> {
        self.representative
    }

    /// The angle `u` of one arm, in radians, between -pi/4 and pi/4.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.representative.y.atan2(self.representative.x) / 4.0
    }

    /// The four arms, unit vectors in counter-clockwise order, the one at
    /// [`Cross::angle`] first.
    #[must_use]
    pub fn arms(&self) -> [Coord<f64>; 4] {
        let (y, x) = self.angle().sin_cos();
        [
            Coord { x, y },
            Coord { x: -y, y: x },
            Coord { x: -x, y: -y },
            Coord { x: y, y: -x },
        ]
    }

    /// The arm that turns least from `heading`, a unit vector.
    ///
    /// `heading` need not be of unit length. Where two arms turn equally, one
    /// of them is returned; for a zero heading, any arm.
    #[must_use]
    pub fn arm_towards(&self, heading: Coord<f64>) -> Coord<f64> {
        let first = self.arms()[0];
        // The arm is the first one after k quarter turns; in the frame of the
        // first arm k is read off the larger component of the heading.
        let along = first.x * heading.x + first.y * heading.y;
        let across = first.x * heading.y - first.y * heading.x;
        let Coord { x, y } = first;
        if along.abs() >= across.abs() {
            if along >= 0.0 {
                first
            } else {
                Coord { x: -x, y: -y }
            }
        } else if across > 0.0 {
            Coord { x: -y, y: x }
        } else {
            Coord { x: y, y: -x }
        }
    }

    /// The angle between the nearest arms of two crosses, in radians, between
    /// 0 and pi/4.
    #[must_use]
    pub fn deviation(&self, other: &Self) -> f64 {
        let (a, b) = (self.representative, other.representative);
        (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y).abs() / 4.0
    }

    /// The cross turned by `angle` radians, counter-clockwise.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        Self::from_angle(self.angle() + angle)
    }
}

/// Representation vectors shorter than this have no direction.
pub(crate) const SINGULAR: f64 = 1e-9;

/// A quarter turn, the symmetry of a cross.
pub(crate) const QUARTER: f64 = FRAC_PI_2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_vectors_have_no_cross() {
        let c = |x, y| Coord { x, y };
        assert!(Cross::from_direction(c(0.0, 0.0)).is_none());
        assert!(Cross::from_direction(c(f64::NAN, 1.0)).is_none());
        assert!(Cross::from_representative(c(1e-10, 0.0)).is_none());
        assert!(Cross::from_representative(c(f64::INFINITY, 0.0)).is_none());
        assert!(Cross::from_direction(c(1e-300, 1e-300)).is_some());
    }

    #[test]
    fn arms_are_a_quarter_turn_apart() {
        let arms = Cross::from_angle(0.3).arms();
        for (a, b) in arms.iter().zip(arms.iter().cycle().skip(1)) {
            let turn = (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y);
            assert!((turn - QUARTER).abs() < 1e-12);
        }
    }
}
