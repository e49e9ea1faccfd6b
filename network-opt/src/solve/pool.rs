//! What solvers that run side by side tell each other.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::design::{Network, Problem};
use crate::error::DesignError;
use crate::formulate::{Cuts, Formulated, Formulation};
use crate::mip::Row;

/// What solvers share: the best network, the best bound, programs, and what is
/// being refuted.
#[derive(Debug, Default)]
pub(super) struct Pool {
    shared: Mutex<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    best: Option<(Network, f64)>,
    bound: f64,
    /// The latest program, and how many there were.
    program: (Option<Tightened>, usize),
    claims: Vec<f64>,
    /// No network costs less without travel.
    least: f64,
    supposed: Option<Supposed>,
}

/// No network that costs `least` at least without travel costs less than `bound`.
#[derive(Clone, Copy, Debug)]
struct Supposed {
    least: f64,
    bound: f64,
}

/// A program with cuts, as another solver can write it down too.
#[derive(Clone, Debug)]
pub(super) struct Tightened {
    pub(super) formulation: Formulation,
    pub(super) longest: Option<Vec<f64>>,
    pub(super) settled: Option<f64>,
    pub(super) cuts: Vec<Row>,
}

impl Tightened {
    pub(super) fn of(formulated: &Formulated<'_>) -> Self {
        Self {
            formulation: formulated.formulation(),
            longest: formulated.longest().map(<[f64]>::to_vec),
            settled: formulated.settled(),
            cuts: formulated.added().to_vec(),
        }
    }

    /// The program, with the same families of cuts.
    pub(super) fn write(
        self,
        problem: &Problem,
        cuts: Cuts,
    ) -> Result<Formulated<'_>, DesignError> {
        let mut formulated = Formulated::with_cuts(problem, self.formulation, self.longest, cuts)?;
        if let Some(cost) = self.settled {
            formulated.settle_length(cost);
        }
        self.cuts.into_iter().for_each(|row| formulated.cut(row));
        Ok(formulated)
    }
}

/// That a level is being refuted, for as long as this lives.
#[derive(Debug)]
pub(super) struct Claim<'p> {
    pool: &'p Pool,
    level: f64,
}

impl Pool {
    fn shared(&self) -> MutexGuard<'_, Shared> {
        // Nothing panics while it holds the lock.
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A network that costs less than `known`, if there is one.
    pub(super) fn better_than(&self, known: f64) -> Option<Network> {
        let shared = self.shared();
        let (network, cost) = shared.best.as_ref()?;
        (*cost < known).then(|| network.clone())
    }

    /// Keeps a valid network if it is better.
    pub(super) fn offer(&self, network: &Network, cost: f64) {
        let mut shared = self.shared();
        if shared.best.as_ref().is_none_or(|(_, known)| cost < *known) {
            shared.best = Some((network.clone(), cost));
        }
    }

    /// No network costs less.
    pub(super) fn bound(&self) -> f64 {
        self.shared().bound
    }

    /// Takes a bound if it is better.
    pub(super) fn raise(&self, bound: f64) {
        let mut shared = self.shared();
        if bound.is_finite() {
            shared.bound = shared.bound.max(bound);
        }
    }

    /// No network costs less without travel, in length, patterns, routes and wishes.
    pub(super) fn settle(&self, least: f64) {
        let mut shared = self.shared();
        shared.least = shared.least.max(least);
        shared.conclude();
    }

    /// Whether it is known that no network costs less without travel.
    pub(super) fn is_settled(&self, least: f64) -> bool {
        self.shared().is_settled(least)
    }

    /// No network that costs `least` at least without travel costs less than
    /// `bound`; it becomes a bound on all as soon as that is what they cost.
    pub(super) fn suppose(&self, least: f64, bound: f64) {
        let mut shared = self.shared();
        let known = shared.supposed.filter(|known| known.least == least);
        if known.is_none_or(|known| bound > known.bound) {
            shared.supposed = Some(Supposed { least, bound });
            shared.conclude();
        }
    }

    /// Hands a program to others, in place of the one before it.
    pub(super) fn publish(&self, program: Tightened) {
        let (latest, count) = &mut self.shared().program;
        *latest = Some(program);
        *count += 1;
    }

    /// How many programs there were.
    pub(super) fn programs(&self) -> usize {
        self.shared().program.1
    }

    /// The latest program, if there is one.
    pub(super) fn program(&self) -> Option<Tightened> {
        self.shared().program.0.clone()
    }

    /// Says that a level is being refuted; the first of those that no other solver
    /// is at already. None if there is none left.
    pub(super) fn claim(&self, levels: impl Iterator<Item = f64>) -> Option<Claim<'_>> {
        let mut shared = self.shared();
        let taken = |level: f64| {
            let near = |&other: &f64| (other - level).abs() <= 1e-9 * level.abs();
            shared.claims.iter().any(near)
        };
        let level = { levels }.find(|&level| !taken(level))?;
        shared.claims.push(level);
        Some(Claim { pool: self, level })
    }
}

impl Shared {
    fn is_settled(&self, least: f64) -> bool {
        // Bounds of solvers are within this of what networks cost.
        self.least >= least - 1e-6 * least.abs().max(1.0)
    }

    fn conclude(&mut self) {
        if let Some(Supposed { least, bound }) = self.supposed {
            if self.is_settled(least) && bound.is_finite() {
                self.bound = self.bound.max(bound);
            }
        }
    }
}

impl Claim<'_> {
    pub(super) fn level(&self) -> f64 {
        self.level
    }
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        let mut shared = self.pool.shared();
        let mine = shared.claims.iter().position(|&level| level == self.level);
        if let Some(mine) = mine {
            shared.claims.swap_remove(mine);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_claimed_once_at_a_time() {
        let pool = Pool::default();
        let levels = || [3.0, 4.0].into_iter();
        let first = pool.claim(levels()).expect("free");
        let second = pool.claim(levels()).expect("one is left");
        assert_eq!((first.level(), second.level()), (3.0, 4.0));
        assert!(pool.claim(levels()).is_none());
        drop(first);
        assert_eq!(pool.claim(levels()).map(|c| c.level()), Some(3.0));
    }

    #[test]
    fn the_best_is_kept() {
        let pool = Pool::default();
        assert_eq!(pool.better_than(f64::INFINITY), None);
        let of = |on: bool| Network {
            active: vec![on],
            ..Network::default()
        };
        pool.offer(&of(true), 2.0);
        pool.offer(&of(false), 3.0);
        assert_eq!(pool.better_than(2.0), None);
        assert_eq!(pool.better_than(2.5), Some(of(true)));
        pool.raise(1.0);
        pool.raise(f64::INFINITY);
        pool.raise(0.5);
        assert_eq!(pool.bound(), 1.0);
    }

    #[test]
    fn what_is_supposed_counts_when_it_is_known() {
        let pool = Pool::default();
        pool.suppose(19.0, 19.5);
        assert_eq!(pool.bound(), 0.0);
        pool.settle(18.0);
        assert_eq!(pool.bound(), 0.0);
        assert!(pool.is_settled(18.0) && !pool.is_settled(19.0));
        pool.settle(19.0 - 1e-9);
        assert!(pool.is_settled(19.0));
        assert_eq!(pool.bound(), 19.5);
        // From then on at once, and never less.
        pool.suppose(19.0, 19.75);
        pool.suppose(19.0, 19.25);
        assert_eq!(pool.bound(), 19.75);
        // Of networks that cost more there may be none.
        pool.suppose(20.0, 20.5);
        assert_eq!(pool.bound(), 19.75);
    }
}
