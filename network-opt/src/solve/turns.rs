//! One solver after another, each from what the one before it found.

use std::time::Duration;

use super::{Ended, Limits, NetworkSolver, Outcome, Progress, Search, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;

/// A search for the first part of the time, then another solver, which takes
/// the network found as its start: a good network in a second, and its proof
/// after. `Started::new(Race::new(Highs))` is what measured best for streets and
/// floorplans, with one thread and with two.
#[derive(Clone, Debug, PartialEq)]
pub struct Started<N> {
    /// What goes first.
    pub search: Search,
    /// What goes on.
    pub then: N,
    /// Part of the time that the search has, 0 to 1; as long as it has found
    /// nothing it has half of the time.
    ///
    /// Default value: 0.15.
    pub share: f64,
    /// Most that the search has once it has found something, and what it has
    /// without a deadline. It ends before that when nothing better has come of it
    /// for a second and three times as long as the best took.
    ///
    /// Default value: 4 s.
    pub most: Duration,
}

/// When a search is over that found its best network after so long: a second later,
/// and three times as long as that took. Time is short for proofs, and more often
/// than not nothing comes of a search that is idle.
pub(super) fn idle_after(last: Duration) -> Duration {
    Duration::from_secs(1) + 4 * last
}

impl<N> Started<N> {
    /// With default options.
    pub fn new(then: N) -> Self {
        Self {
            search: Search::default(),
            then,
            share: 0.15,
            most: Duration::from_secs(4),
        }
    }
}

impl<N: NetworkSolver> NetworkSolver for Started<N> {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        let share = self.share.clamp(0.0, 1.0);
        let time = limits
            .deadline
            .map_or(self.most, |deadline| deadline.mul_f64(share).min(self.most));
        let patience = limits
            .deadline
            .map_or(4 * self.most, |deadline| deadline / 2);
        let first = Turn {
            solver: &self.search,
            time: &|last| time.min(idle_after(last)),
            patience: time.max(patience),
        };
        in_turn(&first, &self.then, problem, start, limits, watch)
    }
}

/// A solver that goes before another.
pub(super) struct Turn<'s> {
    pub(super) solver: &'s dyn NetworkSolver,
    /// When it is over, if its last network was found at that time.
    pub(super) time: &'s dyn Fn(Duration) -> Duration,
    /// When it is over while it has found nothing.
    pub(super) patience: Duration,
}

/// One solver for its time, then `then`. What the first proves, or a watch that
/// stops it, is the end.
pub(super) fn in_turn(
    first: &Turn<'_>,
    then: &dyn NetworkSolver,
    problem: &Problem,
    start: Option<&Network>,
    limits: &Limits,
    watch: &mut Watch<'_>,
) -> Result<Outcome, DesignError> {
    let early = Limits {
        deadline: Some(
            limits
                .deadline
                .map_or(first.patience, |deadline| deadline.min(first.patience)),
        ),
        ..limits.clone()
    };
    let mut refused = false;
    let mut last = Duration::ZERO;
    let mut until_enough = |progress: &Progress<'_>| {
        let go_on = watch(progress);
        refused |= !go_on;
        if progress.improved {
            last = progress.elapsed;
        }
        go_on && (progress.elapsed < (first.time)(last) || progress.best.is_none())
    };
    let mut found = first
        .solver
        .solve(problem, start, &early, &mut until_enough)?;
    if found.ended == Ended::Cancelled && !refused {
        found.ended = Ended::Deadline;
    }
    if found.ended != Ended::Deadline {
        return Ok(found);
    }
    let spent = found.elapsed;
    let late = Limits {
        deadline: limits
            .deadline
            .map(|deadline| deadline.saturating_sub(spent)),
        ..limits.clone()
    };
    let mut later = |progress: &Progress<'_>| {
        watch(&Progress {
            elapsed: progress.elapsed + spent,
            bound: progress.bound.max(found.bound),
            ..*progress
        })
    };
    let best = found.network.as_ref().or(start);
    let mut outcome = then.solve(problem, best, &late, &mut later)?;
    outcome.elapsed += spent;
    outcome.bound = outcome.bound.max(found.bound);
    outcome.first_feasible = found
        .first_feasible
        .or(outcome.first_feasible.map(|first| first + spent));
    if outcome.network.is_none() && outcome.ended != Ended::Infeasible {
        (outcome.network, outcome.cost) = (found.network, found.cost);
    }
    Ok(outcome)
}
