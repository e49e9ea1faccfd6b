//! Laws of the search for networks.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::time::{Duration, Instant};

use common::{config, grid};
use network_opt::design::{
    cost, verify, EdgeState, Network, Pattern, PatternKind, Placement, Problem, Rooms, Route,
};
use network_opt::solve::{Ended, Limits, NetworkSolver, Outcome, Search};
use proptest::prelude::*;

/// Streets on a grid with everything that a problem may contain.
fn streets(columns: usize, rows: usize) -> impl Strategy<Value = Problem> {
    let mesh = grid(columns, rows);
    let (n, m) = (mesh.points().len(), mesh.edges().len());
    let ends = mesh.edges().to_vec();
    let state = prop_oneof![
        12 => Just(EdgeState::Open),
        1 => Just(EdgeState::Given),
        1 => Just(EdgeState::Required),
        1 => Just(EdgeState::Closed),
    ];
    let some = move |count: usize, most: usize| prop::collection::vec(0..count, 1..=most);
    let pattern = (
        prop::collection::vec(0..m, 0..=3),
        prop::collection::vec(0..m, 0..=2),
        prop_oneof![Just(None), (0.0..5.0).prop_map(Some)],
    )
        .prop_map(|(active, inactive, cost)| Pattern {
            kind: PatternKind::ZigZag,
            active,
            inactive,
            cost,
        });
    let route = (
        prop::collection::vec(some(m, 3), 1..3),
        prop_oneof![2 => Just(None), 1 => (0.0..5.0).prop_map(Some)],
    )
        .prop_map(|(paths, cost)| Route {
            cost,
            ..paths.into()
        });
    let routes = prop::collection::vec(route, 0..3);
    (
        prop::collection::vec(state, m),
        prop_oneof![Just(vec![1.0; m]), prop::collection::vec(0.5..2.0, m)],
        prop::collection::vec(prop::bool::weighted(0.3), n),
        prop::collection::vec(some(n, 4), 0..4),
        prop::collection::vec(0..n, 0..2),
        any::<bool>(),
        prop::collection::vec(pattern, 0..5),
        routes,
        prop_oneof![Just((1.0, 0.0)), Just((0.0, 1.0)), (0.1..3.0, 0.1..3.0)],
        0..n,
    )
        .prop_map(
            move |(
                states,
                lengths,
                mut sinks,
                coverage,
                required,
                dead_ends,
                patterns,
                routes,
                weights,
                sink,
            )| {
                sinks[sink] = true;
                Problem {
                    vertices: n,
                    ends: ends.clone(),
                    lengths,
                    states,
                    sinks,
                    coverage,
                    required_vertices: required,
                    dead_ends,
                    patterns,
                    routes,
                    rooms: None,
                    length_weight: weights.0,
                    travel_weight: weights.1,
                    ..Problem::default()
                }
            },
        )
}

/// The same with rooms of one, two or four squares.
fn floor() -> impl Strategy<Value = Problem> {
    let mesh = grid(2, 2);
    let mut shapes: Vec<Vec<usize>> = vec![vec![0, 1, 2, 3]];
    shapes.extend((0..4).map(|f| vec![f]));
    shapes.extend([vec![0, 1], vec![2, 3], vec![0, 2], vec![1, 3]]);
    shapes.extend([vec![0, 1, 2], vec![1, 2, 3]]);
    let placements: Vec<Placement> = (shapes.into_iter())
        .map(|faces| {
            let mut sides: Vec<usize> = faces
                .iter()
                .flat_map(|&f| mesh.edges_of(f))
                .copied()
                .collect();
            sides.sort_unstable();
            let twice = |e: &usize| sides.iter().filter(|k| *k == e).count() == 2;
            let mut inner: Vec<usize> = sides.iter().copied().filter(|e| twice(e)).collect();
            inner.dedup();
            let border = sides.iter().copied().filter(|e| !twice(e)).collect();
            Placement {
                template: "room".into(),
                faces,
                inner,
                border,
            }
        })
        .collect();
    let count = placements.len();
    (
        streets(2, 2),
        prop::collection::vec(prop::bool::weighted(0.8), count),
        prop::collection::vec(prop::bool::weighted(0.9), 4),
    )
        .prop_map(move |(mut problem, keep, covered)| {
            let placements = (placements.iter().zip(&keep))
                .filter(|(_, &keep)| keep)
                .map(|(p, _)| p.clone())
                .collect();
            problem.rooms = Some(Rooms {
                placements,
                covered,
                ..Rooms::default()
            });
            problem.coverage.clear();
            problem
        })
}

fn solve(problem: &Problem, moves: u64, seed: u64, start: Option<&Network>) -> Outcome {
    let search = Search { moves: Some(moves) };
    let limits = Limits {
        deadline: None,
        seed,
        ..Limits::default()
    };
    search
        .solve(problem, start, &limits, &mut |_| true)
        .unwrap()
}

/// All valid networks of a tiny problem: every set of edges, every tiling.
fn all_valid(problem: &Problem) -> Vec<(Network, f64)> {
    let mut tilings = vec![vec![]];
    if let Some(rooms) = &problem.rooms {
        tilings = (0..1_usize << rooms.placements.len())
            .map(|set| {
                (0..rooms.placements.len())
                    .filter(|k| set >> k & 1 == 1)
                    .collect()
            })
            .filter(|set: &Vec<usize>| {
                let mut counts = vec![0; rooms.covered.len()];
                for &f in set.iter().flat_map(|&k| &rooms.placements[k].faces) {
                    counts[f] += 1;
                }
                counts
                    .iter()
                    .zip(&rooms.covered)
                    .all(|(&n, &c)| n == usize::from(c))
            })
            .collect();
    }
    let mut found = Vec::new();
    for set in 0..1_usize << problem.edges() {
        let active: Vec<bool> = (0..problem.edges()).map(|e| set >> e & 1 == 1).collect();
        // Cheap tests first.
        let states = problem
            .states
            .iter()
            .zip(&active)
            .all(|(state, &on)| match state {
                EdgeState::Open => true,
                EdgeState::Given | EdgeState::Required => on,
                EdgeState::Closed => !on,
            });
        if !states {
            continue;
        }
        for rooms in &tilings {
            let network = Network {
                active: active.clone(),
                rooms: rooms.clone(),
                ..Network::default()
            };
            if verify(problem, &network).is_empty() {
                let cost = cost(problem, &active).objective;
                found.push((network, cost));
            }
        }
    }
    found
}

/// The search agrees with the list of all valid networks.
fn agrees(problem: &Problem, seed: u64) -> Result<(), TestCaseError> {
    let valid = all_valid(problem);
    let best = valid
        .iter()
        .map(|(_, cost)| *cost)
        .fold(f64::INFINITY, f64::min);
    let mut found = solve(problem, 20_000, seed, None);
    for more in 1..=3 {
        // Of a single valid network among thousands it may need several tries;
        // it is a search, and this law is about enough of it.
        if !(found.cost.objective > best * (1.0 + 1e-9)
            || found.network.is_none() && best.is_finite())
        {
            break;
        }
        found = solve(problem, 100_000, seed + 1000 * more, None);
    }
    match &found.network {
        None => prop_assert!(valid.is_empty(), "none found, of {}", valid.len()),
        Some(network) => {
            prop_assert_eq!(verify(problem, network), vec![]);
            prop_assert_eq!(found.cost, cost(problem, &network.active));
            // Sums of at most 12 lengths and 12 ways, in different orders.
            prop_assert!((found.cost.objective - best).abs() < 1e-9 * (1.0 + best));
        }
    }
    if found.ended == Ended::Infeasible {
        prop_assert!(valid.is_empty());
        prop_assert!(found.bound.is_infinite());
    }
    if best.is_finite() {
        prop_assert!(
            found.bound <= best * (1.0 + 1e-9),
            "bound {} of {best}",
            found.bound
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(24))]

    #[test]
    fn tiny_streets_are_solved_to_the_optimum(problem in streets(2, 2), seed in 0_u64..100) {
        agrees(&problem, seed)?;
    }

    #[test]
    fn tiny_floors_are_solved_to_the_optimum(problem in floor(), seed in 0_u64..100) {
        agrees(&problem, seed)?;
    }

    /// Problems as they come from specifications: patterns of the mesh, balls.
    #[test]
    fn the_bound_is_below_every_network(
        hops in 1_usize..3,
        given in any::<bool>(),
        dead_ends in any::<bool>(),
        close in any::<bool>(),
        weights in prop_oneof![Just((1.0, 0.0)), Just((0.0, 1.0)), Just((1.0, 1.0))],
        sinks in prop::collection::vec(prop::bool::weighted(0.1), 16),
        sink in 0_usize..16,
        seed in 0_u64..100,
    ) {
        // 24 edges are too many to list; so the search is what bounds are compared with.
        let mesh = grid(3, 3);
        let mut sinks = sinks;
        sinks[sink] = true;
        let problem = Problem {
            vertices: 16,
            ends: mesh.edges().to_vec(),
            lengths: vec![1.0; 24],
            states: mesh.rim().map(|rim| if rim && given { EdgeState::Given } else { EdgeState::Open }).collect(),
            sinks,
            coverage: (0..16).map(|v| mesh.ball(v, hops)).collect(),
            dead_ends,
            patterns: mesh.opposite_edges().into_iter().filter(|_| close && !given).map(|pair| Pattern {
                kind: PatternKind::TooClose,
                active: pair.to_vec(),
                inactive: vec![],
                cost: None,
            }).collect(),
            length_weight: weights.0,
            travel_weight: weights.1,
            ..Problem::default()
        };
        let found = solve(&problem, 5000, seed, None);
        if found.network.is_some() {
            prop_assert!(found.bound <= found.cost.objective * (1.0 + 1e-9));
        }
    }

    #[test]
    fn the_same_seed_gives_the_same(problem in streets(4, 3), seed in any::<u64>()) {
        let twice = [0, 1].map(|_| solve(&problem, 3000, seed, None));
        prop_assert_eq!(&twice[0].network, &twice[1].network);
        prop_assert_eq!(twice[0].cost, twice[1].cost);
        prop_assert_eq!(twice[0].bound, twice[1].bound);
        if let Some(network) = &twice[0].network {
            prop_assert_eq!(verify(&problem, network), vec![]);
        }
    }

    /// Numbering vertices and edges the other way round changes neither whether
    /// there is a network nor what the best one costs.
    #[test]
    fn names_do_not_matter(problem in streets(2, 2), seed in 0_u64..100) {
        let (n, m) = (problem.vertices - 1, problem.edges() - 1);
        let mut turned = problem.clone();
        turned.ends.reverse();
        turned.ends.iter_mut().flatten().for_each(|v| *v = n - *v);
        turned.lengths.reverse();
        turned.states.reverse();
        turned.sinks.reverse();
        turned.coverage.iter_mut().flatten().for_each(|v| *v = n - *v);
        turned.required_vertices.iter_mut().for_each(|v| *v = n - *v);
        for pattern in &mut turned.patterns {
            pattern.active.iter_mut().chain(&mut pattern.inactive).for_each(|e| *e = m - *e);
        }
        let paths = turned.routes.iter_mut().flat_map(|r| &mut r.paths);
        paths.flatten().for_each(|e| *e = m - *e);
        let [a, b] = [&problem, &turned].map(|p| solve(p, 20_000, seed, None));
        prop_assert_eq!(a.network.is_some(), b.network.is_some());
        // As above.
        let scale = 1.0 + a.cost.objective;
        prop_assert!((a.cost.objective - b.cost.objective).abs() < 1e-9 * scale);
    }

    #[test]
    fn a_start_is_never_made_worse(problem in streets(2, 2), pick in any::<prop::sample::Index>(), moves in 0_u64..300) {
        let valid = all_valid(&problem);
        prop_assume!(!valid.is_empty());
        let (start, cost) = &valid[pick.index(valid.len())];
        let found = solve(&problem, moves, 1, Some(start));
        prop_assert!(found.network.is_some());
        prop_assert!(found.cost.objective <= cost * (1.0 + 1e-12));
    }
}

/// A grid whose boundary is road and leads out, as in the paper's figure 2.
fn town(size: usize) -> Problem {
    let mesh = grid(size, size);
    let rim: Vec<bool> = mesh.rim().collect();
    let n = mesh.points().len();
    let mut sinks = vec![false; n];
    for (e, ends) in mesh.edges().iter().enumerate() {
        if rim[e] {
            ends.iter().for_each(|&v| sinks[v] = true);
        }
    }
    Problem {
        vertices: n,
        ends: mesh.edges().to_vec(),
        lengths: vec![1.0; mesh.edges().len()],
        states: (rim.iter())
            .map(|&r| if r { EdgeState::Given } else { EdgeState::Open })
            .collect(),
        sinks,
        coverage: (0..n).map(|v| mesh.ball(v, 2)).collect(),
        patterns: (mesh.opposite_edges().into_iter())
            .map(|pair| Pattern {
                kind: PatternKind::TooClose,
                active: pair.to_vec(),
                inactive: vec![],
                cost: None,
            })
            .filter(|p| !p.active.iter().all(|&e| rim[e]))
            .collect(),
        length_weight: 1.0,
        ..Problem::default()
    }
}

/// 19 is the optimum of the grid of 12 by 12, proven by integer programming
/// with a bound of 19.0; the bound by packing is below.
#[test]
fn the_town_of_figure_two_is_solved() {
    let found = solve(&town(12), 40_000, 0, None);
    assert_eq!(found.cost.length, 19.0);
    assert!(
        found.bound >= 15.0 && found.bound <= 19.0,
        "{}",
        found.bound
    );
}

#[test]
fn cancel_and_deadline_are_heard_with_the_best_so_far() {
    let problem = town(16);
    let began = Instant::now();
    let mut reports = 0;
    let found = Search::default()
        .solve(
            &problem,
            None,
            &Limits {
                threads: 2,
                ..Limits::default()
            },
            &mut |p| {
                reports += 1;
                p.best.is_none() || p.elapsed < Duration::from_millis(300)
            },
        )
        .unwrap();
    assert_eq!(found.ended, Ended::Cancelled);
    assert_eq!(verify(&problem, &found.network.unwrap()), []);
    // Reports are 20 ms apart; a busy machine may take its time.
    assert!(reports >= 3, "{reports}");
    // How soon is for benches; the search has ten seconds, and did not use them.
    assert!(began.elapsed() < Duration::from_secs(9));
    let limits = Limits {
        deadline: Some(Duration::from_millis(100)),
        ..Limits::default()
    };
    let found = Search::default()
        .solve(&problem, None, &limits, &mut |_| true)
        .unwrap();
    assert_eq!(found.ended, Ended::Deadline);
    assert!(found.first_feasible.unwrap() <= found.elapsed);
}

#[test]
fn threads_give_the_same_every_time_and_no_worse_than_one() {
    let problem = town(9);
    let search = Search { moves: Some(2000) };
    let run = |threads| {
        let limits = Limits {
            deadline: None,
            threads,
            ..Limits::default()
        };
        search
            .solve(&problem, None, &limits, &mut |_| true)
            .unwrap()
    };
    let [a, b, one] = [3, 3, 1].map(run);
    assert_eq!(a.network, b.network);
    assert!(a.cost.objective <= one.cost.objective);
}

#[test]
fn what_is_good_enough_ends_the_search() {
    // One sink, one place to be covered far from it along a line: the way there.
    let problem = Problem {
        vertices: 4,
        ends: vec![[0, 1], [1, 2], [2, 3]],
        lengths: vec![2.0; 3],
        states: vec![EdgeState::Open; 3],
        sinks: vec![true, false, false, false],
        coverage: vec![vec![3]],
        dead_ends: true,
        length_weight: 1.0,
        ..Problem::default()
    };
    let found = solve(&problem, 10_000, 0, None);
    assert_eq!(found.ended, Ended::Proven);
    assert_eq!((found.cost.objective, found.bound), (6.0, 6.0));
}

#[test]
fn contradictions_are_infeasible_and_bad_problems_errors() {
    let mut problem = town(4);
    problem.patterns.push(Pattern {
        kind: PatternKind::ZigZag,
        active: vec![problem
            .states
            .iter()
            .position(|s| *s == EdgeState::Given)
            .unwrap()],
        inactive: vec![],
        cost: None,
    });
    let found = solve(&problem, 100, 0, None);
    assert_eq!((found.ended, found.network), (Ended::Infeasible, None));
    problem.lengths.pop();
    let limits = Limits::default();
    assert!(Search::default()
        .solve(&problem, None, &limits, &mut |_| true)
        .is_err());
}
