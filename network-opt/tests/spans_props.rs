//! Laws of routes and of sinks that the program places: programs, the checker
//! and the search against trying everything.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::brute::{all_valid, choices, open_edges, other_numbers, renamed};
use common::programs::{agrees, no_row_cuts_off, same, solved, CLOSE};
use common::{config, grid, search};
use network_opt::design::{
    cost_of, paths_between, verify, EdgeState, PathOptions, Pattern, PatternKind, PlacedSinks,
    Problem, Route, RouteKind, Tessellation,
};
use network_opt::mip::Microlp;
use network_opt::solve::Ended;
use proptest::prelude::*;

#[derive(Clone, Debug)]
struct Recipe {
    size: (usize, usize),
    /// One number each, below 100.
    edges: Vec<u8>,
    vertices: Vec<u8>,
    hops: usize,
    unit: bool,
    dead_ends: bool,
    /// Too close edges: free, weighted, forbidden.
    close: u8,
    weights: (u8, u8),
    /// Sinks to be placed; 0 for none.
    count: usize,
    /// Ends of each route, tolerance, and what it costs to be missing.
    routes: Vec<(usize, usize, usize, Option<u8>)>,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    let size = prop_oneof![Just((2, 1)), Just((3, 1)), Just((2, 2)), Just((1, 1))];
    let lists = (
        prop::collection::vec(0_u8..100, 12),
        prop::collection::vec(0_u8..100, 9),
    );
    let route = (
        0_usize..9,
        0_usize..9,
        0_usize..3,
        prop::option::of(0_u8..8),
    );
    let rest = (
        0_usize..3,
        any::<bool>(),
        any::<bool>(),
        0_u8..4,
        (0_u8..3, 0_u8..3),
        0_usize..3,
        prop::collection::vec(route, 0..3),
    );
    (size, lists, rest).prop_map(|(size, (edges, vertices), rest)| Recipe {
        size,
        edges,
        vertices,
        hops: rest.0,
        unit: rest.1,
        dead_ends: rest.2,
        close: rest.3,
        weights: rest.4,
        count: rest.5,
        routes: rest.6,
    })
}

impl Recipe {
    fn mesh(&self) -> Tessellation {
        grid(self.size.0, self.size.1)
    }

    fn problem(&self) -> Problem {
        let mesh = self.mesh();
        let (n, m) = (mesh.points().len(), mesh.edges().len());
        let states: Vec<EdgeState> = (self.edges.iter().take(m))
            .map(|draw| match draw {
                0..=9 => EdgeState::Given,
                10..=13 => EdgeState::Required,
                14..=19 => EdgeState::Closed,
                _ => EdgeState::Open,
            })
            .collect();
        let lengths = self.edges.iter().take(m).map(|&draw| match self.unit {
            true => 1.0,
            false => 1.0 + f64::from(draw % 5) / 4.0,
        });
        let lengths = lengths.collect();
        let drawn = |low: u8, high: u8| -> Vec<usize> {
            (0..n)
                .filter(|&v| (low..high).contains(&self.vertices[v]))
                .collect()
        };
        let mut sinks = vec![false; n];
        drawn(0, 12).into_iter().for_each(|v| sinks[v] = true);
        let mut candidates = drawn(30, 70);
        // A few are enough, and no more can be tried.
        candidates.truncate(4);
        let count = self.count.min(candidates.len());
        if count == 0 {
            sinks[usize::from(self.vertices[0]) % n] = true;
        }
        let close = match self.close {
            0 => None,
            1 => Some(Some(1.5)),
            _ => Some(None),
        };
        let patterns = close.map_or_else(Vec::new, |cost| {
            let pairs = mesh.opposite_edges().into_iter();
            let patterns = pairs.map(|pair| Pattern {
                kind: PatternKind::TooClose,
                active: pair.to_vec(),
                inactive: vec![],
                cost,
            });
            patterns.collect()
        });
        let routes = self.routes.iter().map(|&(a, b, tolerance, cost)| {
            let options = PathOptions {
                tolerance,
                ..PathOptions::default()
            };
            Route {
                kind: RouteKind::Inside,
                paths: paths_between(&mesh, &vec![true; m], [a % n, b % n], &options),
                cost: cost.map(|c| f64::from(c) / 2.0),
            }
        });
        Problem {
            vertices: n,
            ends: mesh.edges().to_vec(),
            lengths,
            states,
            sinks,
            coverage: (0..n).map(|v| mesh.ball(v, self.hops)).collect(),
            required_vertices: drawn(94, 100),
            dead_ends: self.dead_ends,
            patterns,
            routes: routes.collect(),
            placed: (count > 0).then_some(PlacedSinks { candidates, count }),
            rooms: None,
            length_weight: [1.0, 5.0, 1.0][usize::from(self.weights.0)],
            travel_weight: [0.0, 1.0, 0.001][usize::from(self.weights.1)],
            ..Problem::default()
        }
    }
}

fn least(problem: &Problem) -> Option<f64> {
    let costs = all_valid(problem).into_iter();
    costs
        .map(|n| cost_of(problem, &n).objective)
        .min_by(f64::total_cmp)
}

proptest! {
    #![proptest_config(config(40))]

    /// Every valid network meets every row of every program, ball cuts with
    /// placed sinks included, and costs there what the checker says.
    #[test]
    fn no_program_cuts_off_a_valid_network(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 11);
        no_row_cuts_off(&problem, &all_valid(&problem))?;
    }
}

proptest! {
    #![proptest_config(config(12))]

    /// Every program has the optimum that trying everything has.
    #[test]
    fn programs_agree_with_trying_all(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 9);
        agrees(&problem, &Microlp)?;
        prop_assert!(same(least(&problem), solved(&problem)));
    }

    /// The search finds the optimum of tiny problems, and nothing that is not
    /// valid.
    #[test]
    fn the_search_agrees_with_trying_all(recipe in recipe(), seed in 0_u64..100) {
        let problem = recipe.problem();
        let best = least(&problem);
        let mut found = search(&problem, 20_000, seed);
        for more in 1..=3 {
            // It is a search: of one network among thousands it may need several.
            let is = found.network.as_ref().map(|_| found.cost.objective);
            if same(best, is) {
                break;
            }
            found = search(&problem, 100_000, seed + 1000 * more);
        }
        if let Some(network) = &found.network {
            prop_assert_eq!(verify(&problem, network), vec![]);
            prop_assert_eq!(found.cost, cost_of(&problem, network));
        }
        let is = found.network.as_ref().map(|_| found.cost.objective);
        prop_assert!(same(best, is), "{is:?}, not {best:?}");
        if let Some(best) = best {
            prop_assert!(found.ended != Ended::Infeasible);
            prop_assert!(found.bound <= best * (1.0 + 1e-9), "{} of {best}", found.bound);
        }
    }

    /// One more span never makes the best network cheaper, and one that may be
    /// missing makes it dearer by what that costs at most.
    #[test]
    fn a_span_more_costs_no_less(
        recipe in recipe(),
        (a, b, tolerance, cost) in (0_usize..9, 0_usize..9, 0_usize..3, prop::option::of(0_u8..8)),
    ) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 9);
        let mut more = recipe;
        more.routes.push((a, b, tolerance, cost));
        let (before, after) = (solved(&problem), solved(&more.problem()));
        match (before, after) {
            (None, after) => prop_assert_eq!(after, None),
            (Some(before), Some(after)) => {
                prop_assert!(after >= before - CLOSE);
                if let Some(cost) = cost {
                    prop_assert!(after <= before + f64::from(cost) / 2.0 + CLOSE);
                }
            }
            (Some(_), None) => prop_assert_eq!(cost, None),
        }
    }

    /// Sinks that the program places are the best of all choices.
    #[test]
    fn placed_sinks_are_no_worse_than_any_choice(recipe in recipe()) {
        let problem = Recipe { count: recipe.count.max(1), ..recipe }.problem();
        prop_assume!(open_edges(&problem) <= 9);
        let placed = solved(&problem);
        let all = choices(&problem).into_iter();
        let best = all.filter_map(|sinks| solved(&problem.settled(&sinks)));
        let best = best.min_by(f64::total_cmp);
        prop_assert!(same(best, placed), "{placed:?}, not {best:?}");
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
        prop_assume!(open_edges(&problem) <= 9);
        let other = renamed(&problem, &vertices, &edges);
        let (a, b) = (solved(&problem), solved(&other));
        prop_assert!(same(a, b), "{a:?} and {b:?}");
    }
}
