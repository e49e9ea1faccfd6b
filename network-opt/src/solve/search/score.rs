//! What a network in the making costs, faults included.

use super::model::Model;
use super::state::State;
use super::ways::Ways;

/// Kinds of faults that are counted.
pub(super) const KINDS: usize = 11;

/// Objective and faults of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Score {
    pub(super) objective: f64,
    /// Uncovered rows, dead ends, island edges, forbidden patterns, routes
    /// without a path, rooms without a door, crossed rooms, bare faces, placed
    /// sinks without a street, rooms too few or too many, demands on rooms.
    pub(super) faults: [usize; KINDS],
}

impl Score {
    pub(super) fn of(model: &Model<'_>, state: &State, ways: &mut Ways) -> Self {
        let travel = ways.measure(model, state);
        let problem = model.problem;
        let travelled = problem.travel_weight * travel.sum;
        Self {
            objective: problem.length_weight * state.length
                + travelled
                + state.pattern_cost
                + state.route_cost
                + state.rooms.wish_cost,
            faults: [
                state.missing.len(),
                state.dead_ends.len(),
                travel.islands,
                state.broken.len(),
                state.cut.len(),
                state.rooms.shut.len(),
                state.rooms.crossed.len(),
                state.rooms.bare.len(),
                state.idle.len(),
                state.rooms.off,
                state.rooms.unmet.len(),
            ],
        }
    }

    pub(super) fn is_valid(&self) -> bool {
        self.faults == [0; KINDS]
    }
}

/// What faults cost: more while they stay, less while there are none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fines {
    rates: [f64; KINDS],
    least: f64,
}

impl Fines {
    pub(super) fn new(unit: f64) -> Self {
        Self {
            rates: [2.0, 3.0, 2.0, 4.0, 4.0, 4.0, 4.0, 8.0, 4.0, 4.0, 4.0].map(|k| k * unit),
            least: 0.5 * unit,
        }
    }

    /// Objective and fines together.
    pub(super) fn total(&self, score: &Score) -> f64 {
        let fines = score.faults.iter().zip(&self.rates);
        score.objective + fines.map(|(&count, rate)| count as f64 * rate).sum::<f64>()
    }

    pub(super) fn rate(&self, kind: usize) -> f64 {
        self.rates[kind]
    }

    /// Follows the faults of the state that the search is at.
    pub(super) fn follow(&mut self, score: &Score) {
        for (rate, &count) in self.rates.iter_mut().zip(&score.faults) {
            // Seldom needed up, often down: a valid network every few dozen moves.
            let factor = if count > 0 { 1.02 } else { 0.995 };
            *rate = (*rate * factor).clamp(self.least, 1e4 * self.least);
        }
    }
}
