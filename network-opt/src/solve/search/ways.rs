//! Ways to the sinks over the active edges.

use std::collections::VecDeque;

use super::model::Model;
use super::state::State;

/// The way of each vertex, kept in memory from one measurement to the next.
#[derive(Debug)]
pub(super) struct Ways {
    pub(super) away: Vec<f64>,
    /// The way to each vertex from a sink; kept only where there are one-way
    /// streets.
    pub(super) from: Vec<f64>,
    pub(super) queue: VecDeque<usize>,
    pub(super) waiting: Vec<bool>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Travel {
    /// Sum over the charged edges of the way from the nearer end, islands left
    /// out; with one-way streets the mean of the ways out and in.
    pub(super) sum: f64,
    /// Active edges that reach no sink, or that none reaches.
    pub(super) islands: usize,
}

impl Ways {
    pub(super) fn new(model: &Model<'_>) -> Self {
        Self {
            away: model.base.clone(),
            from: model
                .turns
                .as_ref()
                .map_or_else(Vec::new, |t| t.base.clone()),
            queue: VecDeque::new(),
            waiting: vec![false; model.problem.vertices],
        }
    }

    /// Finds all ways anew.
    ///
    /// The ways over given edges never change but by becoming shorter; so only
    /// what leaves them is followed. Labels are corrected in the order in
    /// which they change (Bellman, Ford, Moore): on street networks each
    /// changes once or twice, which is cheaper than keeping a heap.
    pub(super) fn measure(&mut self, model: &Model<'_>, state: &State) -> Travel {
        let problem = model.problem;
        if let Some(turns) = &model.turns {
            return self.measure_turns(model, turns, state);
        }
        self.away.copy_from_slice(&model.base);
        for &e in state.charged.items() {
            for v in problem.ends[e] {
                if self.away[v].is_finite() && !self.waiting[v] {
                    self.waiting[v] = true;
                    self.queue.push_back(v);
                }
            }
        }
        for &v in state.placed.items() {
            self.away[v] = 0.0;
            if !self.waiting[v] {
                self.waiting[v] = true;
                self.queue.push_back(v);
            }
        }
        while let Some(v) = self.queue.pop_front() {
            self.waiting[v] = false;
            let gone = self.away[v];
            for &(e, w) in model.around.of(v) {
                let there = gone + problem.travel_cost(e);
                if state.active[e] && there < self.away[w] {
                    self.away[w] = there;
                    if !self.waiting[w] {
                        self.waiting[w] = true;
                        self.queue.push_back(w);
                    }
                }
            }
        }
        let mut travel = Travel {
            sum: 0.0,
            islands: 0,
        };
        for &e in state.charged.items() {
            let [a, b] = problem.ends[e];
            let way = self.away[a].min(self.away[b]);
            if way.is_finite() {
                travel.sum += way;
            } else {
                travel.islands += 1;
            }
        }
        let lost = |&&e: &&usize| self.away[problem.ends[e][0]].is_infinite();
        travel.islands += model.stray.iter().filter(lost).count();
        travel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{cost, distances, EdgeState, Problem};
    use crate::dice::Dice;

    /// A ring of twelve with chords, some of it given, one stray given edge.
    fn ring() -> Problem {
        let mut ends: Vec<[usize; 2]> = (0..12).map(|v| [v, (v + 1) % 12]).collect();
        ends.extend([[0, 5], [2, 8], [3, 10]]);
        let mut states = vec![EdgeState::Open; 15];
        states[0] = EdgeState::Given;
        states[1] = EdgeState::Given;
        states[7] = EdgeState::Given;
        let mut sinks = vec![false; 12];
        sinks[0] = true;
        sinks[6] = true;
        Problem {
            vertices: 12,
            lengths: (0..15).map(|e| 1.0 + f64::from(e % 4)).collect(),
            states,
            sinks,
            dead_ends: true,
            length_weight: 1.0,
            travel_weight: 1.0,
            ends,
            ..Problem::default()
        }
    }

    #[test]
    fn ways_are_those_of_the_checker() {
        let problem = ring();
        let model = Model::new(&problem).expect("has solutions");
        let mut state = State::new(&model);
        let mut ways = Ways::new(&model);
        let mut dice = Dice::new(1);
        let mut islands = 0;
        for _ in 0..500 {
            let e = dice.below(15);
            if model.fates[e] == crate::solve::search::model::Fate::Open {
                state.flip(&model, e);
            }
            let travel = ways.measure(&model, &state);
            // Whole numbers: no rounding anywhere.
            assert_eq!(ways.away, distances(&problem, &state.active));
            if travel.islands == 0 {
                assert_eq!(travel.sum, cost(&problem, &state.active).travel);
            } else {
                islands += 1;
                let lost = (0..15).filter(|&e| state.active[e]);
                let lost = lost.filter(|&e| ways.away[problem.ends[e][0]].is_infinite());
                assert_eq!(travel.islands, lost.count());
            }
        }
        assert!((50..450).contains(&islands), "{islands}");
    }
}
