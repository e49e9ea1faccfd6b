//! Laws of the edge-map tracer: lines that cannot cross flatly nor merge,
//! retracing, and agreement with closed forms and with Runge-Kutta.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::coord;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI};
use streamline::{
    survey_by, trace, CandidateOptions, EdgeLine, EdgeMaps, EdgeOptions, EdgeTracer, Seed, Stop,
    Streamline, TraceOptions, TriangleField,
};
use support::*;

/// Cells of a random mesh along one side, and half of that side in metres.
const CELLS: usize = 12;
const HALF: f64 = 200.0;

/// 1,000 fields in the long run.
fn fields() -> ProptestConfig {
    let short = cases();
    let cases = if short.cases > 100 { 1000 } else { 24 };
    ProptestConfig { cases, ..short }
}

/// A grid over a square, vertices shaken by up to .24 of a cell (cells stay convex), diagonals
/// either way, with or without a hole in the middle.
fn mesh(shake: &[(f64, f64)], flip: &[bool], hole: bool) -> (Vec<P>, Vec<[usize; 3]>) {
    let (side, cell) = (CELLS + 1, 2.0 * HALF / CELLS as f64);
    let points = (0..side * side)
        .map(|v| {
            let (i, j) = (v % side, v / side);
            let inner = |k: usize| {
                if k == 0 || k == CELLS {
                    0.0
                } else {
                    0.24 * cell
                }
            };
            coord! {
                x: -HALF + cell * i as f64 + inner(i) * shake[v].0,
                y: -HALF + cell * j as f64 + inner(j) * shake[v].1,
            }
        })
        .collect();
    let mut triangles = Vec::new();
    for (c, &flipped) in flip.iter().enumerate() {
        let (i, j) = (c % CELLS, c / CELLS);
        if hole && (5..7).contains(&i) && (4..6).contains(&j) {
            continue;
        }
        let (a, b) = (j * side + i, j * side + i + 1);
        let (d, e) = (a + side, b + side);
        triangles.extend(if flipped {
            [[a, b, d], [b, e, d]]
        } else {
            [[a, b, e], [a, e, d]]
        });
    }
    (points, triangles)
}

/// Singularities of a quarter turn either way over waves; or, one in five, a
/// vector at random at every vertex, which no field of a solver is as wild as.
fn field() -> impl Strategy<Value = TriangleField> {
    let vertices = (CELLS + 1) * (CELLS + 1);
    let shake = prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), vertices);
    let flip = prop::collection::vec(any::<bool>(), CELLS * CELLS);
    let singular = prop::collection::vec(
        (
            -1.1 * HALF..1.1 * HALF,
            -1.1 * HALF..1.1 * HALF,
            any::<bool>(),
        ),
        1..9,
    );
    let noise = prop::collection::vec(0.0..2.0 * PI, vertices);
    (
        shake,
        flip,
        any::<bool>(),
        singular,
        waves(),
        noise,
        0..5,
        motion(),
    )
        .prop_map(
            |(shake, flip, hole, singular, waves, noise, wild, motion)| {
                let (points, triangles) = mesh(&shake, &flip, hole);
                let vectors = points.iter().enumerate().map(|(i, &p)| {
                    let turns = singular.iter().map(|&(x, y, plus)| {
                        let turn = (p.y - y).atan2(p.x - x);
                        if plus {
                            turn
                        } else {
                            -turn
                        }
                    });
                    let angle = if wild == 0 {
                        noise[i]
                    } else {
                        4.0 * waves.angle(p) + turns.sum::<f64>()
                    };
                    coord! { x: angle.cos(), y: angle.sin() }
                });
                let vectors = vectors.collect();
                // Moved about, crosses left as they are: another random field.
                let points = points.iter().map(|&p| motion.apply(p)).collect();
                TriangleField::new(points, triangles, vectors).unwrap()
            },
        )
}

/// Lines from every seventh triangle in both families.
fn lines(field: &TriangleField, options: &EdgeOptions) -> Vec<EdgeLine> {
    let maps = EdgeMaps::new(field);
    let mut lines = Vec::new();
    for (k, corners) in field.triangles().iter().enumerate().step_by(7) {
        let [a, b, c] = corners.map(|v| field.points()[v]);
        let seed = a * 0.3 + b * 0.36 + c * 0.34;
        let along = coord! { x: (k as f64).cos(), y: (k as f64).sin() };
        for heading in [along, coord! { x: -along.y, y: along.x }] {
            lines.extend(maps.trace(seed, heading, options));
        }
    }
    lines
}

/// Angle between two lines, in [0, pi / 2].
fn slant(u: P, v: P) -> f64 {
    cross(u, v).abs().atan2(dot(u, v).abs())
}

/// Coordinates of the far corner of a map are rounded by 2e-9 m.
const BLUR: f64 = 2e-8;

/// How deep two segments cross: the least distance of an end from the other.
fn depth(s: &[P], t: &[P]) -> f64 {
    let off = |s: &[P], p: P| cross(s[1] - s[0], p - s[0]) / norm(s[1] - s[0]);
    let (a, b) = (off(s, t[0]), off(s, t[1]));
    let (c, d) = (off(t, s[0]), off(t, s[1]));
    if a * b < 0.0 && c * d < 0.0 {
        a.abs().min(b.abs()).min(c.abs()).min(d.abs())
    } else {
        0.0
    }
}

/// No two lines, nor one with itself, cross under 45 degrees.
fn keep_apart<'a>(lines: impl Iterator<Item = &'a Streamline>) -> Result<(), TestCaseError> {
    let mut pieces: Vec<&[P]> = lines.flat_map(|l| l.points.windows(2)).collect();
    pieces.retain(|s| norm(s[1] - s[0]) > 4.0 * BLUR);
    let low = |s: &[P]| s[0].x.min(s[1].x);
    pieces.sort_by(|s, t| low(s).total_cmp(&low(t)));
    for (i, s) in pieces.iter().enumerate() {
        let right = s[0].x.max(s[1].x);
        for t in pieces[i + 1..].iter().take_while(|t| low(t) <= right) {
            if depth(s, t) > BLUR {
                let angle = slant(s[1] - s[0], t[1] - t[0]);
                let rounding = BLUR / norm(s[1] - s[0]).min(norm(t[1] - t[0]));
                prop_assert!(
                    angle > FRAC_PI_4 - rounding,
                    "{} degrees: {s:?} {t:?}",
                    angle.to_degrees()
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(fields())]

    /// The law: no two lines, nor one with itself, cross under 45 degrees.
    #[test]
    fn no_flat_crossing(field in field(), approach in prop_oneof![Just(0.0), Just(4.5)]) {
        let options = EdgeOptions { max_length: 1500.0, self_approach: approach, loop_tolerance: 0.0, ..EdgeOptions::default() };
        let lines = lines(&field, &options);
        prop_assert!(lines.len() > 40, "{} lines", lines.len());
        keep_apart(lines.iter().map(|l| &l.line))?;
    }

    /// Candidates by the second tracer: the law holds between all of them, and
    /// each orientation of each seed is covered or accounted for.
    #[test]
    fn candidates_keep_apart_and_cover_the_seeds(field in field(), seed: u64) {
        let maps = EdgeMaps::new(&field);
        let tracer = EdgeTracer {
            maps: &maps,
            options: EdgeOptions { max_length: 1500.0, loop_tolerance: 0.0, ..EdgeOptions::default() },
        };
        let seeds: Vec<Seed> = field.triangles().iter().enumerate().step_by(5).map(|(k, corners)| {
            let [a, b, c] = corners.map(|v| field.points()[v]);
            let along = coord! { x: (k as f64).cos(), y: (k as f64).sin() };
            Seed {
                at: a * 0.3 + b * 0.36 + c * 0.34,
                directions: [along, coord! { x: -along.y, y: along.x }],
            }
        }).collect();
        let options = CandidateOptions {
            separation: 12.0,
            seed,
            keep_singular: true,
            keep_closed: true,
            ..CandidateOptions::default()
        };
        let all = survey_by(&tracer, &seeds, &options).unwrap();
        let aside = all.discarded.iter().filter_map(|d| d.line.as_ref());
        keep_apart(all.lines.iter().chain(aside))?;
        let placed: Vec<&Streamline> = all.lines.iter()
            .chain(all.discarded.iter().filter(|d| d.switches_off()).filter_map(|d| d.line.as_ref()))
            .collect();
        for (i, seed) in seeds.iter().enumerate() {
            for family in 0..2 {
                let own = all.lines.iter().any(|l| (l.seed_index, usize::from(l.family)) == (i, family))
                    || all.discarded.iter().any(|d| (d.seed_index, usize::from(d.family)) == (i, family));
                let near = placed.iter().any(|line| {
                    let (gap, tangent) = nearest_piece(line, seed.at);
                    let alike = seed.directions.map(|d| dot(d, tangent).abs());
                    gap <= 12.0 * (1.0 + 1e-9) && alike[family] >= alike[1 - family] * (1.0 - 1e-9)
                });
                prop_assert!(own || near, "seed {i}, orientation {family}");
            }
        }
    }

    /// Two pieces of one family between the same two edges are parallel: lines
    /// change neither their order nor their distance on the way, and what does
    /// not come nearer does not merge.
    #[test]
    fn no_merging(field in field()) {
        let options = EdgeOptions { max_length: 1500.0, self_approach: 0.0, loop_tolerance: 0.0, ..EdgeOptions::default() };
        let mut between: BTreeMap<[[usize; 2]; 2], Vec<(P, P)>> = BTreeMap::new();
        for EdgeLine { line, edges } in lines(&field, &options) {
            let stops = [line.start, line.end].iter().filter(|&&s| s == Stop::LengthLimit).count();
            // Without the seed, the points are those on edges, and the cut ends.
            let mut points: Vec<P> = line.points.iter().copied().filter(|&p| p != line.seed).collect();
            if line.start == Stop::LengthLimit {
                points.remove(0);
            }
            if points.len() + stops < edges.len() + usize::from(line.start == Stop::LengthLimit) {
                continue; // through a vertex, where points coincide
            }
            for (e, p) in edges.windows(2).zip(points.windows(2)) {
                let (key, pair) = if e[0] < e[1] { ([e[0], e[1]], (p[0], p[1])) } else { ([e[1], e[0]], (p[1], p[0])) };
                between.entry(key).or_default().push(pair);
            }
        }
        for pairs in between.values() {
            for (i, &(a, b)) in pairs.iter().enumerate() {
                for &(c, d) in &pairs[i + 1..] {
                    let (u, v) = (b - a, d - c);
                    let length = norm(u).min(norm(v));
                    if length > 1.0 && slant(u, v) < FRAC_PI_4 - 1e-3 {
                        let gaps = [cross(u, c - a) / norm(u), cross(u, d - a) / norm(u)];
                        prop_assert!((gaps[0] - gaps[1]).abs() < 4.0 * BLUR, "{gaps:?}");
                    }
                }
            }
        }
    }

    /// Lines run on across every edge: the pieces before and after it go along
    /// one arm of the cross at its ends. Were both sides to lead into an edge,
    /// lines would merge there, or turn back.
    #[test]
    fn no_turning_back(field in field()) {
        let options = EdgeOptions { max_length: 1500.0, self_approach: 0.0, loop_tolerance: 0.0, ..EdgeOptions::default() };
        for EdgeLine { line, edges } in lines(&field, &options) {
            let points: Vec<P> = line.points.iter().copied().filter(|&p| p != line.seed).collect();
            let first = usize::from(line.start == Stop::LengthLimit);
            if points.len() != edges.len() + first + usize::from(line.end == Stop::LengthLimit) {
                continue; // through a vertex, where points coincide
            }
            let inner = edges.iter().enumerate().take(edges.len() - 1).skip(1);
            for (i, ends) in inner {
                let p = &points[i + first - 1..=i + first + 1];
                let (before, after) = (p[1] - p[0], p[2] - p[1]);
                if norm(before) < 1e-3 || norm(after) < 1e-3 {
                    continue; // of no direction but rounding
                }
                for &v in ends.iter().filter(|&&v| v < field.points().len()) {
                    let angle = 0.25 * field.vectors()[v].y.atan2(field.vectors()[v].x);
                    let along = (0..4).map(|k| angle + k as f64 * PI / 2.0).any(|u| {
                        let arm = coord! { x: u.cos(), y: u.sin() };
                        dot(arm, before) > 0.0 && dot(arm, after) > 0.0
                    });
                    prop_assert!(along, "{p:?}");
                }
            }
        }
    }

    /// From any point of a line, either way, the line is the same.
    #[test]
    fn retracing_follows_the_same_edges(field in field(), part in 0.0..1.0_f64) {
        let options = EdgeOptions { max_length: 4000.0, self_approach: 0.0, loop_tolerance: 0.0, ..EdgeOptions::default() };
        // From one end of a line to the other may be twice a half of it.
        let longer = EdgeOptions { max_length: 2.1 * options.max_length, ..options };
        let maps = EdgeMaps::new(&field);
        for EdgeLine { line, edges } in lines(&field, &options) {
            // Where lines end by length or at their seed, the seed matters.
            let through = |s: Stop| s.is_boundary() || s == Stop::Singularity;
            if !(through(line.start) && through(line.end)) {
                continue;
            }
            let i = ((line.points.len() - 1) as f64 * part) as usize;
            let (p, q) = (line.points[i], line.points[i + 1]);
            // In a sliver near a vertex rounding decides where the middle lies.
            if norm(q - p) < 0.1 {
                continue;
            }
            let middle = p * 0.5 + q * 0.5;
            let again = maps.trace(middle, q - p, &longer).unwrap();
            prop_assert_eq!(&again.edges, &edges);
            prop_assert_eq!((again.line.start, again.line.end), (line.start, line.end));
            let mut back = maps.trace(middle, p - q, &longer).unwrap();
            back.edges.reverse();
            prop_assert_eq!(&back.edges, &edges);
            prop_assert_eq!((back.line.end, back.line.start), (line.start, line.end));
        }
    }

    /// Where no triangle is blocked, lines that end at a singularity do so
    /// within its radius, and others keep out of it.
    #[test]
    fn singular_ends_are_at_singular_points(field in field(), radius in prop_oneof![Just(0.005), 0.1..3.0_f64]) {
        let options = EdgeOptions { singular_radius: radius, ..EdgeOptions::default() };
        let maps = EdgeMaps::new(&field);
        let singular = maps.singular_points();
        let away = |p: P| singular.iter().map(|&s| norm(p - s)).fold(f64::INFINITY, f64::min);
        if maps.blocked() > 0 {
            return Ok(());
        }
        for EdgeLine { line, .. } in lines(&field, &options) {
            let last = line.points.len() - 1;
            for (stop, p) in [(line.start, line.points[0]), (line.end, line.points[last])] {
                prop_assert!(stop != Stop::Singularity || away(p) <= radius + BLUR);
            }
        }
    }

    /// Lines end on the border exactly, on the edge that their stop names.
    #[test]
    fn boundary_hits_are_exact(field in field()) {
        for EdgeLine { line, edges } in lines(&field, &EdgeOptions::default()) {
            let last = line.points.len() - 1;
            for (stop, p, edge) in [(line.start, line.points[0], edges.first()), (line.end, line.points[last], edges.last())] {
                if let Stop::Boundary { ring, edge: index } = stop {
                    let ring = &field.rings()[ring];
                    let (u, v) = (ring[index], ring[(index + 1) % ring.len()]);
                    prop_assert_eq!(edge, Some(&[u.min(v), u.max(v)]));
                    let off = to_segment(p, field.points()[u], field.points()[v]);
                    prop_assert!(off < BLUR, "{off}");
                }
            }
        }
    }
}

/// A regular grid of `cells` x `cells` over the square with the crosses of a
/// formula for the angle, less the cells near the origin.
fn sampled(cells: usize, clear: f64, angle: impl Fn(P) -> f64) -> TriangleField {
    let (side, cell) = (cells + 1, 2.0 * HALF / cells as f64);
    let at = |v: usize| coord! { x: -HALF + cell * (v % side) as f64, y: -HALF + cell * (v / side) as f64 };
    let mut triangles = Vec::new();
    for c in 0..cells * cells {
        let a = (c / cells) * side + c % cells;
        let middle = (at(a) + at(a + side + 1)) * 0.5;
        if norm(middle) > clear {
            triangles.extend([[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]);
        }
    }
    let points: Vec<P> = (0..side * side).map(at).collect();
    let vectors = points
        .iter()
        .map(|&p| coord! { x: (4.0 * angle(p)).cos(), y: (4.0 * angle(p)).sin() });
    let vectors = vectors.collect();
    TriangleField::new(points, triangles, vectors).unwrap()
}

/// Errors fall at least with the size of the triangles: lanes are the field's
/// direction in the middle, which differs from that along the line by less than
/// the triangle's size times the curvature. Measured: nearer to the square of
/// the size, since those differences change sign from edge to edge.
fn falls_with_the_first_power(errors: &[f64], sizes: f64, last: f64) {
    let end = errors[errors.len() - 1];
    assert!(errors[0] > sizes * end && end < last, "{errors:?}");
}

#[test]
fn circles_of_log_r_under_refinement() {
    let errors = [20, 40, 80, 160].map(|cells| {
        let field = sampled(cells, 60.0, |p| p.y.atan2(p.x));
        let maps = EdgeMaps::new(&field);
        assert_eq!(maps.blocked(), 0);
        let mut worst = 0.0_f64;
        for k in 0..20 {
            let radius = 90.0 + 4.1 * k as f64;
            // A round, half each way.
            let options = EdgeOptions {
                max_length: PI * radius,
                self_approach: 0.0,
                loop_tolerance: 0.0,
                ..EdgeOptions::default()
            };
            let (sin, cos) = (0.3 * k as f64).sin_cos();
            let seed = coord! { x: radius * cos, y: radius * sin };
            let heading = coord! { x: -sin, y: cos };
            let line = maps.trace(seed, heading, &options).unwrap().line;
            for &p in &line.points {
                worst = worst.max((norm(p) - radius).abs());
            }
        }
        worst
    });
    falls_with_the_first_power(&errors, 8.0, 0.1);
}

#[test]
fn circles_close_and_spirals_stop_alongside_themselves() {
    let seed = coord! { x: 130.0, y: 3.0 };
    let north = coord! { x: 0.0, y: 1.0 };
    let options = EdgeOptions {
        loop_tolerance: 1.0,
        ..EdgeOptions::default()
    };
    let circles = sampled(80, 60.0, |p| p.y.atan2(p.x));
    let line = EdgeMaps::new(&circles)
        .trace(seed, north, &options)
        .unwrap()
        .line;
    assert_eq!((line.start, line.end), (Stop::ClosedLoop, Stop::ClosedLoop));
    assert_eq!(line.points.first(), line.points.last());
    assert!((line.length() / (2.0 * PI * norm(seed)) - 1.0).abs() < 5e-3);
    // Outwards by exp(2 pi tan 0.005) - 1 = 3.2 % or 4.1 m a round, which is
    // below the approach of 4.5 m and above the loop's tolerance.
    let spirals = sampled(80, 60.0, |p| p.y.atan2(p.x) - 0.005);
    let line = EdgeMaps::new(&spirals)
        .trace(seed, north, &options)
        .unwrap()
        .line;
    assert_eq!(line.end, Stop::SelfApproach);
    let free = EdgeOptions {
        self_approach: 0.0,
        ..options
    };
    let line = EdgeMaps::new(&spirals)
        .trace(seed, north, &free)
        .unwrap()
        .line;
    assert!(line.start.is_boundary() && line.end.is_boundary());
}

#[test]
fn hyperbolas_under_refinement_as_by_runge_kutta() {
    let errors = [20, 40, 80, 160].map(|cells| {
        let field = sampled(cells, 0.0, |p| (-p.y).atan2(p.x));
        let maps = EdgeMaps::new(&field);
        let mut worst = [0.0_f64; 2];
        for k in 0..20 {
            let seed = coord! { x: 30.0 + 6.1 * k as f64, y: 150.0 - 6.3 * k as f64 };
            let heading = coord! { x: seed.x, y: -seed.y };
            let edge = maps
                .trace(seed, heading, &EdgeOptions::default())
                .unwrap()
                .line;
            let runge = trace(&field, seed, heading, &fine()).unwrap();
            assert!(edge.start.is_boundary() && edge.end.is_boundary());
            for &p in &edge.points {
                // Distance from x y = c to first order.
                let off = (p.x * p.y - seed.x * seed.y).abs() / norm(p);
                worst[0] = worst[0].max(off);
                worst[1] = worst[1].max(nearest_piece(&runge, p).0);
            }
        }
        worst
    });
    falls_with_the_first_power(&errors.map(|e| e[0]), 8.0, 0.05);
    falls_with_the_first_power(&errors.map(|e| e[1]), 8.0, 0.05);
}

/// Runge-Kutta with errors far below those of edge maps.
fn fine() -> TraceOptions {
    TraceOptions {
        tolerance: 1e-6,
        step: 1.0,
        ..TraceOptions::default()
    }
}

#[test]
fn refining_one_field_leads_to_its_runge_kutta_lines() {
    let wave = |p: P| 0.3 + (p.x / 90.0).sin() * 0.4 + (p.y / 70.0).cos() * 0.3;
    let mut field = sampled(10, 0.0, wave);
    let mut errors = Vec::new();
    for _ in 0..5 {
        let maps = EdgeMaps::new(&field);
        assert_eq!(maps.blocked(), 0);
        let mut worst = 0.0_f64;
        for k in 0..12 {
            let seed = coord! { x: -150.0 + 27.0 * k as f64, y: 120.0 - 21.0 * k as f64 };
            let heading = coord! { x: 1.0, y: 0.3 };
            let edge = maps
                .trace(seed, heading, &EdgeOptions::default())
                .unwrap()
                .line;
            let runge = trace(&field, seed, heading, &fine()).unwrap();
            let off = |&p: &P| nearest_piece(&runge, p).0;
            worst = edge.points.iter().map(off).fold(worst, f64::max);
        }
        errors.push(worst);
        field = field.refined();
    }
    falls_with_the_first_power(&errors, 16.0, 0.2);
}
