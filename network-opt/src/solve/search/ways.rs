//! Ways to the sinks over the active edges.

use std::collections::VecDeque;

use super::model::Model;
use super::state::State;

/// The way of each vertex, kept in memory from one measurement to the next.
#[derive(Debug)]
pub(super) struct Ways {
    pub(super) away: Vec<f64>,
    queue: VecDeque<usize>,
    waiting: Vec<bool>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Travel {
    /// Sum over the charged edges of the way from the nearer end, islands left out.
    pub(super) sum: f64,
    /// Active edges that reach no sink.
    pub(super) islands: usize,
}

impl Ways {
    pub(super) fn new(model: &Model<'_>) -> Self {
        Self {
            away: model.base.clone(),
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
        self.away.copy_from_slice(&model.base);
        for &e in state.charged.items() {
            for v in problem.ends[e] {
                if self.away[v].is_finite() && !self.waiting[v] {
                    self.waiting[v] = true;
                    self.queue.push_back(v);
                }
            }
        }
        while let Some(v) = self.queue.pop_front() {
            self.waiting[v] = false;
            let gone = self.away[v];
            for &(e, w) in model.around.of(v) {
                let there = gone + problem.lengths[e];
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
