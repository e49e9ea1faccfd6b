//! Laws of one-way streets and speeds: the programs and the checker against
//! trying all networks with all directions, and what must not change.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::config;
use common::programs::{is_kept, CLOSE};
use common::ways::{all_networks, all_valid, best, recipe};
use network_opt::design::{
    cost, distances, distances_from, verify, Network, Problem, Violation, Way,
};
use network_opt::formulate::{longest_ways, prepare, Formulated, Formulation};
use network_opt::mip::Microlp;
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver, Search};
use network_opt::DesignError;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// The problem and a network of it with all directions reversed.
fn reversed(problem: &Problem, network: &Network) -> (Problem, Network) {
    let turn = |ways: &[Way]| ways.iter().map(|way| way.reversed()).collect();
    let problem = Problem {
        ways: turn(&problem.ways),
        ..problem.clone()
    };
    let network = Network {
        ways: turn(&network.ways),
        ..network.clone()
    };
    (problem, network)
}

/// Whether all active vertices are within reach of each other with all sinks
/// taken for one, by the closure of a matrix.
fn is_strong(problem: &Problem, network: &Network) -> bool {
    let n = problem.vertices;
    let at = |v: usize| if problem.sinks[v] { n } else { v };
    let mut reach = vec![vec![false; n + 1]; n + 1];
    let mut active = vec![false; n + 1];
    active[n] = true;
    (0..=n).for_each(|v| reach[v][v] = true);
    for (e, &[a, b]) in problem.ends.iter().enumerate() {
        if network.active[e] {
            let way = network.ways.get(e).copied().unwrap_or(problem.way(e));
            active[at(a)] = true;
            active[at(b)] = true;
            reach[at(a)][at(b)] |= matches!(way, Way::Both | Way::Forward);
            reach[at(b)][at(a)] |= matches!(way, Way::Both | Way::Backward);
        }
    }
    for k in 0..=n {
        for a in 0..=n {
            for b in 0..=n {
                reach[a][b] |= reach[a][k] && reach[k][b];
            }
        }
    }
    let all = (0..=n).filter(|&v| active[v]);
    all.clone().all(|a| all.clone().all(|b| reach[a][b]))
}

const PROGRAMS: [Formulation; 2] = [Formulation::Flow, Formulation::TravelFlow];

proptest! {
    #![proptest_config(config(50))]

    /// Every valid network meets every row of both programs and costs there what
    /// the checker says; nothing that is valid was decided away before.
    #[test]
    fn no_program_cuts_off_a_valid_network(recipe in recipe()) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let fates = prepare(&problem);
        let bounds = longest_ways(&problem, 1e6);
        for formulation in PROGRAMS {
            let formulated = Formulated::new(&problem, formulation, None).unwrap();
            prop_assert!(valid.is_empty() || !formulated.contradicts());
            for network in &valid {
                let said = is_kept(&formulated, &fates, network)?;
                let cost = cost(&problem, network);
                let is = match formulation {
                    Formulation::Flow => problem.length_weight * cost.length + cost.patterns,
                    _ => cost.objective,
                };
                prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
                let step = formulated.program().step();
                prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < 1e-6);
                if problem.has_one_way() {
                    let away = [distances(&problem, network), distances_from(&problem, network)];
                    for (&way, bound) in away.iter().flat_map(|away| away.iter().zip(&bounds)) {
                        prop_assert!(way.is_infinite() || way <= bound + 1e-9);
                    }
                }
            }
        }
    }

    /// The optimum of the program is that of all networks, however it is solved,
    /// and where there is no network that is what is said.
    #[test]
    fn brute_force_agrees_with_the_program(recipe in recipe()) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let least = best(&problem, &valid);
        let limits = Limits { deadline: None, ..Limits::default() };
        for formulation in [Formulation::Recommended, Formulation::TravelFlow] {
            let exact = Exact { formulation, ..Exact::new(Microlp) };
            let found = exact.solve(&problem, None, &limits, &mut |_| true).unwrap();
            match found.network {
                None => {
                    prop_assert!(valid.is_empty(), "none found, of {}", valid.len());
                    prop_assert_eq!(found.ended, Ended::Infeasible);
                }
                Some(network) => {
                    prop_assert_eq!(verify(&problem, &network), vec![]);
                    prop_assert!((found.cost.objective - least).abs() < CLOSE,
                        "{formulation:?}: {} for {least}", found.cost.objective);
                    prop_assert_eq!(found.ended, Ended::Proven);
                }
            }
        }
        for formulation in [Formulation::SingleSink, Formulation::Paper] {
            let refused = Formulated::new(&problem, formulation, None);
            prop_assert_eq!(refused.is_err(), problem.has_one_way());
            if let Err(error) = refused {
                let is_option = matches!(error, DesignError::BadOption { .. });
                prop_assert!(is_option);
                prop_assert!(error.to_string().contains("TravelFlow"));
            }
        }
    }

    /// With all sinks taken for one a valid network is strongly connected, and
    /// what is strongly connected has no fault of reachability.
    #[test]
    fn valid_networks_are_strongly_connected(recipe in recipe(), picks in prop::collection::vec(any::<usize>(), 30)) {
        let problem = recipe.problem();
        let Some(all) = all_networks(&problem) else { return Ok(()) };
        for network in picks.iter().map(|&k| &all[k % all.len()]) {
            let found = verify(&problem, network);
            let faults = found.iter().filter(|v| matches!(v,
                Violation::Island { .. } | Violation::OnlyIn { .. } | Violation::OnlyOut { .. }
                | Violation::NoWayIn { .. } | Violation::NoWayOut { .. }));
            prop_assert_eq!(faults.count() == 0, is_strong(&problem, network), "{:?}", found);
        }
    }

    /// A street that becomes two-way, or whose direction is left open, never makes
    /// a network worse, nor the optimum.
    #[test]
    fn one_way_streets_never_improve(recipe in recipe(), edge in any::<prop::sample::Index>()) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let e = edge.index(problem.edges());
        let mut freer = problem.clone();
        freer.ways[e] = Way::Both;
        for network in &valid {
            let mut same = network.clone();
            if let Some(way) = same.ways.get_mut(e) {
                *way = Way::Both;
            }
            if !freer.has_choice_of_ways() {
                same.ways.clear();
            }
            prop_assert_eq!(verify(&freer, &same), vec![]);
            let (one, two) = (cost(&problem, network), cost(&freer, &same));
            // Sums of a dozen ways in one order.
            prop_assert!(two.objective <= one.objective + 1e-9);
        }
        let mut open = problem.clone();
        if matches!(problem.ways[e], Way::Forward | Way::Backward) {
            open.ways[e] = Way::Either;
        }
        if let Some(all) = all_valid(&open) {
            prop_assert!(best(&open, &all) <= best(&problem, &valid) + 1e-9);
        }
    }

    /// All directions reversed, a network is as good as before; and the names of
    /// vertices, and which end of an edge is the first, do not matter.
    #[test]
    fn directions_and_names_are_symmetric(recipe in recipe(), shift in 0_usize..9, flips in prop::collection::vec(any::<bool>(), 12)) {
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let n = problem.vertices;
        let rename = |v: usize| (v + shift) % n;
        for network in valid.iter().take(50) {
            let (back, there) = reversed(&problem, network);
            prop_assert_eq!(verify(&back, &there), vec![]);
            let (a, b) = (cost(&problem, network), cost(&back, &there));
            // Halves of quarters: no rounding but by the weight of travel.
            prop_assert!((a.objective - b.objective).abs() < 1e-9);
            prop_assert_eq!(distances(&problem, network), distances_from(&back, &there));

            let mut named = problem.clone();
            let mut same = network.clone();
            for v in 0..n {
                named.sinks[rename(v)] = problem.sinks[v];
            }
            named.coverage.iter_mut().flatten().for_each(|v| *v = rename(*v));
            named.required_vertices.iter_mut().for_each(|v| *v = rename(*v));
            for e in 0..problem.edges() {
                named.ends[e] = problem.ends[e].map(rename);
                if flips[e % 12] {
                    named.ends[e].reverse();
                    named.ways[e] = named.ways[e].reversed();
                    if let Some(way) = same.ways.get_mut(e) {
                        *way = way.reversed();
                    }
                }
            }
            prop_assert_eq!(verify(&named, &same), vec![]);
            prop_assert!((cost(&named, &same).objective - a.objective).abs() < 1e-9);
        }
    }

    /// What says that all streets are two-way, and that travel costs what edges
    /// are long, is what says nothing.
    #[test]
    fn two_way_problems_are_as_ever(recipe in recipe(), seed in 0_u64..100) {
        let mut plain = recipe.problem();
        plain.ways.clear();
        plain.travel_costs.clear();
        let mut said = plain.clone();
        said.ways = vec![Way::Both; plain.edges()];
        said.travel_costs.clone_from(&plain.lengths);
        prop_assert_eq!(prepare(&plain), prepare(&said));
        let Some(valid) = all_valid(&plain) else { return Ok(()) };
        for formulation in [Formulation::Flow, Formulation::TravelFlow, Formulation::SingleSink, Formulation::Paper] {
            let [a, b] = [&plain, &said].map(|p| Formulated::new(p, formulation, Some(longest_ways(p, 50.0))).unwrap());
            prop_assert_eq!(format!("{:?}", a.program()), format!("{:?}", b.program()));
        }
        for network in valid.iter().take(20) {
            prop_assert_eq!(cost(&plain, network), cost(&said, network));
            prop_assert_eq!(distances(&said, network), distances_from(&said, network));
        }
        let limits = Limits { deadline: None, seed, ..Limits::default() };
        let search = Search { moves: Some(500) };
        let [a, b] = [&plain, &said].map(|p| search.solve(p, None, &limits, &mut |_| true).unwrap());
        prop_assert_eq!(a.network, b.network);
        prop_assert_eq!(a.bound, b.bound);
    }

    /// Speeds: all formulations price travel by what it costs, and twice the speed
    /// everywhere is half the travel.
    #[test]
    fn speeds_are_priced_by_every_program(recipe in recipe()) {
        let mut problem = recipe.problem();
        problem.ways.clear();
        let Some(valid) = all_valid(&problem) else { return Ok(()) };
        let worst = valid.iter().map(|n| cost(&problem, n).objective).fold(0.0, f64::max);
        for formulation in [Formulation::TravelFlow, Formulation::SingleSink] {
            let longest = longest_ways(&problem, worst);
            let formulated = Formulated::new(&problem, formulation, Some(longest)).unwrap();
            for network in &valid {
                let values = formulated.solution(network);
                prop_assert!(formulated.program().violation(&values) < CLOSE);
                let (said, is) = (formulated.program().objective(&values), cost(&problem, network).objective);
                prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
            }
        }
        let mut fast = problem.clone();
        fast.travel_costs.iter_mut().for_each(|c| *c /= 2.0);
        for network in &valid {
            let (slow, fast) = (cost(&problem, network), cost(&fast, network));
            prop_assert_eq!(slow.length, fast.length);
            prop_assert_eq!(slow.travel, 2.0 * fast.travel);
            let known = cost(&problem, network).objective;
            for (v, bound) in longest_ways(&problem, known).into_iter().enumerate() {
                let way = distances(&problem, network)[v];
                prop_assert!(way.is_infinite() || way <= bound);
            }
        }
    }
}

/// Enough of the random problems are small enough to be tried out, have valid
/// networks, and have streets in them whose direction was chosen.
#[test]
fn recipes_are_worth_trying() {
    let mut runner = TestRunner::deterministic();
    let (mut tried, mut solvable, mut turned) = (0, 0, 0);
    for _ in 0..200 {
        let recipe = recipe().new_tree(&mut runner).unwrap().current();
        let problem = recipe.problem();
        let Some(valid) = all_valid(&problem) else {
            continue;
        };
        tried += 1;
        solvable += usize::from(!valid.is_empty());
        let chosen = |n: &Network| {
            let mut edges = 0..problem.edges();
            edges.any(|e| n.active[e] && problem.way(e) == Way::Either)
        };
        turned += usize::from(valid.iter().any(chosen));
    }
    assert!(
        tried > 120 && solvable > 40 && turned > 20,
        "{tried} {solvable} {turned}"
    );
}
