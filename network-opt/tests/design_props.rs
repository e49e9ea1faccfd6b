//! Laws of network design: the programs against the checker, which knows
//! nothing of them, and against trying all networks.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use network_opt::design::{
    cost, verify, EdgeState, Network, Pattern, PatternKind, Placement, Problem, Rooms, Route,
    Tessellation,
};
use network_opt::formulate::{longest_ways, prepare, Cuts, Fate, Formulated, Formulation};
use network_opt::geo_types::{coord, Coord};
use network_opt::mip::{Microlp, MipReply, MipSolver, MipStatus, Row};
use network_opt::solve::{Ended, Exact, Limits, NetworkSolver};
use proptest::prelude::*;
use proptest::sample::subsequence;

/// A thousand cases at least in long runs.
fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    let cases = if long { cases.max(50) * 20 } else { cases };
    ProptestConfig {
        cases,
        // Problems with many open edges are drawn as well, and passed over.
        max_global_rejects: 50 * cases.max(100),
        ..ProptestConfig::default()
    }
}

/// Solvers hold rows to a millionth; sums here have some tens of terms of size
/// one to ten.
const CLOSE: f64 = 1e-4;

/// A grid of quads, some of them cut into two triangles.
fn mesh(columns: usize, rows: usize, cut: &[bool]) -> Tessellation {
    let wide = columns + 1;
    let points: Vec<Coord<f64>> = (0..wide * (rows + 1))
        .map(|k| coord! { x: (k % wide) as f64, y: (k / wide) as f64 })
        .collect();
    let mut faces = Vec::new();
    for k in 0..columns * rows {
        let a = k / columns * wide + k % columns;
        let quad = [a, a + 1, a + wide + 1, a + wide];
        if cut[k % cut.len()] {
            faces.push(vec![quad[0], quad[1], quad[2]]);
            faces.push(vec![quad[0], quad[2], quad[3]]);
        } else {
            faces.push(quad.to_vec());
        }
    }
    Tessellation::new(points, faces).unwrap()
}

fn pattern(kind: PatternKind, active: &[usize], cost: Option<f64>) -> Pattern {
    Pattern {
        kind,
        active: active.to_vec(),
        inactive: Vec::new(),
        cost,
    }
}

/// What random problems are made of.
#[derive(Clone, Debug)]
struct Recipe {
    size: (usize, usize),
    cut: Vec<bool>,
    /// One number each, below 100.
    edges: Vec<u8>,
    vertices: Vec<u8>,
    range: usize,
    unit: bool,
    dead_ends: bool,
    close: u8,
    zig_zags: u8,
    branches: u8,
    weights: (u8, u8),
    route: bool,
    rooms: bool,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    let size = prop_oneof![Just((2, 1)), Just((3, 1)), Just((2, 2)), Just((1, 1))];
    let shape = (
        size,
        prop::collection::vec(prop::bool::weighted(0.15), 4),
        0_usize..3,
    );
    let lists = (
        prop::collection::vec(0_u8..100, 20),
        prop::collection::vec(0_u8..100, 12),
    );
    let local = (any::<bool>(), any::<bool>(), 0_u8..4, 0_u8..4, 0_u8..6);
    let rest = (
        (0_u8..3, 0_u8..3),
        prop::bool::weighted(0.3),
        prop::bool::weighted(0.25),
    );
    (shape, lists, local, rest).prop_map(|(shape, lists, local, rest)| Recipe {
        size: shape.0,
        cut: shape.1,
        range: shape.2,
        edges: lists.0,
        vertices: lists.1,
        unit: local.0,
        dead_ends: local.1,
        close: local.2,
        zig_zags: local.3,
        branches: local.4,
        weights: rest.0,
        route: rest.1,
        rooms: rest.2,
    })
}

impl Recipe {
    fn mesh(&self) -> Tessellation {
        mesh(self.size.0, self.size.1, &self.cut)
    }

    fn problem(&self) -> Problem {
        let mesh = self.mesh();
        let (edges, vertices) = (mesh.edges().len(), mesh.points().len());
        let draw = |list: &[u8], k: usize| list[k % list.len()];
        let states = (0..edges).map(|e| match draw(&self.edges, e) {
            0..=7 => EdgeState::Given,
            8..=10 => EdgeState::Required,
            11..=16 => EdgeState::Closed,
            _ => EdgeState::Open,
        });
        let lengths = (0..edges).map(|e| match self.unit {
            true => 1.0,
            false => 1.0 + f64::from(draw(&self.edges, e) % 5) / 4.0,
        });
        let drawn = |below: u8, from: u8| {
            let hits = (0..vertices).filter(move |&v| {
                let d = draw(&self.vertices, v);
                d >= from && d < from + below
            });
            hits.collect::<Vec<usize>>()
        };
        let mut sinks = vec![false; vertices];
        drawn(15, 0).into_iter().for_each(|v| sinks[v] = true);
        sinks[usize::from(self.vertices[0]) % vertices] = true;
        let mut patterns = Vec::new();
        let weight = |choice: u8| match choice {
            0 => None,
            1 => Some(Some(2.0)),
            _ => Some(None),
        };
        if let Some(cost) = weight(self.close) {
            let pairs = mesh.opposite_edges();
            patterns.extend(
                pairs
                    .iter()
                    .map(|p| pattern(PatternKind::TooClose, p, cost)),
            );
        }
        if let Some(cost) = weight(self.zig_zags) {
            let triples = mesh.zig_zags();
            patterns.extend(
                triples
                    .iter()
                    .map(|p| pattern(PatternKind::ZigZag, p, cost)),
            );
        }
        for v in (0..vertices).filter(|_| self.branches < 2) {
            let around: Vec<usize> = mesh.around(v).iter().map(|&(e, _)| e).collect();
            let cost = (self.branches == 1).then_some(1.0);
            for skipped in 0..around.len() {
                let mut three = around.clone();
                three.remove(skipped);
                if three.len() == 3 {
                    // Three of four: a T-junction.
                    patterns.push(Pattern {
                        inactive: vec![around[skipped]],
                        ..pattern(PatternKind::TJunction, &three, cost)
                    });
                }
            }
            if around.len() == 3 {
                patterns.push(pattern(PatternKind::Branch, &around, cost));
            }
        }
        let rooms = self.rooms.then(|| rooms(&mesh, &self.vertices));
        let places = if rooms.is_some() { 0 } else { vertices };
        let routes = if self.route {
            // Along the bottom, or along the top.
            let wide = self.size.0;
            let row = |base: usize| -> Vec<usize> {
                let steps = (0..wide).filter_map(|k| mesh.edge_between(base + k, base + k + 1));
                steps.collect()
            };
            vec![Route {
                cost: (self.zig_zags % 2 == 1).then_some(3.0),
                ..vec![row(0), row((wide + 1) * self.size.1)].into()
            }]
        } else {
            Vec::new()
        };
        Problem {
            vertices,
            ends: mesh.edges().to_vec(),
            lengths: lengths.collect(),
            states: states.collect(),
            sinks,
            coverage: (0..places).map(|v| mesh.ball(v, self.range)).collect(),
            required_vertices: drawn(6, 94),
            dead_ends: self.dead_ends,
            patterns,
            routes,
            rooms,
            length_weight: [1.0, 5.0, 1.0][usize::from(self.weights.0)],
            travel_weight: [0.0, 1.0, 0.001][usize::from(self.weights.1)],
            ..Problem::default()
        }
    }
}

/// Rooms of one face, and of two that share an edge.
fn rooms(mesh: &Tessellation, draws: &[u8]) -> Rooms {
    let faces = mesh.faces().len();
    let mut placements: Vec<Placement> = (0..faces)
        .map(|f| Placement {
            template: "one".into(),
            faces: vec![f],
            inner: Vec::new(),
            border: mesh.edges_of(f).to_vec(),
        })
        .collect();
    for e in 0..mesh.edges().len() {
        if let &[f, g] = mesh.faces_of(e) {
            let both = mesh.edges_of(f).iter().chain(mesh.edges_of(g));
            placements.push(Placement {
                template: "two".into(),
                faces: vec![f, g],
                inner: vec![e],
                border: both.copied().filter(|&k| k != e).collect(),
            });
        }
    }
    Rooms {
        placements,
        covered: (0..faces).map(|f| draws[f % draws.len()] >= 10).collect(),
        ..Rooms::default()
    }
}

/// All ways to cover the faces; one empty way without rooms.
fn tilings(problem: &Problem) -> Vec<Vec<usize>> {
    let Some(rooms) = &problem.rooms else {
        return vec![Vec::new()];
    };
    let mut found = Vec::new();
    let mut open = vec![(Vec::new(), vec![false; rooms.covered.len()])];
    while let Some((placed, full)) = open.pop() {
        let next = (0..full.len()).find(|&f| rooms.covered[f] && !full[f]);
        let Some(next) = next else {
            let mut placed: Vec<usize> = placed;
            placed.sort_unstable();
            found.push(placed);
            continue;
        };
        for (k, placement) in rooms.placements.iter().enumerate() {
            let fits = placement.faces.contains(&next)
                && placement
                    .faces
                    .iter()
                    .all(|&f| rooms.covered[f] && !full[f]);
            if fits {
                let (mut placed, mut full) = (placed.clone(), full.clone());
                placed.push(k);
                placement.faces.iter().for_each(|&f| full[f] = true);
                open.push((placed, full));
            }
        }
    }
    found
}

/// All valid networks.
fn all_valid(problem: &Problem) -> Vec<Network> {
    let open: Vec<usize> = (0..problem.edges())
        .filter(|&e| problem.states[e] == EdgeState::Open)
        .collect();
    let tilings = tilings(problem);
    let mut found = Vec::new();
    for set in 0_u32..1 << open.len() {
        let mut active: Vec<bool> = (problem.states.iter())
            .map(|s| matches!(s, EdgeState::Given | EdgeState::Required))
            .collect();
        for (k, &e) in open.iter().enumerate() {
            active[e] = set >> k & 1 == 1;
        }
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

fn open_edges(problem: &Problem) -> usize {
    let open = problem.states.iter().filter(|s| **s == EdgeState::Open);
    open.count()
}

const PROGRAMS: [Formulation; 4] = [
    Formulation::Flow,
    Formulation::TravelFlow,
    Formulation::SingleSink,
    Formulation::Paper,
];

/// What a program says that a network costs.
fn priced(problem: &Problem, formulation: Formulation, network: &Network) -> f64 {
    let cost = cost(problem, &network.active);
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
    #![proptest_config(config(60))]

    /// Every valid network meets every row of every program, cuts included,
    /// and costs there what the checker says.
    #[test]
    fn no_program_cuts_off_a_valid_network(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 12);
        let fates = prepare(&problem);
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost(&problem, &n.active).objective);
        let worst = costs.fold(0.0, f64::max);
        for formulation in PROGRAMS {
            let longest = longest_ways(&problem, worst);
            let formulated = Formulated::new(&problem, formulation, Some(longest)).unwrap();
            if !valid.is_empty() {
                prop_assert!(!formulated.contradicts());
            }
            for network in &valid {
                for (e, &fate) in fates.iter().enumerate() {
                    prop_assert!(fate == Fate::Open || (fate == Fate::On) == network.active[e]);
                }
                let values = formulated.solution(network);
                let violation = formulated.program().violation(&values);
                prop_assert!(violation < CLOSE, "{formulation:?} by {violation}");
                prop_assert_eq!(&formulated.network(&values), network);
                if comparable(&problem, formulation) {
                    let (said, is) = (
                        formulated.program().objective(&values),
                        priced(&problem, formulation, network),
                    );
                    prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
                    let step = formulated.program().step();
                    prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < 1e-6);
                }
            }
        }
    }

    /// The ways of a network are no longer than what it costs allows.
    #[test]
    fn ways_are_bounded_by_costs(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        for network in all_valid(&problem) {
            let cost = cost(&problem, &network.active).objective;
            let bounds = longest_ways(&problem, cost);
            let away = network_opt::design::distances(&problem, &network.active);
            for v in (0..problem.vertices).filter(|&v| away[v].is_finite()) {
                prop_assert!(away[v] <= bounds[v], "{v}: {} over {}", away[v], bounds[v]);
            }
        }
    }

    /// Cuts that a random point violates hold for every valid network.
    #[test]
    fn cuts_cut_off_no_valid_network(
        recipe in recipe(),
        rooms in any::<bool>(),
        travel in any::<bool>(),
        point in prop::collection::vec(0.0..1.0_f64, 40),
    ) {
        let mut problem = Recipe { rooms, ..recipe }.problem();
        problem.travel_weight = f64::from(u8::from(travel));
        prop_assume!(open_edges(&problem) <= 12);
        let valid = all_valid(&problem);
        for formulation in [Formulation::Flow, Formulation::TravelFlow, Formulation::SingleSink] {
            let formulated = Formulated::new(&problem, formulation, None).unwrap();
            let n = formulated.program().columns().len();
            // Little of most columns, so that much is violated.
            let values: Vec<f64> = (0..n).map(|k| point[k % point.len()].powi(4)).collect();
            let rows = formulated.separate(&values, 0.01);
            let sum = |row: &Row, values: &[f64]| -> f64 {
                row.terms.iter().map(|&(c, factor)| factor * values[c]).sum()
            };
            for row in &rows {
                prop_assert!(sum(row, &values) < row.low - 0.01 + CLOSE);
            }
            for network in &valid {
                let solution = formulated.solution(network);
                for row in &rows {
                    prop_assert!(sum(row, &solution) >= row.low - CLOSE, "{formulation:?}: {row:?}");
                }
            }
        }
    }
}

/// The least cost that a solver finds; none if there is no network.
fn optimum(problem: &Problem, formulation: Formulation, solver: &impl MipSolver) -> Option<f64> {
    let formulated = Formulated::new(problem, formulation, None).unwrap();
    if formulated.contradicts() {
        return None;
    }
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let found = solver
        .solve(formulated.program(), None, &limits, &mut |_| MipReply::GoOn)
        .unwrap();
    if found.status == MipStatus::Infeasible {
        return None;
    }
    assert_eq!(found.status, MipStatus::Optimal);
    let values = found.solution.unwrap();
    let network = formulated.network(&values);
    assert_eq!(verify(problem, &network), [], "{formulation:?}");
    // The network itself costs no more than its solution says, and no less
    // where distances are the true ones.
    if comparable(problem, formulation) {
        let is = priced(problem, formulation, &network);
        assert!(
            (is - found.objective).abs() < 1e-3,
            "{formulation:?}: {is} for {}",
            found.objective
        );
    }
    Some(found.objective)
}

fn agrees(problem: &Problem, solver: &impl MipSolver) -> Result<(), TestCaseError> {
    let valid = all_valid(problem);
    for formulation in PROGRAMS {
        let best = (valid.iter().map(|n| priced(problem, formulation, n))).min_by(f64::total_cmp);
        let found = optimum(problem, formulation, solver);
        if comparable(problem, formulation) {
            let same = match (best, found) {
                (Some(best), Some(found)) => (best - found).abs() < 1e-3,
                (None, None) => true,
                _ => false,
            };
            prop_assert!(
                same,
                "{formulation:?} found {found:?}, the best is {best:?}"
            );
        } else {
            prop_assert_eq!(best.is_some(), found.is_some());
        }
    }
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
}

fn solved(problem: &Problem) -> Option<f64> {
    solved_by(&Exact::new(Microlp), problem)
}

fn solved_by(solver: &impl NetworkSolver, problem: &Problem) -> Option<f64> {
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let found = solver.solve(problem, None, &limits, &mut |_| true).unwrap();
    match found.ended {
        Ended::Proven => {
            assert!(found.bound <= found.cost.objective + 1e-6);
            Some(found.cost.objective)
        }
        Ended::Infeasible => None,
        other => panic!("{other:?} without a limit"),
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
            let all = |n: usize| subsequence((0..n).collect::<Vec<_>>(), n).prop_shuffle();
            (Just(recipe), all(mesh.points().len()), all(mesh.edges().len()))
        })
    ) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 10);
        let mut other = problem.clone();
        // Vertex v becomes vertices[v], edge e edges[e].
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
            rename(&mut p.inactive, &edges);
        }
        let paths = other.routes.iter_mut().flat_map(|r| &mut r.paths);
        paths.for_each(|path| rename(path, &edges));
        for room in other.rooms.iter_mut().flat_map(|r| &mut r.placements) {
            rename(&mut room.inner, &edges);
            rename(&mut room.border, &edges);
        }
        match (solved(&problem), solved(&other)) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < CLOSE, "{a} and {b}"),
            (a, b) => prop_assert_eq!(a, b),
        }
    }
}

/// A fan of `n` quads around a middle vertex, each rim vertex on a spoke with an
/// edge outwards to a sink: the ball of two edges around the middle is the fan.
/// Vertices: the middle, then spoke and corner in turn, then the sinks.
fn fan(n: usize) -> Problem {
    let (spoke, corner) = (|k: usize| 1 + 2 * (k % n), |k: usize| 2 + 2 * (k % n));
    let mut ends = Vec::new();
    ends.extend((0..n).map(|k| [0, spoke(k)]));
    ends.extend((0..n).map(|k| [spoke(k), corner(k)]));
    ends.extend((0..n).map(|k| [corner(k), spoke(k + 1)]));
    ends.extend((0..n).map(|k| [corner(k), 1 + 2 * n + k]));
    // Quad k: middle, spoke k, corner k, spoke k + 1.
    let close = (0..n).flat_map(|k| [[k, 2 * n + k], [n + k, (k + 1) % n]]);
    let vertices = 1 + 3 * n;
    Problem {
        vertices,
        lengths: vec![1.0; ends.len()],
        states: vec![EdgeState::Open; ends.len()],
        ends,
        sinks: (0..vertices).map(|v| v > 2 * n).collect(),
        coverage: vec![(0..=2 * n).collect()],
        patterns: close
            .map(|pair| pattern(PatternKind::TooClose, &pair, None))
            .collect(),
        length_weight: 1.0,
        ..Problem::default()
    }
}

/// The cut of a ball around vertices of valence 3 and 4 (5 in long runs), over
/// all networks; and it is the best: some network meets it with equality.
#[test]
fn ball_cuts_hold_at_irregular_vertices() {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    for n in 3..=if long { 5 } else { 4 } {
        for closeness in [true, false] {
            let mut problem = fan(n);
            if !closeness {
                problem.patterns.clear();
            }
            let formulated = Formulated::new(&problem, Formulation::Flow, None).unwrap();
            let valid = all_valid(&problem);
            assert!(!valid.is_empty());
            let mut least = f64::INFINITY;
            for network in &valid {
                let values = formulated.solution(network);
                assert!(formulated.program().violation(&values) < CLOSE);
                let out = network.active[3 * n..].iter().filter(|&&on| on).count();
                least = least.min(out as f64);
            }
            // One way out is enough for the rim, which is a cycle.
            assert_eq!(least, 1.0);
        }
    }
}

/// A row of squares, its first vertex the sink; vertex 2 k + 1 is over 2 k.
fn ladder(squares: usize, coverage: &[&[usize]]) -> Problem {
    let mut ends = vec![[0, 1]];
    for k in 0..squares {
        let [a, b, c, d] = [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3];
        ends.extend([[a, c], [b, d], [c, d]]);
    }
    Problem {
        vertices: 2 * squares + 2,
        lengths: vec![1.0; ends.len()],
        states: vec![EdgeState::Open; ends.len()],
        sinks: (0..2 * squares + 2).map(|v| v == 0).collect(),
        coverage: coverage.iter().map(|set| set.to_vec()).collect(),
        length_weight: 1.0,
        ends,
        ..Problem::default()
    }
}

/// Rings that share an edge are counted once, those that are one and the same
/// are not: over all networks, of which each sum of rings is as large in one as
/// its row allows.
#[test]
fn rings_with_a_common_edge_are_told_apart() {
    let shared: [&[usize]; 2] = [&[2, 3, 4, 5], &[4, 5, 6, 7]];
    let same: [&[usize]; 2] = [&[2, 3, 4, 5, 6], &[2, 3, 4, 5, 7]];
    for (coverage, together) in [(shared, false), (same, true)] {
        let problem = ladder(4, &coverage);
        let formulated = Formulated::new(&problem, Formulation::Flow, None).unwrap();
        let columns = formulated.program().columns();
        // The only columns that are real and cost nothing before those of the flow.
        let first = columns.iter().position(|c| !c.integer).unwrap();
        let rings = [first, first + 1];
        // On the edge that the squares share, or each on its own edges.
        let edge = problem.ends.iter().position(|&e| e == [4, 5]).unwrap();
        let common = |row: &Row| {
            let factor = |c: usize| row.terms.iter().find(|t| t.0 == c).map(|t| t.1);
            rings.iter().all(|&r| factor(r) == Some(-1.0)) && factor(edge) == Some(1.0)
        };
        let rows = formulated.program().rows();
        assert_eq!(rows.iter().any(common), !together);
        let mut most: f64 = 0.0;
        let valid = all_valid(&problem);
        assert!(!valid.is_empty());
        for network in &valid {
            let values = formulated.solution(network);
            assert!(formulated.program().violation(&values) < CLOSE);
            most = most.max(rings.iter().map(|&r| values[r]).sum());
        }
        assert_eq!(most, if together { 2.0 } else { 1.0 });
    }
}

/// The paper's own formulation has the paper's number of variables: 2241 for
/// figure 2a, twelve by twelve quads, the boundary given and all sinks. The
/// paper did not count those of dead ends and zig-zags.
#[test]
fn the_papers_variables_are_counted() {
    let mesh = mesh(12, 12, &[false]);
    let rim: Vec<bool> = mesh.rim().collect();
    let mut sinks = vec![false; mesh.points().len()];
    for (e, ends) in mesh.edges().iter().enumerate() {
        ends.iter().for_each(|&v| sinks[v] |= rim[e]);
    }
    let close = mesh.opposite_edges();
    let problem = Problem {
        vertices: mesh.points().len(),
        ends: mesh.edges().to_vec(),
        lengths: vec![1.0; mesh.edges().len()],
        states: rim
            .iter()
            .map(|&on| {
                if on {
                    EdgeState::Given
                } else {
                    EdgeState::Open
                }
            })
            .collect(),
        sinks,
        coverage: (0..mesh.points().len()).map(|v| mesh.ball(v, 2)).collect(),
        patterns: (close.iter())
            .map(|p| pattern(PatternKind::TooClose, p, None))
            .collect(),
        dead_ends: true,
        length_weight: 1.0,
        ..Problem::default()
    };
    assert_eq!(mesh.edges().len(), 312);
    let formulated = Formulated::new(&problem, Formulation::Paper, None).unwrap();
    assert_eq!(formulated.program().columns().len(), 2241);
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
