//! One program, solved, with what is found offered to the record.

use std::borrow::Cow;

use super::super::record::{too_cheap, Record};
use super::super::{Ended, Limits};
use super::Exact;
use crate::design::{verify, Network};
use crate::error::DesignError;
use crate::formulate::Formulated;
use crate::mip::{MipProgress, MipReply, MipSolver, MipStatus};

/// When a run is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Until {
    /// With the first valid network; bounds are of another problem.
    First,
    /// With a valid network, which there was none of before.
    Known,
    /// With a proof.
    Proof,
    /// With a proof that no network costs this at most, in units of the program,
    /// or with the best that does.
    Refuted(f64),
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Run {
    /// For this reason.
    Ended(Ended),
    /// With the optimum of its program, which does not price all, and costs this
    /// at least.
    Settled(f64),
    /// All networks cost more than was asked for.
    Refuted,
}

impl Run {
    /// Without anything after it.
    pub(super) const fn ended(self) -> Ended {
        match self {
            Self::Ended(ended) => ended,
            // The bound is as good as this program can make it.
            Self::Settled(_) | Self::Refuted => Ended::Deadline,
        }
    }
}

impl<M: MipSolver> Exact<M> {
    /// Solves a program; all networks found are offered to the record.
    pub(super) fn run(
        &self,
        formulated: &Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
        until: Until,
    ) -> Result<Run, DesignError> {
        if record.cancelled {
            return Ok(Run::Ended(Ended::Cancelled));
        }
        if until != Until::First && record.is_within(limits.gap) {
            return Ok(Run::Ended(Ended::Proven));
        }
        if limits.deadline.is_some_and(|deadline| deadline.is_zero()) {
            return Ok(Run::Ended(Ended::Deadline));
        }
        let image = |network: &Network| formulated.solution(&formulated.image(network));
        let known = record.best.as_ref().map(|(network, _)| image(network));
        let (program, start) = match until {
            Until::First | Until::Known | Until::Proof => {
                (Cow::Borrowed(formulated.program()), known)
            }
            Until::Refuted(level) => {
                let mut program = formulated.program().clone();
                program.refute(level);
                (Cow::Owned(program), None)
            }
        };
        // No network costs less than a bound that is told, or than the next that one
        // may cost after what is to be refuted.
        let bound = |told: f64| match until {
            Until::First => f64::NEG_INFINITY,
            Until::Known | Until::Proof => formulated.price(program.rounded(told)),
            Until::Refuted(level) => {
                formulated.price(program.rounded(told).min(program.after(level)))
            }
        };
        let goal = bound(f64::MAX);
        let mut enough = false;
        let found = self.solver.solve(
            &program,
            start.as_deref(),
            limits,
            &mut |told: &MipProgress<'_>| {
                let mut improved = false;
                if let (Some(values), true) = (told.best, told.improved) {
                    improved = record.offer(formulated.network(values));
                }
                record.raise(bound(told.bound));
                let received = record.receive();
                enough = match until {
                    Until::First | Until::Known => record.best.is_some(),
                    Until::Proof => record.is_within(limits.gap),
                    Until::Refuted(_) => record.is_within(limits.gap) || record.bound >= goal,
                };
                enough |= record.is_void();
                if !record.report(improved || received) || enough {
                    return MipReply::Stop;
                }
                match (received, &record.best) {
                    (true, Some((network, _))) => MipReply::Try(image(network)),
                    _ => MipReply::GoOn,
                }
            },
        )?;
        if record.is_void() {
            return Ok(Run::Ended(Ended::Deadline));
        }
        let mut invalid = None;
        if let Some(values) = &found.solution {
            let network = formulated.network(values);
            invalid = verify(record.problem, &network).into_iter().next();
            record.offer(network);
        }
        match (found.status, until) {
            (MipStatus::Infeasible, _) => {}
            // All that the row for a level leaves out costs more than what was found.
            (MipStatus::Optimal, Until::Refuted(_)) => {
                record.raise(formulated.price(program.rounded(found.bound)));
            }
            _ => record.raise(bound(found.bound)),
        }
        if record.is_contradicted() {
            return Err(too_cheap(self.solver.name()));
        }
        match (found.status, until) {
            (MipStatus::Infeasible, Until::Refuted(_)) => {
                record.raise(goal);
                Ok(Run::Refuted)
            }
            (MipStatus::Infeasible, _) if record.best.is_some() => {
                // The program only knows of networks that are no worse.
                record.close();
                Ok(Run::Ended(Ended::Proven))
            }
            (MipStatus::Infeasible, _) => Ok(Run::Ended(Ended::Infeasible)),
            _ if until != Until::First && record.is_within(limits.gap) => {
                Ok(Run::Ended(Ended::Proven))
            }
            (MipStatus::Optimal, _) if record.best.is_none() => Err(DesignError::SolverFailed {
                solver: self.solver.name(),
                what: match invalid {
                    Some(violation) => format!("its solution is not valid: {violation}"),
                    None => "it has a proof, but no solution".to_owned(),
                },
            }),
            // Of a program that does not price all: its bound stands.
            (MipStatus::Optimal, _) => {
                Ok(Run::Settled(formulated.price(program.rounded(found.bound))))
            }
            // By another solver.
            (_, Until::Refuted(_)) if record.bound >= goal => Ok(Run::Refuted),
            (MipStatus::Cancelled, _) if record.cancelled => Ok(Run::Ended(Ended::Cancelled)),
            (MipStatus::Deadline | MipStatus::Cancelled, _) => Ok(Run::Ended(Ended::Deadline)),
        }
    }
}
