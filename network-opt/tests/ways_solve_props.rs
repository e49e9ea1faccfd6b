//! Solvers of one-way streets: the search, windows and races against trying all
//! networks with all directions, and problems that are solved by hand.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::time::Duration;

use common::config;
use common::programs::CLOSE;
use common::ways::{all_valid, best, recipe};
use network_opt::design::{cost, verify, EdgeState, Problem, Way};
use network_opt::mip::Microlp;
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver, Race, Search, Windows};
use proptest::prelude::*;

proptest! {
    #![proptest_config(config(30))]

    /// What the search reports is valid, no better than the best, and on meshes as
    /// small as these the best; its bound is one.
    #[test]
    fn the_search_keeps_directions(recipe in recipe(), seed in 0_u64..1000) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let least = best(&problem, &valid);
        let mut objective = f64::INFINITY;
        for more in 0..3 {
            let limits = Limits { deadline: None, seed: seed + 1000 * more, ..Limits::default() };
            let search = Search { moves: Some(20_000) };
            let found = search.solve(&problem, None, &limits, &mut |_| true).unwrap();
            if let Some(network) = &found.network {
                prop_assert_eq!(verify(&problem, network), vec![]);
                prop_assert_eq!(found.cost, cost(&problem, network));
                objective = objective.min(found.cost.objective);
            }
            if found.ended == Ended::Infeasible {
                prop_assert!(valid.is_empty());
            } else {
                prop_assert!(found.bound <= least + 1e-6, "{} over {least}", found.bound);
            }
            // It is a search, and this law is about enough of it.
            if objective <= least + 1e-6 || valid.is_empty() {
                break;
            }
        }
        prop_assert!(objective <= least + 1e-6, "{objective} for {least}");
    }

    /// Windows and races too end with what is best, from any start.
    #[test]
    fn windows_and_races_know_directions(recipe in recipe(), start in any::<prop::sample::Index>()) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        prop_assume!(!valid.is_empty());
        let least = best(&problem, &valid);
        let start = &valid[start.index(valid.len())];
        let limits = Limits { deadline: Some(Duration::from_secs(60)), ..Limits::default() };
        let windows = Windows { size: 4, ..Windows::new(Microlp) };
        let found = windows.solve(&problem, Some(start), &limits, &mut |_| true).unwrap();
        prop_assert!((found.cost.objective - least).abs() < CLOSE);
        prop_assert_eq!(verify(&problem, &found.network.unwrap()), vec![]);
        let found = Race::new(Microlp).solve(&problem, None, &limits, &mut |_| true).unwrap();
        prop_assert!((found.cost.objective - least).abs() < CLOSE);
        prop_assert_eq!(verify(&problem, &found.network.unwrap()), vec![]);
    }
}

/// A street to a block and one way around it, from a single sink: both ways
/// round are as good, and the street alone is no answer.
#[test]
fn a_block_is_driven_around() {
    let mut problem = Problem {
        vertices: 5,
        ends: vec![[0, 1], [1, 2], [2, 3], [3, 4], [4, 1]],
        lengths: vec![1.0; 5],
        states: vec![EdgeState::Open; 5],
        sinks: (0..5).map(|v| v == 0).collect(),
        required_vertices: vec![3],
        dead_ends: true,
        ways: vec![
            Way::Both,
            Way::Either,
            Way::Either,
            Way::Either,
            Way::Either,
        ],
        length_weight: 1.0,
        travel_weight: 1.0,
        ..Problem::default()
    };
    let limits = Limits::default();
    let found = Exact::new(Microlp)
        .solve(&problem, None, &limits, &mut |_| true)
        .unwrap();
    // Length 5. Around the block out 4, 3, 2, 1 from the heads, in 1 to 4 to the
    // tails: a mean of 2.5 each.
    assert_eq!((found.cost.length, found.cost.travel), (5.0, 10.0));
    let ways = found.network.unwrap().ways;
    assert!(ways == problem_ways(Way::Forward) || ways == problem_ways(Way::Backward));
    // The street to the block too must not be one-way.
    problem.ways[0] = Way::Either;
    let found = Exact::new(Microlp)
        .solve(&problem, None, &limits, &mut |_| true)
        .unwrap();
    assert_eq!((found.network, found.ended), (None, Ended::Infeasible));
}

/// Between two vertices: one street has to be two-way, two may be one-way, and
/// nothing is wrong with no edge at all.
#[test]
fn the_least_problems_are_solved() {
    let street = |count: usize| Problem {
        vertices: 2,
        ends: vec![[0, 1]; count],
        lengths: vec![1.0; count],
        states: vec![EdgeState::Open; count],
        sinks: vec![true, false],
        required_vertices: vec![1],
        dead_ends: true,
        ways: vec![Way::Either; count],
        length_weight: 1.0,
        travel_weight: 1.0,
        ..Problem::default()
    };
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let search = Search { moves: Some(2000) };
    for solver in [&Exact::new(Microlp) as &dyn NetworkSolver, &search] {
        let solve =
            |problem: &Problem| solver.solve(problem, None, &limits, &mut |_| true).unwrap();
        assert_eq!(solve(&street(0)).network, None);
        assert_eq!(solve(&street(1)).network, None);
        let two = solve(&street(2));
        // One leads out from a way of 1, the other comes back to one.
        assert_eq!((two.cost.length, two.cost.travel), (2.0, 0.5 + 0.5));
        let ways = two.network.unwrap().ways;
        assert_eq!(ways[0], ways[1].reversed());
        let empty = Problem {
            required_vertices: vec![],
            ..street(2)
        };
        let found = solve(&empty);
        assert_eq!((found.cost.objective, found.ended), (0.0, Ended::Proven));
        assert_eq!(found.network.unwrap().ways, [Way::Either; 2]);
    }
}

fn problem_ways(around: Way) -> Vec<Way> {
    [vec![Way::Both], vec![around; 4]].concat()
}
