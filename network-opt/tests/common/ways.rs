//! Random problems of one-way streets, and all networks with all directions.

use network_opt::design::{cost, verify, EdgeState, Network, Pattern, PatternKind, Problem, Way};
use proptest::prelude::*;

use super::grid;

/// Networks that are tried at most.
const MOST: usize = 20_000;

/// What random problems are made of.
#[derive(Clone, Debug)]
pub(crate) struct Recipe {
    pub(crate) size: (usize, usize),
    pub(crate) states: Vec<u8>,
    pub(crate) ways: Vec<u8>,
    pub(crate) costs: Vec<(u8, u8)>,
    pub(crate) vertices: Vec<u8>,
    pub(crate) range: usize,
    pub(crate) dead_ends: bool,
    pub(crate) close: u8,
    pub(crate) weights: (u8, u8),
}

pub(crate) fn recipe() -> impl Strategy<Value = Recipe> {
    let size = prop_oneof![Just((2, 1)), Just((3, 1)), Just((2, 2)), Just((1, 1))];
    let edges = (
        prop::collection::vec(0_u8..100, 12),
        prop::collection::vec(0_u8..100, 12),
        prop::collection::vec((0_u8..5, 0_u8..5), 12),
    );
    let rest = (
        prop::collection::vec(0_u8..100, 9),
        0_usize..3,
        any::<bool>(),
        0_u8..4,
        (0_u8..3, 0_u8..4),
    );
    (size, edges, rest).prop_map(|(size, edges, rest)| Recipe {
        size,
        states: edges.0,
        ways: edges.1,
        costs: edges.2,
        vertices: rest.0,
        range: rest.1,
        dead_ends: rest.2,
        close: rest.3,
        weights: rest.4,
    })
}

impl Recipe {
    pub(crate) fn problem(&self) -> Problem {
        let mesh = grid(self.size.0, self.size.1);
        let (edges, vertices) = (mesh.edges().len(), mesh.points().len());
        let states = (0..edges).map(|e| match self.states[e % 12] {
            0..=11 => EdgeState::Given,
            12..=15 => EdgeState::Required,
            16..=19 => EdgeState::Closed,
            _ => EdgeState::Open,
        });
        let ways = (0..edges).map(|e| match self.ways[e % 12] {
            0..=34 => Way::Both,
            35..=44 => Way::Forward,
            45..=54 => Way::Backward,
            _ => Way::Either,
        });
        let sinks = (0..vertices).map(|v| self.vertices[v % 9] < 15);
        let mut sinks: Vec<bool> = sinks.collect();
        sinks[usize::from(self.vertices[0]) % vertices] = true;
        let quarter = |k: u8| 1.0 + f64::from(k) / 4.0;
        let patterns = match self.close {
            2 => Some(Some(2.0)),
            3 => Some(None),
            _ => None,
        };
        let patterns = patterns.map_or_else(Vec::new, |cost| {
            let pairs = mesh.opposite_edges();
            let close = |pair: [usize; 2]| Pattern {
                kind: PatternKind::TooClose,
                active: pair.to_vec(),
                inactive: Vec::new(),
                cost,
            };
            pairs.into_iter().map(close).collect()
        });
        Problem {
            vertices,
            ends: mesh.edges().to_vec(),
            lengths: (0..edges).map(|e| quarter(self.costs[e % 12].0)).collect(),
            travel_costs: (0..edges).map(|e| quarter(self.costs[e % 12].1)).collect(),
            states: states.collect(),
            ways: ways.collect(),
            sinks,
            coverage: (0..vertices).map(|v| mesh.ball(v, self.range)).collect(),
            required_vertices: (0..vertices)
                .filter(|v| self.vertices[v % 9] >= 94)
                .collect(),
            dead_ends: self.dead_ends,
            patterns,
            length_weight: [1.0, 5.0, 1.0][usize::from(self.weights.0)],
            travel_weight: [0.0, 1.0, 0.001, 4.0][usize::from(self.weights.1)],
            ..Problem::default()
        }
    }
}

/// All networks with all directions, valid or not; none if there are too many.
pub(crate) fn all_networks(problem: &Problem) -> Option<Vec<Network>> {
    let mut found = vec![(Vec::new(), Vec::new())];
    for e in 0..problem.edges() {
        let (may, must) = match problem.states[e] {
            EdgeState::Open => (true, false),
            EdgeState::Given | EdgeState::Required => (true, true),
            EdgeState::Closed => (false, false),
        };
        let mut choices = Vec::new();
        if !must {
            choices.push((false, problem.way(e)));
        }
        if may {
            match problem.way(e) {
                Way::Either => choices.extend([(true, Way::Forward), (true, Way::Backward)]),
                way => choices.push((true, way)),
            }
        }
        if found.len() * choices.len() > MOST {
            return None;
        }
        let extended = found.iter().flat_map(|(active, ways)| {
            choices.iter().map(move |&(on, way)| {
                let (mut active, mut ways): (Vec<bool>, Vec<Way>) = (active.clone(), ways.clone());
                active.push(on);
                ways.push(way);
                (active, ways)
            })
        });
        found = extended.collect();
    }
    let open = problem.has_choice_of_ways();
    let network = |(active, ways)| Network {
        active,
        ways: if open { ways } else { Vec::new() },
        ..Network::default()
    };
    Some(found.into_iter().map(network).collect())
}

pub(crate) fn all_valid(problem: &Problem) -> Option<Vec<Network>> {
    let mut all = all_networks(problem)?;
    all.retain(|network| verify(problem, network).is_empty());
    Some(all)
}

pub(crate) fn best(problem: &Problem, valid: &[Network]) -> f64 {
    let costs = valid.iter().map(|n| cost(problem, n).objective);
    costs.fold(f64::INFINITY, f64::min)
}
