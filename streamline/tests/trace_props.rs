//! Laws of a single trace: closed forms, order, reversal, the boundary.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, polygon, Polygon};
use proptest::prelude::*;
use streamline::{arm_nearest, from_fn, trace, Divergence, Stop, Streamline, TraceOptions};
use support::*;

fn square(half: f64) -> Polygon<f64> {
    polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)]
}

/// The angle equals y / b: then y and x have closed forms in the arc length,
/// tan(y / 2b) = tan(y0 / 2b) exp(s / b) and x = b ln(sin(y / b) / sin(y0 / b)).
fn error_at_fixed_step(step: f64) -> f64 {
    let (b, y0, s) = (100.0, 40.0, 160.0);
    let field = from_fn(square(500.0), |at, heading| {
        Some(arm_nearest(at.y / b, heading))
    });
    let options = TraceOptions {
        max_length: s,
        ..fixed(step)
    };
    let line = trace(
        &field,
        coord! { x: 0., y: y0 },
        coord! { x: 1., y: 0.4 },
        &options,
    )
    .unwrap();
    assert_eq!(line.end, Stop::LengthLimit);
    let y = 2.0 * b * ((y0 / (2.0 * b)).tan() * (s / b).exp()).atan();
    let x = b * ((y / b).sin() / (y0 / b).sin()).ln();
    norm(line.points[line.points.len() - 1] - coord! { x: x, y: y })
}

#[test]
fn error_falls_with_the_fifth_power_of_the_step() {
    let errors = [40.0, 20.0, 10.0, 5.0].map(error_at_fixed_step);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((4.5..6.5).contains(&order), "order {order} of {errors:?}");
    }
}

#[test]
fn error_follows_the_tolerance() {
    let field = from_fn(square(500.0), |at, heading| {
        Some(arm_nearest(at.y / 100.0, heading))
    });
    let run = |tolerance: f64| {
        let options = TraceOptions {
            max_length: 160.0,
            max_step: 160.0,
            tolerance,
            ..TraceOptions::default()
        };
        let line = trace(
            &field,
            coord! { x: 0., y: 40. },
            coord! { x: 1., y: 0. },
            &options,
        )
        .unwrap();
        let y: f64 = 200.0 * (0.2_f64.tan() * 1.6_f64.exp()).atan();
        (line.points[line.points.len() - 1].y - y).abs()
    };
    // A dozen steps, and lines that spread by less than e^1.6 = 5.
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8] {
        assert!(
            run(tolerance) < 20.0 * tolerance,
            "{tolerance}: {}",
            run(tolerance)
        );
    }
}

proptest! {
    #![proptest_config(cases())]

    /// The cross of log r: circles close on themselves, rays run through.
    #[test]
    fn circles_of_log_r(radius in 8.0..190.0_f64, start in 0.0..6.3_f64, motion in motion(), clockwise: bool) {
        let field = from_fn(motion.polygon(&square(200.0)), |at, heading| {
            let p = motion.undo(at);
            Some(motion.turn(arm_nearest(p.y.atan2(p.x), motion.undo_turn(heading))))
        });
        let (sin, cos) = f64::sin_cos(start);
        let at = motion.apply(coord! { x: radius * cos, y: radius * sin });
        let along = motion.turn(coord! { x: -sin, y: cos }) * if clockwise { -1.0 } else { 1.0 };
        let options = TraceOptions { self_approach: 2.0, ..TraceOptions::default() };
        let circle = trace(&field, at, along, &options).unwrap();
        prop_assert_eq!((circle.start, circle.end), (Stop::ClosedLoop, Stop::ClosedLoop));
        prop_assert_eq!(circle.points.first(), circle.points.last());
        for &p in &circle.points {
            // Errors of up to 200 steps, most far below the tolerance.
            prop_assert!((norm(motion.undo(p)) - radius).abs() < 0.05, "{}", norm(motion.undo(p)) - radius);
        }
        let ray = trace(&field, at, motion.turn(coord! { x: cos, y: sin }), &options).unwrap();
        prop_assert!(ray.end.is_boundary());
        // Rays meet in the middle: a stage that falls there by chance has any
        // direction, and what lies behind it may be another ray. Steps are at
        // most 20 m long, so that none of a point farther out reaches it.
        prop_assert!(ray.start.is_boundary() || ray.start == Stop::Singularity);
        for p in ray.points.iter().map(|&p| motion.undo(p)) {
            if p.x * cos + p.y * sin > options.max_step {
                prop_assert!((p.x * sin - p.y * cos).abs() < 1e-6, "{}", p.x * sin - p.y * cos);
            }
        }
    }

    /// The gradient of x^2 - y^2: hyperbolas x y = c, met exactly at the boundary.
    #[test]
    fn hyperbolas_of_a_saddle(x in 3.0..180.0_f64, y in 3.0..180.0_f64, quadrant in 0..4, motion in motion()) {
        let seed = coord! { x: if quadrant % 2 == 0 { x } else { -x }, y: if quadrant < 2 { y } else { -y } };
        let domain = motion.polygon(&square(200.0));
        let field = from_fn(domain.clone(), |at, _| {
            let p = motion.undo(at);
            Some(motion.turn(coord! { x: p.x, y: -p.y }))
        });
        let line = trace(&field, motion.apply(seed), motion.turn(coord! { x: seed.x, y: -seed.y }), &TraceOptions::default()).unwrap();
        let c = seed.x * seed.y;
        for &p in &line.points {
            let p = motion.undo(p);
            // The distance to the hyperbola, to first order, against a dozen
            // steps' errors; a saddle brings lines together and apart again.
            prop_assert!((p.x * p.y - c).abs() / norm(p) < 0.1, "{}", (p.x * p.y - c) / norm(p));
        }
        for (stop, end) in [(line.start, line.points[0]), (line.end, line.points[line.points.len() - 1])] {
            let Stop::Boundary { ring, edge } = stop else { return Err(TestCaseError::fail(format!("{stop:?}"))) };
            let (_, _, a, b) = edges(&domain)[edge];
            prop_assert_eq!(ring, 0);
            prop_assert!(to_segment(end, a, b) < 1e-8 + 1e-15 * norm(motion.shift));
        }
        prop_assert_eq!(line.points.iter().filter(|&&p| p == motion.apply(seed)).count(), 1);
    }

    /// Tracing back from the end returns to the seed, up to the errors of the
    /// steps magnified by exp(integral |div|) there and back.
    #[test]
    fn reversal_returns_to_the_seed(waves in waves(), x in -50.0..50.0_f64, y in -50.0..50.0_f64, length in 20.0..400.0_f64, family in 0..2) {
        let field = wavy(square(500.0), waves);
        let seed = coord! { x: x, y: y };
        let heading = arm_nearest(waves.angle(seed) + f64::from(family) * std::f64::consts::FRAC_PI_2, coord! { x: 1., y: 0.3 });
        let options = TraceOptions { max_length: length, self_approach: 0.0, loop_tolerance: 0.0, ..TraceOptions::default() };
        let there = trace(&field, seed, heading, &options).unwrap();
        prop_assume!(there.end == Stop::LengthLimit);
        let end = there.points[there.points.len() - 1];
        let back = trace(&field, end, there.end_tangent() * -1.0, &options).unwrap();
        prop_assert_eq!(back.end, Stop::LengthLimit);
        let from = there.points.iter().position(|&p| p == seed).unwrap();
        let way = Streamline { points: there.points[from..].to_vec(), ..there.clone() };
        let steps = 2.0 * (way.points.len() as f64);
        let spread = Divergence { step: 1.0, ..Divergence::default() }.integral(&way, &field).exp();
        let gap = norm(back.points[back.points.len() - 1] - seed);
        prop_assert!(gap <= steps * options.tolerance * spread, "{} over {}", gap, steps * options.tolerance * spread);
    }

    /// Lines stay in the domain, end exactly on the edge they name, keep their
    /// spacing, and never run alongside themselves.
    #[test]
    fn lines_keep_to_the_domain(domain in domain(), waves in waves(), r in 45.0..95.0_f64, angle in 0.0..6.3_f64, motion in motion()) {
        let moved = motion.polygon(&domain);
        let field = from_fn(moved.clone(), |at, heading| {
            Some(motion.turn(arm_nearest(waves.angle(motion.undo(at)), motion.undo_turn(heading))))
        });
        let seed = motion.apply(coord! { x: r * f64::cos(angle), y: r * f64::sin(angle) });
        let options = TraceOptions::default();
        let Ok(line) = trace(&field, seed, coord! { x: 1., y: 0. }, &options) else {
            // Between two far vertices the star may be narrower than the seed.
            return Ok(());
        };
        let all = edges(&moved);
        let rounding = 1e-8 + 1e-15 * norm(motion.shift);
        for (i, p) in line.points.windows(2).enumerate() {
            prop_assert!(norm(p[1] - p[0]) <= options.step + 2.0 * options.tolerance);
            for &(_, _, a, b) in &all {
                let sides = (cross(p[1] - p[0], a - p[0]), cross(p[1] - p[0], b - p[0]));
                let ends = (cross(b - a, p[0] - a), cross(b - a, p[1] - a));
                let clear = rounding * (norm(b - a) + norm(p[1] - p[0]));
                let crosses = sides.0.min(sides.1) < -clear && sides.0.max(sides.1) > clear
                    && ends.0.min(ends.1) < -clear && ends.0.max(ends.1) > clear;
                prop_assert!(!crosses, "piece {i} of {} leaves the domain", line.points.len());
            }
        }
        for (stop, end) in [(line.start, line.points[0]), (line.end, line.points[line.points.len() - 1])] {
            match stop {
                Stop::Boundary { ring, edge } => {
                    let &(_, _, a, b) = all.iter().find(|e| (e.0, e.1) == (ring, edge)).unwrap();
                    prop_assert!(to_segment(end, a, b) < rounding, "{}", to_segment(end, a, b));
                }
                Stop::SelfApproach | Stop::ClosedLoop => {}
                other => return Err(TestCaseError::fail(format!("{other:?}"))),
            }
        }
    }

    /// The same trace elsewhere, turned and mirrored, is the same line.
    #[test]
    fn traces_move_with_the_field(domain in domain(), waves in waves(), motion in motion(), angle in 0.0..6.3_f64) {
        let home = wavy(domain.clone(), waves);
        let away = from_fn(motion.polygon(&domain), |at, heading| {
            Some(motion.turn(arm_nearest(waves.angle(motion.undo(at)), motion.undo_turn(heading))))
        });
        let (seed, heading) = (coord! { x: 47., y: 31. }, coord! { x: f64::cos(angle), y: f64::sin(angle) });
        let options = TraceOptions::default();
        let here = trace(&home, seed, heading, &options);
        let there = trace(&away, motion.apply(seed), motion.turn(heading), &options);
        match (here, there) {
            (Ok(here), Ok(there)) => {
                // A line that grazes a corner may end there in one and pass in
                // the other: no law beyond where both agree.
                prop_assume!(here.end == there.end && here.start == there.start && here.points.len() == there.points.len());
                for (&p, &q) in here.points.iter().zip(&there.points) {
                    prop_assert!(norm(motion.apply(p) - q) < 1e-5, "{}", norm(motion.apply(p) - q));
                }
            }
            (here, there) => prop_assert_eq!(here.is_err(), there.is_err()),
        }
    }

    /// Simplified and original lie within the tolerance of each other.
    #[test]
    fn simplify_keeps_its_tolerance(waves in waves(), tolerance in 0.01..20.0_f64) {
        let field = wavy(square(300.0), waves);
        let line = trace(&field, coord! { x: 3., y: 5. }, coord! { x: 1., y: 0. }, &TraceOptions::default()).unwrap();
        let simple = line.simplify(tolerance);
        prop_assert!(line.points.iter().all(|&p| simple.distance_to(p) <= tolerance * (1.0 + 1e-12)));
        prop_assert!(simple.resample(1.0).points.iter().all(|&p| line.distance_to(p) <= tolerance * (1.0 + 1e-12)));
        prop_assert_eq!(simple.points.first(), line.points.first());
        prop_assert_eq!(simple.points.last(), line.points.last());
    }

    /// Smoothing moves no point farther than allowed, keeps the ends, makes no
    /// piece longer where nothing limits it, and goes with the line wherever
    /// that is moved: on any polyline, however ragged.
    #[test]
    fn smoothing_is_bounded_and_moves_with_the_line(
        steps in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64, 0..4_usize), 3..40),
        rounds in 0..30_usize,
        shift in 0.01..8.0_f64,
        motion in motion(),
    ) {
        let mut at = coord! { x: 0.0, y: 0.0 };
        let mut points = vec![at];
        for (x, y, kind) in steps {
            // Some points twice, some steps tiny.
            let scale = [1.0, 1.0, 1e-6, 0.0][kind];
            at = at + coord! { x: x, y: y } * scale;
            points.push(at);
        }
        let line = Streamline {
            seed: points[0],
            points,
            start: Stop::FieldEnd,
            end: Stop::FieldEnd,
            family: 0,
            seed_index: 0,
        };
        let smooth = line.smooth(rounds, shift);
        prop_assert_eq!(smooth.points.len(), line.points.len());
        prop_assert_eq!(smooth.points.first(), line.points.first());
        prop_assert_eq!(smooth.points.last(), line.points.last());
        for (&p, &q) in line.points.iter().zip(&smooth.points) {
            prop_assert!(norm(q - p) <= shift * (1.0 + 1e-12));
            prop_assert!(line.distance_to(q) <= shift * (1.0 + 1e-12));
        }
        let free = line.smooth(rounds, f64::INFINITY);
        for (p, q) in line.points.windows(2).zip(free.points.windows(2)) {
            prop_assert!(norm(q[1] - q[0]) <= norm(p[1] - p[0]) + 1e-12);
        }
        let moved = Streamline {
            points: line.points.iter().map(|&p| motion.apply(p)).collect(),
            ..line.clone()
        };
        // Rounding at map coordinates is 1e-9 m, and no round magnifies it but
        // where two points are as near as that: there the weights of the two
        // pieces are rounding themselves, and a point may lie anywhere on the
        // chord of its neighbours, which is as short as their distance.
        let least = line.points.windows(2).map(|p| norm(p[1] - p[0])).fold(f64::INFINITY, f64::min);
        if least > 1e-3 {
            for (&p, &q) in smooth.points.iter().zip(&moved.smooth(rounds, shift).points) {
                prop_assert!(norm(motion.apply(p) - q) < 1e-6 * (1.0 + rounds as f64));
            }
        }
    }
}

/// What a plain loop over all pairs of pieces says about running alongside.
fn alongside(line: &Streamline, reach: f64) -> bool {
    let pieces: Vec<_> = line.points.windows(2).collect();
    let mut arc = vec![0.0];
    for p in &pieces {
        arc.push(arc[arc.len() - 1] + norm(p[1] - p[0]));
    }
    (0..pieces.len()).any(|i| {
        (0..i).any(|j| {
            let (e, f) = (pieces[i][1] - pieces[i][0], pieces[j][1] - pieces[j][0]);
            let parallel = dot(e, f).abs() > cross(e, f).abs() * 1.05;
            let middle = (pieces[i][0] + pieces[i][1]) / 2.0;
            arc[i] - arc[j + 1] > 4.0 * reach
                && parallel
                && to_segment(middle, pieces[j][0], pieces[j][1]) < 0.8 * reach
        })
    })
}

#[test]
fn spirals_stop_before_they_wind_up() {
    // Log spirals: at a constant angle to the radius, inwards for ever.
    for pitch in [1.45, 1.5, 1.55] {
        let field = from_fn(square(200.0), |at, _| {
            let a = at.y.atan2(at.x) + pitch;
            Some(coord! { x: f64::cos(a), y: f64::sin(a) })
        });
        let options = TraceOptions {
            self_approach: 6.0,
            ..TraceOptions::default()
        };
        let line = trace(
            &field,
            coord! { x: 120., y: 0. },
            coord! { x: 0., y: 1. },
            &options,
        )
        .unwrap();
        assert!(
            [line.start, line.end].contains(&Stop::SelfApproach),
            "{pitch}: {:?} {:?}",
            line.start,
            line.end
        );
        // All but the pieces that stopped it.
        let n = line.points.len();
        let inner = Streamline {
            points: line.points[2..n - 2].to_vec(),
            ..line
        };
        assert!(!alongside(&inner, 6.0), "{pitch}");
    }
}

#[test]
fn singular_points_and_the_end_of_the_field_differ() {
    let heading = coord! { x: 1., y: 0. };
    // A quarter-turn singularity at the origin, straight ahead.
    let trisector = from_fn(square(100.0), |at, heading| {
        (at != coord! { x: 0., y: 0. }).then(|| arm_nearest(-0.25 * at.y.atan2(-at.x), heading))
    });
    let line = trace(
        &trisector,
        coord! { x: -50., y: 0. },
        heading,
        &TraceOptions::default(),
    )
    .unwrap();
    assert_eq!(line.end, Stop::Singularity);
    assert!(norm(line.points[line.points.len() - 1]) < 0.5);
    let half = from_fn(square(100.0), |at, heading| {
        (at.x < 20.0).then_some(heading)
    });
    let line = trace(
        &half,
        coord! { x: -50., y: 0. },
        heading,
        &TraceOptions::default(),
    )
    .unwrap();
    assert_eq!(line.end, Stop::FieldEnd);
    assert!((line.points[line.points.len() - 1].x - 20.0).abs() < 0.1);
    assert!(line.start.is_boundary());
}

#[test]
fn a_slit_is_not_jumped() {
    // A hole 1 cm wide across the way: steps are up to 20 m long.
    let slit = polygon!(
        exterior: [(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 50.), (x: 0., y: 50.)],
        interiors: [[(x: 61.0, y: 5.), (x: 61.0, y: 45.), (x: 61.01, y: 45.), (x: 61.01, y: 5.)]],
    );
    let east = from_fn(slit, |_, _| Some(coord! { x: 1.0, y: 0.0 }));
    let line = trace(
        &east,
        coord! { x: 20., y: 20. },
        coord! { x: 1., y: 0. },
        &TraceOptions::default(),
    )
    .unwrap();
    assert_eq!(line.end, Stop::Boundary { ring: 1, edge: 0 });
    assert!((line.length() - 61.0).abs() < 1e-9);
}

#[test]
fn seeds_on_the_boundary_and_bad_seeds() {
    let east = from_fn(square(50.0), |_, _| Some(coord! { x: 1.0, y: 0.0 }));
    let heading = coord! { x: 1., y: 0. };
    let options = TraceOptions::default();
    let line = trace(&east, coord! { x: -50., y: 7. }, heading, &options).unwrap();
    assert!(
        (line.length() - 100.0).abs() < 1e-9 && line.start.is_boundary() && line.end.is_boundary()
    );
    assert_eq!(line.points[0], coord! { x: -50., y: 7. });
    // Nothing to either side: a single point.
    let north = from_fn(square(50.0), |at, _| Some(coord! { x: at.y, y: -at.x }));
    let corner = trace(&north, coord! { x: 50., y: 50. }, heading, &options).unwrap();
    assert_eq!((corner.points.len(), corner.length()), (1, 0.0));
    assert_eq!(corner.start_tangent(), coord! { x: 0., y: 0. });
    assert!(trace(&east, coord! { x: 51., y: 0. }, heading, &options).is_err());
    assert!(trace(&east, coord! { x: f64::NAN, y: 0. }, heading, &options).is_err());
    assert!(trace(
        &east,
        coord! { x: 0., y: 0. },
        coord! { x: 0., y: 0. },
        &options
    )
    .is_err());
    assert!(trace(
        &east,
        coord! { x: 0., y: 0. },
        heading,
        &TraceOptions {
            step: -1.0,
            ..options
        }
    )
    .is_err());
}
