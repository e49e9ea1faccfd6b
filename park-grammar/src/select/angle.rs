//! `Angle([-45, 45])`: edges by their angle.
//!
//! The notes give two readings: "[85, 95] degrees are roughly perpendicular
//! edges", which is the orientation of a line, and "[-45, 45] for East", which
//! is the direction an edge faces. Decided: an edge has the angle of the
//! direction that it faces, counted from the region's own east; with the word
//! `Line` that of the line it lies on, from 0 to 180 degrees. Both ends of a
//! range belong to it.

use std::f64::consts::{PI, TAU};

use super::frame::{outward, Frame};
use super::Selection;
use crate::plane::unit;
use crate::shape::Region;

/// Angles this near to the end of a range are at it, radians.
pub(super) const NEAR: f64 = 1e-9;

/// The edges that face into a range of directions, radians from `low` on to
/// `high`.
pub(super) fn facing(region: &Region, frame: Frame, [low, high]: [f64; 2]) -> Selection {
    Selection::edges(region, |a, b, _| {
        within(frame.angle(outward(a, b)), [low, high], TAU)
    })
}

/// The edges on lines of these angles.
pub(super) fn lying(region: &Region, frame: Frame, [low, high]: [f64; 2]) -> Selection {
    Selection::edges(region, |a, b, _| {
        within(frame.angle(unit(b - a)), [low, high], PI)
    })
}

/// Whether an angle lies in a range, all taken round a `turn`.
fn within(angle: f64, [low, high]: [f64; 2], turn: f64) -> bool {
    let past = (angle - low + NEAR).rem_euclid(turn);
    past <= high - low + 2.0 * NEAR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_run_over_half_a_turn() {
        let inside = |angle: f64, low: f64, high: f64, turn: f64| {
            within(angle.to_radians(), [low, high].map(f64::to_radians), turn)
        };
        assert!(inside(-45.0, -45.0, 45.0, TAU) && inside(45.0, -45.0, 45.0, TAU));
        assert!(!inside(46.0, -45.0, 45.0, TAU));
        assert!(inside(-170.0, 135.0, 225.0, TAU) && !inside(0.0, 135.0, 225.0, TAU));
        // A line has no ends: west is east.
        assert!(inside(-90.0, 85.0, 95.0, PI) && inside(90.0, 85.0, 95.0, PI));
    }
}
