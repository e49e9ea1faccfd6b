//! HiGHS, the open solver of mixed-integer programs.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use ::highs::{HighsModelStatus, Model, RowProblem, Sense, SolvedModel};

use super::{MipOutcome, MipProgress, MipReply, MipSolver, MipStatus, MipWatch, Program};
use crate::error::DesignError;
use crate::solve::Limits;

mod callback;

use callback::{run_shared, Shared};

/// HiGHS.
///
/// It runs on a thread of its own, so that the watch is asked twenty times a
/// second whatever HiGHS is at. Asked to stop it looks up soon; should it not,
/// within [`Highs::GRACE`], the answer is given without it, and its thread ends
/// when it does look up.
///
/// `threads` over 1 lets HiGHS search on several; results may then differ
/// between runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Highs;

impl Highs {
    /// How long HiGHS has to stop before it is left behind.
    pub const GRACE: Duration = Duration::from_millis(70);
    /// Between two looks at the watch.
    const SLICE: Duration = Duration::from_millis(50);

    fn failed(self, what: impl Into<String>) -> DesignError {
        DesignError::SolverFailed {
            solver: self.name(),
            what: what.into(),
        }
    }
}

impl MipSolver for Highs {
    fn name(&self) -> &'static str {
        "HiGHS"
    }

    fn solve(
        &self,
        program: &Program,
        start: Option<&[f64]>,
        limits: &Limits,
        watch: &mut MipWatch<'_>,
    ) -> Result<MipOutcome, DesignError> {
        let began = Instant::now();
        // HiGHS counts in 32 bits, and its wrapper panics where that is not enough.
        let largest = (program.columns().len())
            .max(program.rows().len())
            .max(program.nonzeros());
        if i32::try_from(largest).is_err() {
            return Err(DesignError::OutOfMemory {
                what: format!("a program with {largest} factors is too large for HiGHS"),
            });
        }
        let columns = program.columns().len();
        let shared = Arc::new(Shared::default());
        let (program, start) = (program.clone(), start.map(<[f64]>::to_vec));
        let (theirs, limits) = (Arc::clone(&shared), limits.clone());
        let deadline = limits.deadline;
        let thread = thread::Builder::new().name("highs".to_owned());
        // Its own stack for its recursive dives, as large as a main thread's.
        let spawned = thread.stack_size(8 << 20).spawn(move || {
            // Says so in any case, a panic included: who waits must not wait on.
            let _done = Done(&theirs);
            run(&program, start.as_deref(), &limits, &theirs)
        });
        let handle = spawned.map_err(|error| self.failed(format!("no thread: {error}")))?;
        let mut stopped: Option<(MipStatus, Instant)> = None;
        let mut seen = 0;
        loop {
            let finished = shared.wait(Self::SLICE);
            let now = Instant::now();
            let news = shared.news(seen);
            seen = news.version;
            if finished {
                let answer = handle.join();
                let outcome = answer.map_err(|_| self.failed("its thread panicked"))??;
                // What ended HiGHS is known better here.
                return Ok(match (outcome.status, stopped) {
                    (MipStatus::Deadline | MipStatus::Cancelled, Some((why, _))) => MipOutcome {
                        status: why,
                        ..outcome
                    },
                    _ => outcome,
                });
            }
            if let Some((status, since)) = stopped {
                if now - since > Self::GRACE {
                    return Ok(MipOutcome {
                        status,
                        objective: news.objective,
                        solution: news.best,
                        bound: news.bound,
                    });
                }
                continue;
            }
            let reply = watch(&MipProgress {
                elapsed: now - began,
                best: news.best.as_deref(),
                improved: news.improved,
                bound: news.bound,
            });
            let late = deadline.is_some_and(|deadline| now - began >= deadline);
            let no = reply == MipReply::Stop;
            match reply {
                MipReply::Try(values) if values.len() == columns => shared.suggest(values),
                _ => {}
            }
            if no || late {
                let why = if no {
                    MipStatus::Cancelled
                } else {
                    MipStatus::Deadline
                };
                stopped = Some((why, now));
                shared.stop();
            }
        }
    }
}

/// Says that HiGHS is done when it is dropped.
struct Done<'s>(&'s Shared);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.done();
    }
}

/// Solves the program; that there is no solution is believed only if HiGHS says
/// so without its presolve as well, or if that was expected, and that a start is the
/// best only if its bound says so too.
fn run(
    program: &Program,
    start: Option<&[f64]>,
    limits: &Limits,
    shared: &Shared,
) -> Result<MipOutcome, DesignError> {
    let began = Instant::now();
    let found = attempt(program, start, limits, shared, true)?;
    let rest = || Limits {
        deadline: (limits.deadline).map(|deadline| deadline.saturating_sub(began.elapsed())),
        ..limits.clone()
    };
    match found.status {
        // Where that is what was expected, asking twice would take as long again.
        MipStatus::Infeasible if !program.is_refuted() => {
            attempt(program, start, &rest(), shared, false)
        }
        // HiGHS 1.16 takes the image of a start in its presolved program for the
        // optimum, which it may be, and answers with the start itself, which costs
        // more: presolve drops what costs something and is not needed.
        MipStatus::Optimal if start.is_some() && !is_proven(program, &found, limits) => {
            attempt(program, None, &rest(), shared, true)
        }
        _ => Ok(found),
    }
}

/// Whether the bound of an outcome is as near to its solution as was asked for.
fn is_proven(program: &Program, found: &MipOutcome, limits: &Limits) -> bool {
    let scale = found.objective.abs();
    let gap = (limits.gap * scale).max(program.step() * (1.0 - 1e-4));
    // Bounds are of solutions that are whole to a millionth, column by column.
    found.objective - found.bound <= gap + 1e-5 * scale.max(1.0)
}

/// Hands the program to HiGHS and waits for its answer.
fn attempt(
    program: &Program,
    start: Option<&[f64]>,
    limits: &Limits,
    shared: &Shared,
    presolve: bool,
) -> Result<MipOutcome, DesignError> {
    let failed = |what: &str| Highs.failed(what);
    let mut rows = RowProblem::default();
    let columns: Vec<_> = program
        .columns()
        .iter()
        .map(|c| rows.add_column_with_integrality(c.cost, c.low..=c.high, c.integer))
        .collect();
    for row in program.rows() {
        let terms = row.terms.iter().map(|&(c, factor)| (columns[c], factor));
        rows.add_row(row.low..=row.high, terms);
    }
    let mut model = rows
        .try_optimise(Sense::Minimise)
        .map_err(|_| failed("it refused the program"))?;
    model.make_quiet();
    configure(&mut model, program, limits, presolve)
        .ok_or_else(|| failed("it refused an option"))?;
    if let Some(values) = start {
        // A start that it does not like is left out; so is one that meets not
        // all rows.
        let _: Result<(), _> = model.try_set_solution(Some(values), None, None, None);
    }
    let mut solved = run_shared(model, shared).map_err(|_| failed("it gave up"))?;
    answer(program, &mut solved, shared)
}

/// Factors of a linear program from which on the interior point method is
/// faster: a relaxation of a floorplan of 20,000 takes 0.9 s, by simplex 3.5 s.
const LARGE: usize = 10_000;

fn configure(model: &mut Model, program: &Program, limits: &Limits, presolve: bool) -> Option<()> {
    let threads = u32::try_from(limits.threads)
        .unwrap_or(u32::MAX)
        .clamp(1, 256);
    model.set_threads(NonZeroU32::new(threads)?);
    // A sixteenth of 2^31 seeds is enough, and all that its option takes.
    let seed = (limits.seed % (1 << 27)) as i32;
    model.try_set_option("random_seed", seed).ok()?;
    model
        .try_set_option("mip_rel_gap", limits.gap.max(0.0))
        .ok()?;
    // Two rules of HiGHS 1.16's presolve, enumeration and Fourier-Motzkin
    // elimination, lose solutions: with them the programs of some small networks
    // come out infeasible (regression tests in `tests/optimum_props.rs`).
    model
        .try_set_option("presolve_rule_off", 1 << 16 | 1 << 22)
        .ok()?;
    if !presolve {
        model.try_set_option("presolve", "off").ok()?;
    }
    if program.is_refuted() {
        // Those with switches of their own do not ask what effort there is for them:
        // of a step of 45 s they took 25.
        for heuristic in ["rins", "rens", "root_reduced_cost"] {
            let switch = format!("mip_heuristic_run_{heuristic}");
            model.try_set_option(switch.as_str(), false).ok()?;
        }
        model.try_set_option("mip_heuristic_effort", 0.0).ok()?;
        // A restart separates all cuts of the root once more, of a program that is
        // hardly smaller: without it the same step took 35 s instead of 50.
        model.try_set_option("mip_allow_restart", false).ok()?;
    }
    if program.columns().iter().all(|c| !c.integer) && program.nonzeros() > LARGE {
        model.try_set_option("solver", "ipm").ok()?;
    }
    if program.step() > 0.0 {
        // Less than a step, by more than what HiGHS holds a solution feasible for.
        let gap = program.step() * (1.0 - 1e-4);
        model.try_set_option("mip_abs_gap", gap).ok()?;
    }
    if let Some(deadline) = limits.deadline {
        model
            .try_set_option("time_limit", deadline.as_secs_f64())
            .ok()?;
    }
    Some(())
}

fn answer(
    program: &Program,
    solved: &mut SolvedModel,
    shared: &Shared,
) -> Result<MipOutcome, DesignError> {
    let has_integers = program.columns().iter().any(|c| c.integer);
    let status = match solved.status() {
        HighsModelStatus::Optimal | HighsModelStatus::ModelEmpty => MipStatus::Optimal,
        // Every column of a network's program is bounded.
        HighsModelStatus::Infeasible | HighsModelStatus::UnboundedOrInfeasible => {
            return Ok(MipOutcome {
                status: MipStatus::Infeasible,
                solution: None,
                objective: f64::INFINITY,
                bound: f64::INFINITY,
            })
        }
        HighsModelStatus::ReachedTimeLimit => MipStatus::Deadline,
        HighsModelStatus::ReachedInterrupt => MipStatus::Cancelled,
        HighsModelStatus::ReachedMemoryLimit => {
            return Err(DesignError::OutOfMemory {
                what: "HiGHS ran out of memory".to_owned(),
            })
        }
        other => return Err(Highs.failed(format!("it ended with {other:?}"))),
    };
    // The wrapper's own method panics where HiGHS has no status, as of an empty
    // program.
    let primal = solved.int_info_value(c"primal_solution_status");
    let feasible = primal == Ok(::highs::HighsSolutionStatus::Feasible as i64)
        || solved.status() == HighsModelStatus::ModelEmpty;
    let mut outcome = MipOutcome {
        status,
        solution: None,
        objective: f64::INFINITY,
        bound: f64::NEG_INFINITY,
    };
    if feasible {
        let mut values = solved.get_solution().columns().to_vec();
        values.resize(program.columns().len(), 0.0);
        for (value, column) in values.iter_mut().zip(program.columns()) {
            if column.integer {
                *value = value.round();
            }
        }
        outcome.objective = program.objective(&values);
        outcome.solution = Some(values);
    }
    outcome.bound = if has_integers {
        let told = solved.double_info_value(c"mip_dual_bound");
        told.unwrap_or(f64::NEG_INFINITY).max(shared.bound())
    } else if status == MipStatus::Optimal {
        outcome.objective
    } else {
        f64::NEG_INFINITY
    };
    if status == MipStatus::Optimal {
        outcome.bound = program.rounded(outcome.bound);
        outcome.bound = outcome.bound.min(outcome.objective);
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mip::tests::{an_infeasible_program, knapsack};

    #[test]
    fn small_programs_are_solved() {
        let (program, best) = knapsack(10);
        for start in [None, Some(vec![0.0; 10])] {
            let found = Highs
                .solve(&program, start.as_deref(), &Limits::default(), &mut |_| {
                    MipReply::GoOn
                })
                .expect("solved");
            assert_eq!(found.status, MipStatus::Optimal);
            assert!((found.objective - best).abs() < 1e-6, "{found:?}");
            assert!((found.bound - best).abs() < 1e-6);
        }
        let none = Highs
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
    fn an_empty_program_is_solved() {
        let found = Highs
            .solve(&Program::default(), None, &Limits::default(), &mut |_| {
                MipReply::GoOn
            })
            .expect("solved");
        assert_eq!(found.solution, Some(vec![]));
        assert_eq!((found.status, found.objective), (MipStatus::Optimal, 0.0));
    }

    #[test]
    fn a_relaxation_is_a_lower_bound() {
        let (program, best) = knapsack(10);
        let found = Highs
            .solve(&program.relaxed(), None, &Limits::default(), &mut |_| {
                MipReply::GoOn
            })
            .expect("solved");
        assert_eq!(found.status, MipStatus::Optimal);
        assert!(found.objective <= best + 1e-6);
        assert_eq!(found.bound, found.objective);
    }

    /// Hard to prove: as many pigeons as holes and one more, by pairs.
    fn pigeons(n: usize) -> Program {
        let mut program = Program::default();
        let at: Vec<Vec<usize>> = (0..=n)
            .map(|_| (0..n).map(|_| program.binary(0.0)).collect())
            .collect();
        // That some are left out is possible, and expensive.
        let out: Vec<usize> = (0..=n).map(|_| program.binary(1.0)).collect();
        for p in 0..=n {
            let places = at[p].iter().chain([&out[p]]).map(|&c| (c, 1.0));
            program.row(1.0, f64::INFINITY, places);
            for q in 0..p {
                for (&mine, &theirs) in at[p].iter().zip(&at[q]) {
                    program.row(f64::NEG_INFINITY, 1.0, [(mine, 1.0), (theirs, 1.0)]);
                }
            }
        }
        program
    }

    #[test]
    fn a_no_and_a_deadline_are_kept() {
        // Its own cliques would end the search at once if it were small.
        let program = pigeons(40);
        let mut told = None;
        let found = Highs
            .solve(&program, None, &Limits::default(), &mut |progress| {
                let go_on = progress.elapsed < Duration::from_millis(60);
                if go_on {
                    return MipReply::GoOn;
                }
                told = Some(Instant::now());
                MipReply::Stop
            })
            .expect("no failure");
        // If it was not done before, it stopped soon.
        if let Some(told) = told {
            // 0.15 s on a machine at rest; on a busy one, well before the end.
            assert!(told.elapsed() < Duration::from_secs(8));
            assert!(matches!(
                found.status,
                MipStatus::Cancelled | MipStatus::Optimal
            ));
        }
        let limits = Limits {
            deadline: Some(Duration::from_millis(100)),
            ..Limits::default()
        };
        let found = Highs
            .solve(&program, None, &limits, &mut |_| MipReply::GoOn)
            .expect("no failure");
        assert!(found.bound <= 1.0 + 1e-6);
    }
}
