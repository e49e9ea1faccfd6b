//! Branch and bound in pure Rust.

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
#[derive(Clone, Copy, Debug, Default)]
pub struct Microlp;

/// Between two looks at the watch.
const SLICE: Duration = Duration::from_millis(100);

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
                Err(Error::Unbounded) => return Err(self.failed("the program is unbounded")),
                Err(error) => return Err(self.failed(&error.to_string())),
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
            let status = ended.or_else(|| {
                let reply = watch(&MipProgress {
                    elapsed: began.elapsed(),
                    best: best.as_ref().map(|(_, values)| values.as_slice()),
                    improved,
                    bound,
                });
                match reply {
                    MipReply::Stop => Some(MipStatus::Cancelled),
                    _ => slice().is_zero().then_some(MipStatus::Deadline),
                }
            });
            if let Some(status) = status {
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
}

impl Microlp {
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
