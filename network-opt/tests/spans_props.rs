//! Laws of spans between places and of sinks that the program places: parts,
//! paths, programs, the checker and the search against trying everything.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;

use network_opt::design::{
    check_partition, cost_of, partition, paths_between, verify, Across, Among, EdgeState, Feature,
    Inside, Network, Pairs, Parts, PathOptions, Pattern, PatternKind, Place, PlacedSinks, Problem,
    Rim, Route, RouteKind, Sinks, Specification, Tessellation, Traffic,
};
use network_opt::formulate::{longest_ways, prepare, Fate, Formulated, Formulation};
use network_opt::geo_types::{coord, Coord};
use network_opt::mip::{Microlp, MipReply, MipSolver, MipStatus};
use network_opt::solve::{
    conflicts, Constraints, Ended, Exact, Limits, NetworkSolver, Outcome, Search,
};
use proptest::prelude::*;
use proptest::sample::subsequence;

/// Few cases by default; many with `URBAN_LAYOUT_LONG=1`.
fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|v| v == "1");
    ProptestConfig::with_cases(if long { cases * 20 } else { cases })
}

/// Solvers hold rows to a millionth; sums here have some tens of terms of size
/// one to ten.
const CLOSE: f64 = 1e-4;

/// A grid of squares, without some of them.
fn grid(columns: usize, rows: usize, keep: &dyn Fn(usize) -> bool) -> Tessellation {
    let wide = columns + 1;
    let faces = (0..columns * rows).filter(|&f| keep(f)).map(|f| {
        let a = f / columns * wide + f % columns;
        [a, a + 1, a + wide + 1, a + wide]
    });
    let faces: Vec<[usize; 4]> = faces.collect();
    let used: Vec<usize> = BTreeSet::from_iter(faces.iter().flatten().copied())
        .into_iter()
        .collect();
    let points = used.iter().map(|&k| -> Coord<f64> {
        coord! { x: (k % wide) as f64, y: (k / wide) as f64 }
    });
    let named = faces
        .iter()
        .map(|face| face.map(|v| used.partition_point(|&w| w < v)).to_vec());
    Tessellation::new(points.collect(), named.collect()).unwrap()
}

/// What random problems are made of.
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
        grid(self.size.0, self.size.1, &|_| true)
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

/// All choices of sinks: one empty choice if none is to be placed.
fn choices(problem: &Problem) -> Vec<Vec<usize>> {
    let Some(placed) = &problem.placed else {
        return vec![Vec::new()];
    };
    let all = 0_u32..1 << placed.candidates.len();
    let chosen = all.filter(|set| set.count_ones() as usize == placed.count);
    let choice = chosen.map(|set| {
        let all = placed.candidates.iter().enumerate();
        let mut chosen: Vec<usize> = all
            .filter(|(k, _)| set >> k & 1 == 1)
            .map(|(_, &v)| v)
            .collect();
        chosen.sort_unstable();
        chosen
    });
    choice.collect()
}

fn open_edges(problem: &Problem) -> usize {
    let open = problem.states.iter().filter(|s| **s == EdgeState::Open);
    open.count()
}

/// All valid networks.
fn all_valid(problem: &Problem) -> Vec<Network> {
    let open: Vec<usize> = (0..problem.edges())
        .filter(|&e| problem.states[e] == EdgeState::Open)
        .collect();
    let mut found = Vec::new();
    for set in 0_u32..1 << open.len() {
        let mut active: Vec<bool> = (problem.states.iter())
            .map(|s| matches!(s, EdgeState::Given | EdgeState::Required))
            .collect();
        for (k, &e) in open.iter().enumerate() {
            active[e] = set >> k & 1 == 1;
        }
        for sinks in choices(problem) {
            let network = Network {
                active: active.clone(),
                sinks,
                ..Network::default()
            };
            if verify(problem, &network).is_empty() {
                found.push(network);
            }
        }
    }
    found
}

fn least(problem: &Problem) -> Option<f64> {
    let costs = all_valid(problem).into_iter();
    costs
        .map(|n| cost_of(problem, &n).objective)
        .min_by(f64::total_cmp)
}

const PROGRAMS: [Formulation; 4] = [
    Formulation::Flow,
    Formulation::TravelFlow,
    Formulation::SingleSink,
    Formulation::Paper,
];

/// What a program says that a network costs.
fn priced(problem: &Problem, formulation: Formulation, network: &Network) -> f64 {
    let cost = cost_of(problem, network);
    match formulation {
        Formulation::Flow => problem.length_weight * cost.length + cost.patterns + cost.routes,
        _ => cost.objective,
    }
}

/// The paper's distances are the true ones only of edges of length 1.
fn comparable(problem: &Problem, formulation: Formulation) -> bool {
    formulation != Formulation::Paper
        || problem.travel_weight == 0.0
        || problem.lengths.iter().all(|&l| l == 1.0)
}

proptest! {
    #![proptest_config(config(40))]

    /// Every valid network meets every row of every program, ball cuts with
    /// placed sinks included, and costs there what the checker says.
    #[test]
    fn no_program_cuts_off_a_valid_network(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 11);
        let fates = prepare(&problem);
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost_of(&problem, n).objective);
        let worst = costs.fold(0.0, f64::max);
        for formulation in PROGRAMS {
            let longest = longest_ways(&problem, worst);
            let formulated = Formulated::new(&problem, formulation, Some(longest)).unwrap();
            prop_assert!(valid.is_empty() || !formulated.contradicts());
            for network in &valid {
                for (e, &fate) in fates.iter().enumerate() {
                    prop_assert!(fate == Fate::Open || (fate == Fate::On) == network.active[e]);
                }
                let values = formulated.solution(network);
                let violation = formulated.program().violation(&values);
                prop_assert!(violation < CLOSE, "{formulation:?} by {violation}");
                prop_assert_eq!(&formulated.network(&values), network);
                if comparable(&problem, formulation) {
                    let said = formulated.program().objective(&values);
                    let is = priced(&problem, formulation, network);
                    prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
                    let step = formulated.program().step();
                    prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < 1e-6);
                }
            }
        }
    }
}

/// The network of least cost by a program; none if there is none.
fn optimum(problem: &Problem, formulation: Formulation) -> Option<f64> {
    let formulated = Formulated::new(problem, formulation, None).unwrap();
    if formulated.contradicts() {
        return None;
    }
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let found = Microlp
        .solve(formulated.program(), None, &limits, &mut |_| MipReply::GoOn)
        .unwrap();
    if found.status == MipStatus::Infeasible {
        return None;
    }
    assert_eq!(found.status, MipStatus::Optimal);
    let network = formulated.network(&found.solution.unwrap());
    assert_eq!(verify(problem, &network), [], "{formulation:?}");
    Some(found.objective)
}

fn exact(problem: &Problem) -> Option<f64> {
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let found = Exact::new(Microlp)
        .solve(problem, None, &limits, &mut |_| true)
        .unwrap();
    match found.ended {
        Ended::Proven => Some(found.cost.objective),
        Ended::Infeasible => None,
        other => panic!("{other:?} without a limit"),
    }
}

fn search(problem: &Problem, moves: u64, seed: u64) -> Outcome {
    let limits = Limits {
        deadline: None,
        seed,
        ..Limits::default()
    };
    Search { moves: Some(moves) }
        .solve(problem, None, &limits, &mut |_| true)
        .unwrap()
}

fn same(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-3,
        (a, b) => a == b,
    }
}

proptest! {
    #![proptest_config(config(12))]

    /// Every program has the optimum that trying everything has.
    #[test]
    fn programs_agree_with_trying_all(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 9);
        let valid = all_valid(&problem);
        for formulation in PROGRAMS {
            let costs = valid.iter().map(|n| priced(&problem, formulation, n));
            let (best, found) = (costs.min_by(f64::total_cmp), optimum(&problem, formulation));
            if comparable(&problem, formulation) {
                prop_assert!(same(best, found), "{formulation:?}: {found:?}, not {best:?}");
            } else {
                prop_assert_eq!(best.is_some(), found.is_some());
            }
        }
        prop_assert!(same(least(&problem), exact(&problem)));
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
        let (before, after) = (exact(&problem), exact(&more.problem()));
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
        let placed = exact(&problem);
        let all = choices(&problem).into_iter();
        let best = all.filter_map(|sinks| exact(&problem.settled(&sinks)));
        let best = best.min_by(f64::total_cmp);
        prop_assert!(same(best, placed), "{placed:?}, not {best:?}");
    }

    /// Other numbers for the same vertices and edges change nothing.
    #[test]
    fn numbers_do_not_matter(
        (recipe, vertices, edges) in recipe().prop_flat_map(|recipe| {
            let mesh = recipe.mesh();
            let all = |n: usize| subsequence((0..n).collect::<Vec<_>>(), n).prop_shuffle();
            (Just(recipe), all(mesh.points().len()), all(mesh.edges().len()))
        })
    ) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 9);
        let mut other = problem.clone();
        let rename = |list: &mut Vec<usize>, to: &[usize]| list.iter_mut().for_each(|k| *k = to[*k]);
        for (e, &to) in edges.iter().enumerate() {
            other.ends[to] = problem.ends[e].map(|v| vertices[v]);
            other.lengths[to] = problem.lengths[e];
            other.states[to] = problem.states[e];
        }
        for (v, &to) in vertices.iter().enumerate() {
            other.sinks[to] = problem.sinks[v];
        }
        other.coverage.iter_mut().for_each(|ball| rename(ball, &vertices));
        rename(&mut other.required_vertices, &vertices);
        for p in &mut other.patterns {
            rename(&mut p.active, &edges);
        }
        for path in other.routes.iter_mut().flat_map(|r| &mut r.paths) {
            rename(path, &edges);
        }
        if let Some(placed) = &mut other.placed {
            rename(&mut placed.candidates, &vertices);
        }
        let (a, b) = (exact(&problem), exact(&other));
        prop_assert!(same(a, b), "{a:?} and {b:?}");
    }
}

/// All simple paths of at most so many edges, by extending every walk.
fn every_path(
    mesh: &Tessellation,
    open: &[bool],
    from: usize,
    to: usize,
    most: usize,
) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut walks = vec![(vec![from], Vec::new())];
    while let Some((met, path)) = walks.pop() {
        let at = met[met.len() - 1];
        if at == to {
            found.push(path);
            continue;
        }
        for (e, &[a, b]) in mesh.edges().iter().enumerate() {
            let next = if a == at { b } else { a };
            if open[e] && (a == at || b == at) && !met.contains(&next) && path.len() < most {
                let (mut met, mut path): (Vec<usize>, Vec<usize>) = (met.clone(), path.clone());
                met.push(next);
                path.push(e);
                walks.push((met, path));
            }
        }
    }
    found
}

proptest! {
    #![proptest_config(config(60))]

    /// Parts cover all faces, each connected, none empty; the same for the same
    /// seed. What is not connected has no fewer parts than pieces.
    #[test]
    fn parts_are_connected_and_cover(
        size in (1_usize..8, 1_usize..8),
        gone in prop::collection::vec(prop::bool::weighted(0.2), 64),
        count in 1_usize..12,
        seed in any::<u64>(),
    ) {
        prop_assume!((0..size.0 * size.1).any(|f| !gone[f]));
        let mesh = grid(size.0, size.1, &|f| !gone[f]);
        let faces = mesh.faces().len();
        match partition(&mesh, count, seed) {
            Ok(parts) => {
                prop_assert_eq!(&check_partition(&mesh, &parts), &Ok(parts.clone()));
                let names: BTreeSet<usize> = parts.iter().copied().collect();
                prop_assert!(names.into_iter().eq(0..count));
                prop_assert_eq!(partition(&mesh, count, seed), Ok(parts));
            }
            Err(_) => {
                // Too many parts, or too few: as many as faces is never that.
                prop_assert!(count > faces || partition(&mesh, faces, seed).is_ok());
            }
        }
    }

    /// The paths listed are those that extending every walk finds.
    #[test]
    fn paths_are_all_paths(
        size in (1_usize..4, 1_usize..4),
        closed in prop::collection::vec(prop::bool::weighted(0.2), 24),
        ends in (0_usize..16, 0_usize..16),
        tolerance in 0_usize..5,
        most in 1_usize..40,
        seed in any::<u64>(),
    ) {
        let mesh = grid(size.0, size.1, &|_| true);
        let n = mesh.points().len();
        let (a, b) = (ends.0 % n, ends.1 % n);
        let open: Vec<bool> = (0..mesh.edges().len()).map(|e| !closed[e]).collect();
        let all = PathOptions { tolerance, most: usize::MAX, seed };
        let mut found = paths_between(&mesh, &open, [a, b], &all);
        let everything = every_path(&mesh, &open, a, b, n);
        let shortest = everything.iter().map(Vec::len).min().unwrap_or(0);
        let mut wanted: Vec<Vec<usize>> = everything.into_iter()
            .filter(|path| !path.is_empty() && path.len() <= shortest + tolerance)
            .collect();
        prop_assert!(found.windows(2).all(|pair| pair[0].len() <= pair[1].len()));
        // Of a few the shortest: as many of each length as there is room for.
        let few = paths_between(&mesh, &open, [a, b], &PathOptions { most, ..all });
        prop_assert_eq!(few.len(), found.len().min(most));
        for (few, all) in few.iter().zip(&found) {
            prop_assert_eq!(few.len(), all.len());
        }
        prop_assert!(few.iter().all(|path| found.contains(path)));
        found.sort_unstable();
        wanted.sort_unstable();
        prop_assert_eq!(found, wanted);
    }
}

fn town(traffic: Traffic, sinks: Sinks) -> (Tessellation, Problem) {
    let mesh = grid(10, 10, &|_| true);
    let spec = Specification {
        travel: 0.2,
        traffic,
        sinks,
        ..Specification::default()
    };
    let problem = spec.on(&mesh).unwrap();
    (mesh, problem)
}

proptest! {
    #![proptest_config(config(6))]

    /// Whatever the search says of a whole town is valid, and has the spans that
    /// it has to have.
    #[test]
    fn what_the_search_says_of_towns_is_valid(
        parts in 1_usize..7,
        pairs in 1_usize..4,
        seed in any::<u64>(),
        inside in prop_oneof![Just(Feature::Forbidden), Just(Feature::Weighted(0.5))],
        across in prop_oneof![Just(Feature::Free), Just(Feature::Weighted(1.0))],
        count in prop::option::of(1_usize..4),
        among in prop_oneof![Just(Among::Boundary), Just(Among::Interior), Just(Among::Anywhere)],
    ) {
        let traffic = Traffic {
            inside: Some(Inside { parts: Parts::Count(parts), seed, missing: inside, ..Inside::default() }),
            across: Some(Across { pairs: Pairs::Count(pairs), seed, missing: across, ..Across::default() }),
            ..Traffic::default()
        };
        let sinks = count.map_or(Sinks::Boundary, |count| Sinks::Placed { count, among });
        let (_, problem) = town(traffic, sinks);
        let expected = if across == Feature::Free { 0 } else { pairs };
        let of = |kind| problem.routes.iter().filter(move |r| r.kind == kind);
        prop_assert_eq!(of(RouteKind::Across).count(), expected);
        // Parts are joined to each other, so pairs to a connected graph.
        prop_assert!(of(RouteKind::Inside).count() + 1 >= parts);
        for route in &problem.routes {
            prop_assert_eq!(route.cost.is_none(), route.kind == RouteKind::Inside && inside == Feature::Forbidden);
        }
        let found = search(&problem, 1500, seed);
        if let Some(network) = &found.network {
            prop_assert_eq!(verify(&problem, network), vec![]);
            prop_assert_eq!(network.sinks.len(), count.unwrap_or(0));
            let missing = problem.routes.iter().filter(|r| !r.is_there(&network.active));
            let cost: f64 = missing.map(|r| r.cost.unwrap()).sum();
            prop_assert!((found.cost.routes - cost).abs() < 1e-9);
        }
        let again = search(&problem, 1500, seed);
        prop_assert_eq!(again.network, found.network);
    }
}

/// Figures 2c and 8e in small: spans tie the network together, and sinks find
/// places on the boundary.
#[test]
fn spans_and_sinks_do_what_they_are_for() {
    let (_, plain) = town(Traffic::default(), Sinks::Boundary);
    let inside = Traffic {
        inside: Some(Inside::default()),
        ..Traffic::default()
    };
    let (_, joined) = town(inside, Sinks::Boundary);
    assert!(joined.routes.len() >= 3);
    let [a, b] = [&plain, &joined].map(|problem| search(problem, 8000, 0));
    // Spans only add.
    assert!(b.cost.objective > a.cost.objective);
    let there = |o: &Outcome| {
        let active = o.network.as_ref().unwrap().active.clone();
        joined
            .routes
            .iter()
            .filter(move |r| r.is_there(&active))
            .count()
    };
    assert_eq!(there(&b), joined.routes.len());
    assert!(there(&a) < joined.routes.len());
    let placed = Sinks::Placed {
        count: 3,
        among: Among::Boundary,
    };
    let (mesh, problem) = town(Traffic::default(), placed);
    let found = search(&problem, 8000, 0);
    let network = found.network.unwrap();
    assert_eq!(verify(&problem, &network), []);
    assert_eq!(network.sinks.len(), 3);
    // All side by side would be a bad choice: some two are five apart or more.
    let apart = |a: usize, b: usize| {
        let way = mesh.points()[a] - mesh.points()[b];
        way.x.hypot(way.y)
    };
    let s = &network.sinks;
    assert!([apart(s[0], s[1]), apart(s[1], s[2]), apart(s[0], s[2])]
        .iter()
        .any(|&d| d >= 5.0));
}

#[test]
fn new_families_are_named_in_conflicts() {
    let mesh = grid(4, 4, &|_| true);
    // The middle column is an obstacle, so nothing leads from side to side.
    let spec = Specification {
        rim: Rim::Open,
        too_close: Feature::Free,
        dead_ends: Feature::Free,
        obstacles: vec![2, 7, 12, 17, 22],
        sinks: Sinks::At(vec![0, 4]),
        ..Specification::default()
    };
    let limits = Limits::default();
    let named = |problem: &Problem| conflicts(problem, &Microlp, &limits).unwrap();
    let mut problem = spec.on(&mesh).unwrap();
    assert_eq!(named(&problem), None);
    let route = |kind, cost| Route {
        kind,
        cost,
        paths: vec![vec![
            mesh.edge_between(1, 2).unwrap(),
            mesh.edge_between(2, 3).unwrap(),
        ]],
    };
    for (kind, family) in [
        (RouteKind::Inside, Constraints::Inside),
        (RouteKind::Across, Constraints::Across),
        (RouteKind::Asked, Constraints::Routes),
    ] {
        problem.routes = vec![route(kind, Some(3.0))];
        assert_eq!(named(&problem), None);
        problem.routes = vec![route(kind, None)];
        let conflict = named(&problem).unwrap();
        assert_eq!(conflict.each, [Constraints::ClosedEdges, family]);
    }
    // Two sinks to be placed on the left alone, with places on the right to be
    // covered: without placing, or with sinks everywhere, there is a network.
    problem.routes.clear();
    problem.sinks = vec![false; 25];
    problem.placed = Some(PlacedSinks {
        candidates: vec![0, 1, 4],
        count: 1,
    });
    let conflict = named(&problem).unwrap();
    assert!(conflict.each.contains(&Constraints::PlacedSinks));
    assert!(conflict.each.contains(&Constraints::Connectivity));
}

#[test]
fn specifications_that_do_not_fit_say_why() {
    let mesh = grid(6, 6, &|_| true);
    let with = |traffic: Traffic, sinks: Sinks| {
        let spec = Specification {
            traffic,
            sinks,
            ..Specification::default()
        };
        spec.on(&mesh).map_err(|e| e.to_string())
    };
    let inside = |inside: Inside| {
        let traffic = Traffic {
            inside: Some(inside),
            ..Traffic::default()
        };
        with(traffic, Sinks::Boundary)
    };
    let across = |across: Across| {
        let traffic = Traffic {
            across: Some(across),
            ..Traffic::default()
        };
        with(traffic, Sinks::Boundary)
    };
    let says = |result: Result<Problem, String>, word: &str| {
        let error = result.unwrap_err();
        assert!(error.contains(word), "{error}");
    };
    says(
        inside(Inside {
            parts: Parts::Count(0),
            ..Inside::default()
        }),
        "parts",
    );
    says(
        inside(Inside {
            parts: Parts::Labels(vec![0]),
            ..Inside::default()
        }),
        "labels",
    );
    says(
        inside(Inside {
            tolerance: 40,
            ..Inside::default()
        }),
        "longer",
    );
    says(
        inside(Inside {
            most: 0,
            ..Inside::default()
        }),
        "0 paths",
    );
    // More parts than vertices that streets can touch.
    says(
        inside(Inside {
            parts: Parts::Count(36),
            ..Inside::default()
        }),
        "fewer",
    );
    says(
        across(Across {
            pairs: Pairs::Count(0),
            ..Across::default()
        }),
        "pairs",
    );
    says(
        across(Across {
            pairs: Pairs::Count(99),
            ..Across::default()
        }),
        "pairs",
    );
    let twice = [Place::Vertex(3), Place::Share { u: 0.5, v: 0.0 }];
    says(
        across(Across {
            pairs: Pairs::Between(vec![twice]),
            ..Across::default()
        }),
        "nothing joins",
    );
    let inner = [Place::Vertex(24), Place::Vertex(0)];
    says(
        across(Across {
            pairs: Pairs::Between(vec![inner]),
            ..Across::default()
        }),
        "24",
    );
    let missing = Feature::Weighted(-1.0);
    says(
        inside(Inside {
            missing,
            ..Inside::default()
        }),
        "costs -",
    );
    says(
        with(
            Traffic {
                to_sinks: f64::NAN,
                ..Traffic::default()
            },
            Sinks::Boundary,
        ),
        "NaN",
    );
    for count in [0, 25] {
        let placed = Sinks::Placed {
            count,
            among: Among::Boundary,
        };
        says(with(Traffic::default(), placed), "ask for 1 to 24");
    }
    let nowhere = Among::List(vec![Place::Vertex(99)]);
    says(
        with(
            Traffic::default(),
            Sinks::Placed {
                count: 1,
                among: nowhere,
            },
        ),
        "99",
    );
    // Where nothing can join two places it is an error, or no matter.
    let across_wall = |missing| {
        let spec = Specification {
            rim: Rim::Open,
            obstacles: (0..7).map(|k| 3 + 7 * k).collect(),
            traffic: Traffic {
                across: Some(Across {
                    pairs: Pairs::Between(vec![[Place::Vertex(21), Place::Vertex(27)]]),
                    missing,
                    ..Across::default()
                }),
                ..Traffic::default()
            },
            ..Specification::default()
        };
        spec.on(&mesh).map_err(|e| e.to_string())
    };
    says(across_wall(Feature::Forbidden), "no path");
    assert_eq!(across_wall(Feature::Weighted(2.0)).unwrap().routes, []);
}
