//! All at once: search and windows for good networks, the whole program for the
//! proof.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::pool::Pool;
use super::record::{contradicts, too_cheap};
use super::turns::{idle_after, in_turn, Turn};
use super::{Ended, Exact, Limits, NetworkSolver, Outcome, Progress, Search, Watch, Windows};
use crate::design::{cost_of, EdgeState, Network, Problem};
use crate::error::DesignError;
use crate::mip::MipSolver;

/// Runs [`Exact`] and, side by side with it, what finds better networks:
/// [`Search`] from nothing, as long as something comes of it, for an eighth of the time
/// at most, and [`Windows`], until a quarter of it is over; and then, where bounds are
/// raised in steps ([`Exact::climbs_from`]), other steps than those of the first. Where
/// travel only decides between networks of one length, and there are no steps, it looks
/// into travel at once, while the first thread proves the length. Programs and
/// windows know of the best network and the best bound. With one thread windows
/// and programs come one after the other.
///
/// What threads find in which order is not the same in every run; with one
/// thread and without a deadline it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Race<M> {
    /// For proofs.
    pub exact: Exact<M>,
    /// For networks.
    pub windows: Windows<M>,
    /// For networks, before windows; of two threads and more.
    pub search: Search,
}

/// Part of the time that the search and windows have, the search half of it at most.
const SHARE: f64 = 0.25;
/// What that is without a deadline.
const UNLIMITED: Duration = Duration::from_secs(40);
/// Between two looks for something to do.
const PACE: Duration = Duration::from_millis(20);
/// Make other seeds of those of the first thread.
const SEARCH: u64 = 0x5EA2_C4B5;
const PROOF: u64 = 0x74A7_E115;

impl<M: Copy> Race<M> {
    /// With default options.
    pub fn new(solver: M) -> Self {
        Self {
            exact: Exact::new(solver),
            windows: Windows::new(solver),
            search: Search::default(),
        }
    }
}

impl<M: MipSolver + Sync> NetworkSolver for Race<M> {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        problem.check()?;
        if limits.threads < 2 {
            return self.in_turn(problem, start, limits, watch);
        }
        let pool = Pool::default();
        let over = AtomicBool::new(false);
        let proof = Limits {
            threads: limits.threads - 1,
            ..limits.clone()
        };
        thread::scope(|scope| {
            let beside = scope.spawn(|| {
                let beside = Beside {
                    race: self,
                    problem,
                    limits: Limits {
                        threads: 1,
                        ..limits.clone()
                    },
                    began: Instant::now(),
                    pool: &pool,
                    over: &over,
                };
                beside.run()
            });
            let mut told = |progress: &Progress<'_>| {
                let go_on = watch(progress);
                if !go_on {
                    over.store(true, Ordering::Relaxed);
                }
                go_on
            };
            let exact = self
                .exact
                .solve_in(problem, start, &proof, &mut told, Some(&pool));
            over.store(true, Ordering::Relaxed);
            let first = beside.join().unwrap_or_else(|_| {
                Err(DesignError::SolverFailed {
                    solver: self.windows.solver.name(),
                    what: "the thread beside it panicked".to_owned(),
                })
            })?;
            let mut outcome = exact?;
            outcome.first_feasible = match (outcome.first_feasible, first) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
            if outcome.ended == Ended::Infeasible {
                return Ok(outcome);
            }
            let known = match outcome.network {
                Some(_) => outcome.cost.objective - 1e-9,
                None => f64::INFINITY,
            };
            if let Some(network) = pool.better_than(known) {
                outcome.cost = cost_of(problem, &network);
                outcome.network = Some(network);
            }
            if outcome.network.is_some() {
                let cost = outcome.cost.objective;
                outcome.bound = outcome.bound.max(pool.bound());
                if contradicts(&outcome.cost, outcome.bound) {
                    return Err(too_cheap(self.exact.solver.name()));
                }
                outcome.bound = outcome.bound.min(cost);
                // As the record of a solver has it.
                if cost - outcome.bound <= limits.gap * cost.abs() + 1e-6 {
                    outcome.ended = Ended::Proven;
                }
            }
            Ok(outcome)
        })
    }
}

/// What runs beside the proof.
struct Beside<'r, M> {
    race: &'r Race<M>,
    problem: &'r Problem,
    limits: Limits,
    began: Instant,
    pool: &'r Pool,
    over: &'r AtomicBool,
}

impl<M: MipSolver + Sync> Beside<'_, M> {
    /// Says when the first network was there.
    fn run(&self) -> Result<Option<Duration>, DesignError> {
        let exact = &self.race.exact;
        let share = (self.limits.deadline).map_or(UNLIMITED, |time| time.mul_f64(SHARE));
        let mut first = self.search(share / 2)?;
        let share = if exact.travels_beside(self.problem) {
            // Travel takes longer than what is left of a proof of length.
            Duration::ZERO
        } else {
            share
        };
        let mut until_over = |_: &Progress<'_>| !self.is_over();
        let mut done = 0;
        while !self.is_over() {
            let is_new = || self.pool.programs() > done;
            let mut until_due = |_: &Progress<'_>| {
                let is_due = is_new() && self.spent() >= share;
                !self.is_over() && !is_due
            };
            self.windows(&mut first, done as u64, &mut until_due)?;
            // Windows are over by themselves where one holds all.
            while !self.is_over() && !is_new() {
                thread::sleep(PACE);
            }
            done = self.pool.programs();
            if !self.is_over() {
                // Not the way of the one that comes to the same later.
                let limits = self.left_with(PROOF);
                exact.solve_beside(self.problem, &limits, &mut until_over, self.pool)?;
            }
        }
        Ok(first)
    }

    /// From nothing: what comes of the best network the search before this one has
    /// tried.
    fn search(&self, time: Duration) -> Result<Option<Duration>, DesignError> {
        let mut last = Duration::ZERO;
        let mut go_on = |progress: &Progress<'_>| {
            if let (Some((network, cost)), true) = (progress.best, progress.improved) {
                self.pool.offer(network, cost.objective);
                last = progress.elapsed;
            }
            self.pool.raise(progress.bound);
            !self.is_over() && progress.elapsed < time.min(idle_after(last))
        };
        // Not the way of a search that came before.
        let limits = self.left_with(SEARCH);
        let found = (self.race.search).solve(self.problem, None, &limits, &mut go_on)?;
        if let Some(network) = &found.network {
            self.pool.offer(network, found.cost.objective);
        }
        Ok(found.first_feasible)
    }

    /// From the best network; other windows come first with another seed.
    fn windows(
        &self,
        first: &mut Option<Duration>,
        seed: u64,
        until: &mut Watch<'_>,
    ) -> Result<(), DesignError> {
        let spent = self.spent();
        let best = self.pool.better_than(f64::INFINITY);
        let found = self.race.windows.solve_in(
            self.problem,
            best.as_ref(),
            &self.left_with(seed),
            until,
            Some(self.pool),
        )?;
        *first = first.or(found.first_feasible.map(|time| time + spent));
        Ok(())
    }

    fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    fn spent(&self) -> Duration {
        self.began.elapsed()
    }

    /// The limits, with what is left of the time and another seed.
    fn left_with(&self, other: u64) -> Limits {
        let deadline = self.limits.deadline;
        Limits {
            deadline: deadline.map(|time| time.saturating_sub(self.spent())),
            seed: self.limits.seed ^ other,
            ..self.limits.clone()
        }
    }
}

impl<M: MipSolver + Sync> Race<M> {
    /// An eighth of the time for windows, where the program is too large for its
    /// solver to find good networks by itself.
    fn in_turn(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        let open = problem.states.iter().filter(|s| **s == EdgeState::Open);
        if open.count() < LARGE {
            return self.exact.solve(problem, start, limits, watch);
        }
        match limits.deadline {
            Some(deadline) => {
                let time = deadline / 8;
                let first = Turn {
                    solver: &self.windows,
                    time: &|_| time,
                    patience: time,
                };
                in_turn(&first, &self.exact, problem, start, limits, watch)
            }
            None => self.exact.solve(problem, start, limits, watch),
        }
    }
}

/// Edges to decide from which on windows go first.
const LARGE: usize = 280;

#[cfg(test)]
pub(super) mod tests {
    use super::super::pool::Tightened;
    use super::*;
    use crate::formulate::Formulation;
    use crate::mip::Microlp;

    /// A square with a diagonal; vertex 2 has to be reached and left. Best is out by
    /// the diagonal and back by two edges: 3.5 long, and the edge at vertex 2 starts
    /// from a way of 1.
    pub(in crate::solve) fn square() -> Problem {
        Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
            lengths: vec![1.0, 1.0, 1.0, 1.0, 1.5],
            states: vec![EdgeState::Open; 5],
            sinks: vec![true, false, false, false],
            required_vertices: vec![2],
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn side_by_side_and_in_turn_are_as_good() {
        let problem = square();
        for (threads, climbs_from) in [(1, 280), (2, 280), (2, 0)] {
            let limits = Limits {
                threads,
                deadline: None,
                ..Limits::default()
            };
            let mut race = Race::new(Microlp);
            race.exact.climbs_from = climbs_from;
            let found = race
                .solve(&problem, None, &limits, &mut |_| true)
                .expect("solved");
            assert_eq!(found.ended, Ended::Proven);
            assert_eq!(found.cost.objective, 4.5);
            assert_eq!(found.bound, 4.5);
        }
    }

    #[test]
    fn travel_beside_a_proof_counts_when_length_is_settled() {
        let problem = Problem {
            travel_weight: 0.001,
            ..square()
        };
        // Around the square is 4 long and travels 2. The shortest is 3.5 long and
        // travels 1; there are two of them.
        let of = |active: [bool; 5]| Network {
            active: active.to_vec(),
            ..Network::default()
        };
        let exact = Exact::new(Microlp);
        let limits = Limits::default();
        let beside = |pool: &Pool| {
            let found = exact.solve_beside(&problem, &limits, &mut |_| true, pool);
            found.expect("no failure");
        };
        let length = || Tightened {
            formulation: Formulation::Flow,
            longest: None,
            settled: None,
            cuts: vec![],
        };
        let pool = Pool::default();
        pool.publish(length());
        // Nothing to do without a network.
        beside(&pool);
        let around = of([true, true, true, true, false]);
        pool.offer(&around, cost_of(&problem, &around).objective);
        beside(&pool);
        pool.settle(3.5);
        assert_eq!(pool.bound(), 0.0, "some are shorter than 4");
        let short = of([false, false, true, true, true]);
        pool.offer(&short, cost_of(&problem, &short).objective);
        beside(&pool);
        assert!((pool.bound() - 3.501).abs() < 1e-6, "{}", pool.bound());
        // The first is at travel itself.
        let pool = Pool::default();
        pool.publish(Tightened {
            settled: Some(3.5),
            ..length()
        });
        pool.offer(&short, cost_of(&problem, &short).objective);
        pool.settle(3.5);
        beside(&pool);
        assert_eq!(pool.bound(), 0.0);
    }

    #[test]
    fn steps_beside_a_proof_end_at_the_optimum() {
        let problem = square();
        let pool = Pool::default();
        let all = Network {
            active: vec![true; 5],
            ..Network::default()
        };
        pool.offer(&all, cost_of(&problem, &all).objective);
        let exact = Exact {
            climbs_from: 0,
            ..Exact::new(Microlp)
        };
        let limits = Limits::default();
        let beside = || exact.solve_beside(&problem, &limits, &mut |_| true, &pool);
        // Nothing to do without a program.
        beside().expect("no failure");
        assert_eq!(pool.bound(), 0.0);
        pool.publish(Tightened {
            formulation: Formulation::TravelFlow,
            longest: None,
            settled: None,
            cuts: vec![],
        });
        beside().expect("no failure");
        assert!((pool.bound() - 4.5).abs() < 1e-6, "{}", pool.bound());
        let best = pool.better_than(5.0).expect("better than all edges");
        assert_eq!(cost_of(&problem, &best).objective, 4.5);
    }
}
