//! The best network so far, and who is told of it.

use std::time::{Duration, Instant};

use super::pool::Pool;
use super::{Ended, Limits, Outcome, Progress, Watch};
use crate::design::{cost_of, verify, Cost, Network, Problem};
use crate::error::DesignError;

/// What a solver has found, and whom it tells.
pub(super) struct Record<'p, 'w> {
    pub(super) problem: &'p Problem,
    pub(super) began: Instant,
    pub(super) best: Option<(Network, Cost)>,
    /// No valid network costs less.
    pub(super) bound: f64,
    /// Whether the watch has said no.
    pub(super) cancelled: bool,
    first: Option<Duration>,
    watch: &'w mut Watch<'w>,
    pub(super) pool: Option<&'w Pool>,
    /// What all networks are supposed to cost at least without travel, so that
    /// bounds are of those that do.
    supposed: Option<f64>,
}

impl<'p, 'w> Record<'p, 'w> {
    /// The clock starts, from `start` if that is valid, and networks are shared
    /// with other solvers through the pool.
    ///
    /// # Errors
    ///
    /// Those of [`Problem::check`].
    pub(super) fn begin(
        problem: &'p Problem,
        start: Option<&Network>,
        watch: &'w mut Watch<'_>,
        pool: Option<&'w Pool>,
    ) -> Result<Self, DesignError> {
        problem.check()?;
        let mut record = Self {
            problem,
            began: Instant::now(),
            best: None,
            bound: 0.0,
            cancelled: false,
            first: None,
            watch,
            pool,
            supposed: None,
        };
        record.receive();
        if let Some(network) = start {
            record.offer(network.clone());
        }
        Ok(record)
    }

    /// Takes the bound of other solvers, and their network if it is better; says
    /// whether that is.
    pub(super) fn receive(&mut self) -> bool {
        let Some(pool) = self.pool else { return false };
        self.bound = self.bound.max(pool.bound());
        let known = self
            .best
            .as_ref()
            .map_or(f64::INFINITY, |(_, cost)| cost.objective);
        match pool.better_than(known - 1e-9) {
            Some(network) => self.offer(network),
            None => false,
        }
    }

    /// Keeps a network if it is valid and better; says whether it is.
    pub(super) fn offer(&mut self, network: Network) -> bool {
        if network.active.len() != self.problem.edges() {
            return false;
        }
        let found = cost_of(self.problem, &network);
        let better =
            (self.best.as_ref()).is_none_or(|(_, known)| found.objective < known.objective - 1e-9);
        if !better || !verify(self.problem, &network).is_empty() {
            return false;
        }
        self.first.get_or_insert(self.began.elapsed());
        if let Some(pool) = self.pool {
            pool.offer(&network, found.objective);
        }
        self.best = Some((network, found));
        true
    }

    /// Takes a bound if it is better.
    pub(super) fn raise(&mut self, bound: f64) {
        if bound > self.bound && bound.is_finite() {
            self.bound = bound;
            match (self.pool, self.supposed) {
                (Some(pool), Some(least)) => pool.suppose(least, bound),
                (Some(pool), None) => pool.raise(bound),
                (None, _) => {}
            }
        }
    }

    /// No network costs less without travel.
    pub(super) fn settle(&mut self, least: f64) {
        if let Some(pool) = self.pool {
            pool.settle(least);
            self.receive();
        }
    }

    /// Whether it is known that no network costs less than the best without travel.
    pub(super) fn is_shortest(&self) -> bool {
        let (Some(pool), Some((_, cost))) = (self.pool, &self.best) else {
            return false;
        };
        pool.is_settled(cost.without_travel(self.problem))
    }

    /// Bounds are of the networks that cost so much without travel from now on; what
    /// was supposed before is forgotten.
    pub(super) fn suppose(&mut self, least: f64) {
        self.supposed = Some(least);
        self.bound = self.pool.map_or(0.0, Pool::bound);
    }

    /// Whether the best network is none of those that the bound is of.
    pub(super) fn is_void(&self) -> bool {
        let (Some(least), Some((_, cost))) = (self.supposed, &self.best) else {
            return false;
        };
        cost.without_travel(self.problem) < least - 1e-6 * least.abs().max(1.0)
    }

    /// No network is better than the best.
    pub(super) fn close(&mut self) {
        if let Some((_, cost)) = &self.best {
            self.raise(cost.objective);
        }
    }

    /// Whether the best is good enough.
    pub(super) fn is_within(&self, gap: f64) -> bool {
        self.best.as_ref().is_some_and(|(_, cost)| {
            // A millionth is what solvers hold a solution optimal for.
            cost.objective - self.bound <= gap * cost.objective.abs() + 1e-6
        })
    }

    /// Whether the best costs less than networks may, so that some solver was wrong.
    pub(super) fn is_contradicted(&self) -> bool {
        (self.best.as_ref()).is_some_and(|(_, cost)| contradicts(cost, self.bound))
    }

    /// Tells the watch; says whether to go on.
    pub(super) fn report(&mut self, improved: bool) -> bool {
        if !self.cancelled {
            let bound = self.best_bound();
            let go_on = (self.watch)(&Progress {
                elapsed: self.began.elapsed(),
                best: self.best.as_ref().map(|(network, cost)| (network, *cost)),
                improved,
                bound,
            });
            self.cancelled = !go_on;
        }
        !self.cancelled
    }

    /// The limits with what is left of the time.
    pub(super) fn left(&self, limits: &Limits) -> Limits {
        let spent = self.began.elapsed();
        Limits {
            deadline: limits
                .deadline
                .map(|deadline| deadline.saturating_sub(spent)),
            ..limits.clone()
        }
    }

    /// Whether the time is over.
    pub(super) fn is_late(&self, limits: &Limits) -> bool {
        self.left(limits)
            .deadline
            .is_some_and(|left| left.is_zero())
    }

    /// The answer.
    pub(super) fn outcome(self, ended: Ended) -> Outcome {
        let bound = match ended {
            Ended::Infeasible => f64::INFINITY,
            _ => self.best_bound(),
        };
        let (network, cost) = self.best.map_or_else(
            || (None, Cost::default()),
            |(network, cost)| (Some(network), cost),
        );
        Outcome {
            network,
            cost,
            bound,
            ended,
            first_feasible: self.first,
            elapsed: self.began.elapsed(),
        }
    }

    /// A solver's bound may be over the best by its tolerance.
    fn best_bound(&self) -> f64 {
        let best = self
            .best
            .as_ref()
            .map_or(f64::INFINITY, |(_, cost)| cost.objective);
        self.bound.min(best)
    }
}

/// Whether a network costs less than a bound says that networks may.
pub(super) fn contradicts(cost: &Cost, bound: f64) -> bool {
    cost.objective < bound - 1e-5 * bound.abs().max(1.0)
}

/// What a solver is told whose bound a network contradicts.
pub(super) fn too_cheap(solver: &'static str) -> DesignError {
    DesignError::SolverFailed {
        solver,
        what: "a valid network costs less than what it said was the least".to_owned(),
    }
}
