//! A network made better piece by piece: all is fixed but a window, which is
//! solved to proof.

use std::time::Duration;

use super::exact::breaks_ties;
use super::pool::Pool;
use super::record::Record;
use super::{Ended, Exact, Limits, NetworkSolver, Outcome, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;
use crate::formulate::Formulation;
use crate::mip::MipSolver;

mod places;
mod slide;

use slide::{Goal, Slide};

/// Improves networks by windows that slide over the mesh: the edges near one
/// vertex are free, all others as they are in the best network; the program of
/// that is solved to proof, or for [`Windows::time`]. When no window makes the
/// network better, windows grow, until one holds all edges.
///
/// Where travel is worth so little that length comes first, larger windows go before,
/// in which the network has to be shorter, whatever it travels. It is soon known when
/// there is no such network, and they find what windows that are small enough for
/// travel miss.
///
/// A local optimum of large windows is often the optimum; there is a proof only
/// if a window holds all edges. Without a start the first network is that of
/// [`Exact`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Windows<M> {
    /// Solves the programs.
    pub solver: M,
    /// Which program a problem becomes.
    ///
    /// Default value: [`Formulation::Recommended`].
    pub formulation: Formulation,
    /// Edges of the first windows that are free; of those for length alone 1.75 times
    /// as many.
    ///
    /// Default value: 90.
    pub size: usize,
    /// Time for one window at most.
    ///
    /// Default value: 3 s.
    pub time: Duration,
}

impl<M> Windows<M> {
    /// With default sizes and times.
    pub const fn new(solver: M) -> Self {
        Self {
            solver,
            formulation: Formulation::Recommended,
            size: 90,
            time: Duration::from_secs(3),
        }
    }
}

impl<M: MipSolver> NetworkSolver for Windows<M> {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        self.solve_in(problem, start, limits, watch, None)
    }
}

impl<M: MipSolver> Windows<M> {
    /// As [`NetworkSolver::solve`], beside other solvers that share a pool.
    pub(super) fn solve_in(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
        pool: Option<&Pool>,
    ) -> Result<Outcome, DesignError> {
        let mut record = Record::begin(problem, start, watch, pool)?;
        if record.best.is_none() {
            let exact = Exact {
                formulation: self.formulation,
                ..Exact::new(&self.solver)
            };
            let ended = exact.first(limits, &mut record)?;
            if record.best.is_none() || ended == Ended::Cancelled {
                return Ok(record.outcome(ended));
            }
        }
        let mut goals = vec![Goal::Cheaper];
        if self.formulation == Formulation::Recommended && breaks_ties(problem) {
            goals.insert(0, Goal::Shorter);
        }
        let mut ended = Ended::Deadline;
        for goal in goals {
            if record.is_late(limits) {
                break;
            }
            let Some(slide) = Slide::new(self, goal, limits, &record)? else {
                continue;
            };
            ended = slide.run(limits, &mut record)?;
            if ended != Ended::Deadline {
                break;
            }
        }
        Ok(record.outcome(ended))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::design::EdgeState;
    use crate::mip::Microlp;

    /// A ladder of `n` squares with the sink at one corner.
    pub(super) fn ladder(n: usize) -> Problem {
        let mut ends = Vec::new();
        for k in 0..=n {
            ends.push([2 * k, 2 * k + 1]);
        }
        for k in 0..n {
            ends.extend([[2 * k, 2 * k + 2], [2 * k + 1, 2 * k + 3]]);
        }
        Problem {
            vertices: 2 * n + 2,
            lengths: vec![1.0; ends.len()],
            states: vec![EdgeState::Open; ends.len()],
            ends,
            sinks: (0..2 * n + 2).map(|v| v == 0).collect(),
            coverage: (0..=n).map(|k| vec![2 * k, 2 * k + 1]).collect(),
            dead_ends: true,
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn windows_reach_the_optimum_and_say_so() {
        // One side of the ladder is enough; the start is all of it.
        let problem = ladder(8);
        let start = Network {
            active: vec![true; problem.edges()],
            ..Network::default()
        };
        let windows = Windows {
            size: 8,
            ..Windows::new(Microlp)
        };
        let mut told = Vec::new();
        let found = windows
            .solve(
                &problem,
                Some(&start),
                &Limits::default(),
                &mut |progress| {
                    told.extend(progress.best.map(|(_, cost)| cost.objective));
                    true
                },
            )
            .expect("solved");
        assert_eq!(found.cost.objective, 8.0);
        assert_eq!(found.ended, Ended::Proven);
        assert!(told.windows(2).all(|pair| pair[1] <= pair[0]));
        // Without a start too.
        let found = windows
            .solve(&problem, None, &Limits::default(), &mut |_| true)
            .expect("solved");
        assert_eq!((found.cost.objective, found.ended), (8.0, Ended::Proven));
    }
}
