//! In which directions a field leaves a singularity.

use super::Singularity;
use crate::field::{Cursor, DirectionField};
use crate::vector::{point, turn, Point};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

/// Smaller circles to try, each half of the last, when one does not show the
/// arms that the index calls for.
const CIRCLES: usize = 8;
/// Samples for each arm around the circle: between two of them the cross turns
/// against the radius by about 90 / 24 = 4 degrees, far from the 45 at which
/// arms are mixed up.
const SAMPLES: usize = 24;

/// The arms found, and the circle that they were found on.
#[derive(Clone, Debug)]
pub(super) struct Arms {
    /// Angles from east, ascending, in [0, 2 pi).
    pub(super) angles: Vec<f64>,
    pub(super) radius: f64,
    /// Whether the circle lies wholly in the field.
    pub(super) whole: bool,
    /// Whether it does and shows the number of arms that the index calls for.
    pub(super) complete: bool,
}

/// The directions on the circle of the given radius, or a smaller one, in which
/// an arm of the cross points straight away from the singularity.
pub(super) fn arms<F: DirectionField + ?Sized>(
    field: &F,
    singularity: &Singularity,
    radius: f64,
) -> Arms {
    let expected = singularity.arms();
    let mut best: Option<Arms> = None;
    for halved in 0..CIRCLES {
        let radius = radius * 0.5_f64.powi(halved as i32);
        let found = on_circle(field, singularity.at, radius, expected);
        if found.complete {
            return found;
        }
        // Of incomplete circles the one that shows most, the largest first.
        if best
            .as_ref()
            .is_none_or(|b| found.angles.len() > b.angles.len() && found.angles.len() <= expected)
        {
            best = Some(found);
        }
    }
    best.unwrap_or(Arms {
        angles: Vec::new(),
        radius,
        whole: false,
        complete: false,
    })
}

fn on_circle<F: DirectionField + ?Sized>(
    field: &F,
    centre: Point,
    radius: f64,
    expected: usize,
) -> Arms {
    let count = SAMPLES * expected.max(4);
    let mut cursor = Cursor::default();
    // The angle from the radius to the arm nearest to it.
    let mut off = |angle: f64| {
        let out = radial(angle);
        field
            .direction(centre + out * radius, out, &mut cursor)
            .map(|arm| turn(out, arm))
            .filter(|off| off.abs() <= FRAC_PI_4 + 1e-6)
    };
    let angle_of = |i: usize| TAU * i as f64 / count as f64;
    let samples: Vec<Option<f64>> = (0..count).map(|i| off(angle_of(i))).collect();
    let whole = samples.iter().all(Option::is_some);
    // Where the arm falls behind the radius (true) or overtakes it (false).
    let mut crossings: Vec<(f64, bool)> = Vec::new();
    for i in 0..count {
        let (Some(u), Some(v)) = (samples[i], samples[(i + 1) % count]) else {
            continue;
        };
        // Continued from `u`, so that another arm taking over is no crossing.
        let w = u + same_arm(v - u);
        let falls = u >= 0.0 && w < 0.0;
        if !(falls || (u < 0.0 && w >= 0.0)) {
            continue;
        }
        let (mut low, mut high) = (angle_of(i), angle_of(i + 1));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let Some(m) = off(middle) else { break };
            if (m >= 0.0) == falls {
                low = middle;
            } else {
                high = middle;
            }
        }
        crossings.push((0.5 * (low + high), falls));
    }
    // Close to a singularity arms only fall behind; where the field wavers
    // around the radius, one that overtakes it takes back a fall beside it.
    while let Some(i) = crossings.iter().position(|c| !c.1) {
        let n = crossings.len();
        let beside = [(i + n - 1) % n, (i + 1) % n];
        let Some(&fall) = beside.iter().find(|&&j| crossings[j].1) else {
            break;
        };
        crossings.remove(i.max(fall));
        crossings.remove(i.min(fall));
    }
    let mut angles: Vec<f64> = crossings
        .iter()
        .filter(|c| c.1)
        .map(|c| c.0.rem_euclid(TAU))
        .collect();
    angles.sort_by(f64::total_cmp);
    Arms {
        complete: whole && angles.len() == expected,
        angles,
        radius,
        whole,
    }
}

pub(super) fn radial(angle: f64) -> Point {
    point(angle.cos(), angle.sin())
}

/// An angle less the nearest multiple of a right angle.
fn same_arm(angle: f64) -> f64 {
    angle - (angle / FRAC_PI_2).round() * FRAC_PI_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{arm_nearest, from_fn};
    use geo_types::polygon;

    #[test]
    fn an_edge_through_the_singularity_leaves_the_arms_inside() {
        // Index -1/4 at the middle of the south side: arms at 0.1 + i 72 degrees.
        let half = polygon![(x: -9., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: -9., y: 9.)];
        let field = from_fn(half, |at, heading| {
            let turned = at.y.atan2(at.x) - 0.1;
            Some(arm_nearest(0.1 - 0.25 * turned, heading))
        });
        let singularity = Singularity {
            at: point(0.0, 0.0),
            quarters: -1,
        };
        let found = arms(&field, &singularity, 1.0);
        assert!(!found.complete);
        let exact: Vec<f64> = (0..3).map(|i| 0.1 + f64::from(i) * TAU / 5.0).collect();
        assert_eq!(found.angles.len(), 3);
        for (a, b) in found.angles.iter().zip(exact) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn a_circle_that_holds_another_singularity_is_too_large() {
        // +1/4 at the origin, -1/4 at (0.6, 0): together none on a large circle.
        let land = polygon![(x: -9., y: -9.), (x: 9., y: -9.), (x: 9., y: 9.), (x: -9., y: 9.)];
        let field = from_fn(land, |at, heading| {
            let angle = at.y.atan2(at.x) - at.y.atan2(at.x - 0.6);
            Some(arm_nearest(0.25 * angle, heading))
        });
        let singularity = Singularity {
            at: point(0.0, 0.0),
            quarters: 1,
        };
        let found = arms(&field, &singularity, 2.0);
        assert!(found.complete && found.radius < 0.6, "{found:?}");
        assert_eq!(found.angles.len(), 3);
    }
}
