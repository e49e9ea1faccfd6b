//! Laws of even placement: lines keep apart, nothing is left out.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, polygon, Polygon, Rect};
use proptest::prelude::*;
use streamline::{
    arm_nearest, from_fn, lattice, place, place_scaled, Cursor, DirectionField, Ends,
    PlacementOptions, Seed, Stop, Strategy as Order, Streamline, TraceError, TraceOptions,
};
use support::*;

/// Every domain of [`domain`] lies in this square.
fn extent() -> Rect<f64> {
    Rect::new(coord! { x: -260., y: -260. }, coord! { x: 260., y: 260. })
}

fn options() -> impl Strategy<Value = PlacementOptions> {
    let separation = (14.0..45.0_f64, 14.0..45.0_f64).prop_map(|(a, b)| [a, b]);
    let strategy = prop_oneof![Just(Order::Neighbour), Just(Order::Farthest)];
    let widest = prop::option::of(1.5..2.0_f64);
    (separation, 0.4..0.95_f64, strategy, widest).prop_map(
        |(separation, test, strategy, widest)| PlacementOptions {
            separation,
            test,
            widest: widest.map(|factor| factor * test),
            strategy,
            ..PlacementOptions::default()
        },
    )
}

/// A smooth cross, or one with a singularity of a quarter turn either way.
#[derive(Clone, Copy, Debug)]
struct Cross {
    waves: Waves,
    centre: P,
    index: f64,
}

impl Cross {
    fn angle(&self, at: P) -> f64 {
        let off = at - self.centre;
        self.waves.angle(at) + 0.25 * self.index * off.y.atan2(off.x)
    }

    /// Where the field turns too fast for any law of distances: d_test there is
    /// not small against the radius at which the cross turns.
    fn wild(&self, at: P, reach: f64) -> bool {
        self.index != 0.0 && norm(at - self.centre) < reach
    }
}

fn crosses() -> impl Strategy<Value = Cross> {
    let index = prop_oneof![Just(0.0), Just(1.0), Just(-1.0)];
    (waves(), -80.0..80.0_f64, -80.0..80.0_f64, index).prop_map(|(waves, x, y, index)| Cross {
        waves,
        centre: coord! { x: x, y: y },
        index,
    })
}

fn field_of(domain: Polygon<f64>, cross: Cross) -> impl DirectionField {
    from_fn(domain, move |at, heading| {
        Some(arm_nearest(cross.angle(at), heading))
    })
}

/// Points of a line with the tangents there, at most 2 m apart, and arc length.
fn samples(line: &Streamline) -> Vec<(P, P, f64)> {
    let mut arc = 0.0;
    line.samples(2.0)
        .into_iter()
        .map(|s| {
            arc += s.length;
            (s.at, s.tangent, arc)
        })
        .collect()
}

/// The nearest that two lines, or a line and itself, come where they run within
/// 40 degrees of each other (5 to spare for what tangents of chords are worth).
fn nearest_alongside(lines: &[Streamline], own_gap: f64, skip: impl Fn(P) -> bool) -> f64 {
    let all: Vec<_> = lines.iter().map(samples).collect();
    let mut nearest = f64::INFINITY;
    for i in 0..all.len() {
        for j in 0..=i {
            for &(p, t, s) in &all[i] {
                if skip(p) {
                    continue;
                }
                for &(q, u, r) in &all[j] {
                    let d = norm(q - p);
                    if d >= nearest || cross(t, u).abs() >= 0.839 * dot(t, u).abs() {
                        continue;
                    }
                    if i == j {
                        let around = (s - r).abs();
                        let length = all[i].last().unwrap().2;
                        let around = if lines[i].is_closed() {
                            around.min(length - around)
                        } else {
                            around
                        };
                        // Its own next piece; and only abreast, as promised.
                        if around < own_gap || dot(q - p, u).abs() > 2.0 {
                            continue;
                        }
                    }
                    nearest = d;
                }
            }
        }
    }
    nearest
}

/// Distance from `p` to the nearest line that runs within 50 degrees of `along`.
fn nearest_line(lines: &[Streamline], p: P, along: P) -> f64 {
    lines
        .iter()
        .flat_map(|line| line.points.windows(2))
        .filter(|s| {
            let e = s[1] - s[0];
            cross(e, along).abs() < 1.2 * dot(e, along).abs()
        })
        .map(|s| to_segment(p, s[0], s[1]))
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(cases())]

    /// Lines keep d_test apart where they run alongside.
    #[test]
    fn lines_keep_apart(domain in domain(), cross in crosses(), options in options()) {
        let field = field_of(domain, cross);
        let seeds = lattice(&field, extent(), 10.0).unwrap();
        let lines = place(&field, &seeds, &options).unwrap();
        let wide = options.separation[0].max(options.separation[1]);
        let least = if cross.index == 0.0 { options.separation.map(|s| s * options.test) } else {
            let least = options.test * options.separation[0].min(options.separation[1]);
            [least; 2]
        };
        // Steps of 5 m: between two points the gap is smaller by up to
        // 25 / (8 d_test), on curves by 0.002 d_sep; samples 2 m apart see no
        // less than the true distance. The last piece at the boundary runs on
        // for up to 5 m untested, and what it runs beside turns from it by up
        // to |div| * gap * 5: waves of 80 m and height 0.7 twice reach
        // 0.11 / m, though rarely. Hence one metre, of 5.6 to 43.
        for family in 0..2 {
            let of: Vec<Streamline> = lines.iter().filter(|l| cross.index != 0.0 || l.family == family).cloned().collect();
            let least = least[usize::from(family)];
            let slack = 25.0 / (8.0 * least) + 0.002 * wide + 1.0;
            let nearest = nearest_alongside(&of, 3.2 * options.test * wide, |p| cross.wild(p, 1.5 * wide));
            prop_assert!(nearest >= least - slack, "family {family}: {nearest} of {least}");
        }
    }

    /// Of each orientation every seed has a line within the separation.
    #[test]
    fn nothing_is_left_out(domain in domain(), cross in crosses(), options in options()) {
        let field = field_of(domain, cross);
        let seeds = lattice(&field, extent(), 10.0).unwrap();
        let options = PlacementOptions { min_length: 0.0, ..options };
        let lines = place(&field, &seeds, &options).unwrap();
        let wide = options.separation[0].max(options.separation[1]);
        for seed in seeds.iter().filter(|seed| !cross.wild(seed.at, 1.5 * wide)) {
            for along in seed.directions {
                let nearest = nearest_line(&lines, seed.at, along);
                // Chords stand for curves to 0.002 d_sep.
                prop_assert!(nearest <= 1.003 * wide, "{nearest} of {wide} at {:?}", seed.at);
            }
        }
        // And so has, about, every other point: the lattice's squares have
        // half diagonals of 7.1 m.
    }

    /// Cut ends lie on points of other lines, and none is left in the open.
    #[test]
    fn ends_meet_other_lines(domain in domain(), cross in crosses(), options in options()) {
        let field = field_of(domain, cross);
        let seeds = lattice(&field, extent(), 10.0).unwrap();
        let open = place(&field, &seeds, &options).unwrap();
        let lines = place(&field, &seeds, &PlacementOptions { ends: Ends::Junction, ..options }).unwrap();
        prop_assert!(lines.len() <= open.len());
        for line in &lines {
            let n = line.points.len();
            prop_assert!(line.length() > 0.0 && line.points.contains(&line.seed));
            for (stop, end) in [(line.start, line.points[0]), (line.end, line.points[n - 1])] {
                match stop {
                    Stop::Junction { line: other } => {
                        prop_assert!(lines[other].points.contains(&end), "{end:?} is not on {other}");
                    }
                    Stop::Neighbour | Stop::SelfApproach | Stop::LengthLimit => {
                        return Err(TestCaseError::fail(format!("left in the open: {stop:?}")));
                    }
                    _ => {}
                }
            }
        }
    }

    /// The same placement elsewhere has as many lines of the same length, up to
    /// what rounding decides otherwise.
    #[test]
    fn the_same_input_gives_the_same_lines(domain in domain(), cross in crosses(), options in options()) {
        let field = field_of(domain, cross);
        let seeds = lattice(&field, extent(), 10.0).unwrap();
        let lines = place(&field, &seeds, &options).unwrap();
        prop_assert_eq!(&lines, &place(&field, &seeds, &options).unwrap());
        prop_assert_eq!(&lines, &place_scaled(&field, &seeds, &options, &|_| 1.0).unwrap());
        let one = PlacementOptions { families: [false, true], ..options };
        if cross.index == 0.0 {
            prop_assert!(place(&field, &seeds, &one).unwrap().iter().all(|line| line.family == 1));
        }
    }
}

fn square(half: f64) -> Polygon<f64> {
    polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)]
}

fn seeds_in(field: &impl DirectionField, half: f64, spacing: f64) -> Vec<Seed> {
    let corner = coord! { x: half, y: half };
    lattice(field, Rect::new(corner * -1.0, corner), spacing).unwrap()
}

#[test]
fn a_constant_cross_becomes_an_exact_grid() {
    // Turned by 30 degrees, so that no line follows the boundary.
    let field = from_fn(square(300.0), |_, heading| {
        Some(arm_nearest(0.5235987755982988, heading))
    });
    let seeds = seeds_in(&field, 300.0, 10.0);
    let options = PlacementOptions {
        separation: [30.0, 70.0],
        min_length: 0.0,
        ..PlacementOptions::default()
    };
    let lines = place(&field, &seeds, &options).unwrap();
    let (sin, cos) = 0.5235987755982988_f64.sin_cos();
    for family in 0..2_u8 {
        let normal = if family == 0 {
            coord! { x: -sin, y: cos }
        } else {
            coord! { x: cos, y: sin }
        };
        let mut offsets: Vec<f64> = lines
            .iter()
            .filter(|line| line.family == family)
            .map(|line| dot(line.points[0], normal))
            .collect();
        offsets.sort_by(f64::total_cmp);
        // The square is 2 * 300 * (cos 30 + sin 30) = 819.6 m across.
        let separation = options.separation[usize::from(family)];
        assert!((offsets.len() as f64 - 819.6 / separation).abs() <= 1.0);
        for pair in offsets.windows(2) {
            // Across, places are found to 0.001 separations.
            let gap = (pair[1] - pair[0]) / separation;
            assert!((gap - 1.0).abs() < 2e-3, "{gap}");
        }
    }
}

#[test]
fn concentric_circles_close_and_keep_their_distance() {
    let field = from_fn(square(200.0), |at, heading| {
        (norm(at) > 10.0).then(|| arm_nearest(at.y.atan2(at.x), heading))
    });
    let seeds = seeds_in(&field, 200.0, 10.0);
    let options = PlacementOptions {
        separation: [25.0, 25.0],
        ..PlacementOptions::default()
    };
    let lines = place(&field, &seeds, &options).unwrap();
    let mut radii: Vec<f64> = lines
        .iter()
        .filter(|line| line.is_closed())
        .map(|line| norm(line.points[0]))
        .collect();
    radii.sort_by(f64::total_cmp);
    assert!(radii.len() >= 6, "{radii:?}");
    for pair in radii.windows(2) {
        // Chords are 0.002 d_sep off.
        assert!((pair[1] - pair[0] - 25.0).abs() < 0.1, "{radii:?}");
    }
}

/// For each point of each line the distance to the nearest point of another
/// one, ascending, by looking at all of them within 45 m.
fn to_others(lines: &[Streamline]) -> Vec<f64> {
    let cell = |p: P| {
        (
            ((p.x + 500.0) / 45.0) as usize,
            ((p.y + 500.0) / 45.0) as usize,
        )
    };
    let mut cells = vec![vec![Vec::new(); 25]; 25];
    for (i, line) in lines.iter().enumerate() {
        for &p in &line.points {
            let (x, y) = cell(p);
            cells[x + 1][y + 1].push((i, p));
        }
    }
    let mut all = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        for &p in &line.points {
            let (x, y) = cell(p);
            let near = cells[x..=x + 2]
                .iter()
                .flat_map(|column| &column[y..=y + 2]);
            let others = near.flatten().filter(|other| other.0 != i);
            all.push(
                others
                    .map(|other| norm(other.1 - p))
                    .fold(f64::INFINITY, f64::min),
            );
        }
    }
    all.sort_by(f64::total_cmp);
    all
}

/// With `widest` of 1.5 times `test` nearly no point lacks a near neighbour,
/// even where the field spreads and gathers by a factor of two within 180 m.
#[test]
fn no_line_is_lonely() {
    for strength in [1.0, 0.25] {
        let field = from_fn(square(500.0), |at, _| {
            let wave = 0.5 * (at.x / 130.0 + at.y / 410.0).sin()
                + 0.4 * (at.y / 170.0 - at.x / 600.0).cos();
            let (sin, cos) = f64::sin_cos(0.3 + strength * wave);
            Some(coord! { x: cos, y: sin })
        });
        let seeds = seeds_in(&field, 500.0, 10.0);
        let options = PlacementOptions {
            separation: [20.0; 2],
            test: 0.86,
            families: [true, false],
            trace: TraceOptions {
                step: 1.0,
                ..PlacementOptions::default().trace
            },
            ..PlacementOptions::default()
        };
        let share = |options: &PlacementOptions| {
            let all = to_others(&place(&field, &seeds, options).unwrap());
            let count = all.len() as f64;
            (
                all[(0.01 * count) as usize] / 20.0,
                all.iter().filter(|&&d| d > 26.0).count() as f64 / count,
            )
        };
        let (near, far) = share(&options);
        assert!(
            near > 0.85 && far > 0.1,
            "strength {strength}: {near} {far}"
        );
        let (near, far) = share(&PlacementOptions {
            widest: Some(1.29),
            ..options
        });
        assert!(
            near > 0.85 && far < 0.01,
            "strength {strength}: {near} {far}"
        );
    }
}

#[test]
fn the_scale_sets_the_local_spacing() {
    let field = from_fn(square(400.0), |_, heading| Some(arm_nearest(0.0, heading)));
    let seeds = seeds_in(&field, 400.0, 5.0);
    // Lines to the north stand 10 m apart in the west and 40 m in the east.
    let scale = |at: P| 1.0 + 3.0 * ((at.x + 400.0) / 800.0).clamp(0.0, 1.0);
    let options = PlacementOptions {
        separation: [10.0, 10.0],
        families: [false, true],
        ..PlacementOptions::default()
    };
    let lines = place_scaled(&field, &seeds, &options, &scale).unwrap();
    let mut at: Vec<f64> = lines.iter().map(|line| line.points[0].x).collect();
    at.sort_by(f64::total_cmp);
    for pair in at.windows(2) {
        let gap =
            (pair[1] - pair[0]) / (10.0 * scale(coord! { x: (pair[0] + pair[1]) / 2.0, y: 0. }));
        // A last line may squeeze in between two sweeps.
        assert!((0.85..1.95).contains(&gap), "{gap}");
    }
    // The integral of dx / separation: 80/3 * ln 4.
    assert!(
        (lines.len() as f64 - 80.0 / 3.0 * 4.0_f64.ln()).abs() < 4.0,
        "{}",
        lines.len()
    );
}

#[test]
fn bad_input_is_refused() {
    let field = from_fn(square(50.0), |_, heading| Some(heading));
    let seeds = seeds_in(&field, 50.0, 10.0);
    let options = PlacementOptions::default();
    assert_eq!(place(&field, &[], &options), Ok(Vec::new()));
    let mut bad = seeds.clone();
    bad[3].at.x = f64::NAN;
    assert!(matches!(
        place(&field, &bad, &options),
        Err(TraceError::SeedNotFinite { index: 3, .. })
    ));
    let mut bad = seeds.clone();
    bad[4].directions[1] = coord! { x: 0., y: 0. };
    assert!(matches!(
        place(&field, &bad, &options),
        Err(TraceError::NoHeading { index: 4, .. })
    ));
    let scale = |at: P| if at.x > 0.0 { -1.0 } else { 1.0 };
    assert!(matches!(
        place_scaled(&field, &seeds, &options, &scale),
        Err(TraceError::BadScale { .. })
    ));
    // Seeds outside are passed over.
    let outside: Vec<Seed> = seeds
        .iter()
        .map(|s| Seed {
            at: s.at + coord! { x: 500., y: 0. },
            ..*s
        })
        .collect();
    assert_eq!(place(&field, &outside, &options), Ok(Vec::new()));
    assert!(field
        .direction(
            outside[0].at,
            outside[0].directions[0],
            &mut Cursor::default()
        )
        .is_none());
}
