//! What is promised of time: a watch's no and a deadline are kept by every
//! solver, whatever it is at, on meshes of any size.
//!
//! On a machine at rest an answer is promised 0.2 s after a no and 0.5 s after
//! a deadline. Tests may run beside others on machines that are slow, so what
//! they hold solvers to is [`SLACK`]; the seconds measured are printed (`--nocapture`).

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::time::{Duration, Instant};

use network_opt::design::{
    verify, EdgeState, Pattern, PatternKind, Placement, Problem, Rooms, Tessellation,
};
use network_opt::geo_types::coord;
use network_opt::mip::Microlp;
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver, Race, Search, Started, Windows};

/// Ten times what is promised of a deadline: a machine that does ten things at
/// once gives a solver a tenth of its time.
const SLACK: Duration = Duration::from_secs(5);

fn is_long() -> bool {
    std::env::var_os("URBAN_LAYOUT_LONG").is_some()
}

/// `n` by `n` squares, the boundary given and all of it sink; every place within
/// two steps of a street, no dead ends, opposite edges of a square excluded.
fn streets(n: usize, travel_weight: f64) -> Problem {
    let wide = n + 1;
    let points = (0..wide * wide)
        .map(|k| coord! { x: (k % wide) as f64, y: (k / wide) as f64 })
        .collect();
    let corners = (0..n * n).map(|k| k / n * wide + k % n);
    let faces = corners.map(|a| vec![a, a + 1, a + wide + 1, a + wide]);
    let mesh = Tessellation::new(points, faces.collect()).unwrap();
    let rim: Vec<bool> = mesh.rim().collect();
    let mut sinks = vec![false; wide * wide];
    for (ends, _) in mesh.edges().iter().zip(&rim).filter(|(_, &rim)| rim) {
        ends.iter().for_each(|&v| sinks[v] = true);
    }
    let state = |&rim: &bool| match rim {
        true => EdgeState::Given,
        false => EdgeState::Open,
    };
    let close = mesh.opposite_edges().into_iter().map(|pair| Pattern {
        kind: PatternKind::TooClose,
        active: pair.to_vec(),
        inactive: vec![],
        cost: None,
    });
    Problem {
        vertices: wide * wide,
        ends: mesh.edges().to_vec(),
        lengths: vec![1.0; mesh.edges().len()],
        states: rim.iter().map(state).collect(),
        sinks,
        coverage: (0..wide * wide).map(|v| mesh.ball(v, 2)).collect(),
        patterns: close.collect(),
        length_weight: 1.0,
        travel_weight,
        ..Problem::default()
    }
}

/// A floor of `n` by `n` squares with one entrance, for rooms of two by two and
/// of one by two squares.
fn floor(n: usize) -> Problem {
    let mut problem = streets(n, 0.0);
    let wide = n + 1;
    let edge = |a: usize, b: usize| {
        let ends = [a.min(b), a.max(b)];
        let mut found = problem.ends.iter();
        found.position(|e| [e[0].min(e[1]), e[0].max(e[1])] == ends)
    };
    let square = |f: usize| {
        let a = f / n * wide + f % n;
        let b = a + wide;
        [
            edge(a, a + 1),
            edge(a + 1, b + 1),
            edge(b, b + 1),
            edge(a, b),
        ]
        .map(|e| e.unwrap())
    };
    let squares: Vec<[usize; 4]> = (0..n * n).map(square).collect();
    let place = |template: &str, faces: Vec<usize>| {
        let all: Vec<usize> = faces.iter().flat_map(|&f| squares[f]).collect();
        let often = |e: usize| all.iter().filter(|&&k| k == e).count();
        let mut inner: Vec<usize> = all.iter().copied().filter(|&e| often(e) == 2).collect();
        inner.sort_unstable();
        inner.dedup();
        Placement {
            template: template.into(),
            border: all.iter().copied().filter(|&e| often(e) == 1).collect(),
            faces,
            inner,
        }
    };
    let mut placements = Vec::new();
    for f in 0..n * n {
        let (right, up) = (f % n + 1 < n, f / n + 1 < n);
        if right {
            placements.push(place("two", vec![f, f + 1]));
        }
        if right && up {
            placements.push(place("four", vec![f, f + 1, f + n, f + n + 1]));
        }
    }
    problem.rooms = Some(Rooms {
        placements,
        covered: vec![true; n * n],
        ..Rooms::default()
    });
    problem.coverage.clear();
    problem.states.fill(EdgeState::Open);
    problem.sinks.fill(false);
    problem.sinks[n / 2] = true;
    problem
}

/// All solvers, by name.
fn solvers() -> Vec<(&'static str, Box<dyn NetworkSolver>)> {
    #[cfg_attr(not(feature = "highs"), allow(unused_mut, reason = "added to below"))]
    let mut all: Vec<(&'static str, Box<dyn NetworkSolver>)> = vec![
        ("search", Box::new(Search::default())),
        ("exact microlp", Box::new(Exact::new(Microlp))),
        ("windows microlp", Box::new(Windows::new(Microlp))),
        ("race microlp", Box::new(Race::new(Microlp))),
        (
            "search, then exact microlp",
            Box::new(Started::new(Exact::new(Microlp))),
        ),
    ];
    #[cfg(feature = "highs")]
    {
        use network_opt::mip::Highs;
        all.push(("exact highs", Box::new(Exact::new(Highs))));
        all.push(("windows highs", Box::new(Windows::new(Highs))));
        all.push(("race highs", Box::new(Race::new(Highs))));
        all.push((
            "search, then race highs",
            Box::new(Started::new(Race::new(Highs))),
        ));
    }
    all
}

/// Every solver on one problem: a deadline, and a no after that long.
fn keeps_time(name: &str, problem: &Problem, time: Duration) {
    for (solver, solve) in solvers() {
        for threads in [1, 2] {
            let limits = Limits {
                deadline: Some(time),
                threads,
                ..Limits::default()
            };
            let began = Instant::now();
            let found = solve.solve(problem, None, &limits, &mut |_| true).unwrap();
            let late = began.elapsed().saturating_sub(time);
            println!("{name}, {solver}, {threads} threads: {late:.2?} after a deadline");
            assert!(late < SLACK, "{name}, {solver}: {late:?} late");
            if let Some(network) = &found.network {
                assert_eq!(verify(problem, network), []);
            }

            let (began, mut told) = (Instant::now(), None);
            let endless = Limits {
                deadline: None,
                threads,
                ..Limits::default()
            };
            let mut best = None;
            let found = solve
                .solve(problem, None, &endless, &mut |progress| {
                    best = progress.best.map(|(network, _)| network.clone());
                    let go_on = began.elapsed() < time;
                    if !go_on {
                        told.get_or_insert_with(Instant::now);
                    }
                    go_on
                })
                .unwrap();
            // Counted from when the no was due: a watch that is not asked is late.
            let late = began.elapsed().saturating_sub(time);
            println!("{name}, {solver}, {threads} threads: {late:.2?} after a no");
            assert!(late < SLACK, "{name}, {solver}: {late:?} late");
            if told.is_some() {
                assert_eq!(found.ended, Ended::Cancelled, "{name}, {solver}");
            }
            // The best network that was told of is not lost.
            assert!(
                best.is_none() || found.network.is_some(),
                "{name}, {solver}"
            );
        }
    }
}

#[test]
fn deadlines_are_kept_on_small_meshes() {
    keeps_time("streets of 4", &streets(4, 1.0), Duration::from_millis(60));
}

/// Long, because each of the solvers takes its seconds.
#[test]
fn deadlines_are_kept_on_large_meshes() {
    if !is_long() {
        return;
    }
    let time = Duration::from_millis(700);
    keeps_time("streets of 40", &streets(40, 0.0), time);
    keeps_time("streets of 40 with travel", &streets(40, 1.0), time);
    keeps_time("ties of 40", &streets(40, 0.001), time);
    keeps_time("floor of 24", &floor(24), time);
    keeps_time("no time", &streets(12, 1.0), Duration::ZERO);
}
