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
        self.formulation == Formulation::Recommended
            && problem.travel_weight > 0.0
            && problem.travel_weight <= problem.length_weight / 100.0
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

/// Whether what costs more than `low` without travel costs more than `high` in all,
/// whatever it travels.
fn leaves_travel(problem: &Problem, low: f64, high: f64) -> bool {
    let step = step(problem, Formulation::Flow);
    step > 0.0 && high < low + step - 1e-6
}
