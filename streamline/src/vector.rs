//! Products of plane vectors: `geo_types::Coord` has sums but no products.

use geo_types::Coord;

pub(crate) type Point = Coord<f64>;

pub(crate) fn point(x: f64, y: f64) -> Point {
    Coord { x, y }
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a.x * b.x + a.y * b.y
}

/// Positive where `b` lies to the left of `a`.
pub(crate) fn cross(a: Point, b: Point) -> f64 {
    a.x * b.y - a.y * b.x
}

/// A quarter turn to the left.
pub(crate) fn left(a: Point) -> Point {
    point(-a.y, a.x)
}

/// Length, by a square root where the squares stay in range: several times
/// faster than `hypot`, which is left to extreme input.
#[inline]
pub(crate) fn norm(a: Point) -> f64 {
    let square = dot(a, a);
    if square > 1e-200 && square < 1e200 {
        square.sqrt()
    } else {
        a.x.hypot(a.y)
    }
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    norm(b - a)
}

pub(crate) fn is_finite(a: Point) -> bool {
    a.x.is_finite() && a.y.is_finite()
}

/// The unit vector along `a`; `None` if it has no length or is not finite.
#[inline]
pub(crate) fn unit(a: Point) -> Option<Point> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| a / length)
}

/// The signed angle from `a` to `b`, in (-pi, pi].
pub(crate) fn turn(a: Point, b: Point) -> f64 {
    cross(a, b).atan2(dot(a, b))
}

/// Parameter in [0, 1] of the point of segment `a b` nearest to `p`.
pub(crate) fn nearest_parameter(p: Point, a: Point, b: Point) -> f64 {
    let edge = b - a;
    let square = dot(edge, edge);
    if square > 0.0 {
        (dot(p - a, edge) / square).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// The point of segment `a b` nearest to `p`.
pub(crate) fn nearest_on_segment(p: Point, a: Point, b: Point) -> Point {
    a + (b - a) * nearest_parameter(p, a, b)
}

/// True if the open segments `a b` and `c d` cross in one inner point, or an
/// end of one lies inside the other; collinear overlap does not count.
pub(crate) fn segments_cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    // Relative to `a`: at map coordinates the differences stay exact.
    let (e, f) = (b - a, d - c);
    let (c0, c1) = (cross(e, c - a), cross(e, d - a));
    let (a0, a1) = (cross(f, a - c), cross(f, b - c));
    c0 * c1 <= 0.0 && a0 * a1 <= 0.0 && (c0 != 0.0 || c1 != 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turn_is_signed() {
        assert_eq!(
            turn(point(1.0, 0.0), point(0.0, 2.0)),
            std::f64::consts::FRAC_PI_2
        );
        assert_eq!(
            turn(point(0.0, 1.0), point(3.0, 0.0)),
            -std::f64::consts::FRAC_PI_2
        );
    }

    #[test]
    fn crossing_segments() {
        let p = point;
        assert!(segments_cross(p(0., 0.), p(2., 2.), p(0., 2.), p(2., 0.)));
        assert!(!segments_cross(p(0., 0.), p(2., 2.), p(3., 0.), p(3., 9.)));
        assert!(!segments_cross(p(0., 0.), p(2., 0.), p(1., 0.), p(3., 0.)));
        assert!(segments_cross(p(0., 0.), p(2., 0.), p(1., 0.), p(1., 3.)));
    }

    #[test]
    fn unit_refuses_what_has_no_direction() {
        assert_eq!(unit(point(0.0, 0.0)), None);
        assert_eq!(unit(point(f64::NAN, 1.0)), None);
        assert_eq!(unit(point(f64::INFINITY, 1.0)), None);
        assert_eq!(unit(point(0.0, 4.0)), Some(point(0.0, 1.0)));
        assert_eq!(unit(point(-1e300, 0.0)), Some(point(-1.0, 0.0)));
        assert_eq!(unit(point(0.0, 1e-300)), Some(point(0.0, 1.0)));
    }
}
