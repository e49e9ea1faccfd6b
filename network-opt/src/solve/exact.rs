//! The exact solver: an integer program, solved to proof if time allows.

use super::pool::Pool;
use super::record::Record;
use super::{Ended, Limits, NetworkSolver, Outcome, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;
use crate::formulate::{longest_ways, Cuts, Formulated, Formulation};
use crate::mip::MipSolver;

mod climb;
mod run;
mod ties;
mod tighten;

use run::Until;

pub(super) use ties::breaks_ties;

/// Solves problems as integer programs.
///
/// Every network that it reports has passed [`verify`](crate::design::verify); its cost is that of
/// [`cost`](crate::design::cost), and the bound is one on that cost.
///
/// # Examples
///
/// ```
/// use network_opt::design::Problem;
/// use network_opt::mip::Microlp;
/// use network_opt::solve::{Ended, Exact, Limits, NetworkSolver};
///
/// // A street around a block, from the sink to vertex 2 and back.
/// let problem = Problem {
///     vertices: 4,
///     ends: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
///     lengths: vec![1.0; 4],
///     states: vec![Default::default(); 4],
///     sinks: vec![true, false, false, false],
///     required_vertices: vec![2],
///     length_weight: 1.0,
///     ..Problem::default()
/// };
/// let found = Exact::new(Microlp).solve(&problem, None, &Limits::default(), &mut |_| true)?;
/// assert_eq!(found.ended, Ended::Proven);
/// assert_eq!(found.cost.objective, 4.0);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact<M> {
    /// Solves the programs.
    pub solver: M,
    /// Which program a problem becomes.
    ///
    /// Default value: [`Formulation::Recommended`].
    pub formulation: Formulation,
    /// Rounds of cuts at most that are added where a solution of the relaxation
    /// violates them, before the search: room cuts, detour cuts and connection
    /// cuts. They have half of the time at most.
    ///
    /// Default value: 12.
    pub rounds: usize,
    /// Families of cuts that programs have.
    ///
    /// Default value: all of them.
    pub cuts: Cuts,
    /// Whether programs of problems with symmetries, such as squares that look
    /// the same from all sides, know of one of all images of a network only.
    ///
    /// Default value: `true`.
    pub symmetry: bool,
    /// Edges to be decided from which on bounds are raised in steps, each of which
    /// says that no network costs less than a little more than the bound before.
    /// That gives better bounds in the same time where a proof takes too long, and
    /// takes longer for a proof.
    ///
    /// Default value: 280.
    pub climbs_from: usize,
}

impl<M> Exact<M> {
    /// With the recommended formulation.
    pub const fn new(solver: M) -> Self {
        Self {
            solver,
            formulation: Formulation::Recommended,
            rounds: 12,
            cuts: Cuts::all(),
            symmetry: true,
            climbs_from: 280,
        }
    }
}

impl<M: MipSolver> NetworkSolver for Exact<M> {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        self.solve_in(problem, start, limits, watch, None)
    }
}

impl<M: MipSolver> Exact<M> {
    /// As [`NetworkSolver::solve`], beside other solvers that share a pool.
    pub(super) fn solve_in(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
        pool: Option<&Pool>,
    ) -> Result<Outcome, DesignError> {
        let mut record = Record::begin(problem, start, watch, pool)?;
        let formulation = match self.formulation {
            Formulation::Recommended => Formulation::for_problem(problem),
            other => other,
        };
        if self.breaks_ties(problem) {
            return self.in_two_steps(problem, formulation, limits, record);
        }
        let mut longest = None;
        if formulation == Formulation::SingleSink {
            // Its bounds on ways are those of networks that cost no more than a
            // known one, so that is found first.
            if record.best.is_none() {
                let ended = self.first(limits, &mut record)?;
                if record.best.is_none() {
                    return Ok(record.outcome(ended));
                }
            }
            longest = (record.best.as_ref()).map(|(_, cost)| longest_ways(problem, cost.objective));
        }
        let mut formulated = Formulated::with_cuts(problem, formulation, longest, self.cuts)?;
        if formulated.contradicts() {
            return Ok(record.outcome(Ended::Infeasible));
        }
        self.tighten(&mut formulated, limits, &mut record)?;
        let run = self.climb(&mut formulated, limits, &mut record)?;
        Ok(record.outcome(run.ended()))
    }

    /// Helps another solver that has put its program into the pool: refutes levels
    /// that one is not at, or looks into travel while that one is at length. Whether
    /// there was anything to do is not told: bounds are in the pool.
    pub(super) fn solve_beside(
        &self,
        problem: &Problem,
        limits: &Limits,
        watch: &mut Watch<'_>,
        pool: &Pool,
    ) -> Result<(), DesignError> {
        let Some(program) = pool.program() else {
            return Ok(());
        };
        let mut record = Record::begin(problem, None, watch, Some(pool))?;
        if self.is_climbed(problem) {
            let formulated = program.write(problem, self.cuts)?;
            return self.climb_below(&formulated, limits, &mut record);
        }
        if self.travels_beside(problem) && program.settled.is_none() {
            return self.travel_beside(&program.cuts, limits, &mut record);
        }
        Ok(())
    }
}

impl<M: MipSolver> Exact<M> {
    /// Looks for any network: the shortest, whatever it travels, is the easiest
    /// to look for.
    pub(super) fn first(
        &self,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<Ended, DesignError> {
        let shortest = Problem {
            length_weight: record.problem.length_weight.max(1.0),
            travel_weight: 0.0,
            ..record.problem.clone()
        };
        let formulated = Formulated::with_cuts(&shortest, Formulation::Flow, None, self.cuts)?;
        if formulated.contradicts() {
            return Ok(Ended::Infeasible);
        }
        let left = record.left(limits);
        Ok(self.run(&formulated, &left, record, Until::First)?.ended())
    }

    /// Leaves one of all images of a network. Relaxations are no better for it, so
    /// it comes after them.
    fn order(&self, formulated: &mut Formulated<'_>) {
        if self.symmetry {
            formulated.order_images();
        }
    }
}
