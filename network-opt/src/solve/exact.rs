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
mod tighten;

use run::{Run, Until};

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
        if self.formulation == Formulation::Recommended && breaks_ties(problem) {
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

    /// Refutes levels of the program that another solver has put into the pool,
    /// lower ones than that one is at. Whether there was any is not told: bounds are
    /// in the pool.
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
        let mut formulated =
            Formulated::with_cuts(problem, program.formulation, program.longest, self.cuts)?;
        program.cuts.into_iter().for_each(|row| formulated.cut(row));
        self.climb_below(&formulated, limits, &mut record)
    }
}

/// Whether travel is worth so little that length has to be settled first.
fn breaks_ties(problem: &Problem) -> bool {
    problem.travel_weight > 0.0 && problem.travel_weight <= problem.length_weight / 100.0
}

impl<M: MipSolver> Exact<M> {
    /// First the least length, without travel, by the program that is best for
    /// that; then travel among networks that can still be better.
    ///
    /// Every network costs in length and patterns at least what the first
    /// program's bound says, and one that is better than the best at most what
    /// that costs in all.
    fn in_two_steps(
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
        let longest = (formulation == Formulation::SingleSink).then(|| longest_ways(problem, high));
        let mut travel = Formulated::with_cuts(problem, formulation, longest, self.cuts)?;
        let step = flow.program().step();
        if step > 0.0 && high < low + step - 1e-6 {
            // What is longer costs more, whatever it travels.
            travel.settle_length(low);
        } else {
            travel.limit_length(low - 1e-6, high);
        }
        let run = self.climb(&mut travel, limits, &mut record)?;
        Ok(record.outcome(run.ended()))
    }

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
