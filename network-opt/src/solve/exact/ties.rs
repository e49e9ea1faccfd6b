//! Travel that only decides between networks of one length: length first, then
//! travel.

use super::super::record::Record;
use super::super::{Limits, Outcome};
use super::run::{Run, Until};
use super::Exact;
use crate::design::Problem;
use crate::error::DesignError;
use crate::formulate::{step, Formulated, Formulation};
use crate::mip::{MipSolver, Row};
use crate::solve::Ended;

impl<M: MipSolver> Exact<M> {
    /// Whether travel is worth so little that length has to be settled first.
    pub(super) fn breaks_ties(&self, problem: &Problem) -> bool {
        self.formulation == Formulation::Recommended && breaks_ties(problem)
    }

    /// First the least length, without travel, by the program that is best for
    /// that; then travel among networks that can still be better.
    ///
    /// Every network costs in length and patterns at least what the first
    /// program's bound says, and one that is better than the best at most what
    /// that costs in all.
    pub(super) fn in_two_steps(
        &self,
        problem: &Problem,
        formulation: Formulation,
        limits: &Limits,
        mut record: Record<'_, '_>,
    ) -> Result<Outcome, DesignError> {
        let mut flow = Formulated::with_cuts(problem, Formulation::Flow, None, self.cuts)?;
        if flow.contradicts() {
            return Ok(record.outcome(Ended::Infeasible));
        }
        self.tighten(&mut flow, limits, &mut record)?;
        let run = self.climb(&mut flow, limits, &mut record)?;
        let best = record.best.as_ref().map(|(_, cost)| cost.objective);
        let (Run::Settled(low), Some(high)) = (run, best) else {
            return Ok(record.outcome(run.ended()));
        };
        record.settle(low);
        let mut travel = Formulated::with_cuts(problem, formulation, None, self.cuts)?;
        if leaves_travel(problem, low, high) {
            travel.settle_length(low);
        } else {
            travel.limit_length(low - 1e-6, high);
        }
        travel.adopt(flow.added());
        let run = self.climb(&mut travel, limits, &mut record)?;
        Ok(record.outcome(run.ended()))
    }

    /// Whether another solver may do the second step while this one is at the first.
    /// Where length takes steps it takes all threads.
    pub(in super::super) fn travels_beside(&self, problem: &Problem) -> bool {
        self.breaks_ties(problem) && !self.is_climbed(problem)
    }

    /// The second of the two steps, beside another solver that is at the first and
    /// has found these cuts: travel among the networks that cost as much without it
    /// as the best one does. What it proves counts as soon as it is known that no
    /// network costs less without it. Begins anew with a network that does.
    pub(super) fn travel_beside(
        &self,
        cuts: &[Row],
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<(), DesignError> {
        let problem = record.problem;
        let formulation = Formulation::for_problem(problem);
        while let Some((_, cost)) = &record.best {
            let (low, high) = (cost.without_travel(problem), cost.objective);
            if !leaves_travel(problem, low, high) {
                return Ok(());
            }
            let mut travel = Formulated::with_cuts(problem, formulation, None, self.cuts)?;
            travel.settle_length(low);
            travel.adopt(cuts);
            record.suppose(low);
            self.order(&mut travel);
            let left = record.left(limits);
            self.run(&travel, &left, record, Until::Proof)?;
            if record.cancelled || !record.is_void() {
                return Ok(());
            }
        }
        Ok(())
    }
}

/// Whether travel is worth so little that length comes first.
pub(in super::super) fn breaks_ties(problem: &Problem) -> bool {
    problem.travel_weight > 0.0 && problem.travel_weight <= problem.length_weight / 100.0
}

/// Whether what costs more than `low` without travel costs more than `high` in all,
/// whatever it travels.
fn leaves_travel(problem: &Problem, low: f64, high: f64) -> bool {
    let step = step(problem, Formulation::Flow);
    step > 0.0 && high < low + step - 1e-6
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::super::super::pool::{Pool, Tightened};
    use super::*;
    use crate::design::{cost_of, Network};
    use crate::mip::{Microlp, MipOutcome, MipProgress, MipReply, MipStatus, MipWatch, Program};
    use crate::solve::race::tests::square;

    /// Is told of a shorter network while it looks into travel for the first time.
    struct Interrupted<'a> {
        pool: &'a Pool,
        shorter: (Network, f64),
        calls: AtomicUsize,
    }

    impl MipSolver for Interrupted<'_> {
        fn name(&self) -> &'static str {
            "interrupted"
        }

        fn solve(
            &self,
            program: &Program,
            start: Option<&[f64]>,
            limits: &Limits,
            watch: &mut MipWatch<'_>,
        ) -> Result<MipOutcome, DesignError> {
            if self.calls.fetch_add(1, Ordering::Relaxed) > 0 {
                return Microlp.solve(program, start, limits, watch);
            }
            self.pool.offer(&self.shorter.0, self.shorter.1);
            let reply = watch(&MipProgress {
                elapsed: std::time::Duration::ZERO,
                best: None,
                improved: false,
                // More than the shorter one costs: of longer ones it is true.
                bound: 1.0,
            });
            assert_eq!(reply, MipReply::Stop);
            Ok(MipOutcome {
                status: MipStatus::Cancelled,
                solution: None,
                objective: f64::INFINITY,
                bound: 1.0,
            })
        }
    }

    #[test]
    fn a_shorter_network_begins_travel_anew() {
        let problem = Problem {
            travel_weight: 0.001,
            ..square()
        };
        let of = |active: [bool; 5]| {
            let network = Network {
                active: active.to_vec(),
                ..Network::default()
            };
            let cost = cost_of(&problem, &network).objective;
            (network, cost)
        };
        let pool = Pool::default();
        let (around, cost) = of([true, true, true, true, false]);
        pool.offer(&around, cost);
        pool.publish(Tightened {
            formulation: Formulation::Flow,
            longest: None,
            settled: None,
            cuts: vec![],
        });
        let exact = Exact::new(Interrupted {
            pool: &pool,
            shorter: of([false, false, true, true, true]),
            calls: AtomicUsize::new(0),
        });
        let found = exact.solve_beside(&problem, &Limits::default(), &mut |_| true, &pool);
        found.expect("no failure");
        assert!(exact.solver.calls.load(Ordering::Relaxed) > 1);
        assert_eq!(pool.bound(), 0.0);
        pool.settle(3.5);
        assert!((pool.bound() - 3.501).abs() < 1e-6, "{}", pool.bound());
    }
}
