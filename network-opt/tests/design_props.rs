//! Laws of integer programs of networks: no row, cut or decision beforehand
//! loses a valid network by the checker, which knows nothing of programs.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::brute::{all_valid, open_edges};
use common::programs::{no_row_cuts_off, CLOSE};
use common::recipe::{config, mesh, pattern, recipe, Recipe};
use network_opt::design::{cost, EdgeState, PatternKind, Problem};
use network_opt::formulate::{longest_ways, Formulated, Formulation};
use network_opt::mip::Row;
use proptest::prelude::*;

proptest! {
    #![proptest_config(config(60))]

    /// Every valid network meets every row of every program, cuts included,
    /// and costs there what the checker says.
    #[test]
    fn no_program_cuts_off_a_valid_network(recipe in recipe()) {
        let problem = recipe.problem();
        prop_assume!(open_edges(&problem) <= 12);
        no_row_cuts_off(&problem, &all_valid(&problem))?;
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
