//! The search by the clock: threads, reports, the deadline and the bound.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::anneal::{Anneal, Best};
use super::bound::Bound;
use super::model::Model;
use super::Search;
use crate::design::{full_cost, verify, Cost, Network, Problem};
use crate::error::DesignError;
use crate::solve::{Ended, Limits, Outcome, Progress, Watch};

/// Between two reports.
const PACE: Duration = Duration::from_millis(20);

/// What threads tell each other.
struct Shared {
    stop: AtomicBool,
    busy: AtomicUsize,
    /// The best of each other thread that the first has not seen yet.
    news: Vec<Mutex<Option<Best>>>,
}

pub(super) fn run(
    search: &Search,
    problem: &Problem,
    start: Option<&Network>,
    limits: &Limits,
    watch: &mut Watch<'_>,
) -> Result<Outcome, DesignError> {
    let began = Instant::now();
    problem.check()?;
    let start = start.filter(|s| verify(problem, s).is_empty());
    let mut outcome = Outcome {
        network: None,
        cost: Cost::default(),
        bound: 0.0,
        ended: Ended::Deadline,
        first_feasible: None,
        elapsed: Duration::ZERO,
    };
    let Ok(model) = Model::new(problem) else {
        outcome.ended = Ended::Infeasible;
        outcome.bound = f64::INFINITY;
        outcome.elapsed = began.elapsed();
        return Ok(outcome);
    };
    let others = limits.threads.max(1) - 1;
    let shared = Shared {
        stop: AtomicBool::new(false),
        busy: AtomicUsize::new(others),
        news: (0..others).map(|_| Mutex::new(None)).collect(),
    };
    std::thread::scope(|scope| {
        for k in 0..others {
            let (model, shared) = (&model, &shared);
            // Seeds that follow each other must not share streams.
            let seed = limits.seed ^ (k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            scope.spawn(move || {
                work(search, Anneal::new(model, start, seed), shared, k);
                shared.busy.fetch_sub(1, Ordering::Release);
            });
        }
        let mut lead = Lead {
            problem,
            limits,
            began,
            bests: vec![None; others + 1],
            outcome: &mut outcome,
        };
        lead.run(search, &model, start, &shared, watch);
        shared.stop.store(true, Ordering::Relaxed);
    });
    outcome.elapsed = began.elapsed();
    Ok(outcome)
}

/// What a thread besides the first does.
fn work(search: &Search, mut anneal: Anneal<'_, '_>, shared: &Shared, k: usize) {
    let mut moves = 0;
    let mut told = Instant::now();
    let mut pending = anneal.best().is_some();
    loop {
        let over = search.moves.is_some_and(|m| moves >= m) || shared.stop.load(Ordering::Relaxed);
        if pending && (over || told.elapsed() >= PACE) {
            let mut news = shared.news[k]
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            *news = anneal.best().cloned();
            told = Instant::now();
            pending = false;
        }
        if over {
            return;
        }
        pending |= anneal.step();
        moves += 1;
    }
}

/// The first thread, which searches and reports.
struct Lead<'a> {
    problem: &'a Problem,
    limits: &'a Limits,
    began: Instant,
    /// The best of each thread, with its cost.
    bests: Vec<Option<(Network, Cost)>>,
    outcome: &'a mut Outcome,
}

impl Lead<'_> {
    fn run(
        &mut self,
        search: &Search,
        model: &Model<'_>,
        start: Option<&Network>,
        shared: &Shared,
        watch: &mut Watch<'_>,
    ) {
        let mut anneal = Anneal::new(model, start, self.limits.seed);
        let mut bound = None;
        let mut pending = anneal.best().is_some();
        let mut told = self.began;
        let mut moves = 0;
        // Looked at after every move and not at every report: by the clock the
        // bound would be another each time.
        let mut proven = false;
        loop {
            let now = Instant::now();
            let late = self.limits.deadline.is_some_and(|d| now - self.began >= d);
            let done = search.moves.is_some_and(|m| moves >= m);
            // Read before the news, or the last of them were lost.
            let alone = shared.busy.load(Ordering::Acquire) == 0;
            let over = late || done && alone;
            let first = pending && self.outcome.network.is_none();
            if over || proven || first || now - told >= PACE {
                told = now;
                if std::mem::take(&mut pending) {
                    self.take(0, anneal.best());
                }
                for (k, news) in shared.news.iter().enumerate() {
                    let mut news = news.lock().unwrap_or_else(PoisonError::into_inner);
                    self.take(k + 1, news.take().as_ref());
                }
                let improved = self.choose();
                let going = watch(&Progress {
                    elapsed: self.began.elapsed(),
                    best: self
                        .outcome
                        .network
                        .as_ref()
                        .map(|n| (n, self.outcome.cost)),
                    improved,
                    bound: self.outcome.bound,
                });
                if !going {
                    self.outcome.ended = Ended::Cancelled;
                    return;
                }
                if proven || self.others_are_good() {
                    self.outcome.ended = Ended::Proven;
                    return;
                }
                if over {
                    return;
                }
            }
            if done {
                std::thread::sleep(Duration::from_millis(1));
                continue;
            }
            pending |= anneal.step();
            moves += 1;
            if anneal.is_hopeless() {
                self.outcome.ended = Ended::Infeasible;
                self.outcome.bound = f64::INFINITY;
                return;
            }
            // The bound begins after the first networks, and then goes along.
            if moves >= 200 && moves % 8 == 0 {
                let bound = bound.get_or_insert_with(|| Bound::new(model));
                self.outcome.bound = self.outcome.bound.max(bound.improve(model));
            }
            proven = anneal
                .best()
                .is_some_and(|best| self.is_good(best.objective));
        }
    }

    /// Keeps the best network of a thread, if it is valid.
    fn take(&mut self, k: usize, best: Option<&Best>) {
        let Some(best) = best else {
            return;
        };
        // It always is; but this is the promise, whatever happens elsewhere.
        let valid = verify(self.problem, &best.network).is_empty();
        debug_assert!(
            valid,
            "counters of the search do not agree with the checker"
        );
        if valid {
            let cost = full_cost(self.problem, &best.network);
            let known = self.bests[k].as_ref();
            if known.is_none_or(|(_, known)| cost.objective < known.objective) {
                self.bests[k] = Some((best.network.clone(), cost));
            }
        }
    }

    /// Makes the best of all threads the outcome, the first of equals.
    fn choose(&mut self) -> bool {
        let mut found: Option<&(Network, Cost)> = None;
        for best in self.bests.iter().flatten() {
            if found.is_none_or(|(_, cost)| best.1.objective < cost.objective) {
                found = Some(best);
            }
        }
        let Some((network, cost)) = found else {
            return false;
        };
        let known = self.outcome.network.as_ref();
        let improved = known.is_none() || cost.objective < self.outcome.cost.objective;
        if known != Some(network) {
            self.outcome.network = Some(network.clone());
            self.outcome.cost = *cost;
        }
        let now = self.began.elapsed();
        self.outcome.first_feasible.get_or_insert(now);
        improved
    }

    /// Whether the bound comes as near to an objective as was asked for.
    fn is_good(&self, objective: f64) -> bool {
        // Sums in another order differ in the last digits.
        let slack = (self.limits.gap.max(0.0) + 1e-9) * objective;
        self.outcome.bound >= objective - slack
    }

    /// Whether another thread has found what is good enough.
    fn others_are_good(&self) -> bool {
        let mut others = self.bests[1..].iter().flatten();
        others.any(|(_, cost)| self.is_good(cost.objective))
    }
}
