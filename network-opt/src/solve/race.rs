//! Both at once: windows for good networks, the whole program for the proof.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use super::record::Pool;
use super::turns::in_turn;
use super::{Ended, Exact, Limits, NetworkSolver, Outcome, Progress, Watch, Windows};
use crate::design::{EdgeState, Network, Problem};
use crate::error::DesignError;
use crate::mip::MipSolver;

/// Runs [`Windows`] and [`Exact`] side by side, each with the best network of
/// both; with one thread, one after the other.
///
/// What threads find in which order is not the same in every run; with one
/// thread and without a deadline it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Race<M> {
    /// For proofs.
    pub exact: Exact<M>,
    /// For networks.
    pub windows: Windows<M>,
}

impl<M: Copy> Race<M> {
    /// With default options.
    pub const fn new(solver: M) -> Self {
        Self {
            exact: Exact::new(solver),
            windows: Windows::new(solver),
        }
    }
}

impl<M: MipSolver + Sync> NetworkSolver for Race<M> {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        problem.check()?;
        if limits.threads < 2 {
            return self.in_turn(problem, start, limits, watch);
        }
        let pool = Pool::default();
        let over = AtomicBool::new(false);
        let beside = Limits {
            threads: 1,
            ..limits.clone()
        };
        let proof = Limits {
            threads: limits.threads - 1,
            ..limits.clone()
        };
        thread::scope(|scope| {
            let windows = scope.spawn(|| {
                let mut go_on = |_: &Progress<'_>| !over.load(Ordering::Relaxed);
                self.windows
                    .solve_in(problem, start, &beside, &mut go_on, Some(&pool))
            });
            let mut told = |progress: &Progress<'_>| {
                let go_on = watch(progress);
                if !go_on {
                    over.store(true, Ordering::Relaxed);
                }
                go_on
            };
            let exact = self
                .exact
                .solve_in(problem, start, &proof, &mut told, Some(&pool));
            over.store(true, Ordering::Relaxed);
            let windows = windows.join().unwrap_or_else(|_| {
                Err(DesignError::SolverFailed {
                    solver: self.windows.solver.name(),
                    what: "the thread of windows panicked".to_owned(),
                })
            })?;
            let mut outcome = exact?;
            outcome.first_feasible = match (outcome.first_feasible, windows.first_feasible) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
            outcome.bound = outcome.bound.max(windows.bound);
            // A window that holds all edges is a proof as well.
            if outcome.ended != Ended::Infeasible && windows.network.is_some() {
                let better = windows.cost.objective < outcome.cost.objective - 1e-9;
                if better || outcome.network.is_none() {
                    (outcome.network, outcome.cost) = (windows.network, windows.cost);
                }
                if windows.ended == Ended::Proven {
                    outcome.ended = Ended::Proven;
                }
                outcome.bound = outcome.bound.min(outcome.cost.objective);
            }
            Ok(outcome)
        })
    }
}

impl<M: MipSolver + Sync> Race<M> {
    /// An eighth of the time for windows, where the program is too large for its
    /// solver to find good networks by itself.
    fn in_turn(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        let open = problem.states.iter().filter(|s| **s == EdgeState::Open);
        if open.count() < LARGE {
            return self.exact.solve(problem, start, limits, watch);
        }
        match limits.deadline {
            Some(deadline) => {
                let time = deadline / 8;
                let first = (&self.windows as &dyn NetworkSolver, time, time);
                in_turn(first, &self.exact, problem, start, limits, watch)
            }
            None => self.exact.solve(problem, start, limits, watch),
        }
    }
}

/// Edges to decide from which on windows go first.
const LARGE: usize = 280;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mip::Microlp;

    #[test]
    fn side_by_side_and_in_turn_are_as_good() {
        // A square with a diagonal; vertex 2 has to be reached and left.
        let problem = Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
            lengths: vec![1.0, 1.0, 1.0, 1.0, 1.5],
            states: vec![EdgeState::Open; 5],
            sinks: vec![true, false, false, false],
            required_vertices: vec![2],
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        };
        for threads in [1, 2] {
            let limits = Limits {
                threads,
                deadline: None,
                ..Limits::default()
            };
            let found = Race::new(Microlp)
                .solve(&problem, None, &limits, &mut |_| true)
                .expect("solved");
            assert_eq!(found.ended, Ended::Proven);
            // Out by the diagonal, back by two edges: 3.5 long, and the edge at
            // vertex 2 starts from a way of 1.
            assert_eq!(found.cost.objective, 4.5);
            assert_eq!(found.bound, 4.5);
        }
    }
}
