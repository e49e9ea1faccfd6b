//! Bounds in steps: is there a network that costs so little?
//!
//! A search that knows of a network of cost c looks at all fractions that cost
//! less than c. Far from a proof most of that work is between the bound and c,
//! where nothing is decided for long. Asked whether some network costs no more
//! than a level L close to the bound, it has a row that all of it costs L at most,
//! and with that row columns are fixed and branches end that else would not. If
//! there is no such network every one costs more than L, and L goes up; that is
//! the *destructive bound* of scheduling (Klein and Scholl 1999).
//!
//! What it is good for: on `g16x16_b` of the benchmark instances (best 126) the
//! plain search is at 114 after two minutes; that nothing costs 115 takes half a
//! minute, that nothing costs 119 takes a minute and a half. Where the plain search
//! ends in time it is as fast, so small problems are not climbed, nor is the last
//! step.

use std::time::{Duration, Instant};

use super::super::pool::{Pool, Tightened};
use super::super::record::Record;
use super::super::{Ended, Limits};
use super::run::{Run, Until};
use super::Exact;
use crate::design::Problem;
use crate::error::DesignError;
use crate::formulate::{prepare, Fate, Formulated};
use crate::mip::MipSolver;

/// Part of what is between the bound and the best network that the first step has,
/// of a solver by itself and of one that works below another.
const FIRST: [f64; 2] = [0.25, 0.1];

/// How much larger or smaller the next step is, for the part of the time left that
/// the last one took. A step takes long to set up, whatever it is, and twice as
/// long with every few parts in a hundred that it is higher.
const STRIDES: [(f64, f64); 4] = [(0.08, 2.5), (0.2, 1.5), (0.5, 1.0), (f64::INFINITY, 0.5)];

impl<M: MipSolver> Exact<M> {
    /// Solves a program to proof, in steps where it is large.
    pub(super) fn climb(
        &self,
        formulated: &mut Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<Run, DesignError> {
        if let Some(pool) = record.pool {
            pool.publish(Tightened::of(formulated));
        }
        if self.is_climbed(record.problem) {
            record.receive();
            if record.best.is_none() {
                // Levels lie below some network.
                let left = record.left(limits);
                let run = self.run(formulated, &left, record, Until::Known)?;
                if run != Run::Ended(Ended::Deadline) || record.best.is_none() {
                    return Ok(run);
                }
            }
            if let Some(run) = self.in_steps(formulated, limits, record, FIRST[0])? {
                return Ok(run);
            }
        }
        let left = record.left(limits);
        let no_time = left.deadline.is_some_and(|time| time.is_zero());
        if !record.cancelled && !no_time {
            // Steps are of few branches each, and long rows only slow them down.
            self.order(formulated);
        }
        self.run(formulated, &left, record, Until::Proof)
    }

    /// Refutes levels that another solver is not at, until none are left.
    pub(super) fn climb_below(
        &self,
        formulated: &Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<(), DesignError> {
        self.in_steps(formulated, limits, record, FIRST[1])?;
        Ok(())
    }

    pub(super) fn is_climbed(&self, problem: &Problem) -> bool {
        let fates = prepare(problem);
        fates.iter().filter(|&&fate| fate == Fate::Open).count() >= self.climbs_from
    }

    /// Refutes level after level; none when there is none below the best network.
    fn in_steps(
        &self,
        formulated: &Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
        first: f64,
    ) -> Result<Option<Run>, DesignError> {
        let alone = Pool::default();
        let pool = record.pool.unwrap_or(&alone);
        let mut stride = None;
        loop {
            record.receive();
            let Some(levels) = Levels::of(formulated, record) else {
                return Ok(None);
            };
            let stride = stride.get_or_insert(first * (levels.top - levels.bound));
            *stride = stride.max(levels.least);
            let Some(claim) = pool.claim(levels.from(*stride).map(|l| formulated.price(l))) else {
                return Ok(None);
            };
            let level = formulated.unpriced(claim.level());
            let left = record.left(limits);
            let (began, before) = (Instant::now(), record.bound);
            match self.run(formulated, &left, record, Until::Refuted(level))? {
                // Where costs are tiny rounding may take all of a step.
                Run::Refuted if record.bound <= before => return Ok(None),
                Run::Refuted => {
                    let left = record.left(limits).deadline;
                    *stride *= factor(began.elapsed(), left);
                }
                other => return Ok(Some(other)),
            }
        }
    }
}

/// What may be refuted, in units of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Levels {
    /// No network costs less.
    bound: f64,
    /// The most that a better network than the best may cost.
    top: f64,
    /// What networks cost is a multiple of this, if it is not 0.
    step: f64,
    /// Smaller steps are not worth it.
    least: f64,
}

impl Levels {
    /// None without a network.
    fn of(formulated: &Formulated<'_>, record: &Record<'_, '_>) -> Option<Self> {
        let program = formulated.program();
        let (network, _) = record.best.as_ref()?;
        let best = program.objective(&formulated.solution(&formulated.image(network)));
        let step = program.step();
        Some(Self {
            bound: program.rounded(formulated.unpriced(record.bound)),
            top: best - step,
            step,
            least: step.max(1e-4 * best.abs()),
        })
    }

    /// The level that is so far above the bound, counted from the one below it, and
    /// those after it; all below the top.
    fn from(self, stride: f64) -> impl Iterator<Item = f64> {
        let on_steps = move |level: f64| {
            if self.step > 0.0 {
                (level / self.step + 1e-4).floor() * self.step
            } else {
                level
            }
        };
        let first = on_steps(self.bound + stride - self.step).max(self.bound);
        let end = self.top - 1e-6 * self.top.abs();
        (0..)
            .map(move |k| first + f64::from(k) * self.least)
            .map(on_steps)
            .take_while(move |&level| level < end)
    }
}

/// By what to change the stride after a step that took so long, with so much time
/// left.
fn factor(took: Duration, left: Option<Duration>) -> f64 {
    let part = left.map_or(0.0, |left| {
        took.as_secs_f64() / left.as_secs_f64().max(1e-3)
    });
    let found = STRIDES.iter().find(|&&(most, _)| part <= most);
    found.map_or(1.0, |&(_, factor)| factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Network;
    use crate::mip::{Microlp, MipOutcome, MipStatus, MipWatch, Program};
    use crate::solve::race::tests::square;
    use crate::solve::NetworkSolver;

    #[test]
    fn levels_are_on_steps_between_bound_and_best() {
        let levels = Levels {
            bound: 108.0,
            top: 125.0,
            step: 1.0,
            least: 1.0,
        };
        // 6.8 above 107, which is known to cost too little.
        let from: Vec<f64> = levels.from(6.8).collect();
        assert_eq!(from[..2], [113.0, 114.0]);
        assert_eq!(from.last(), Some(&124.0));
        // The bound itself may be what a network costs.
        assert_eq!(levels.from(0.1).next(), Some(108.0));
        // The last is left to a proof.
        assert_eq!(levels.from(100.0).next(), None);
        let done = Levels {
            bound: 125.0,
            ..levels
        };
        assert_eq!(done.from(1.0).next(), None);
        let unstepped = Levels {
            step: 0.0,
            least: 0.5,
            ..levels
        };
        assert_eq!(unstepped.from(0.75).next(), Some(108.75));
    }

    #[test]
    fn quick_steps_grow_and_slow_ones_shrink() {
        let seconds = Duration::from_secs;
        assert_eq!(factor(seconds(1), Some(seconds(100))), 2.5);
        assert_eq!(factor(seconds(30), Some(seconds(100))), 1.0);
        assert_eq!(factor(seconds(90), Some(seconds(10))), 0.5);
        assert_eq!(factor(seconds(90), None), 2.5);
    }

    /// Says of every level that no network costs so little.
    struct Denier;

    impl MipSolver for Denier {
        fn name(&self) -> &'static str {
            "denier"
        }

        fn solve(
            &self,
            program: &Program,
            start: Option<&[f64]>,
            limits: &Limits,
            watch: &mut MipWatch<'_>,
        ) -> Result<MipOutcome, DesignError> {
            if program.is_refuted() {
                return Ok(MipOutcome {
                    status: MipStatus::Infeasible,
                    solution: None,
                    objective: f64::INFINITY,
                    bound: f64::INFINITY,
                });
            }
            Microlp.solve(program, start, limits, watch)
        }
    }

    #[test]
    fn a_network_under_the_bound_is_an_error() {
        // All of it active costs 7.5; 4.5 is enough.
        let problem = square();
        let all = Network {
            active: vec![true; 5],
            ..Network::default()
        };
        let exact = Exact {
            climbs_from: 0,
            ..Exact::new(Denier)
        };
        let found = exact.solve(&problem, Some(&all), &Limits::default(), &mut |_| true);
        assert!(
            matches!(found, Err(DesignError::SolverFailed { .. })),
            "{found:?}"
        );
    }
}
