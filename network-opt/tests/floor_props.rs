//! Laws of counts and wishes: programs, the exact solver and the search against
//! trying all sets of edges and of rooms.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;

use common::programs::PROGRAMS;
use common::{config, forever, grid};
use network_opt::design::{
    cost_of, verify, EdgeState, Network, Problem, RoomCount, RoomWish, Rooms, Violation,
};
use network_opt::floor::placements;
use network_opt::formulate::{Formulated, Formulation};
use network_opt::mip::Microlp;
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver, Search};
use proptest::prelude::*;

/// Sums of a few dozen numbers below 100.
const CLOSE: f64 = 1e-6;

/// A tiny floor with counts and wishes drawn at random.
#[derive(Clone, Debug)]
struct Recipe {
    rows: usize,
    dead_ends: bool,
    travel: f64,
    sink: usize,
    closed: Vec<usize>,
    counts: Vec<(Vec<usize>, usize, usize)>,
    wishes: Vec<(Vec<usize>, Vec<usize>, Option<u8>)>,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    let some = |most: usize| prop::collection::vec(0..100_usize, 0..most);
    let wish = (
        prop::collection::vec(0..100_usize, 1..3),
        some(4),
        prop::option::of(0..4_u8),
    );
    (
        1..3_usize,
        any::<bool>(),
        prop_oneof![Just(0.0), Just(0.5)],
        0..100_usize,
        some(2),
        prop::collection::vec((some(6), 0..3_usize, 0..4_usize), 0..3),
        prop::collection::vec(wish, 0..5),
    )
        .prop_map(
            |(rows, dead_ends, travel, sink, closed, counts, wishes)| Recipe {
                rows,
                dead_ends,
                travel,
                sink,
                closed,
                counts,
                wishes,
            },
        )
}

impl Recipe {
    fn problem(&self) -> Problem {
        let mesh = grid(2, self.rows);
        let mut found = placements(&mesh, "one", &"#".parse().unwrap(), true, true);
        found.extend(placements(&mesh, "two", &"##".parse().unwrap(), true, true));
        let (n, m) = (mesh.points().len(), mesh.edges().len());
        let count = found.len();
        let draw = |list: &[usize]| -> Vec<usize> {
            let set: BTreeSet<usize> = list.iter().map(|k| k % count).collect();
            set.into_iter().collect()
        };
        let mut states = vec![EdgeState::Open; m];
        self.closed
            .iter()
            .for_each(|&e| states[e % m] = EdgeState::Closed);
        Problem {
            vertices: n,
            ends: mesh.edges().to_vec(),
            lengths: vec![1.0; m],
            states,
            sinks: (0..n).map(|v| v == self.sink % n).collect(),
            dead_ends: self.dead_ends,
            rooms: Some(Rooms {
                placements: found,
                covered: vec![true; 2 * self.rows],
                counts: (self.counts.iter())
                    .map(|(rooms, least, more)| RoomCount {
                        name: "some".into(),
                        rooms: draw(rooms),
                        least: *least,
                        most: (*more < 3).then_some(least + more),
                    })
                    .collect(),
                wishes: (self.wishes.iter())
                    .map(|(when, then, cost)| RoomWish {
                        when: draw(when),
                        then: draw(then),
                        cost: cost.map(f64::from),
                    })
                    .collect(),
            }),
            length_weight: 1.0,
            travel_weight: self.travel,
            ..Problem::default()
        }
    }
}

/// All valid plans, by trying all sets of edges and of rooms.
fn all_valid(problem: &Problem) -> Vec<Network> {
    let m = problem.edges();
    let count = problem.rooms.as_ref().unwrap().placements.len();
    let mut tilings = Vec::new();
    for bits in 0_u32..1 << count {
        let rooms: Vec<usize> = (0..count).filter(|k| bits >> k & 1 == 1).collect();
        let network = Network {
            active: vec![true; m],
            rooms,
            ..Network::default()
        };
        // With all edges active what is wrong with tiling, counts and wishes
        // stays wrong.
        let about_rooms = |v: &Violation| {
            matches!(
                v,
                Violation::Tiling { .. } | Violation::Count { .. } | Violation::Wish { .. }
            )
        };
        if !verify(problem, &network).iter().any(about_rooms) {
            tilings.push(network.rooms);
        }
    }
    let mut found = Vec::new();
    for bits in 0_u32..1 << m {
        let active: Vec<bool> = (0..m).map(|e| bits >> e & 1 == 1).collect();
        for rooms in &tilings {
            let network = Network {
                active: active.clone(),
                rooms: rooms.clone(),
                ..Network::default()
            };
            if verify(problem, &network).is_empty() {
                found.push(network);
            }
        }
    }
    found
}

proptest! {
    #![proptest_config(config(24))]

    /// Programs and brute force agree on counts and wishes: every valid plan
    /// meets every row and costs there what the checker says, the optimum is the
    /// least cost, and where nothing is valid the solver says so.
    #[test]
    fn programs_agree_with_brute_force(recipe in recipe()) {
        let problem = recipe.problem();
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost_of(&problem, n).objective);
        let least = costs.fold(f64::INFINITY, f64::min);
        for formulation in PROGRAMS {
            let formulated = Formulated::new(&problem, formulation, None).unwrap();
            for network in &valid {
                let values = formulated.solution(network);
                let violation = formulated.program().violation(&values);
                prop_assert!(violation < CLOSE, "{formulation:?} by {violation}");
                prop_assert_eq!(&formulated.network(&values), network);
                let cost = cost_of(&problem, network);
                let (said, mut is) = (formulated.program().objective(&values), cost.objective);
                if formulation == Formulation::Flow {
                    is -= problem.travel_weight * cost.travel;
                }
                prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
                let step = formulated.program().step();
                prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < CLOSE);
            }
        }
        let found = Exact::new(Microlp).solve(&problem, None, &forever(), &mut |_| true).unwrap();
        match &found.network {
            Some(network) => {
                prop_assert_eq!(verify(&problem, network), []);
                prop_assert!((found.cost.objective - least).abs() < CLOSE, "{} for {least}", found.cost.objective);
                prop_assert!((found.cost.objective - cost_of(&problem, network).objective).abs() < CLOSE);
            }
            None => {
                prop_assert_eq!(found.ended, Ended::Infeasible);
                prop_assert!(valid.is_empty());
            }
        }
    }

    /// So does the search: what it finds is valid and costs what it says, its
    /// bound is none that a plan undercuts, it says that there is nothing only
    /// where there is nothing, and given some time it finds the optimum.
    #[test]
    fn the_search_agrees_with_brute_force(recipe in recipe(), seed in 0..1000_u64) {
        let problem = recipe.problem();
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost_of(&problem, n).objective);
        let least = costs.fold(f64::INFINITY, f64::min);
        let limits = Limits { seed, ..forever() };
        let search = Search { moves: Some(8000) };
        let found = search.solve(&problem, None, &limits, &mut |_| true).unwrap();
        prop_assert!(found.ended == Ended::Infeasible || found.bound <= least + CLOSE);
        match &found.network {
            Some(network) => {
                prop_assert_eq!(verify(&problem, network), []);
                let cost = cost_of(&problem, network).objective;
                prop_assert!((found.cost.objective - cost).abs() < CLOSE);
                prop_assert!((cost - least).abs() < CLOSE, "{cost} for {least}");
            }
            None => prop_assert!(valid.is_empty(), "there is one of {least}"),
        }
    }

    /// A count more, or a demand more, never makes the optimum better.
    #[test]
    fn more_is_never_cheaper(recipe in recipe()) {
        let problem = recipe.problem();
        let solve = |problem: &Problem| {
            let found = Exact::new(Microlp).solve(problem, None, &forever(), &mut |_| true).unwrap();
            found.network.map_or(f64::INFINITY, |_| found.cost.objective)
        };
        let asked = solve(&problem);
        let mut fewer = problem.clone();
        let rooms = fewer.rooms.as_mut().unwrap();
        rooms.counts.pop();
        rooms.wishes.pop();
        prop_assert!(solve(&fewer) <= asked + CLOSE);
    }
}
