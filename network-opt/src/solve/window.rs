//! A network made better piece by piece: all is fixed but a window, which is
//! solved to proof.

use std::time::Duration;

use super::pool::Pool;
use super::record::Record;
use super::{Ended, Exact, Limits, NetworkSolver, Outcome, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;
use crate::formulate::{longest_ways, prepare, Cuts, Fate, Formulated, Formulation};
use crate::mip::{MipSolver, MipStatus};

/// Improves networks by windows that slide over the mesh: the edges near one
/// vertex are free, all others as they are in the best network; the program of
/// that is solved to proof, or for [`Windows::time`]. When no window makes the
/// network better, windows grow, until one holds all edges.
///
/// A local optimum of large windows is often the optimum; there is a proof only
/// if a window holds all edges. Without a start the first network is that of
/// [`Exact`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Windows<M> {
    /// Solves the programs.
    pub solver: M,
    /// Which program a problem becomes.
    ///
    /// Default value: [`Formulation::Recommended`].
    pub formulation: Formulation,
    /// Edges of the first windows that are free.
    ///
    /// Default value: 90.
    pub size: usize,
    /// Time for one window at most.
    ///
    /// Default value: 3 s.
    pub time: Duration,
}

impl<M> Windows<M> {
    /// With default sizes and times.
    pub const fn new(solver: M) -> Self {
        Self {
            solver,
            formulation: Formulation::Recommended,
            size: 90,
            time: Duration::from_secs(3),
        }
    }
}

impl<M: MipSolver> NetworkSolver for Windows<M> {
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

impl<M: MipSolver> Windows<M> {
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
        if record.best.is_none() {
            let exact = Exact {
                formulation: self.formulation,
                ..Exact::new(&self.solver)
            };
            let ended = exact.first(limits, &mut record)?;
            if record.best.is_none() || ended == Ended::Cancelled {
                return Ok(record.outcome(ended));
            }
        }
        let ended = self.slide(limits, &mut record)?;
        Ok(record.outcome(ended))
    }
}

impl<M: MipSolver> Windows<M> {
    /// Slides windows until the time is over, the watch says no, or a window
    /// holds all edges.
    fn slide(&self, limits: &Limits, record: &mut Record<'_, '_>) -> Result<Ended, DesignError> {
        let problem = record.problem;
        let is_late = |record: &Record<'_, '_>| {
            let left = record.left(limits).deadline;
            left.is_some_and(|left| left.is_zero())
        };
        if is_late(record) {
            return Ok(Ended::Deadline);
        }
        let cost = record
            .best
            .as_ref()
            .map_or(f64::INFINITY, |(_, cost)| cost.objective);
        let longest = longest_ways(problem, cost);
        let formulation = match self.formulation {
            // Distances of vertices outside of a window move with it; flows are
            // linear and their program falls apart where edges are fixed.
            Formulation::Recommended if problem.travel_weight > 0.0 => Formulation::TravelFlow,
            other => other,
        };
        // A window is solved whatever its relaxation is worth.
        let cuts = Cuts {
            balls: true,
            ..Cuts::none()
        };
        let formulated = Formulated::with_cuts(problem, formulation, Some(longest), cuts)?;
        let open: Vec<bool> = prepare(problem).iter().map(|f| *f == Fate::Open).collect();
        let all = open.iter().filter(|&&open| open).count();
        let mut size = self.size.clamp(1, all.max(1));
        let order = far_apart(problem);
        // Windows since the last improvement, at this size.
        let mut idle = 0;
        let mut at = 0;
        loop {
            let Some((network, before)) = record.best.clone() else {
                return Ok(Ended::Deadline);
            };
            let free = window(problem, order[at % order.len()], size, &open);
            let holds_all = size >= all;
            let left = record.left(limits);
            if is_late(record) {
                return Ok(Ended::Deadline);
            }
            let program = formulated.window(&network, &free);
            let start = formulated.solution(&network);
            let limits = Limits {
                deadline: Some(match left.deadline {
                    Some(deadline) if holds_all => deadline,
                    Some(deadline) => deadline.min(self.time),
                    None if holds_all => Duration::MAX,
                    None => self.time,
                }),
                gap: if holds_all { limits.gap } else { 0.0 },
                ..left
            };
            let found = self
                .solver
                .solve(&program, Some(&start), &limits, &mut |told| {
                    let improved = match told.best {
                        Some(values) if told.improved => record.offer(formulated.network(values)),
                        _ => false,
                    };
                    record.report(improved).into()
                })?;
            record.receive();
            if let Some(values) = &found.solution {
                if record.offer(formulated.network(values)) {
                    record.report(true);
                }
            }
            if record.cancelled {
                return Ok(Ended::Cancelled);
            }
            if holds_all {
                // A flow does not price travel, so it proves nothing of it.
                let prices =
                    formulated.formulation() != Formulation::Flow || problem.travel_weight == 0.0;
                if prices && found.status == MipStatus::Optimal {
                    record.raise(program.rounded(found.bound));
                    return Ok(Ended::Proven);
                }
                return Ok(Ended::Deadline);
            }
            let after = record
                .best
                .as_ref()
                .map_or(f64::INFINITY, |(_, cost)| cost.objective);
            idle = if after < before.objective - 1e-9 {
                0
            } else {
                idle + 1
            };
            at += 1;
            // Windows of n edges overlap well if there are four times as many as
            // would lie side by side.
            if idle > 4 * all.div_ceil(size) {
                size = (size + size / 2).min(all);
                idle = 0;
            }
        }
    }
}

/// The edges nearest to a vertex, about `size` of them open.
fn window(problem: &Problem, centre: usize, size: usize, open: &[bool]) -> Vec<bool> {
    let around = problem.around();
    let mut free = vec![false; problem.edges()];
    let mut seen = vec![false; problem.vertices];
    let mut queue = std::collections::VecDeque::from([centre]);
    seen[centre] = true;
    let mut count = 0;
    while let Some(v) = queue.pop_front() {
        if count >= size {
            break;
        }
        for &(e, w) in &around[v] {
            if !free[e] {
                free[e] = true;
                count += usize::from(open[e]);
            }
            if !seen[w] {
                seen[w] = true;
                queue.push_back(w);
            }
        }
    }
    if size >= open.iter().filter(|&&open| open).count() {
        free.fill(true);
    }
    free
}

/// All vertices, each far from those before it, so that consecutive windows lie
/// apart and the first few cover all.
fn far_apart(problem: &Problem) -> Vec<usize> {
    let around = problem.around();
    let mut nearest = vec![usize::MAX; problem.vertices];
    let mut order = Vec::with_capacity(problem.vertices);
    let mut chosen = vec![false; problem.vertices];
    for _ in 0..problem.vertices {
        let far = (0..problem.vertices)
            .filter(|&v| !chosen[v])
            .max_by_key(|&v| (nearest[v], std::cmp::Reverse(v)));
        let Some(next) = far else { break };
        chosen[next] = true;
        order.push(next);
        let mut queue = std::collections::VecDeque::from([next]);
        nearest[next] = 0;
        while let Some(v) = queue.pop_front() {
            for &(_, w) in &around[v] {
                if nearest[v] + 1 < nearest[w] {
                    nearest[w] = nearest[v] + 1;
                    queue.push_back(w);
                }
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::EdgeState;
    use crate::mip::Microlp;

    /// A ladder of `n` squares with the sink at one corner.
    fn ladder(n: usize) -> Problem {
        let mut ends = Vec::new();
        for k in 0..=n {
            ends.push([2 * k, 2 * k + 1]);
        }
        for k in 0..n {
            ends.extend([[2 * k, 2 * k + 2], [2 * k + 1, 2 * k + 3]]);
        }
        Problem {
            vertices: 2 * n + 2,
            lengths: vec![1.0; ends.len()],
            states: vec![EdgeState::Open; ends.len()],
            ends,
            sinks: (0..2 * n + 2).map(|v| v == 0).collect(),
            coverage: (0..=n).map(|k| vec![2 * k, 2 * k + 1]).collect(),
            dead_ends: true,
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn windows_reach_the_optimum_and_say_so() {
        // One side of the ladder is enough; the start is all of it.
        let problem = ladder(8);
        let start = Network {
            active: vec![true; problem.edges()],
            ..Network::default()
        };
        let windows = Windows {
            size: 8,
            ..Windows::new(Microlp)
        };
        let mut told = Vec::new();
        let found = windows
            .solve(
                &problem,
                Some(&start),
                &Limits::default(),
                &mut |progress| {
                    told.extend(progress.best.map(|(_, cost)| cost.objective));
                    true
                },
            )
            .expect("solved");
        assert_eq!(found.cost.objective, 8.0);
        assert_eq!(found.ended, Ended::Proven);
        assert!(told.windows(2).all(|pair| pair[1] <= pair[0]));
        // Without a start too.
        let found = windows
            .solve(&problem, None, &Limits::default(), &mut |_| true)
            .expect("solved");
        assert_eq!((found.cost.objective, found.ended), (8.0, Ended::Proven));
    }

    #[test]
    fn windows_are_local_and_centres_far_apart() {
        let problem = ladder(8);
        let open = vec![true; problem.edges()];
        let free = window(&problem, 0, 5, &open);
        let far: Vec<usize> = (0..problem.edges()).filter(|&e| free[e]).collect();
        assert!(far.iter().all(|&e| problem.ends[e].iter().all(|&v| v < 8)));
        assert_eq!(far_apart(&problem)[..2], [0, 17]);
        assert_eq!(window(&problem, 3, 25, &open), vec![true; 25]);
    }
}
