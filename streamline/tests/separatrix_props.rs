//! Laws of separatrices: arms of analytic crosses in closed form, motions, and
//! the blocks that they cut.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, polygon, Polygon};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use streamline::{
    arm_nearest, from_fn, separatrices, separatrix_arms, tiles, Dangling, DirectionField,
    Separatrix, SeparatrixEnd, SeparatrixOptions, Singularity, TileOptions, TraceError,
};
use support::*;

fn square(half: f64) -> Polygon<f64> {
    polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)]
}

/// A cross whose angle is a sum of multiples of the angles at which points are
/// seen, and a constant.
#[derive(Clone, Debug)]
struct Poles {
    base: f64,
    at: Vec<(P, i32)>,
}

impl Poles {
    fn angle(&self, p: P) -> f64 {
        let seen = |&(q, k): &(P, i32)| 0.25 * f64::from(k) * (p.y - q.y).atan2(p.x - q.x);
        self.base + self.at.iter().map(seen).sum::<f64>()
    }

    fn singularities(&self, motion: &Motion) -> Vec<Singularity> {
        // In a mirror both the cross and the way around turn the other way: the
        // index stays.
        self.at
            .iter()
            .map(|&(at, quarters)| Singularity {
                at: motion.apply(at),
                quarters,
            })
            .collect()
    }
}

fn field(poles: Poles, land: Polygon<f64>, motion: Motion) -> impl DirectionField {
    from_fn(motion.polygon(&land), move |at, heading| {
        let home = arm_nearest(poles.angle(motion.undo(at)), motion.undo_turn(heading));
        Some(motion.turn(home))
    })
}

fn still() -> Motion {
    Motion {
        angle: 0.0,
        mirror: false,
        shift: coord! { x: 0., y: 0. },
    }
}

/// One or two singularities of plus or minus a quarter, well apart.
fn poles() -> impl Strategy<Value = Poles> {
    let quarter = || prop_oneof![Just(-1), Just(1)];
    let at =
        |x: f64| (x - 25.0..x + 25.0, -50.0..50.0_f64).prop_map(|(x, y)| coord! { x: x, y: y });
    (
        0.0..FRAC_PI_2,
        (at(-40.0), quarter()),
        prop::option::of((at(40.0), quarter())),
    )
        .prop_map(|(base, a, b)| Poles {
            base,
            at: std::iter::once(a).chain(b).collect(),
        })
}

proptest! {
    #![proptest_config(cases())]

    /// The cross of z^(k/4): at angle u its angle is base + k u / 4, an arm
    /// points outwards where this is u modulo a quarter turn, so at
    /// (base + i pi / 2) / (1 - k / 4): 4 - k arms.
    #[test]
    fn arms_in_closed_form(k in -8..4_i32, base in 0.0..FRAC_PI_2, radius in 1e-3..50.0_f64, shift in prop_oneof![Just(0.0), Just(4e5)]) {
        let at = coord! { x: shift, y: -shift };
        let motion = Motion { shift: at, ..still() };
        let poles = Poles { base, at: vec![(coord! { x: 0., y: 0. }, k)] };
        let singularity = Singularity { at, quarters: k };
        let field = field(poles, square(100.0), motion);
        let found = separatrix_arms(&field, &singularity, radius).unwrap();
        let n = 4 - k;
        prop_assert_eq!(found.len(), singularity.arms());
        prop_assert_eq!(found.len() as i32, n);
        let mut exact: Vec<f64> = (0..n)
            .map(|i| ((base + f64::from(i) * FRAC_PI_2) / (1.0 - 0.25 * f64::from(k))).rem_euclid(TAU))
            .collect();
        exact.sort_by(f64::total_cmp);
        // Around east an angle of 0 may come last as 2 pi. Else: bisection to
        // 2^-50 of a step, coordinates rounded at 6e-11 (4e5), a few times.
        let bound = 1e-12 + 1e-9 * shift / 4e5 / radius;
        for e in exact {
            let off = found.iter().map(|f| {
                let d = (f - e).rem_euclid(TAU);
                d.min(TAU - d)
            }).fold(f64::INFINITY, f64::min);
            prop_assert!(off <= bound, "{e}: {off} > {bound}, {found:?}");
        }
    }

    /// The separatrices of z^(k/4) are straight rays to the boundary.
    #[test]
    fn rays_of_one_singularity(k in -4..4_i32, base in 0.0..FRAC_PI_2, motion in motion()) {
        let poles = Poles { base, at: vec![(coord! { x: 3., y: -7. }, k)] };
        let singular = poles.singularities(&motion);
        let lines = separatrices(&field(poles, square(80.0), motion), &singular, &SeparatrixOptions::default()).unwrap();
        prop_assert_eq!(lines.len() as i32, 4 - k);
        let mut ways: Vec<f64> = Vec::new();
        for line in &lines {
            prop_assert!(matches!(line.end, SeparatrixEnd::Stop(stop) if stop.is_boundary()), "{:?}", line.end);
            let (first, last) = (line.points[0], line.points[line.points.len() - 1]);
            prop_assert_eq!(first, singular[0].at);
            let way = last - first;
            ways.push(way.y.atan2(way.x));
            // Neighbours of a ray move away from it or towards it by at most
            // a power of the distance of 8, from 1e-9 to 1e-4 m at the far end
            // at map coordinates; the tracer's own errors are of that order.
            for &p in &line.points {
                prop_assert!((cross(p - first, way) / norm(way)).abs() < 0.01);
            }
        }
        // They divide the full turn evenly.
        ways.sort_by(f64::total_cmp);
        let gap = TAU / f64::from(4 - k);
        for pair in ways.windows(2) {
            prop_assert!((pair[1] - pair[0] - gap).abs() < 1e-3);
        }
    }

    /// Every block decomposition is a partition, its junctions lie on the lines
    /// that they name, and no tile has a loose end.
    #[test]
    fn blocks(poles in poles(), junctions in any::<bool>(), motion in motion()) {
        let land = motion.polygon(&square(120.0));
        let singular = poles.singularities(&motion);
        let options = SeparatrixOptions { junctions, ..SeparatrixOptions::default() };
        let lines = separatrices(&field(poles, square(120.0), motion), &singular, &options).unwrap();
        let arms: usize = singular.iter().map(Singularity::arms).sum();
        let shared = lines.iter().filter(|l| matches!(l.end, SeparatrixEnd::Singularity { .. })).count();
        prop_assert_eq!(lines.len() + shared, arms);
        for line in &lines {
            let last = line.points[line.points.len() - 1];
            match line.end {
                SeparatrixEnd::Junction { separatrix } => {
                    prop_assert!(junctions);
                    let on = &lines[separatrix].points;
                    let far = on.windows(2).map(|s| to_segment(last, s[0], s[1])).fold(f64::INFINITY, f64::min);
                    prop_assert!(far < 1e-6, "{far}");
                }
                SeparatrixEnd::Singularity { index, .. } => prop_assert_eq!(last, singular[index].at),
                SeparatrixEnd::Stop(_) => {}
            }
        }
        let strings: Vec<_> = lines.iter().map(Separatrix::to_line_string).collect();
        let tiling = tiles(&land, &strings, &TileOptions::default()).unwrap();
        let kept = tiles(&land, &strings, &TileOptions { dangling: Dangling::Keep, ..TileOptions::default() }).unwrap();
        let sum: f64 = tiling.tiles.iter().map(|t| t.area).sum();
        // Vertices move by 2e-9 m along 960 m of boundary, of 57600 m2.
        prop_assert!((sum - 57_600.0).abs() < 1e-5);
        let ended = lines.iter().all(|l| !matches!(l.end, SeparatrixEnd::Stop(stop) if !stop.is_boundary()));
        if ended {
            prop_assert_eq!(tiling.edges.len(), kept.edges.len(), "a loose end");
            prop_assert!(tiling.tiles.len() >= 3);
        }
    }

    /// Turned, mirrored and shifted, a field has its blocks turned, mirrored and
    /// shifted. A fixed field, none of whose meetings is close.
    #[test]
    fn blocks_move_with_the_field(motion in motion()) {
        let poles = Poles {
            base: 0.3,
            at: vec![(coord! { x: -45., y: 12. }, -1), (coord! { x: 38., y: -20. }, 1)],
        };
        let areas = |motion: Motion| {
            let lines = separatrices(
                &field(poles.clone(), square(120.0), motion),
                &poles.singularities(&motion),
                &SeparatrixOptions::default(),
            ).unwrap();
            let strings: Vec<_> = lines.iter().map(Separatrix::to_line_string).collect();
            let tiling = tiles(&motion.polygon(&square(120.0)), &strings, &TileOptions::default()).unwrap();
            let mut areas: Vec<f64> = tiling.tiles.iter().map(|t| t.area).collect();
            areas.sort_by(f64::total_cmp);
            areas
        };
        let (one, two) = (areas(still()), areas(motion));
        prop_assert_eq!(one.len(), two.len());
        for (a, b) in one.iter().zip(&two) {
            // Both trace the same curves with the same steps up to rounding; at
            // map coordinates a step may be chosen otherwise, and lines of up to
            // 300 m err by 0.01 m: 2 * 3 m2 for a tile with two of them.
            prop_assert!((a - b).abs() < 6.0, "{a} {b}");
        }
    }

    /// With T-junctions, lines share no inner point but their ends.
    #[test]
    fn junctions_leave_no_crossing(poles in poles()) {
        let singular = poles.singularities(&still());
        let lines = separatrices(&field(poles, square(120.0), still()), &singular, &SeparatrixOptions::default()).unwrap();
        for (i, a) in lines.iter().enumerate() {
            for b in &lines[i + 1..] {
                for s in a.points.windows(2) {
                    for t in b.points.windows(2) {
                        let side = |p: P, q: P, r: P| cross(q - p, r - p) / norm(q - p);
                        // By more than rounding on both sides.
                        let apart = |u: f64, v: f64| u * v < 0.0 && u.abs().min(v.abs()) > 1e-6;
                        prop_assert!(!(apart(side(s[0], s[1], t[0]), side(s[0], s[1], t[1]))
                            && apart(side(t[0], t[1], s[0]), side(t[0], t[1], s[1]))));
                    }
                }
            }
        }
    }
}

/// Two singularities on a common axis of symmetry: the separatrix between them
/// is that axis, and traced once.
#[test]
fn a_line_between_two_singularities_is_one() {
    let (a, b) = (coord! { x: -30., y: 0. }, coord! { x: 30., y: 0. });
    for (ka, kb) in [(1, 1), (-1, 1), (-1, -1), (1, -1)] {
        // East of a and west of b the angle is base + kb pi / 4: zero, modulo a
        // quarter turn, for this base.
        let poles = Poles {
            base: -0.5 * FRAC_PI_2 * f64::from(kb),
            at: vec![(a, ka), (b, kb)],
        };
        let singular = poles.singularities(&still());
        let lines = separatrices(
            &field(poles, square(100.0), still()),
            &singular,
            &SeparatrixOptions::default(),
        )
        .unwrap();
        let between: Vec<_> = lines
            .iter()
            .filter(|l| matches!(l.end, SeparatrixEnd::Singularity { index: 1, .. }))
            .collect();
        assert_eq!(between.len(), 1, "{ka} {kb}");
        assert!(between[0].points.iter().all(|p| p.y.abs() < 0.01));
        assert_eq!(lines.len() as i32, 8 - ka - kb - 1);
    }
}

#[test]
fn a_wrong_index_is_an_error() {
    let poles = Poles {
        base: 0.0,
        at: vec![(coord! { x: 0., y: 0. }, 1)],
    };
    let wrong = [Singularity {
        at: coord! { x: 0., y: 0. },
        quarters: -1,
    }];
    let field = field(poles, square(50.0), still());
    let options = SeparatrixOptions::default();
    assert_eq!(
        separatrices(&field, &wrong, &options),
        Err(TraceError::NoArms {
            index: 0,
            x: 0.0,
            y: 0.0,
            expected: 5,
            found: 3
        })
    );
    let outside = [Singularity {
        at: coord! { x: 900., y: 0. },
        quarters: 1,
    }];
    assert!(matches!(
        separatrices(&field, &outside, &options),
        Err(TraceError::NoArms { found: 0, .. })
    ));
    let bad = [Singularity {
        at: coord! { x: f64::NAN, y: 0. },
        quarters: 1,
    }];
    assert!(matches!(
        separatrices(&field, &bad, &options),
        Err(TraceError::SeedNotFinite { index: 0, .. })
    ));
    assert_eq!(separatrices(&field, &[], &options), Ok(vec![]));
}
