//! The paper's baseline: a stochastic search of single edges (section 5.4).

mod draft;
mod operations;

use std::time::{Duration, Instant};

use super::record::Record;
use super::{Ended, Limits, NetworkSolver, Outcome, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;
use crate::random::Random;
use draft::{Draft, Worth};
use operations::operations;

/// The stochastic search that the paper compares its integer programs with
/// (section 5.4), and finds hopeless: here for the same comparison. Use
/// [`Search`](super::Search) for networks.
///
/// From a trivial solution, every edge active, it changes the network step by
/// step: it deletes (i) an edge, (ii) a pair of adjacent ones or (iii) three in a
/// row, or (iv) adds an edge. In each step all operations that are feasible are
/// ranked by the objective they lead to, and one is picked, the higher ranked
/// the likelier, the more so the later in a pass; then it begins anew, and the
/// best of all passes is the answer.
///
/// The paper leaves open what is feasible where edges that are too close are
/// forbidden, as in its figure 2, since then the trivial solution is not valid
/// itself: here an operation is, if it leaves no more islands, places without a
/// street and routes cut than there were, which is none after a sound beginning.
/// Dead ends and forbidden patterns count as faults, and fewer of them rank
/// higher whatever the objective.
///
/// An answer is valid by [`verify`](crate::design::verify). There is no bound,
/// and no proof. One thread; it depends on problem and seed alone if
/// [`passes`](Self::passes) are given and there is no deadline. From a start
/// that is valid every pass begins, instead of the trivial solution.
///
/// # Examples
///
/// ```
/// use network_opt::design::{Specification, Tessellation};
/// use network_opt::geo_types::polygon;
/// use network_opt::quad::{quads, QuadOptions};
/// use network_opt::solve::{Limits, NetworkSolver, Stochastic};
///
/// let site = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
/// let mesh = quads(&site, &QuadOptions { edge_length: 10.0, ..QuadOptions::default() })?;
/// let problem = Specification { coverage: network_opt::design::Coverage::Hops(1), ..Specification::default() }.on(&mesh)?;
/// let solver = Stochastic { passes: Some(3), ..Stochastic::default() };
/// let found = solver.solve(&problem, None, &Limits::default(), &mut |_| true)?;
/// assert!(found.network.is_some());
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stochastic {
    /// Passes at most; with `None` the deadline alone ends the search.
    ///
    /// Default value: `None`.
    pub passes: Option<u64>,
    /// Steps of a pass at most.
    ///
    /// Default value: 400.
    pub steps: usize,
    /// How freely operations are picked at the start of a pass: the mean rank as
    /// a share of all that are feasible, 0 to 1; it falls to 0 along the pass.
    ///
    /// Default value: 0.05.
    pub heat: f64,
}

impl Default for Stochastic {
    fn default() -> Self {
        Self {
            passes: None,
            steps: 400,
            heat: 0.05,
        }
    }
}

/// Between two reports.
const PACE: Duration = Duration::from_millis(20);

impl NetworkSolver for Stochastic {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        if !(0.0..=1.0).contains(&self.heat) {
            return Err(DesignError::BadOption {
                what: format!("heat is {}; give a share from 0 to 1", self.heat),
            });
        }
        if problem.rooms.is_some() {
            return Err(DesignError::BadProblem {
                what: "the stochastic search places no rooms; use another solver".to_owned(),
            });
        }
        if problem.placed.is_some() || problem.has_one_way() {
            return Err(DesignError::BadProblem {
                what: "the stochastic search, which is the paper's, places no sinks and knows no one-way streets; use another solver".to_owned(),
            });
        }
        let mut record = Record::begin(problem, start, watch, None)?;
        record.report(record.best.is_some());
        let start = record
            .best
            .as_ref()
            .map(|(network, _)| network.active.clone());
        let mut run = Run {
            record,
            limits,
            told: Instant::now(),
        };
        let mut random = Random::new(limits.seed);
        let mut pass = 0;
        while self.passes.is_none_or(|passes| pass < passes) && !run.is_over(false) {
            self.pass(problem, start.as_deref(), &mut random, &mut run);
            pass += 1;
        }
        let ended = if run.record.cancelled {
            Ended::Cancelled
        } else {
            Ended::Deadline
        };
        Ok(run.record.outcome(ended))
    }
}

/// The clock and who is told.
struct Run<'p, 'w> {
    record: Record<'p, 'w>,
    limits: &'w Limits,
    told: Instant,
}

impl Run<'_, '_> {
    /// Whether time is up, or the watch says no; it is told now and then.
    fn is_over(&mut self, improved: bool) -> bool {
        let now = Instant::now();
        if improved || now - self.told >= PACE {
            self.told = now;
            self.record.report(improved);
        }
        let late = (self.limits.deadline).is_some_and(|d| now - self.record.began >= d);
        late || self.record.cancelled
    }
}

impl Stochastic {
    /// One search until it is cold.
    fn pass(
        &self,
        problem: &Problem,
        start: Option<&[bool]>,
        random: &mut Random,
        run: &mut Run<'_, '_>,
    ) {
        let mut draft = Draft::new(problem, start);
        let mut at = draft.worth();
        for step in 0..self.steps {
            if at.faults == [0; draft::KINDS] {
                let network = Network {
                    active: draft.active().to_vec(),
                    ..Network::default()
                };
                let improved = run.record.offer(network);
                if run.is_over(improved) {
                    return;
                }
            }
            let mut ranked: Vec<(Worth, Vec<usize>)> = Vec::new();
            for edges in operations(problem, &draft) {
                if run.is_over(false) {
                    return;
                }
                if let Some(worth) = draft.tried(&edges, &at) {
                    ranked.push((worth, edges));
                }
            }
            ranked.sort_by(|a, b| a.0.rank(&b.0).then_with(|| a.1.cmp(&b.1)));
            let left = 1.0 - step as f64 / self.steps as f64;
            let mean = self.heat * left * ranked.len() as f64;
            // An exponential distribution of that mean.
            let rank = (-mean * (1.0 - random.unit()).ln()) as usize;
            let Some((worth, edges)) = ranked.get(rank.min(ranked.len().saturating_sub(1))) else {
                return;
            };
            // Cold, and nothing better to do.
            if mean < 0.5 && worth.rank(&at).is_ge() {
                return;
            }
            draft.toggle(edges);
            at = *worth;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{verify, EdgeState, Rooms, Specification, Tessellation};

    fn small() -> Problem {
        Specification::default()
            .on(&Tessellation::grid(8, 8))
            .expect("fits")
    }

    #[test]
    fn a_small_grid_is_solved() {
        let problem = small();
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let solver = Stochastic {
            passes: Some(4),
            ..Stochastic::default()
        };
        let found = solver
            .solve(&problem, None, &limits, &mut |_| true)
            .expect("fits");
        let network = found.network.expect("a network");
        assert_eq!(verify(&problem, &network), []);
        assert_eq!((found.ended, found.bound), (Ended::Deadline, 0.0));
    }

    /// It stops when it is told to, and at the deadline, with what it has.
    #[test]
    fn it_stops() {
        let problem = small();
        let none = Limits {
            deadline: None,
            ..Limits::default()
        };
        let mut reports = 0;
        let found = Stochastic::default().solve(&problem, None, &none, &mut |_| {
            reports += 1;
            reports < 3
        });
        assert_eq!(found.expect("fits").ended, Ended::Cancelled);
        assert_eq!(reports, 3);
        let soon = Limits {
            deadline: Some(Duration::from_millis(50)),
            ..Limits::default()
        };
        let found = Stochastic::default().solve(&problem, None, &soon, &mut |_| true);
        let found = found.expect("fits");
        assert_eq!(found.ended, Ended::Deadline);
        assert!(found.elapsed < Duration::from_millis(550));
    }

    #[test]
    fn rooms_and_strange_options_are_refused() {
        let mut problem = small();
        let limits = Limits::default();
        let hot = Stochastic {
            heat: f64::NAN,
            ..Stochastic::default()
        };
        assert!(hot.solve(&problem, None, &limits, &mut |_| true).is_err());
        problem.rooms = Some(Rooms::default());
        let refused = Stochastic::default().solve(&problem, None, &limits, &mut |_| true);
        assert!(refused.is_err());
    }

    /// Where nothing can be changed the trivial solution is the answer.
    #[test]
    fn nothing_to_do() {
        let mut problem = small();
        problem.states.fill(EdgeState::Given);
        problem.patterns.clear();
        let once = Stochastic {
            passes: Some(1),
            ..Stochastic::default()
        };
        let found = once.solve(&problem, None, &Limits::default(), &mut |_| true);
        assert!(found.expect("fits").network.is_some());
    }
}
