//! Paths over inactive edges from a vertex to the network: ears.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::model::{Fate, Model};
use super::state::State;
use super::turns::passes;
use crate::design::Heading;

/// How a path is to be found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Manner {
    /// By how much prices vary at random, relative to themselves.
    pub(super) noise: f64,
    /// Of the random variation.
    pub(super) salt: u64,
    /// What a forbidden pattern costs; infinite if it may not be.
    pub(super) breach: f64,
    /// What an edge inside a room costs; infinite if it may not be.
    pub(super) breakthrough: f64,
    /// What covering one more row is worth.
    pub(super) reward: f64,
    /// What a door for one more room is worth.
    pub(super) opening: f64,
    /// Whether the path may only end where there is a way to a sink.
    pub(super) reached: bool,
    /// Which way traffic is to run over the path; `None` if that is no matter.
    pub(super) heading: Option<Heading>,
    /// Whether it may pass what is active, at no cost, until it is where there is
    /// a way.
    pub(super) through: bool,
    /// How much the ways at its end count.
    pub(super) pull: f64,
}

/// Finds cheapest paths, with memory that is used again.
#[derive(Debug)]
pub(super) struct Finder {
    cost: Vec<f64>,
    /// The edge by which each vertex was reached.
    by: Vec<usize>,
    round: Vec<u64>,
    now: u64,
    heap: BinaryHeap<Reverse<(u64, usize)>>,
    /// The edges of the path found last, from its start.
    pub(super) path: Vec<usize>,
}

const NONE: usize = usize::MAX;

impl Finder {
    pub(super) fn new(model: &Model<'_>) -> Self {
        let n = model.problem.vertices;
        Self {
            cost: vec![0.0; n],
            by: vec![NONE; n],
            round: vec![0; n],
            now: 0,
            heap: BinaryHeap::new(),
            path: Vec::new(),
        }
    }

    /// Finds a path from `from` over inactive edges and inactive vertices to a
    /// sink or an active vertex that is not `besides`; leaves it in `path`.
    /// Says where it ends.
    pub(super) fn find(
        &mut self,
        model: &Model<'_>,
        state: &State,
        away: &[f64],
        from: usize,
        besides: usize,
        manner: &Manner,
    ) -> Option<usize> {
        let problem = model.problem;
        self.now += 1;
        let now = self.now;
        self.heap.clear();
        self.path.clear();
        self.cost[from] = 0.0;
        self.by[from] = NONE;
        self.round[from] = now;
        self.heap.push(Reverse((0, from)));
        while let Some(Reverse((bits, v))) = self.heap.pop() {
            let gone = f64::from_bits(bits);
            if gone > self.cost[v] {
                continue;
            }
            let passed = manner.through && away[v].is_infinite();
            if v != from && state.is_stop(v) && !passed {
                let mut at = v;
                while self.by[at] != NONE {
                    let e = self.by[at];
                    self.path.push(e);
                    at = other(problem.ends[e], at);
                }
                self.path.reverse();
                return Some(v);
            }
            let last = self.by[v];
            let before = if last == NONE {
                NONE
            } else {
                self.by[other(problem.ends[last], v)]
            };
            for &(e, w) in model.around.of(v) {
                let active = state.active[e];
                if active && !manner.through
                    || model.fates[e] == Fate::Off
                    || w == from
                    || w == besides
                {
                    continue;
                }
                if !passes(model, state, e, w, manner.heading) {
                    continue;
                }
                // Every step costs something.
                if self.round[w] == now && self.cost[w] <= gone {
                    continue;
                }
                let stop = state.is_stop(w);
                if stop && manner.reached && !manner.through && away[w].is_infinite() {
                    continue;
                }
                let mut step = model.price(e, model.floor[e]);
                step += 1e-3 * model.unit;
                if manner.noise > 0.0 {
                    step *= 1.0 + manner.noise * scatter(e as u64 ^ manner.salt);
                }
                let floor = 0.1 * step;
                if state.rooms.inside[e] > 0 {
                    step += manner.breakthrough * state.rooms.inside[e] as f64;
                }
                step += surcharge(model, state, e, last, before, manner.breach);
                if stop {
                    if away[w].is_finite() {
                        step += manner.pull * problem.travel_weight * away[w];
                    }
                } else if manner.reward > 0.0 {
                    step -= manner.reward * state.gain(w) as f64;
                }
                if let Some(rooms) = model
                    .rooms
                    .as_ref()
                    .filter(|_| !state.rooms.shut.is_empty())
                {
                    let opens = rooms.border_at.of(e).iter();
                    step -= manner.opening
                        * opens.filter(|&&p| state.rooms.shut.contains(p)).count() as f64;
                }
                if step.is_infinite() && !active {
                    continue;
                }
                let there = gone + if active { 0.0 } else { step.max(floor) };
                if self.round[w] != now || there < self.cost[w] {
                    self.round[w] = now;
                    self.cost[w] = there;
                    self.by[w] = e;
                    self.heap.push(Reverse((there.to_bits(), w)));
                }
            }
        }
        None
    }
}

/// What patterns cost that edge `e` would complete, together with the two
/// edges of the path before it. Patterns of more than three edges are left to
/// the fines.
fn surcharge(
    model: &Model<'_>,
    state: &State,
    e: usize,
    last: usize,
    before: usize,
    breach: f64,
) -> f64 {
    let on = |k: usize| state.active[k] || k == last || k == before || k == e;
    let mut sum = 0.0;
    for triple in model.triples.of(e) {
        let [a, b] = triple.others;
        if on(a) && on(b) && state.allows(model, triple.pattern) {
            sum += if triple.cost.is_finite() {
                triple.cost
            } else {
                breach
            };
        }
    }
    sum
}

pub(super) fn other([a, b]: [usize; 2], v: usize) -> usize {
    if a == v {
        b
    } else {
        a
    }
}

/// A number from 0 to 1 that looks random (SplitMix64).
fn scatter(key: u64) -> f64 {
    let mut z = key.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{EdgeState, Pattern, PatternKind, Problem};

    /// Two ways from 0 to the sink 5: 0-1-5, and 0-2-3-5 which is longer.
    fn fork() -> Problem {
        let mut sinks = vec![false; 6];
        sinks[5] = true;
        Problem {
            vertices: 6,
            ends: vec![[0, 1], [1, 5], [0, 2], [2, 3], [3, 5], [0, 4]],
            lengths: vec![1.0; 6],
            states: vec![EdgeState::Open; 6],
            sinks,
            dead_ends: true,
            coverage: vec![vec![2], vec![3]],
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    const PLAIN: Manner = Manner {
        noise: 0.0,
        salt: 0,
        breach: f64::INFINITY,
        breakthrough: f64::INFINITY,
        reward: 0.0,
        opening: 0.0,
        reached: false,
        heading: None,
        through: false,
        pull: 0.0,
    };

    fn path(problem: &Problem, manner: &Manner) -> (Option<usize>, Vec<usize>) {
        let model = Model::new(problem).expect("has solutions");
        let state = State::new(&model);
        let mut finder = Finder::new(&model);
        let away = model.base.clone();
        let end = finder.find(&model, &state, &away, 0, usize::MAX, manner);
        (end, finder.path)
    }

    #[test]
    fn ears_are_short_or_cover_much_or_keep_what_is_forbidden() {
        let mut problem = fork();
        assert_eq!(path(&problem, &PLAIN), (Some(5), vec![0, 1]));
        // Two of its three edges are worth more than they cost; a tenth stays.
        let covering = Manner {
            reward: 1.5,
            ..PLAIN
        };
        assert_eq!(path(&problem, &covering), (Some(5), vec![2, 3, 4]));
        let pattern = |cost| Pattern {
            kind: PatternKind::ZigZag,
            active: vec![0, 1],
            inactive: vec![],
            cost,
        };
        problem.patterns = vec![pattern(None)];
        assert_eq!(path(&problem, &PLAIN), (Some(5), vec![2, 3, 4]));
        let forced = Manner {
            breach: 0.5,
            ..PLAIN
        };
        assert_eq!(path(&problem, &forced), (Some(5), vec![0, 1]));
        problem.patterns = vec![pattern(Some(2.0))];
        assert_eq!(path(&problem, &PLAIN), (Some(5), vec![2, 3, 4]));
        // Nowhere to go.
        problem.states = vec![EdgeState::Closed; 6];
        problem.coverage.clear();
        assert_eq!(path(&problem, &PLAIN), (None, vec![]));
    }
}
