//! Laws of optima: programs and the exact solver find the best of all networks,
//! and what must not change it does not.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::brute::{all_valid, open_edges, other_numbers, renamed};
use common::forever;
use common::programs::{agrees, solved, solved_by, CLOSE};
use common::recipe::{config, pattern, recipe, Recipe};
use network_opt::design::{cost, cost_of, EdgeState, Network, PatternKind, Problem};
use network_opt::formulate::Cuts;
use network_opt::mip::{Microlp, MipSolver};
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver, Race};
use proptest::prelude::*;

/// Solves from the worst valid network on, in steps whatever the size, and looks at
/// every bound and every network on the way.
fn in_steps(problem: &Problem, solver: impl MipSolver) -> Result<(), TestCaseError> {
    let exact = Exact {
        climbs_from: 0,
        ..Exact::new(solver)
    };
    ends_at_the_optimum(problem, &exact, &forever(), true)
}

/// Solves with two threads, in steps and without, from the worst valid network on
/// and from none.
fn side_by_side(
    problem: &Problem,
    solver: impl MipSolver + Copy + Sync,
) -> Result<(), TestCaseError> {
    let limits = Limits {
        threads: 2,
        ..forever()
    };
    for (climbs_from, starts) in [(0, true), (0, false), (1000, true)] {
        let mut race = Race::new(solver);
        race.exact.climbs_from = climbs_from;
        // The second thread has something else to do.
        race.search.moves = Some(20);
        ends_at_the_optimum(problem, &race, &limits, starts)?;
    }
    Ok(())
}

/// Every other one with travel that only decides between networks of one length.
fn recipe_with_ties() -> impl Strategy<Value = Recipe> {
    (recipe(), any::<bool>()).prop_map(|(mut recipe, breaks_ties)| {
        if breaks_ties {
            recipe.weights.1 = 2;
        }
        recipe
    })
}

fn ends_at_the_optimum(
    problem: &Problem,
    solver: &impl NetworkSolver,
    limits: &Limits,
    starts: bool,
) -> Result<(), TestCaseError> {
    let valid = all_valid(problem);
    let price = |network: &Network| cost_of(problem, network).objective;
    let worst = valid.iter().max_by(|a, b| price(a).total_cmp(&price(b)));
    let least = valid.iter().map(price).min_by(f64::total_cmp);
    let mut bounds = vec![];
    let start = worst.filter(|_| starts);
    let found = solver
        .solve(problem, start, limits, &mut |progress| {
            bounds.push(progress.bound);
            true
        })
        .unwrap();
    let Some(least) = least else {
        prop_assert_eq!(found.ended, Ended::Infeasible);
        return Ok(());
    };
    prop_assert_eq!(found.ended, Ended::Proven);
    prop_assert!(
        (found.cost.objective - least).abs() < CLOSE,
        "{found:?} for {least}"
    );
    prop_assert!(
        bounds.iter().all(|&bound| bound <= least + CLOSE),
        "{bounds:?} for {least}"
    );
    // But for rounding.
    let falls = |pair: &[f64]| pair[1] < pair[0] - CLOSE;
    prop_assert!(!bounds.windows(2).any(falls), "{bounds:?}");
    Ok(())
}

proptest! {
    #![proptest_config(config(12))]

    /// Every program has the optimum that trying all networks has, and a
    /// network exactly where there is one.
    #[test]
    fn programs_agree_with_trying_all(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        agrees(&problem, &Microlp)?;
    }
}

#[cfg(feature = "highs")]
proptest! {
    #![proptest_config(config(50))]

    #[test]
    fn programs_of_highs_agree_with_trying_all(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 12);
        agrees(&problem, &network_opt::mip::Highs)?;
    }

    #[test]
    fn steps_of_highs_lead_to_the_optimum(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 12);
        in_steps(&problem, network_opt::mip::Highs)?;
    }

    #[test]
    fn side_by_side_highs_leads_to_the_optimum(recipe in recipe_with_ties()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 12);
        side_by_side(&problem, network_opt::mip::Highs)?;
    }
}

proptest! {
    #![proptest_config(config(12))]

    /// The exact solver answers as trying all does, and asking for more never
    /// makes the answer better.
    #[test]
    fn asking_for_more_costs_no_less(recipe in recipe(), more in 0_usize..6, which in 0_usize..100) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        let before = solved(&problem);
        let least = all_valid(&problem).iter()
            .map(|n| cost(&problem, &n.active).objective)
            .min_by(f64::total_cmp);
        prop_assert_eq!(before.is_some(), least.is_some());
        if let (Some(before), Some(least)) = (before, least) {
            prop_assert!((before - least).abs() < 1e-3, "{} for {}", before, least);
        }
        let mut asked = problem.clone();
        let (edge, vertex) = (which % problem.edges(), which % problem.vertices);
        match more {
            0 if problem.states[edge] == EdgeState::Open => asked.states[edge] = EdgeState::Closed,
            1 if problem.states[edge] == EdgeState::Open => asked.states[edge] = EdgeState::Required,
            2 => asked.required_vertices.push(vertex),
            3 => asked.dead_ends = false,
            4 => asked.coverage.push(vec![vertex]),
            _ => asked.patterns.push(pattern(PatternKind::Branch, &[edge], None)),
        }
        match (before, solved(&asked)) {
            (None, after) => prop_assert_eq!(after, None),
            (Some(before), Some(after)) => prop_assert!(after >= before - CLOSE),
            (Some(_), None) => {}
        }
    }

    /// The exact solver finds the same without any cuts.
    #[test]
    fn cuts_change_no_optimum(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        let plain = Exact { cuts: Cuts::none(), ..Exact::new(Microlp) };
        match (solved(&problem), solved_by(&plain, &problem)) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < CLOSE, "{a} and {b}"),
            (a, b) => prop_assert_eq!(a, b),
        }
    }

    /// Other numbers for the same vertices and edges change nothing.
    #[test]
    fn numbers_do_not_matter(
        (recipe, vertices, edges) in recipe().prop_flat_map(|recipe| {
            let mesh = recipe.mesh();
            (Just(recipe), other_numbers(mesh.points().len()), other_numbers(mesh.edges().len()))
        })
    ) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        let other = renamed(&problem, &vertices, &edges);
        match (solved(&problem), solved(&other)) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < CLOSE, "{a} and {b}"),
            (a, b) => prop_assert_eq!(a, b),
        }
    }
}

proptest! {
    // Few of them have more than one step between the relaxation and the worst.
    #![proptest_config(config(300))]

    /// Bounds that are raised in steps are bounds at every time, from the worst
    /// network on, and end at the same optimum.
    #[test]
    fn steps_lead_to_the_optimum(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        in_steps(&problem, Microlp)?;
    }
}

proptest! {
    #![proptest_config(config(100))]

    /// The same of what runs beside a proof: bounds of travel that another thread proves
    /// before the length, steps, windows.
    #[test]
    fn side_by_side_leads_to_the_optimum(recipe in recipe_with_ties()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        side_by_side(&problem, Microlp)?;
    }
}

/// HiGHS's presolve once called this one infeasible: a given edge apart from the
/// others, with travel that costs nothing.
#[cfg(feature = "highs")]
#[test]
fn presolve_of_highs_loses_no_network() {
    let recipe = Recipe {
        size: (2, 2),
        cut: vec![true, false, false, false],
        edges: vec![
            0, 17, 11, 17, 17, 17, 17, 17, 11, 17, 17, 17, 17, 0, 0, 0, 0, 0, 0, 0,
        ],
        vertices: vec![94, 15, 15, 15, 0, 15, 0, 15, 15, 0, 0, 0],
        range: 1,
        unit: false,
        dead_ends: false,
        close: 1,
        zig_zags: 2,
        branches: 1,
        weights: (0, 0),
        route: false,
        rooms: false,
    };
    agrees(&recipe.problem(), &network_opt::mip::Highs).unwrap();
    // Another, by another rule.
    let recipe = Recipe {
        size: (3, 1),
        cut: vec![false],
        edges: vec![17, 17, 17, 17, 17, 17, 17, 17, 17, 17, 0],
        vertices: vec![24, 15, 15, 15, 94, 15, 15, 15],
        dead_ends: true,
        close: 2,
        zig_zags: 1,
        route: true,
        ..recipe
    };
    agrees(&recipe.problem(), &network_opt::mip::Highs).unwrap();
}

/// HiGHS's presolve makes the worst network the best, and its answer was the worst.
#[cfg(feature = "highs")]
#[test]
fn highs_knows_its_start_from_the_optimum() {
    let recipe = Recipe {
        size: (2, 1),
        cut: vec![false],
        edges: vec![17, 11, 0, 17, 8, 8, 8],
        vertices: vec![42, 0, 15, 15, 15, 15],
        range: 0,
        unit: true,
        dead_ends: false,
        close: 0,
        zig_zags: 0,
        branches: 0,
        weights: (0, 0),
        route: false,
        rooms: false,
    };
    in_steps(&recipe.problem(), network_opt::mip::Highs).unwrap();
}

/// All edges known beforehand: nothing is left to decide, a program without
/// columns.
#[test]
fn nothing_to_decide_is_decided() {
    let recipe = Recipe {
        size: (1, 1),
        cut: vec![false],
        edges: vec![11, 11, 11, 0],
        vertices: vec![0],
        range: 1,
        unit: false,
        dead_ends: false,
        close: 0,
        zig_zags: 0,
        branches: 0,
        weights: (0, 0),
        route: false,
        rooms: false,
    };
    agrees(&recipe.problem(), &Microlp).unwrap();
    #[cfg(feature = "highs")]
    agrees(&recipe.problem(), &network_opt::mip::Highs).unwrap();
}
