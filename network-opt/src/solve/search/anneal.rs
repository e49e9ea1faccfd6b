//! Annealing in cycles, each longer than the last.

use super::model::Model;
use super::moves::Walk;
use super::score::{Fines, Score};
use super::state::State;
use crate::design::Network;

/// A search that can be run move by move.
#[derive(Debug)]
pub(super) struct Anneal<'m, 'p> {
    walk: Walk<'m, 'p>,
    at: Score,
    best: Option<Best>,
    /// Moves of this cycle, and how many it has.
    done: u64,
    cycle: u64,
    hot: f64,
}

/// The best network that was met.
#[derive(Clone, Debug)]
pub(super) struct Best {
    pub(super) network: Network,
    pub(super) objective: f64,
}

const FIRST_CYCLE: u64 = 2000;
/// Where sinks are decides what a network looks like, and they seldom move far
/// once there are streets. So where they are to be placed cycles begin anew as a
/// rule, elsewhere, and are long enough to tell good places.
const PLACING_CYCLE: u64 = 8000;

impl<'m, 'p> Anneal<'m, 'p> {
    pub(super) fn new(model: &'m Model<'p>, start: Option<&Network>, seed: u64) -> Self {
        let mut walk = Walk::new(model, seed);
        if let Some(start) = start {
            walk.state.become_network(model, start);
        }
        let at = Score::of(model, &walk.state, &mut walk.ways);
        let cycle = match model.placing {
            Some(_) => PLACING_CYCLE,
            None => FIRST_CYCLE,
        };
        let mut anneal = Self {
            walk,
            at,
            best: None,
            done: 0,
            cycle,
            hot: model.unit,
        };
        anneal.note();
        anneal
    }

    pub(super) fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }

    /// Whether it is certain that no network is valid.
    pub(super) fn is_hopeless(&self) -> bool {
        self.walk.untileable
    }

    /// One move. Says whether a better network was found.
    pub(super) fn step(&mut self) -> bool {
        let share = self.done as f64 / self.cycle as f64;
        // From the price of an edge to a twentieth of it.
        let heat = self.hot * 0.05_f64.powf(share);
        let mark = self.walk.state.mark();
        self.walk.step();
        let slack = -heat * (1.0 - self.walk.dice.unit()).ln();
        let model = self.walk.model;
        let score = Score::of(model, &self.walk.state, &mut self.walk.ways);
        let fines = &self.walk.fines;
        let improved = if fines.total(&score) <= fines.total(&self.at) + slack {
            self.walk.state.settle();
            self.at = score;
            self.note()
        } else {
            self.walk.state.undo(model, mark);
            false
        };
        self.walk.fines.follow(&self.at);
        self.done += 1;
        if self.done == self.cycle {
            self.done = 0;
            self.begin_cycle();
        }
        improved
    }

    /// Begins a cycle where the last one ended, at the best network, or anew.
    fn begin_cycle(&mut self) {
        if self.walk.model.placing.is_some() {
            self.cycle += self.cycle / 4;
            if self.best.is_none() || self.walk.dice.chance(0.6) {
                self.afresh();
            } else {
                self.restart();
            }
            return;
        }
        self.cycle *= 2;
        if self.best.is_none() {
            self.afresh();
        } else if self.walk.dice.chance(0.5) {
            self.restart();
        }
        let walk = &mut self.walk;
        if !walk.state.lapsed.is_empty() && walk.dice.chance(0.7) {
            walk.open_lapsed();
            walk.state.settle();
            self.at = Score::of(walk.model, &walk.state, &mut walk.ways);
        }
    }

    /// Begins again from nothing. Where nothing valid was found fines have grown
    /// until nothing moved any more.
    fn afresh(&mut self) {
        let walk = &mut self.walk;
        walk.fines = Fines::new(walk.model.unit);
        walk.state = State::new(walk.model);
        walk.scatter_sinks();
        walk.state.settle();
        self.at = Score::of(walk.model, &walk.state, &mut walk.ways);
    }

    /// Goes back to the best network.
    fn restart(&mut self) {
        if let Some(best) = &self.best {
            let walk = &mut self.walk;
            walk.state.become_network(walk.model, &best.network);
            self.at = Score::of(walk.model, &walk.state, &mut walk.ways);
        }
    }

    /// Keeps the network that the search is at, if it is the best.
    fn note(&mut self) -> bool {
        let least = self.best.as_ref().map_or(f64::INFINITY, |b| b.objective);
        if !self.at.is_valid() || self.at.objective >= least - 1e-9 * least.abs().min(1e9) {
            return false;
        }
        let state = &self.walk.state;
        self.best = Some(Best {
            network: state.network(self.walk.model),
            objective: self.at.objective,
        });
        if !state.charged.is_empty() && self.at.objective > 0.0 {
            self.hot = self.at.objective / state.charged.len() as f64;
        }
        true
    }
}
