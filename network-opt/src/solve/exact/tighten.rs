//! Cuts that solutions of the relaxation violate, before the search.

use super::super::record::Record;
use super::super::Limits;
use super::Exact;
use crate::error::DesignError;
use crate::formulate::Formulated;
use crate::mip::{MipSolver, MipStatus};

/// Rounds of cuts in a row that raise the bound by less than [`PROGRESS`] of it,
/// after which there are no more. Where relaxations have many solutions of one cost
/// a round or two may do nothing.
const IDLE: usize = 3;
const PROGRESS: f64 = 1e-4;

impl<M: MipSolver> Exact<M> {
    /// Adds cuts that solutions of the relaxation violate, in rounds, and takes
    /// its bound.
    pub(super) fn tighten(
        &self,
        formulated: &mut Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<(), DesignError> {
        // Half of the time at most: of rooms most of the bound is made here.
        let budget = limits.deadline.map(|deadline| deadline / 2);
        // Where there are none, steps begin at the bound of the relaxation.
        if !formulated.separates() && !self.is_climbed(record.problem) {
            return Ok(());
        }
        // Rounds without progress, and the last solution with what it costs.
        let mut idle = 0;
        let mut last: Option<(Vec<f64>, f64)> = None;
        for _ in 0..self.rounds {
            if record.cancelled || record.is_within(limits.gap) {
                break;
            }
            let left = budget.map(|budget| budget.saturating_sub(record.began.elapsed()));
            if left.is_some_and(|left| left.is_zero()) {
                break;
            }
            let relaxed = formulated.program().relaxed();
            let limits = Limits {
                deadline: left,
                ..limits.clone()
            };
            let found = self.solver.solve(&relaxed, None, &limits, &mut |_| {
                let received = record.receive();
                record.report(received).into()
            })?;
            let (MipStatus::Optimal, Some(values)) = (found.status, found.solution) else {
                break;
            };
            record.raise(formulated.price(formulated.program().rounded(found.objective)));
            let rows = formulated.separate(&values, 0.02);
            let before = last.as_ref().map_or(f64::NEG_INFINITY, |(_, cost)| *cost);
            let moved = found.objective > before + PROGRESS * found.objective.abs();
            idle = if moved { 0 } else { idle + 1 };
            last = Some((values, found.objective));
            if rows.is_empty() || idle == IDLE {
                break;
            }
            rows.into_iter().for_each(|row| formulated.cut(row));
        }
        if let Some((values, _)) = last {
            formulated.drop_idle_cuts(&values);
        }
        Ok(())
    }
}
