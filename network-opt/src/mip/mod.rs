//! Integer programs and what solves them.
//!
//! - [`Program`]: columns and rows, nothing else;
//! - [`MipSolver`]: what a solver has to do;
//! - [`Microlp`]: branch and bound in pure Rust, for small programs and for
//!   linear relaxations;
//! - `Highs`, with the feature `highs`: HiGHS, which needs a C++ toolchain.

use std::time::Duration;

use crate::error::DesignError;
use crate::solve::Limits;

#[cfg(feature = "highs")]
mod highs;
mod microlp;
mod program;

#[cfg(feature = "highs")]
pub use self::highs::Highs;
pub use self::microlp::Microlp;
pub use program::{Column, Program, Row};

/// How far a solver of programs has come.
#[derive(Clone, Copy, Debug)]
pub struct MipProgress<'a> {
    /// Time since the start.
    pub elapsed: Duration,
    /// The best solution so far, one value a column, if there is one.
    pub best: Option<&'a [f64]>,
    /// Whether `best` is new since the last report.
    pub improved: bool,
    /// No solution costs less; minus infinity if nothing is known.
    pub bound: f64,
}

/// What a watch answers.
#[derive(Clone, Debug, PartialEq)]
pub enum MipReply {
    /// Go on.
    GoOn,
    /// Go on, with this solution that was found elsewhere. A solver may ignore it.
    Try(Vec<f64>),
    /// Stop, and give what there is.
    Stop,
}

impl From<bool> for MipReply {
    /// Whether to go on.
    fn from(go_on: bool) -> Self {
        if go_on {
            Self::GoOn
        } else {
            Self::Stop
        }
    }
}

/// Is told of progress, and answers whether to go on.
pub type MipWatch<'w> = dyn FnMut(&MipProgress<'_>) -> MipReply + 'w;

/// Why a solver of programs stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MipStatus {
    /// The solution is optimal, or within the gap asked for.
    Optimal,
    /// There is no solution.
    Infeasible,
    /// The deadline came.
    Deadline,
    /// The watch said so.
    Cancelled,
}

/// What a solver of programs found.
#[derive(Clone, Debug, PartialEq)]
pub struct MipOutcome {
    /// Why it stopped.
    pub status: MipStatus,
    /// The best solution found, one value a column; those of integer columns
    /// are whole.
    pub solution: Option<Vec<f64>>,
    /// What it costs; infinite if there is none.
    pub objective: f64,
    /// No solution costs less; minus infinity if nothing is known, infinite if
    /// there is no solution.
    pub bound: f64,
}

/// Solves integer programs.
///
/// None of the solvers here takes rows during its search. Rows that are too
/// many to be written down are added in rounds before it: see
/// [`Exact`](crate::solve::Exact).
pub trait MipSolver {
    /// What it is called in messages.
    fn name(&self) -> &'static str;

    /// Looks for the solution of least cost, from `start` on if that is given
    /// and meets all rows. Linear programs are solved too.
    ///
    /// The watch is called at least five times a second; a deadline is kept
    /// within half a second and a watch's no within 0.2 s. A solver that does not
    /// look up in time is left behind, with the best that it has told of.
    ///
    /// # Errors
    ///
    /// [`DesignError::OutOfMemory`], [`DesignError::SolverFailed`]. No solution
    /// in time is no error, and neither is that there is none.
    fn solve(
        &self,
        program: &Program,
        start: Option<&[f64]>,
        limits: &Limits,
        watch: &mut MipWatch<'_>,
    ) -> Result<MipOutcome, DesignError>;
}

impl<M: MipSolver + ?Sized> MipSolver for &M {
    fn name(&self) -> &'static str {
        (**self).name()
    }

    fn solve(
        &self,
        program: &Program,
        start: Option<&[f64]>,
        limits: &Limits,
        watch: &mut MipWatch<'_>,
    ) -> Result<MipOutcome, DesignError> {
        (**self).solve(program, start, limits, watch)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::Program;

    /// A knapsack of `n` things of weight 3, 5, 7 ... (mod 11) + 2 and worth
    /// weight + 1, that holds half of their weight, with the best cost by
    /// trying all.
    pub(crate) fn knapsack(n: usize) -> (Program, f64) {
        let weight = |k: usize| ((3 + 2 * k) % 11 + 2) as f64;
        let mut program = Program::default();
        let things: Vec<usize> = (0..n).map(|k| program.binary(-(weight(k) + 1.0))).collect();
        let half = (0..n).map(weight).sum::<f64>() / 2.0;
        let terms = things.iter().map(|&t| (t, weight(t)));
        program.row(f64::NEG_INFINITY, half, terms);
        let best = (0..1_u32 << n)
            .map(|set| {
                let values: Vec<f64> = (0..n).map(|k| f64::from(set >> k & 1)).collect();
                (program.violation(&values), program.objective(&values))
            })
            .filter(|&(violation, _)| violation == 0.0)
            .fold(f64::INFINITY, |best, (_, cost)| best.min(cost));
        (program, best)
    }

    /// Three things of which two at least, but no two of which.
    pub(crate) fn an_infeasible_program() -> Program {
        let mut program = Program::default();
        let x: Vec<usize> = (0..3).map(|_| program.binary(1.0)).collect();
        program.row(2.0, f64::INFINITY, x.iter().map(|&c| (c, 1.0)));
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            program.row(f64::NEG_INFINITY, 1.0, [(x[a], 1.0), (x[b], 1.0)]);
        }
        program
    }
}
