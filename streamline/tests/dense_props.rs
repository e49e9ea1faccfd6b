//! Laws of dense output: the curve between the points of a line.

mod support;

use geo_types::{coord, polygon};
use proptest::prelude::*;
use streamline::{
    arm_nearest, from_fn, trace, trace_dense, Curve, DirectionField, Stop, TraceOptions,
};
use support::{cases, cross, domain, dot, fixed, norm, waves, wavy, P};

const EAST: P = P { x: 1.0, y: 0.0 };

/// Positions all along the curve, seldom at a step's end.
fn along(curve: &Curve) -> impl Iterator<Item = f64> + '_ {
    (0..=400).map(|k| curve.length() * f64::from(k) / 400.0)
}

proptest! {
    #![proptest_config(cases())]

    /// The line is that of `trace`, and its points lie on the curve: a short
    /// segment across each of them crosses the curve there.
    #[test]
    fn the_curve_is_that_of_the_line(domain in domain(), waves in waves(), heading in 0.0..6.3_f64) {
        let field = wavy(domain, waves);
        let (seed, options) = (coord! { x: 60.0, y: 5.0 }, TraceOptions::default());
        let heading = coord! { x: heading.cos(), y: heading.sin() };
        let curve = match trace_dense(&field, seed, heading, &options) {
            Ok(curve) => curve,
            Err(error) => {
                prop_assert_eq!(Err(error), trace(&field, seed, heading, &options));
                return Ok(());
            }
        };
        let line = trace(&field, seed, heading, &options);
        prop_assert_eq!(Ok(&curve.line), line.as_ref());
        let points = &curve.line.points;
        prop_assert!(norm(curve.point_at(0.0) - points[0]) < 1e-9);
        prop_assert!(norm(curve.point_at(curve.length()) - points[points.len() - 1]) < 1e-9);
        prop_assert!(norm(curve.point_at(curve.seed_at()) - seed) < 1e-9);
        for p in points.windows(3) {
            let way = p[2] - p[0];
            let normal = coord! { x: -way.y, y: way.x } / norm(way);
            let near = curve
                .crossings(p[1] - normal, p[1] + normal)
                .into_iter()
                .map(|s| norm(curve.point_at(s) - p[1]))
                .fold(f64::INFINITY, f64::min);
            prop_assert!(near < 1e-8, "{:?} is {} off the curve", p[1], near);
        }
    }

    /// The curve runs at speed 1 along the field. A step of length h is off by
    /// `tolerance` at most, its derivative by some sixteen times that over h;
    /// steps are 1 m long at least but before the boundary, where the last
    /// stretch may be straight: it leaves the curve by half the tolerance at
    /// most, so on radii from 20 m on it is at most 0.5 m long and turns
    /// 0.025 rad.
    #[test]
    fn tangents_follow_the_field(domain in domain(), waves in waves()) {
        let field = wavy(domain, waves);
        let options = TraceOptions { tolerance: 0.001, ..TraceOptions::default() };
        let Ok(curve) = trace_dense(&field, coord! { x: 60.0, y: 5.0 }, EAST, &options) else {
            return Ok(());
        };
        let mut last = (0.0, curve.point_at(0.0));
        for s in along(&curve) {
            let (at, tangent) = (curve.point_at(s), curve.tangent_at(s));
            let wanted = arm_nearest(waves.angle(at), tangent);
            prop_assert!(cross(tangent, wanted).abs() < 0.03, "{s}: {tangent:?} {wanted:?}");
            prop_assert!(norm(at - last.1) <= (s - last.0) * 1.01 + 1e-9, "a jump at {s}");
            last = (s, at);
        }
        let fine = curve.resample(0.25).length();
        prop_assert!((fine / curve.length() - 1.0).abs() < 2e-3, "{} {}", fine, curve.length());
    }

    /// Whatever line is drawn across, the curve passes it an odd number of
    /// times if its ends lie on different sides, and each time on it.
    #[test]
    fn crossings_are_complete(domain in domain(), waves in waves(), turn in 0.0..6.3_f64, offset in -150.0..150.0_f64) {
        let field = wavy(domain, waves);
        let Ok(curve) = trace_dense(&field, coord! { x: 60.0, y: 5.0 }, EAST, &TraceOptions::default()) else {
            return Ok(());
        };
        let (normal, way) = (coord! { x: turn.cos(), y: turn.sin() }, coord! { x: -turn.sin(), y: turn.cos() });
        let found = curve.crossings(normal * offset - way * 1e3, normal * offset + way * 1e3);
        let side = |p: P| dot(p, normal) - offset;
        let (from, to) = (side(curve.point_at(0.0)), side(curve.point_at(curve.length())));
        // An end on the line itself may count either way.
        prop_assume!(from.abs() > 1e-9 && to.abs() > 1e-9);
        prop_assert_eq!(found.len() % 2 == 1, (from < 0.0) != (to < 0.0));
        for s in found {
            prop_assert!(side(curve.point_at(s)).abs() < 1e-9);
        }
    }

    /// Against the heading the curve is the same one, from its other end.
    #[test]
    fn reversal_is_exact(domain in domain(), waves in waves()) {
        let field = wavy(domain, waves);
        let (seed, options) = (coord! { x: 60.0, y: 5.0 }, TraceOptions::default());
        let Ok(there) = trace_dense(&field, seed, EAST, &options) else {
            return Ok(());
        };
        prop_assume!(there.line.start.is_boundary() && there.line.end.is_boundary());
        let back = trace_dense(&field, seed, EAST * -1.0, &options).expect("the same seed");
        prop_assert!((there.length() - back.length()).abs() < 1e-9);
        for s in along(&there) {
            prop_assert!(norm(there.point_at(s) - back.point_at(there.length() - s)) < 1e-8);
            prop_assert!((there.curvature_at(s).abs() - back.curvature_at(there.length() - s).abs()).abs() < 1e-2);
        }
    }
}

fn polar() -> impl DirectionField {
    let land = polygon![(x: -300., y: -300.), (x: 300., y: -300.), (x: 300., y: 300.), (x: -300., y: 300.)];
    from_fn(land, |at, heading| {
        Some(arm_nearest(at.y.atan2(at.x), heading))
    })
}

/// Between the points too, the curve converges to the circle with the fourth
/// order of the extension at least.
#[test]
fn circles_between_the_points_are_of_order_four() {
    let (field, radius) = (polar(), 100.0);
    let error = |step: f64| {
        let options = TraceOptions {
            loop_tolerance: 5.0,
            max_length: 0.9 * std::f64::consts::TAU * radius,
            ..fixed(step)
        };
        let north = coord! { x: 0., y: 1. };
        let curve =
            trace_dense(&field, coord! { x: radius, y: 0. }, north, &options).expect("on a circle");
        along(&curve)
            .map(|s| {
                let angle = (s - curve.seed_at()) / radius;
                norm(
                    curve.point_at(s) - coord! { x: radius * angle.cos(), y: radius * angle.sin() },
                )
            })
            .fold(0.0, f64::max)
    };
    let errors = [40.0, 20.0, 10.0].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 3.9, "{errors:?}");
    }
    assert!(errors[2] < 1e-3, "{errors:?}");
}

/// A closed line's curve ends where it began, and curves as a circle does.
#[test]
fn closed_curves_close() {
    let north = coord! { x: 0., y: 1. };
    let seed = coord! { x: 80., y: 0. };
    let curve = trace_dense(&polar(), seed, north, &TraceOptions::default()).expect("a circle");
    assert_eq!(curve.line.end, Stop::ClosedLoop);
    assert_eq!(curve.seed_at(), 0.0);
    assert_eq!(curve.point_at(curve.length()), seed);
    assert_eq!(curve.point_at(f64::NAN), seed);
    assert!((curve.length() - 80.0 * std::f64::consts::TAU).abs() < 0.1);
    for s in along(&curve).skip(1).take(398) {
        assert!((curve.curvature_at(s) - 1.0 / 80.0).abs() < 2e-4);
    }
    // The y axis is met at a quarter and at three.
    let met = curve.crossings(coord! { x: 0., y: -99. }, coord! { x: 0., y: 99. });
    assert_eq!(met.len(), 2);
    assert!((met[1] - 3.0 * met[0]).abs() < 0.05);
}
