//! Small vector arithmetic shared by the rooms of this crate.

use geo_types::Coord;
use nalgebra::Vector2;

/// A vector, or a point relative to the centre of the domain.
pub(crate) type V2 = Vector2<f64>;

/// The vector with the components of `c`.
pub(crate) fn vector(c: Coord<f64>) -> V2 {
    V2::new(c.x, c.y)
}

/// The coordinate with the components of `v`.
pub(crate) fn coord(v: V2) -> Coord<f64> {
    Coord { x: v.x, y: v.y }
}

/// z component of the cross product: positive when `b` is to the left of `a`.
pub(crate) fn wedge(a: V2, b: V2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// `v` turned a quarter to the left.
pub(crate) fn left(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}

/// Twice the signed area of the triangle `a b c`, positive counter-clockwise.
pub(crate) fn orient(a: V2, b: V2, c: V2) -> f64 {
    wedge(b - a, c - a)
}

/// The sign of [`orient`], exact (Shewchuk's adaptive predicate).
pub(crate) fn orient_exact(a: V2, b: V2, c: V2) -> f64 {
    let robust = |v: V2| robust::Coord { x: v.x, y: v.y };
    robust::orient2d(robust(a), robust(b), robust(c))
}

/// The fourth power of `direction` as a complex number, at unit length: the
/// representation vector of the cross with an arm along `direction`.
///
/// Zero for a zero direction.
pub(crate) fn fourth_power(direction: V2) -> V2 {
    let square = |v: V2| V2::new(v.x * v.x - v.y * v.y, 2.0 * v.x * v.y);
    // To unit length before the powers are taken, and by its larger component
    // before that: neither may leave the range of exponents.
    let larger = direction.amax();
    if larger > 0.0 {
        square(square((direction / larger).normalize()))
    } else {
        V2::zeros()
    }
}

/// Difference of two phases, wrapped into [-pi, pi].
///
/// Antisymmetric, ties included: `wrapped(a, b) == -wrapped(b, a)` bit for
/// bit, which makes the index law exact (see [`crate::Field::index_sum`]).
pub(crate) fn wrapped(from: f64, to: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let difference = to - from;
    if difference > PI {
        difference - TAU
    } else if difference < -PI {
        difference + TAU
    } else {
        difference
    }
}

/// Squared distance from `p` to the segment `a b`.
pub(crate) fn segment_distance_squared(p: V2, a: V2, b: V2) -> f64 {
    (p - nearest_on_segment(p, a, b)).norm_squared()
}

/// The point of the segment `a b` nearest to `p`.
pub(crate) fn nearest_on_segment(p: V2, a: V2, b: V2) -> V2 {
    let along = b - a;
    let length_squared = along.norm_squared();
    if length_squared <= 0.0 {
        return a;
    }
    let t = (p - a).dot(&along) / length_squared;
    if t <= 0.0 {
        a
    } else if t >= 1.0 {
        b
    } else {
        a + along * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_4, PI};

    #[test]
    fn fourth_power_of_a_diagonal_points_west() {
        let power = fourth_power(V2::new(FRAC_PI_4.cos(), FRAC_PI_4.sin()) * 7.0);
        assert!((power - V2::new(-1.0, 0.0)).norm() < 1e-15);
        assert_eq!(fourth_power(V2::zeros()), V2::zeros());
    }

    #[test]
    fn wrapping_is_antisymmetric_at_the_tie() {
        assert_eq!(wrapped(0.0, PI), -wrapped(PI, 0.0));
        assert_eq!(wrapped(-PI, PI), -wrapped(PI, -PI));
        assert!((wrapped(3.0, -3.0) - (2.0 * PI - 6.0)).abs() < 1e-15);
    }
}
