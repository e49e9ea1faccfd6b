//! Solvers of [`Problem`]s: what they are told, and what they answer.

mod search;

use std::time::Duration;

use crate::design::{Cost, Network, Problem};
use crate::error::DesignError;

mod conflicts;
mod exact;
mod pool;
mod race;
mod record;
mod stochastic;
mod turns;
mod window;

pub use conflicts::{conflicts, conflicts_by, Conflict, Constraints};
pub use exact::Exact;
pub use race::Race;
pub use search::Search;
pub use stochastic::Stochastic;
pub use turns::Started;
pub use window::Windows;

/// How long to look, and how good is good enough.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// Time, by the clock; `None` until the gap is reached.
    ///
    /// Default value: 10 s.
    pub deadline: Option<Duration>,
    /// The gap between objective and bound, relative to the objective, at
    /// which the answer is good enough.
    ///
    /// Default value: 0, a proof.
    pub gap: f64,
    /// Threads at most.
    ///
    /// Default value: 1.
    pub threads: usize,
    /// Seed of what is drawn at random.
    ///
    /// Default value: 0.
    pub seed: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            deadline: Some(Duration::from_secs(10)),
            gap: 0.0,
            threads: 1,
            seed: 0,
        }
    }
}

/// How far a solver has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Time since the start.
    pub elapsed: Duration,
    /// The best network so far with what it costs, if there is one; new since
    /// the last report if `improved`.
    pub best: Option<(&'a Network, Cost)>,
    /// Whether `best` is better than in the last report.
    pub improved: bool,
    /// No valid network costs less; 0 if nothing better is known.
    pub bound: f64,
}

/// Is told of progress, at least five times a second; where it answers false
/// the solver stops and gives the best that it has.
pub type Watch<'w> = dyn FnMut(&Progress<'_>) -> bool + 'w;

/// What a solver found.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Outcome {
    /// The best network found; `None` if there was none in time.
    pub network: Option<Network>,
    /// What it costs; all zero if there is none.
    pub cost: Cost,
    /// No valid network costs less.
    pub bound: f64,
    /// Why the solver stopped.
    pub ended: Ended,
    /// Time until the first valid network.
    pub first_feasible: Option<Duration>,
    /// Time in all.
    pub elapsed: Duration,
}

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ended {
    /// The network is optimal, or within the gap asked for.
    Proven,
    /// There is no valid network.
    Infeasible,
    /// The deadline came.
    Deadline,
    /// The watch said so.
    Cancelled,
}

/// Solves problems.
pub trait NetworkSolver {
    /// Looks for the valid network of least cost, from `start` on if that is
    /// given and valid.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`] if the problem does not fit together, and
    /// what a solver may find wrong. No network in time is no error, and
    /// neither is that there is none: see [`Outcome::ended`].
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError>;
}
