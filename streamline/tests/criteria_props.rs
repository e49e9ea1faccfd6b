//! Laws of UrbanFab's six criteria.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, polygon, LineString, Polygon};
use proptest::prelude::*;
use streamline::{
    arm_nearest, candidates, criteria, from_fn, tiles, CandidateOptions, Criteria, CriteriaOptions,
    Criterion, Dangling, DirectionField, Singularity, Stop, Streamline, TileOptions, TraceError,
    TurnRule,
};
use support::*;

/// A line that nobody traced.
fn drawn(points: Vec<P>, stop: Stop) -> Streamline {
    Streamline {
        seed: points.first().copied().unwrap_or_default(),
        points,
        start: stop,
        end: stop,
        family: 0,
        seed_index: 0,
    }
}

fn at(x: f64, y: f64) -> P {
    coord! { x: x, y: y }
}

fn rectangle(width: f64, height: f64) -> Polygon<f64> {
    polygon![(x: 0., y: 0.), (x: width, y: 0.), (x: width, y: height), (x: 0., y: height)]
}

/// Cuts the land along the lines and judges both.
fn judge(
    field: &impl DirectionField,
    land: &Polygon<f64>,
    lines: &[Streamline],
    singularities: &[Singularity],
    options: &CriteriaOptions,
) -> Criteria {
    let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
    let cut = TileOptions {
        snap: options.snap,
        ..TileOptions::default()
    };
    let tiling = tiles(land, &strings, &cut).unwrap();
    criteria(field, land, lines, &tiling, singularities, options).unwrap()
}

/// Everything is a number, and in its range.
fn check_ranges(found: &Criteria) -> Result<(), TestCaseError> {
    let t = &found.totals;
    for (total, most) in [
        (&t.divergence, f64::MAX),
        (&t.continuity, f64::MAX),
        (&t.parallelism, 1.0 + 1e-12),
        (&t.perpendicularity, 1.0 + 1e-12),
    ] {
        for v in [total.sum, total.mean, total.line_mean, total.worst] {
            prop_assert!(v >= 0.0 && v.is_finite(), "{total:?}");
        }
        prop_assert!((0.0..=1.0).contains(&total.measured));
        prop_assert!(total.mean <= most && total.worst <= most && total.line_mean <= most);
        prop_assert!(total.mean <= total.worst * (1.0 + 1e-12));
        // Exact but for rounding: the mean is the sum over what was measured.
        let sum = total.mean * total.measured * t.length;
        prop_assert!(
            (sum - total.sum).abs() <= 1e-9 * total.sum.max(1e-3),
            "{total:?}"
        );
    }
    for tile in &found.tiles {
        prop_assert!((0.0..1.0).contains(&tile.convexity) && tile.area > 0.0);
    }
    let quantiles = t.convexity.quantiles;
    prop_assert!(quantiles.windows(2).all(|q| q[0] <= q[1]));
    prop_assert!(t.convexity.deviation.is_finite() && t.convexity.worst < 1.0);
    for line in &found.lines {
        let turns: usize = line.segments.iter().map(|s| s.turns).sum();
        prop_assert!(line.segments.is_empty() || turns == line.turns);
        let length: f64 = line.segments.iter().map(|s| s.piece.length).sum();
        prop_assert!((length - line.length).abs() <= 1e-9 * line.length);
    }
    Ok(())
}

/// Lines of a wavy cross, both families.
fn traced(field: &impl DirectionField) -> Vec<Streamline> {
    let seeds = lattice(field, 260.0, 30.0);
    let options = CandidateOptions {
        separation: 45.0,
        keep_closed: true,
        ..CandidateOptions::default()
    };
    candidates(field, &seeds, &options).unwrap()
}

proptest! {
    #![proptest_config(cases())]

    /// The best case: a rectangle, lines along its sides from side to side or
    /// from line to line. Zero to the last bit, wherever coordinates are exact.
    #[test]
    fn a_grid_in_a_rectangle_is_zero_in_all_six(
        (width, height) in (20.0..900.0_f64, 20.0..900.0_f64),
        across in prop::collection::vec(0.01..0.99_f64, 0..6),
        up in prop::collection::vec((0.01..0.99_f64, 0..6_usize, 0..6_usize), 0..6),
    ) {
        let land = rectangle(width, height);
        let mut ys = vec![0.0];
        ys.extend(across.iter().map(|t| t * height));
        ys.push(height);
        ys.sort_by(f64::total_cmp);
        ys.dedup_by(|a, b| (*a - *b).abs() < 0.01);
        let stop = Stop::Boundary { ring: 0, edge: 0 };
        let inner = &ys[1..ys.len() - 1];
        let mut lines: Vec<_> = inner
            .iter()
            .map(|&y| drawn(vec![at(0.0, y), at(width, y)], stop))
            .collect();
        for (t, i, j) in up {
            let (low, high) = (ys[i.min(j) % ys.len()], ys[i.max(j) % ys.len()]);
            if low < high {
                let x = t * width;
                lines.push(drawn(vec![at(x, low), at(x, high)], Stop::Junction { line: 0 }));
            }
        }
        let east = from_fn(land.clone(), |_, heading| Some(arm_nearest(0.0, heading)));
        let found = judge(&east, &land, &lines, &[], &CriteriaOptions::default());
        check_ranges(&found)?;
        for criterion in Criterion::ALL {
            prop_assert_eq!(criterion.of(&found.totals), 0.0, "{}", criterion.name());
        }
        prop_assert_eq!(found.totals.convexity.worst, 0.0);
        prop_assert_eq!(found.totals.parallelism.worst, 0.0);
        if !lines.is_empty() {
            // Every segment has a boundary to be compared with.
            prop_assert!(found.totals.parallelism.measured > 1.0 - 1e-12);
            prop_assert!(found.totals.continuity.measured > 0.0);
        }
        if inner.len() + 1 < ys.len() && !inner.is_empty() {
            prop_assert!(found.totals.perpendicularity.measured > 0.0);
        }
    }

    /// A grid along the sides of a parallelogram is as parallel and convex as
    /// can be, but its lines meet the boundary at its angle.
    #[test]
    fn a_skewed_grid_lacks_the_angle(
        degrees in 50.0..130.0_f64,
        (n, m) in (1..6_i32, 1..6_i32),
        motion in motion(),
    ) {
        let side = at(degrees.to_radians().cos(), degrees.to_radians().sin()) * 200.0;
        let base = at(300.0, 0.0);
        let corners = [at(0.0, 0.0), base, base + side, side];
        let moved: Vec<P> = corners.iter().map(|&p| motion.apply(p)).collect();
        let land = Polygon::new(LineString(moved), vec![]);
        let stop = Stop::Boundary { ring: 0, edge: 0 };
        let line = |from: P, way: P| {
            drawn(vec![motion.apply(from), motion.apply(from + way)], stop)
        };
        let share = |i: i32, n: i32| f64::from(i) / f64::from(n + 1);
        let lines: Vec<_> = (1..=n)
            .map(|i| line(side * share(i, n), base))
            .chain((1..=m).map(|i| line(base * share(i, m), side)))
            .collect();
        let steady = from_fn(land.clone(), |_, heading| Some(heading));
        let found = judge(&steady, &land, &lines, &[], &CriteriaOptions::default()).totals;
        // Coordinates up to 1e7 with 2e-9 of rounding on lines of 200 m.
        let angle = 1e-9;
        let wanted = (degrees - 90.0).abs() / 90.0;
        prop_assert!((found.perpendicularity.mean - wanted).abs() < angle);
        prop_assert!((found.perpendicularity.worst - wanted).abs() < angle);
        prop_assert!(found.parallelism.worst < angle);
        prop_assert!(found.parallelism.measured > 1.0 - 1e-9);
        prop_assert!(found.convexity.worst < 1e-9);
        prop_assert_eq!(found.convexity.count as i32, (n + 1) * (m + 1));
        prop_assert_eq!(found.continuity.sum, 0.0);
    }

    /// A grid askew in a rectangle: half of a line belongs to each of the edges
    /// that it touches, and no segment is farther off than the grid is.
    #[test]
    fn a_turned_grid_is_off_by_its_angle(
        degrees in 3.0..42.0_f64,
        offsets in prop::collection::vec(-0.9..0.9_f64, 1..9),
    ) {
        let land = rectangle(500.0, 300.0);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let centre = at(250.0, 150.0);
        let (part, rest) = (degrees / 90.0, 1.0 - degrees / 90.0);
        let mut lines = Vec::new();
        let mut wanted = Vec::new();
        for (k, offset) in offsets.iter().enumerate() {
            let way = if k % 2 == 0 { at(cos, sin) } else { at(-sin, cos) };
            let from = centre + at(-way.y, way.x) * (offset * 120.0);
            // Where it leaves: the nearer of the two walls ahead, which one of
            // its two parts of the deviation belongs to.
            let leave = |sign: f64| {
                let walls = [
                    ((if way.x * sign > 0.0 { 500.0 } else { 0.0 }) - from.x) / (way.x * sign),
                    ((if way.y * sign > 0.0 { 300.0 } else { 0.0 }) - from.y) / (way.y * sign),
                ];
                let upright = walls[0] < walls[1];
                // Flat lines meet upright walls squarely but for the angle.
                let off = if upright == (k % 2 == 0) { part } else { rest };
                (from + way * (sign * walls[0].min(walls[1])), off)
            };
            let ((a, off_a), (b, off_b)) = (leave(-1.0), leave(1.0));
            lines.push(drawn(vec![a, b], Stop::Boundary { ring: 0, edge: 0 }));
            wanted.push((off_a + off_b) / 2.0);
        }
        let askew = from_fn(land.clone(), move |_, heading| {
            Some(arm_nearest(degrees.to_radians(), heading))
        });
        let found = judge(&askew, &land, &lines, &[], &CriteriaOptions::default());
        check_ranges(&found)?;
        prop_assert!(found.totals.divergence.worst < 1e-9);
        for (line, wanted) in found.lines.iter().zip(wanted) {
            // Equal halves, shared out exactly but for the segment astride.
            let off = line.perpendicularity.unwrap();
            prop_assert!((off - wanted).abs() < 1e-9, "{off} {wanted}");
            for segment in &line.segments {
                if let Some(off) = segment.parallelism {
                    prop_assert!((part - 1e-9..=rest + 1e-9).contains(&off), "{off}");
                }
            }
        }
    }

    /// Place, rotation, mirroring and the direction of the lines change nothing,
    /// and scale changes units alone.
    #[test]
    fn motions_and_scale(
        land in domain(),
        waves in waves(),
        motion in motion(),
        factor in prop_oneof![Just(1.0), 0.1..10.0_f64],
        reverse in any::<bool>(),
    ) {
        let field = wavy(land.clone(), waves);
        let lines = traced(&field);
        let options = CriteriaOptions {
            // Smooth lines turn on a larger scale.
            region: 40.0,
            reach: Some(90.0),
            min_tile_area: 5.0,
            ..CriteriaOptions::default()
        };
        let plain = judge(&field, &land, &lines, &[], &options);
        check_ranges(&plain)?;
        let there = |p: P| motion.apply(p) * factor;
        let back = |p: P| motion.undo(p / factor);
        let ring = |line: &LineString<f64>| LineString(line.0.iter().map(|&p| there(p)).collect());
        let moved_land = Polygon::new(
            ring(land.exterior()),
            land.interiors().iter().map(ring).collect(),
        );
        let moved_field = from_fn(moved_land.clone(), |p, heading| {
            Some(motion.turn(arm_nearest(waves.angle(back(p)), motion.undo_turn(heading))))
        });
        let moved_lines: Vec<Streamline> = lines
            .iter()
            .map(|line| {
                let mut points: Vec<P> = line.points.iter().map(|&p| there(p)).collect();
                let (mut start, mut end) = (line.start, line.end);
                if reverse {
                    points.reverse();
                    (start, end) = (end, start);
                }
                Streamline { points, start, end, ..line.clone() }
            })
            .collect();
        let scaled = CriteriaOptions {
            step: options.step * factor,
            region: options.region * factor,
            reach: options.reach.map(|reach| reach * factor),
            snap: options.snap * factor,
            min_tile_area: options.min_tile_area * factor * factor,
            ..options
        };
        let moved = judge(&moved_field, &moved_land, &moved_lines, &[], &scaled);
        let (a, b) = (plain.totals, moved.totals);
        prop_assert_eq!(a.tiles, b.tiles);
        prop_assert_eq!(a.continuity.sum, b.continuity.sum);
        // Coordinates up to 1e8 have 1.5e-8 of rounding in 60 m or more of line;
        // differences of the field over 1e-5 of the size make 1e-5 of it.
        let near = |a: f64, b: f64, within: f64| (a - b).abs() < within;
        prop_assert!(near(a.divergence.mean, b.divergence.mean * factor, 1e-4), "{a:?} {b:?}");
        prop_assert!(near(a.continuity.mean, b.continuity.mean * factor, 1e-9));
        for (a, b) in [(a.parallelism, b.parallelism), (a.perpendicularity, b.perpendicularity)] {
            prop_assert!(near(a.mean, b.mean, 1e-4), "{a:?} {b:?}");
            prop_assert!(near(a.measured, b.measured, 1e-4), "{a:?} {b:?}");
        }
        prop_assert!(near(a.convexity.mean, b.convexity.mean, 1e-6));
        prop_assert!(near(a.convexity.deviation, b.convexity.deviation, 1e-6));
    }

    /// Rays and circles between two circles, as polygons of n sides.
    #[test]
    fn rays_and_circles(
        (inner, outer) in (20.0..60.0_f64, 90.0..200.0_f64),
        rays in 3..9_usize,
        shares in prop::collection::vec(0.1..0.9_f64, 1..4),
    ) {
        let n = 240;
        let round = |r: f64, n: usize| -> Vec<P> {
            let at_angle = |i: usize| {
                let (sin, cos) = (i as f64 * std::f64::consts::TAU / n as f64).sin_cos();
                at(cos, sin) * r
            };
            (0..=n).map(|i| at_angle(i % n)).collect()
        };
        let land = Polygon::new(LineString(round(outer, n)), vec![LineString(round(inner, n))]);
        let polar = from_fn(land.clone(), |p, heading| Some(arm_nearest(p.y.atan2(p.x), heading)));
        // Rays in the middles of sides, which they meet squarely.
        let flat = (std::f64::consts::PI / n as f64).cos();
        let stop = Stop::Boundary { ring: 0, edge: 0 };
        let mut lines: Vec<_> = (0..rays)
            .map(|k| {
                let side = k * (n / rays);
                let (sin, cos) = ((side as f64 + 0.5) * std::f64::consts::TAU / n as f64).sin_cos();
                drawn(vec![at(cos, sin) * (inner * flat), at(cos, sin) * (outer * flat)], stop)
            })
            .collect();
        let radii = shares.iter().map(|t| inner + t * (outer - inner));
        lines.extend(radii.map(|r| drawn(round(r, 720), Stop::ClosedLoop)));
        let options = CriteriaOptions { step: 0.25, ..CriteriaOptions::default() };
        let found = judge(&polar, &land, &lines, &[], &options);
        check_ranges(&found)?;
        // div = 1 / r along rays: its mean is ln(R / r) / (R - r), by the middle
        // rule with h = 0.25 to h^2 max |2 / r^3| / 24 < 1e-6.
        let (r0, r1) = (inner * flat, outer * flat);
        let mean = (r1 / r0).ln() / (r1 - r0);
        for ray in &found.lines[..rays] {
            prop_assert!((ray.divergence.unwrap() - mean).abs() < 2e-6);
            prop_assert!(ray.perpendicularity.unwrap() < 1e-9);
            prop_assert_eq!(ray.turns, 0);
            if let Some(off) = ray.parallelism {
                // Next to the boundary it is beside in no tile: all have four sides.
                prop_assert!(false, "{off}: the strips between circles go round");
            }
        }
        for circle in &found.lines[rays..] {
            // The tangents of a chord's ends are exact, its middle is off by
            // nothing: no divergence but what rounding makes of differences.
            prop_assert!(circle.divergence.unwrap() < 1e-6);
            prop_assert_eq!(circle.perpendicularity, None);
            prop_assert!((circle.turning - std::f64::consts::TAU).abs() < 1e-9);
            // 720 bends of half a degree: 4 m of the smallest circle, 28 m in
            // radius at least, hold under 9 degrees.
            prop_assert_eq!(circle.turns, 0);
        }
    }

    /// The hull of an L cuts its notch off.
    #[test]
    fn an_l_lacks_its_notch(
        (a, b) in (10.0..90.0_f64, 10.0..90.0_f64),
        (s, t) in (0.05..0.95_f64, 0.05..0.95_f64),
        motion in motion(),
    ) {
        let (c, d) = (s * a, t * b);
        let land = motion.polygon(&polygon![(x: 0., y: 0.), (x: a, y: 0.), (x: a, y: b - d), (x: a - c, y: b - d), (x: a - c, y: b), (x: 0., y: b)]);
        let still = from_fn(land.clone(), |_, heading| Some(heading));
        let found = judge(&still, &land, &[], &[], &CriteriaOptions::default());
        let wanted = (c + d - c.hypot(d)) / (2.0 * (a + b));
        // 2e-9 of rounding at map coordinates in a perimeter of over 40 m.
        prop_assert!((found.totals.convexity.mean - wanted).abs() < 1e-8);
        prop_assert_eq!(found.totals.convexity.count, 1);
        prop_assert_eq!(found.totals.parallelism.measured, 0.0);
    }

    /// One more kink where the line is straight adds one turn or none, by its
    /// angle; no other is lost.
    #[test]
    fn a_kink_never_lowers_continuity(
        steps in prop::collection::vec((0.1..9.0_f64, -50.0..50.0_f64), 1..30),
        place in 0..30_usize,
        kink in prop_oneof![-170.0..170.0_f64, -25.0..25.0_f64],
        region in 1.0..8.0_f64,
    ) {
        let place = place % steps.len();
        let options = CriteriaOptions { region, ..CriteriaOptions::default() };
        let turns = |kink: f64| {
            let (mut here, mut way) = (at(0.0, 0.0), 0.0_f64);
            let mut points = vec![here];
            for (i, &(length, turn)) in steps.iter().enumerate() {
                let straight = |here: P, way: f64, length: f64| {
                    here + at(way.to_radians().cos(), way.to_radians().sin()) * length
                };
                if i == place {
                    // Straight for more than a region to both sides.
                    here = straight(here, way, region + 1.0);
                    points.push(here);
                    way += kink;
                    here = straight(here, way, region + 1.0);
                    points.push(here);
                }
                here = straight(here, way, length);
                points.push(here);
                way += turn;
            }
            let land = rectangle(10.0, 10.0);
            let still = from_fn(land.clone(), |_, heading| Some(heading));
            let line = drawn(points, Stop::LengthLimit);
            judge(&still, &land, &[line], &[], &options).lines[0].turns
        };
        let (before, after) = (turns(0.0), turns(kink));
        let more = usize::from(kink.abs() > 20.0);
        prop_assume!((kink.abs() - 20.0).abs() > 1e-6);
        prop_assert_eq!(after, before + more);
    }

    /// Stretches are as many as any choice of disjoint ones can be: against all
    /// choices, by dynamic programming; and the same backwards.
    #[test]
    fn no_more_turns_can_be_found(
        steps in prop::collection::vec((0.1..6.0_f64, -40.0..40.0_f64), 2..14),
    ) {
        let (mut here, mut way) = (at(0.0, 0.0), 0.0_f64);
        let mut points = vec![here];
        for &(length, turn) in &steps {
            here = here + at(way.to_radians().cos(), way.to_radians().sin()) * length;
            points.push(here);
            way += turn;
        }
        // Bend i lies behind step i; the last step has none.
        let n = steps.len() - 1;
        let turns_within = |i: usize, j: usize| {
            let length: f64 = steps[i + 1..=j].iter().map(|s| s.0).sum();
            let angle: f64 = steps[i..=j].iter().map(|s| s.1).sum();
            length <= 4.0 && angle.abs() > 20.0
        };
        let mut most = vec![0; n + 1];
        for j in 0..n {
            most[j + 1] = most[j];
            for i in 0..=j {
                if turns_within(i, j) {
                    most[j + 1] = most[j + 1].max(most[i] + 1);
                }
            }
        }
        let land = rectangle(10.0, 10.0);
        let still = from_fn(land.clone(), |_, heading| Some(heading));
        let mut back = points.clone();
        back.reverse();
        let lines = [drawn(points, Stop::FieldEnd), drawn(back, Stop::FieldEnd)];
        let found = judge(&still, &land, &lines, &[], &CriteriaOptions::default());
        prop_assert_eq!(found.lines[0].turns, most[n]);
        prop_assert_eq!(found.lines[1].turns, most[n]);
    }

    /// Whatever the lines do: numbers in their ranges, and no panic.
    #[test]
    fn hostile_lines(
        lines in prop::collection::vec(
            (prop::collection::vec((-2..15_i32, -2..15_i32), 0..7), 0..5_usize),
            0..12,
        ),
        dangling in prop_oneof![Just(Dangling::Prune), Just(Dangling::Bridges), Just(Dangling::Keep)],
        signed in any::<bool>(),
        by in prop_oneof![Just(TurnRule::Stretches), Just(TurnRule::Segments)],
        step in prop_oneof![Just(0.3), Just(4.0), Just(1e4)],
        singular in prop::collection::vec(-4..5_i32, 0..4),
    ) {
        let square = |low: f64, high: f64| {
            LineString(vec![at(low, low), at(high, low), at(high, high), at(low, high), at(low, low)])
        };
        let land = Polygon::new(square(0.0, 12.0), vec![square(5.0, 7.0)]);
        let stops = [
            Stop::Boundary { ring: 9, edge: 99 },
            Stop::ClosedLoop,
            Stop::Junction { line: 77 },
            Stop::Singularity,
            Stop::LengthLimit,
        ];
        let lines: Vec<Streamline> = lines
            .into_iter()
            .map(|(points, stop)| {
                let points = points.into_iter().map(|(x, y)| at(f64::from(x), f64::from(y)));
                drawn(points.collect(), stops[stop])
            })
            .collect();
        let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
        let cut = TileOptions { dangling, ..TileOptions::default() };
        let tiling = tiles(&land, &strings, &cut).unwrap();
        // A field that has nowhere a direction in the west.
        let field = from_fn(land.clone(), |p, heading| (p.x > 6.0).then(|| arm_nearest(p.y / 9.0, heading)));
        let singular: Vec<_> = singular
            .into_iter()
            .map(|quarters| Singularity { at: at(f64::NAN, 1.0), quarters })
            .collect();
        let options = CriteriaOptions { signed, turns: by, step, ..CriteriaOptions::default() };
        let found = criteria(&field, &land, &lines, &tiling, &singular, &options).unwrap();
        check_ranges(&found)?;
        prop_assert_eq!(found.totals.singularities, singular.len());
        prop_assert_eq!(found.lines.len(), lines.len());
        // Fewer lines than the tiling knows of is an error, never a panic.
        let used = tiling.edges.iter().flat_map(|e| e.lines.iter().copied()).max();
        if let Some(last) = used {
            let fewer = criteria(&field, &land, &lines[..last], &tiling, &singular, &options);
            let named = matches!(fewer, Err(TraceError::BadTiling { what: "edge", .. }));
            prop_assert!(named, "{:?}", fewer);
        }
        // Two domains judged apart and joined: twice the sums, the same means.
        let twice = Criteria::joined([found.clone(), found.clone()], &options);
        prop_assert_eq!(twice.totals.singularities, 2 * found.totals.singularities);
        prop_assert_eq!(twice.tiles.len(), 2 * found.tiles.len());
        for criterion in Criterion::ALL {
            let (one, two) = (criterion.of(&found.totals), criterion.of(&twice.totals));
            prop_assert!((one - two).abs() <= 1e-12 * one.abs().max(1.0), "{}", criterion.name());
        }
    }
}

#[test]
fn signs_cancel_only_where_asked() {
    // Lines spread until x = 0 and narrow again behind it; in the middle the
    // absolute divergence is 1e-3 |x|, whose mean to 50 m is 0.025.
    let land = polygon![(x: -50., y: -20.), (x: 50., y: -20.), (x: 50., y: 20.), (x: -50., y: 20.)];
    let lens = from_fn(land.clone(), |p, _| Some(at(1.0, -1e-3 * p.x * p.y)));
    let line = drawn(
        vec![at(-50.0, 0.0), at(50.0, 0.0)],
        Stop::Boundary { ring: 0, edge: 0 },
    );
    let found = |signed| {
        let options = CriteriaOptions {
            signed,
            step: 5.0,
            ..CriteriaOptions::default()
        };
        judge(&lens, &land, std::slice::from_ref(&line), &[], &options)
    };
    assert!((found(false).totals.divergence.mean - 0.025).abs() < 1e-6);
    assert!(found(true).totals.divergence.mean < 1e-9);
    let segments = &found(true).lines[0].segments;
    assert!(segments.iter().all(|s| s.divergence.unwrap() >= 0.0));
}

#[test]
fn bad_input_is_named() {
    let land = rectangle(10.0, 10.0);
    let east = from_fn(land.clone(), |_, heading| Some(arm_nearest(0.0, heading)));
    let tiling = tiles(&land, &[], &TileOptions::default()).unwrap();
    let options = CriteriaOptions::default();
    let nan = drawn(vec![at(0.0, f64::NAN)], Stop::FieldEnd);
    assert!(matches!(
        criteria(&east, &land, &[nan], &tiling, &[], &options),
        Err(TraceError::LineNotFinite { index: 0, .. })
    ));
    let mut torn = land.clone();
    torn.exterior_mut(|ring| ring.0[2].x = f64::INFINITY);
    assert!(matches!(
        criteria(&east, &torn, &[], &tiling, &[], &options),
        Err(TraceError::DomainNotFinite { ring: 0, .. })
    ));
    let mut broken = tiling.clone();
    broken.edges.pop();
    assert!(matches!(
        criteria(&east, &land, &[], &broken, &[], &options),
        Err(TraceError::BadTiling {
            what: "tile",
            index: 0
        })
    ));
    let mut broken = tiling.clone();
    broken.vertices[1].x = f64::NAN;
    assert!(matches!(
        criteria(&east, &land, &[], &broken, &[], &options),
        Err(TraceError::BadTiling {
            what: "vertex",
            index: 1
        })
    ));
    let bad = CriteriaOptions {
        angle_deg: 180.0,
        ..options
    };
    assert!(matches!(
        criteria(&east, &land, &[], &tiling, &[], &bad),
        Err(TraceError::BadOption {
            name: "angle_deg",
            ..
        })
    ));
}
