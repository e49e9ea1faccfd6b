//! The exact solver: an integer program, solved to proof if time allows.

use super::record::{Pool, Record};
use super::{Ended, Limits, NetworkSolver, Outcome, Watch};
use crate::design::{verify, Network, Problem};
use crate::error::DesignError;
use crate::formulate::{longest_ways, Cuts, Formulated, Formulation};
use crate::mip::{MipProgress, MipReply, MipSolver, MipStatus};

/// Solves problems as integer programs.
///
/// Every network that it reports has passed [`verify`]; its cost is that of
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
        self.order(&mut formulated);
        let left = record.left(limits);
        let run = self.run(&formulated, &left, &mut record, Until::Proof)?;
        Ok(record.outcome(run.ended()))
    }
}

/// Rounds of cuts in a row that raise the bound by less than [`PROGRESS`] of it,
/// after which there are no more. Where relaxations have many solutions of one cost
/// a round or two may do nothing.
const IDLE: usize = 3;
const PROGRESS: f64 = 1e-4;

/// When a run is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Until {
    /// With the first valid network; bounds are of another problem.
    First,
    /// With a proof.
    Proof,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
    /// For this reason.
    Ended(Ended),
    /// With the optimum of its program, which does not price all.
    Settled,
}

impl Run {
    /// Without anything after it.
    const fn ended(self) -> Ended {
        match self {
            Self::Ended(ended) => ended,
            // The bound is as good as this program can make it.
            Self::Settled => Ended::Deadline,
        }
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
        self.order(&mut flow);
        let left = record.left(limits);
        let run = self.run(&flow, &left, &mut record, Until::Proof)?;
        let best = record.best.as_ref().map(|(_, cost)| cost.objective);
        let (Run::Settled, Some(high)) = (run, best) else {
            return Ok(record.outcome(run.ended()));
        };
        let longest = (formulation == Formulation::SingleSink).then(|| longest_ways(problem, high));
        let mut travel = Formulated::with_cuts(problem, formulation, longest, self.cuts)?;
        travel.limit_length(record.bound - 1e-6, high);
        self.order(&mut travel);
        let left = record.left(limits);
        let run = self.run(&travel, &left, &mut record, Until::Proof)?;
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

    /// Adds cuts that solutions of the relaxation violate, in rounds, and takes
    /// its bound.
    fn tighten(
        &self,
        formulated: &mut Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<(), DesignError> {
        // Half of the time at most: of rooms most of the bound is made here.
        let budget = limits.deadline.map(|deadline| deadline / 2);
        if !formulated.separates() {
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
            record.raise(formulated.program().rounded(found.objective));
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

    /// Solves a program; all networks found are offered to the record.
    fn run(
        &self,
        formulated: &Formulated<'_>,
        limits: &Limits,
        record: &mut Record<'_, '_>,
        until: Until,
    ) -> Result<Run, DesignError> {
        if record.cancelled {
            return Ok(Run::Ended(Ended::Cancelled));
        }
        if until == Until::Proof && record.is_within(limits.gap) {
            return Ok(Run::Ended(Ended::Proven));
        }
        if limits.deadline.is_some_and(|deadline| deadline.is_zero()) {
            return Ok(Run::Ended(Ended::Deadline));
        }
        let start = record
            .best
            .as_ref()
            .map(|(network, _)| formulated.solution(&formulated.image(network)));
        let program = formulated.program();
        let mut enough = false;
        let found = self.solver.solve(
            program,
            start.as_deref(),
            limits,
            &mut |told: &MipProgress<'_>| {
                let mut improved = false;
                if let (Some(values), true) = (told.best, told.improved) {
                    improved = record.offer(formulated.network(values));
                }
                if until == Until::Proof {
                    record.raise(program.rounded(told.bound));
                }
                enough = match until {
                    Until::First => record.best.is_some(),
                    Until::Proof => record.is_within(limits.gap),
                };
                let received = record.receive();
                if !record.report(improved || received) || enough {
                    return MipReply::Stop;
                }
                match (received, &record.best) {
                    (true, Some((network, _))) => {
                        MipReply::Try(formulated.solution(&formulated.image(network)))
                    }
                    _ => MipReply::GoOn,
                }
            },
        )?;
        let mut invalid = None;
        if let Some(values) = &found.solution {
            let network = formulated.network(values);
            invalid = verify(record.problem, &network).into_iter().next();
            record.offer(network);
        }
        if until == Until::Proof && found.status != MipStatus::Infeasible {
            record.raise(program.rounded(found.bound));
        }
        match found.status {
            MipStatus::Infeasible if record.best.is_some() => {
                // The program only knows of networks that are no worse.
                record.close();
                Ok(Run::Ended(Ended::Proven))
            }
            MipStatus::Infeasible => Ok(Run::Ended(Ended::Infeasible)),
            _ if until == Until::Proof && record.is_within(limits.gap) => {
                Ok(Run::Ended(Ended::Proven))
            }
            MipStatus::Optimal if record.best.is_none() => Err(DesignError::SolverFailed {
                solver: self.solver.name(),
                what: match invalid {
                    Some(violation) => format!("its solution is not valid: {violation}"),
                    None => "it has a proof, but no solution".to_owned(),
                },
            }),
            // Of a program that does not price all: its bound stands.
            MipStatus::Optimal => Ok(Run::Settled),
            MipStatus::Cancelled if record.cancelled => Ok(Run::Ended(Ended::Cancelled)),
            MipStatus::Deadline | MipStatus::Cancelled => Ok(Run::Ended(Ended::Deadline)),
        }
    }
}
