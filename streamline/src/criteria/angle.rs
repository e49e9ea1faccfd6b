//! Angles between directions that have no sign, in parts of a right angle.

use crate::vector::{cross, dot, norm, point, Point};
use std::f64::consts::FRAC_PI_2;

/// Mean directions shorter than this, of 1 at most, have none.
const NONE: f64 = 1e-9;

/// The vector of twice the angle, of the same length: the same for a direction
/// and its opposite, so that means can be taken. Exact for directions along the
/// axes.
pub(super) fn doubled(v: Point) -> Point {
    let length = norm(v);
    if length > 0.0 {
        point((v.x - v.y) * (v.x + v.y), 2.0 * v.x * v.y) / length
    } else {
        point(0.0, 0.0)
    }
}

/// How far a direction lies from a mean of doubled ones: 0 for the same or the
/// opposite, 1 for a right angle. `None` if the mean has no direction.
pub(super) fn off_parallel(direction: Point, mean: Point) -> Option<f64> {
    if norm(mean).is_nan() || norm(mean) <= NONE {
        return None;
    }
    let own = doubled(direction);
    (norm(own) > 0.0).then(|| cross(mean, own).abs().atan2(dot(mean, own)) / (2.0 * FRAC_PI_2))
}

/// How far two directions are from a right angle: 0 at one, 1 if they are
/// parallel. `None` if one has no length.
pub(super) fn off_perpendicular(a: Point, b: Point) -> Option<f64> {
    let (along, across) = (dot(a, b).abs(), cross(a, b).abs());
    (along > 0.0 || across > 0.0).then(|| along.atan2(across) / FRAC_PI_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_right_angle() {
        for degrees in [0.0, 10.0, 45.0, 89.0, 90.0, 91.0, 135.0, 180.0, 270.0] {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            let way = point(cos, sin) * 3.0;
            let folded = 90.0 - (degrees % 180.0 - 90.0_f64).abs();
            let parallel = off_parallel(way, doubled(point(1.0, 0.0))).unwrap();
            assert!((parallel * 90.0 - folded).abs() < 1e-12, "{degrees}");
            let upright = off_perpendicular(way, point(0.0, -2.0)).unwrap();
            assert!((upright * 90.0 - folded).abs() < 1e-12, "{degrees}");
        }
    }

    #[test]
    fn the_axes_are_exact_and_no_direction_is_none() {
        let east = point(1.0, 0.0);
        assert_eq!(off_parallel(east, doubled(east * -7.0)), Some(0.0));
        assert_eq!(off_perpendicular(east, point(0.0, 5.0)), Some(0.0));
        let nothing = point(0.0, 0.0);
        assert_eq!(
            off_parallel(east, doubled(east) + doubled(point(0.0, 1.0))),
            None
        );
        assert_eq!(off_parallel(nothing, doubled(east)), None);
        assert_eq!(off_perpendicular(nothing, east), None);
    }
}
