//! A network in the making: what it costs, and what is wrong with it.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use crate::design::{EdgeState, Problem};

/// Kinds of faults: patterns, dead ends, places, islands, routes.
pub(super) const KINDS: usize = 5;
const PATTERNS: usize = 0;
const DEAD_ENDS: usize = 1;
const PLACES: usize = 2;
const ISLANDS: usize = 3;
const ROUTES: usize = 4;

/// What a network is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Worth {
    /// How many faults of each kind there are.
    pub(super) faults: [usize; KINDS],
    /// What is to be small.
    pub(super) objective: f64,
}

impl Worth {
    /// Fewer faults first, then the smaller objective.
    pub(super) fn rank(&self, other: &Self) -> Ordering {
        let count = |w: &Self| w.faults.iter().sum::<usize>();
        count(self)
            .cmp(&count(other))
            .then(self.objective.total_cmp(&other.objective))
    }

    /// Whether nothing that makes a network valid in the paper's sense has become
    /// worse: places covered, no islands, routes whole.
    fn is_no_worse(&self, before: &Self) -> bool {
        [PLACES, ISLANDS, ROUTES]
            .iter()
            .all(|&kind| self.faults[kind] <= before.faults[kind])
    }
}

/// A network with counters, so that the edges of an operation are toggled, and
/// toggled back, in no time; islands and travel are found anew each time.
#[derive(Debug)]
pub(super) struct Draft<'p> {
    problem: &'p Problem,
    around: Vec<Vec<(usize, usize)>>,
    /// Patterns, places and routes by edge, vertex and edge.
    patterns_at: Vec<Vec<usize>>,
    places_at: Vec<Vec<usize>>,
    routes_at: Vec<Vec<usize>>,
    active: Vec<bool>,
    degree: Vec<usize>,
    /// Active vertices of each place that is to be covered; the vertices that
    /// must be active are places of one vertex.
    covers: Vec<usize>,
    /// How many edges of each pattern are not as it has them.
    lacks: Vec<usize>,
    faults: [usize; KINDS],
    length: f64,
    pattern_cost: f64,
    away: Vec<f64>,
    heap: BinaryHeap<(Reverse<Way>, usize)>,
}

/// A length that is a number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Way(f64);

impl Eq for Way {}

impl PartialOrd for Way {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Way {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl<'p> Draft<'p> {
    /// Every edge active that may be, or those of a valid network.
    pub(super) fn new(problem: &'p Problem, start: Option<&[bool]>) -> Self {
        let (edges, vertices) = (problem.edges(), problem.vertices);
        let mut patterns_at = vec![Vec::new(); edges];
        for (k, pattern) in problem.patterns.iter().enumerate() {
            for &e in pattern.active.iter().chain(&pattern.inactive) {
                patterns_at[e].push(k);
            }
        }
        let single = problem.required_vertices.iter().map(std::slice::from_ref);
        let places = problem.coverage.iter().map(Vec::as_slice).chain(single);
        let mut places_at = vec![Vec::new(); vertices];
        let mut count = 0;
        for place in places {
            place.iter().for_each(|&v| places_at[v].push(count));
            count += 1;
        }
        let mut routes_at = vec![Vec::new(); edges];
        for (k, route) in problem.routes.iter().enumerate() {
            let edges = route.paths.iter().flatten();
            edges.for_each(|&e| routes_at[e].push(k));
        }
        for lists in [&mut patterns_at, &mut routes_at, &mut places_at] {
            lists.iter_mut().for_each(Vec::dedup);
        }
        let mut draft = Self {
            problem,
            around: problem.around(),
            patterns_at,
            places_at,
            routes_at,
            active: vec![false; edges],
            degree: vec![0; vertices],
            covers: vec![0; count],
            lacks: Vec::new(),
            faults: [0; KINDS],
            length: 0.0,
            pattern_cost: 0.0,
            away: Vec::new(),
            heap: BinaryHeap::new(),
        };
        draft.lacks = (0..problem.patterns.len())
            .map(|k| draft.lacking(k))
            .collect();
        for k in 0..draft.lacks.len() {
            draft.count_pattern(k, true);
        }
        draft.faults[PLACES] = count;
        draft.faults[ROUTES] = (0..problem.routes.len())
            .filter(|&k| draft.is_faulty(k))
            .count();
        let first = |e: &usize| match start {
            Some(active) => active[*e],
            None => problem.states[*e] != EdgeState::Closed,
        };
        draft.toggle(&(0..edges).filter(first).collect::<Vec<_>>());
        draft
    }

    pub(super) fn active(&self) -> &[bool] {
        &self.active
    }

    /// The edges at a vertex, and their other ends.
    pub(super) fn around(&self, v: usize) -> &[(usize, usize)] {
        &self.around[v]
    }

    /// How many edges of a pattern are not as it has them.
    fn lacking(&self, k: usize) -> usize {
        let pattern = &self.problem.patterns[k];
        let off = pattern.active.iter().filter(|&&e| !self.active[e]);
        let on = pattern.inactive.iter().filter(|&&e| self.active[e]);
        off.count() + on.count()
    }

    /// Counts a pattern that occurs, or takes it off the count.
    fn count_pattern(&mut self, k: usize, more: bool) {
        if self.lacks[k] > 0 {
            return;
        }
        match (self.problem.patterns[k].cost, more) {
            (Some(cost), true) => self.pattern_cost += cost,
            (Some(cost), false) => self.pattern_cost -= cost,
            (None, true) => self.faults[PATTERNS] += 1,
            (None, false) => self.faults[PATTERNS] -= 1,
        }
    }

    /// Whether no path of a route is active throughout.
    fn is_cut(&self, k: usize) -> bool {
        let whole = |path: &Vec<usize>| path.iter().all(|&e| self.active[e]);
        !self.problem.routes[k].paths.iter().any(whole)
    }

    /// Whether a route that must be there is cut.
    fn is_faulty(&self, k: usize) -> bool {
        self.problem.routes[k].cost.is_none() && self.is_cut(k)
    }

    /// What cut routes cost that need not be there.
    fn route_cost(&self) -> f64 {
        let costs = self.problem.routes.iter().enumerate();
        costs
            .filter_map(|(k, route)| route.cost.filter(|_| self.is_cut(k)))
            .sum()
    }

    fn is_dead_end(&self, v: usize) -> bool {
        !self.problem.dead_ends && self.degree[v] == 1 && !self.problem.sinks[v]
    }

    /// Makes active edges inactive and the other way round.
    pub(super) fn toggle(&mut self, edges: &[usize]) {
        for &e in edges {
            self.toggle_one(e);
        }
    }

    fn toggle_one(&mut self, e: usize) {
        let on = !self.active[e];
        let cut = |draft: &Self| {
            let routes = draft.routes_at[e].iter();
            routes.filter(|&&k| draft.is_faulty(k)).count()
        };
        self.faults[ROUTES] -= cut(self);
        let patterns = std::mem::take(&mut self.patterns_at[e]);
        patterns.iter().for_each(|&k| self.count_pattern(k, false));
        self.active[e] = on;
        for &k in &patterns {
            self.lacks[k] = self.lacking(k);
            self.count_pattern(k, true);
        }
        self.patterns_at[e] = patterns;
        self.faults[ROUTES] += cut(self);
        if !self.problem.is_given(e) {
            self.length += if on { 1.0 } else { -1.0 } * self.problem.lengths[e];
        }
        for v in self.problem.ends[e] {
            self.faults[DEAD_ENDS] -= usize::from(self.is_dead_end(v));
            let was_active = self.degree[v] > 0;
            if on {
                self.degree[v] += 1;
            } else {
                self.degree[v] -= 1;
            }
            self.faults[DEAD_ENDS] += usize::from(self.is_dead_end(v));
            let is_active = self.degree[v] > 0;
            if was_active != is_active {
                for &place in &self.places_at[v] {
                    if is_active {
                        self.covers[place] += 1;
                        self.faults[PLACES] -= usize::from(self.covers[place] == 1);
                    } else {
                        self.covers[place] -= 1;
                        self.faults[PLACES] += usize::from(self.covers[place] == 0);
                    }
                }
            }
        }
    }

    /// What the network is worth with edges toggled, if that is feasible; it
    /// stays as it is.
    pub(super) fn tried(&mut self, edges: &[usize], before: &Worth) -> Option<Worth> {
        let (length, patterns) = (self.length, self.pattern_cost);
        self.toggle(edges);
        let mut faults = self.faults;
        faults[ISLANDS] = 0;
        let hopeful = Worth {
            faults,
            objective: 0.0,
        };
        let worth = hopeful.is_no_worse(before).then(|| self.worth());
        self.toggle(edges);
        // So that rounding does not add up.
        (self.length, self.pattern_cost) = (length, patterns);
        worth.filter(|worth| worth.is_no_worse(before))
    }

    /// What the network is worth.
    pub(super) fn worth(&mut self) -> Worth {
        self.measure();
        let (mut travel, mut islands) = (0.0, 0);
        for (e, &[a, b]) in self.problem.ends.iter().enumerate() {
            if !self.active[e] {
                continue;
            }
            let nearer = self.away[a].min(self.away[b]);
            if nearer.is_infinite() {
                islands += 1;
            } else if !self.problem.is_given(e) {
                travel += nearer;
            }
        }
        let mut faults = self.faults;
        faults[ISLANDS] = islands;
        let problem = self.problem;
        let travelled = problem.travel_weight * travel;
        Worth {
            faults,
            objective: problem.length_weight * self.length
                + travelled
                + self.pattern_cost
                + self.route_cost(),
        }
    }

    /// The ways from all vertices to their nearest sinks, by Dijkstra's
    /// algorithm.
    fn measure(&mut self) {
        self.away.clear();
        self.away.resize(self.problem.vertices, f64::INFINITY);
        for (v, _) in self.problem.sinks.iter().enumerate().filter(|(_, &s)| s) {
            self.away[v] = 0.0;
            self.heap.push((Reverse(Way(0.0)), v));
        }
        while let Some((Reverse(Way(gone)), v)) = self.heap.pop() {
            if gone > self.away[v] {
                continue;
            }
            for &(e, w) in &self.around[v] {
                let there = gone + self.problem.travel_cost(e);
                if self.active[e] && there < self.away[w] {
                    self.away[w] = there;
                    self.heap.push((Reverse(Way(there)), w));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{cost, verify, Network, Route, RouteKind, Specification, Tessellation};

    /// Counters agree with the checker that counts anew, whatever is toggled.
    #[test]
    fn counters_agree_with_the_checker() {
        let mesh = Tessellation::grid(5, 4);
        let mut problem = Specification::default().on(&mesh).expect("fits");
        problem.required_vertices = vec![8, 9];
        let route = |paths, cost| Route {
            kind: RouteKind::Inside,
            paths,
            cost,
        };
        problem.routes = vec![
            route(vec![vec![3, 4], vec![12]], None),
            route(vec![vec![20]], None),
            route(vec![vec![9], vec![5, 6]], Some(2.5)),
        ];
        let mut draft = Draft::new(&problem, None);
        let mut e = 0;
        for round in 0..300 {
            e = (e + 7 + round) % problem.edges();
            draft.toggle(&[e]);
            let worth = draft.worth();
            let network = Network {
                active: draft.active().to_vec(),
                ..Network::default()
            };
            let wrong = verify(&problem, &network).into_iter();
            // Given and closed edges are not the draft's business.
            let wrong = wrong.filter(|v| {
                !matches!(
                    v,
                    crate::design::Violation::Missing { .. }
                        | crate::design::Violation::Forbidden { .. }
                )
            });
            assert_eq!(worth.faults.iter().sum::<usize>(), wrong.count());
            if worth.faults[ISLANDS] == 0 {
                let cost = cost(&problem, &network.active);
                assert!((cost.objective - worth.objective).abs() < 1e-9);
            }
            let before = draft.active().to_vec();
            let _ = draft.tried(&[e, (e + 3) % problem.edges()], &worth);
            assert_eq!(draft.active(), before);
        }
    }
}
