//! Branch and bound in pure Rust.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use ::microlp::{
    ComparisonOp, Error, LinearExpr, OptimizationDirection, ResumeOptions, SolveOptions,
    SolveOutcome, TerminationReason, Variable,
};

use super::{MipOutcome, MipProgress, MipReply, MipSolver, MipStatus, MipWatch, Program};
use crate::error::DesignError;
use crate::solve::Limits;

/// The crate `microlp`: no toolchain but Rust's, one thread; for small programs
/// and linear relaxations.
///
/// It looks up between linear programs only, so it runs on a thread of its own:
/// asked to stop, or late, it is left behind after [`Microlp::GRACE`], and its
/// thread ends with the linear program that it is at.
#[derive(Clone, Copy, Debug, Default)]
pub struct Microlp;

/// Between two looks of the search at the time.
const SLICE: Duration = Duration::from_millis(100);
/// Between two looks at the watch.
const PACE: Duration = Duration::from_millis(50);

/// What the search tells: its best solution, if it is new, and its bound.
struct News {
    best: Option<(f64, Vec<f64>)>,
    bound: f64,
}

impl MipSolver for Microlp {
    fn name(&self) -> &'static str {
        "microlp"
    }

    fn solve(
        &self,
        program: &Program,
        start: Option<&[f64]>,
        limits: &Limits,
        watch: &mut MipWatch<'_>,
    ) -> Result<MipOutcome, DesignError> {
        let began = Instant::now();
        let stop = Arc::new(AtomicBool::new(false));
        let (tell, told) = mpsc::channel();
        let (program, start) = (program.clone(), start.map(<[f64]>::to_vec));
        let (theirs, their_limits) = (Arc::clone(&stop), limits.clone());
        let thread = thread::Builder::new().name("microlp".to_owned());
        let spawned = thread.stack_size(8 << 20).spawn(move || {
            search(
                &program,
                start.as_deref(),
                &their_limits,
                began,
                &theirs,
                &tell,
            )
        });
        let handle = spawned.map_err(|error| self.failed(&format!("no thread: {error}")))?;
        let mut best: Option<(f64, Vec<f64>)> = None;
        let mut bound = f64::NEG_INFINITY;
        let mut stopped: Option<(MipStatus, Instant)> = None;
        loop {
            let news: Result<News, _> = told.recv_timeout(PACE);
            let mut improved = false;
            match news {
                Ok(news) => {
                    bound = bound.max(news.bound);
                    improved = news.best.is_some();
                    best = news.best.or(best);
                }
                Err(RecvTimeoutError::Timeout) => {}
                // The search is over, and its answer is at hand.
                Err(RecvTimeoutError::Disconnected) => {
                    let answer = handle.join();
                    let found = answer.map_err(|_| self.failed("its thread panicked"))??;
                    // What ended it is known better here.
                    return Ok(match (found.status, stopped) {
                        (MipStatus::Deadline | MipStatus::Cancelled, Some((status, _))) => {
                            MipOutcome { status, ..found }
                        }
                        _ => found,
                    });
                }
            }
            let now = Instant::now();
            if let Some((status, since)) = stopped {
                if now - since > Self::GRACE {
                    let (objective, solution) = match best {
                        Some((objective, values)) => (objective, Some(values)),
                        None => (f64::INFINITY, None),
                    };
                    return Ok(MipOutcome {
                        status,
                        solution,
                        objective,
                        bound,
                    });
                }
                continue;
            }
            let reply = watch(&MipProgress {
                elapsed: now - began,
                best: best.as_ref().map(|(_, values)| values.as_slice()),
                improved,
                bound,
            });
            let late = limits.deadline.is_some_and(|d| now - began >= d);
            if reply == MipReply::Stop {
                stopped = Some((MipStatus::Cancelled, now));
            } else if late {
                stopped = Some((MipStatus::Deadline, now));
            }
            stop.store(stopped.is_some(), Ordering::Relaxed);
        }
    }
}

/// The search itself, which ends soon after `stop`, but not within a linear
/// program.
fn search(
    program: &Program,
    start: Option<&[f64]>,
    limits: &Limits,
    began: Instant,
    stop: &AtomicBool,
    tell: &mpsc::Sender<News>,
) -> Result<MipOutcome, DesignError> {
    let (problem, variables) = translate(program)?;
    let slice = || match limits.deadline {
        Some(deadline) => SLICE.min(deadline.saturating_sub(began.elapsed())),
        None => SLICE,
    };
    let mut options = SolveOptions::default();
    options.time_limit = Some(slice());
    options.mip_gap = limits.gap;
    // Only wholes: the solver completes the rest by a linear program.
    let whole = program.columns().iter().zip(&variables);
    options.warm_start = start.map(|values| {
        let wholes = whole.zip(values).filter(|((c, _), _)| c.integer);
        wholes.map(|((_, &v), &value)| (v, value.round())).collect()
    });
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut bound = f64::NEG_INFINITY;
    let mut outcome = problem.solve_with(options);
    loop {
        let found = match outcome {
            Ok(found) => found,
            Err(Error::Infeasible) => {
                return Ok(MipOutcome {
                    status: MipStatus::Infeasible,
                    solution: None,
                    objective: f64::INFINITY,
                    bound: f64::INFINITY,
                })
            }
            Err(Error::Unbounded) => return Err(Microlp.failed("the program is unbounded")),
            Err(error) => return Err(Microlp.failed(&error.to_string())),
        };
        let mut improved = false;
        if let SolveOutcome::Solution(solution) = &found {
            let values: Vec<f64> = (variables.iter().zip(program.columns()))
                .map(|(&v, c)| {
                    let value = solution.var_value(v);
                    if c.integer {
                        value.round()
                    } else {
                        value
                    }
                })
                .collect();
            let objective = solution.objective();
            // The gap is relative to the objective.
            let below = solution.gap().unwrap_or(f64::INFINITY) * objective.abs();
            bound = bound.max(program.rounded(objective - below));
            if best.as_ref().is_none_or(|(known, _)| objective < *known) {
                best = Some((objective, values));
                improved = true;
            }
        }
        let ended = match found.termination_reason() {
            TerminationReason::ProvenOptimal => {
                bound = best.as_ref().map_or(bound, |(objective, _)| *objective);
                Some(MipStatus::Optimal)
            }
            TerminationReason::MipGap => Some(MipStatus::Optimal),
            // Within a step of the bound there is nothing.
            _ => {
                let closed = best.as_ref().is_some_and(|(o, _)| *o <= bound + 1e-9);
                closed.then_some(MipStatus::Optimal)
            }
        };
        // Nobody may be waiting any more.
        let _: Result<(), _> = tell.send(News {
            best: best.clone().filter(|_| improved),
            bound,
        });
        let over = stop.load(Ordering::Relaxed).then_some(MipStatus::Cancelled);
        let late = slice().is_zero().then_some(MipStatus::Deadline);
        if let Some(status) = ended.or(over).or(late) {
            let (objective, solution) = match best {
                Some((objective, values)) => (objective, Some(values)),
                None => (f64::INFINITY, None),
            };
            return Ok(MipOutcome {
                status,
                solution,
                objective,
                bound,
            });
        }
        let mut options = ResumeOptions::default();
        options.time_limit = Some(slice());
        options.mip_gap = Some(limits.gap);
        outcome = found.resume_with(options);
    }
}

impl Microlp {
    /// How long it has to stop before it is left behind.
    pub const GRACE: Duration = Duration::from_millis(70);

    fn failed(self, what: &str) -> DesignError {
        DesignError::SolverFailed {
            solver: self.name(),
            what: what.to_owned(),
        }
    }
}

fn translate(program: &Program) -> Result<(::microlp::Problem, Vec<Variable>), DesignError> {
    let mut problem = ::microlp::Problem::new(OptimizationDirection::Minimize);
    let mut variables = Vec::with_capacity(program.columns().len());
    for (k, column) in program.columns().iter().enumerate() {
        variables.push(if column.integer {
            let whole = |bound: f64| {
                let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&bound);
                fits.then_some(bound as i32)
                    .ok_or_else(|| DesignError::SolverFailed {
                        solver: Microlp.name(),
                        what: format!("whole column {k} has the bound {bound}, not one of 32 bits"),
                    })
            };
            let bounds = (whole(column.low.ceil())?, whole(column.high.floor())?);
            problem.add_integer_var(column.cost, bounds)
        } else {
            problem.add_var(column.cost, (column.low, column.high))
        });
    }
    for row in program.rows() {
        let mut sum = LinearExpr::empty();
        for &(column, factor) in &row.terms {
            sum.add(variables[column], factor);
        }
        if row.low == row.high {
            problem.add_constraint(sum, ComparisonOp::Eq, row.low);
            continue;
        }
        if row.low > f64::NEG_INFINITY {
            problem.add_constraint(sum.clone(), ComparisonOp::Ge, row.low);
        }
        if row.high < f64::INFINITY {
            problem.add_constraint(sum, ComparisonOp::Le, row.high);
        }
    }
    Ok((problem, variables))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mip::tests::{an_infeasible_program, knapsack};

    #[test]
    fn small_programs_are_solved() {
        let (program, best) = knapsack(8);
        let found = Microlp
            .solve(&program, None, &Limits::default(), &mut |_| MipReply::GoOn)
            .expect("solved");
        assert_eq!(found.status, MipStatus::Optimal);
        assert!((found.objective - best).abs() < 1e-6, "{found:?}");
        assert!((found.bound - best).abs() < 1e-6);
        let none = Microlp
            .solve(
                &an_infeasible_program(),
                None,
                &Limits::default(),
                &mut |_| MipReply::GoOn,
            )
            .expect("solved");
        assert_eq!(none.status, MipStatus::Infeasible);
    }

    #[test]
    fn a_bound_too_large_for_the_solver_is_refused() {
        let mut program = Program::default();
        let many = program.binary(1.0);
        program.bound(many, 0.0, 1e12);
        let found = Microlp.solve(&program, None, &Limits::default(), &mut |_| MipReply::GoOn);
        assert!(matches!(found, Err(DesignError::SolverFailed { .. })));
    }
}
