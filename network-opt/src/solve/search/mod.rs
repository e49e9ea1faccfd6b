//! Annealed large-neighbourhood search.

mod anneal;
mod ears;
mod lists;
mod model;
mod moves;
mod score;
mod state;
mod tiling;
mod ways;

use std::time::{Duration, Instant};

use super::{Ended, Limits, NetworkSolver, Outcome, Progress, Watch};
use crate::design::{cost, verify, Cost, Network, Problem};
use crate::error::DesignError;
use anneal::Anneal;
use model::Model;

/// A solver in pure Rust.
#[derive(Clone, Debug, Default)]
pub struct Search {
    /// Moves at most; `None` until the deadline.
    pub moves: Option<u64>,
}

/// Between two reports.
const PACE: Duration = Duration::from_millis(40);

impl NetworkSolver for Search {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        let began = Instant::now();
        problem.check()?;
        let start = start.filter(|s| verify(problem, s).is_empty());
        let mut outcome = Outcome {
            network: None,
            cost: Cost::default(),
            bound: 0.0,
            ended: Ended::Deadline,
            first_feasible: None,
            elapsed: Duration::ZERO,
        };
        let Ok(model) = Model::new(problem) else {
            outcome.ended = Ended::Infeasible;
            outcome.bound = f64::INFINITY;
            outcome.elapsed = began.elapsed();
            return Ok(outcome);
        };
        let mut anneal = Anneal::new(&model, start, limits.seed);
        let mut pending = anneal.best().is_some();
        let mut told = began;
        let mut moves = 0;
        loop {
            let now = Instant::now();
            let late = limits.deadline.is_some_and(|d| now - began >= d);
            let over = late || self.moves.is_some_and(|m| moves >= m);
            if over || now - told >= PACE || pending && outcome.network.is_none() {
                let mut improved = false;
                if let Some(best) = anneal.best().filter(|_| pending) {
                    if verify(problem, &best.network).is_empty() {
                        let found = cost(problem, &best.network.active);
                        if outcome.network.is_none() || found.objective < outcome.cost.objective {
                            improved = true;
                            outcome.network = Some(best.network.clone());
                            outcome.cost = found;
                            outcome.first_feasible.get_or_insert(now - began);
                        }
                    } else {
                        debug_assert!(false, "the counters are wrong");
                    }
                }
                pending = false;
                told = now;
                let best = outcome.network.as_ref().map(|n| (n, outcome.cost));
                let going = watch(&Progress {
                    elapsed: began.elapsed(),
                    best,
                    improved,
                    bound: outcome.bound,
                });
                if over {
                    break;
                }
                if !going {
                    outcome.ended = Ended::Cancelled;
                    break;
                }
            }
            pending |= anneal.step();
            moves += 1;
        }
        outcome.elapsed = began.elapsed();
        Ok(outcome)
    }
}
