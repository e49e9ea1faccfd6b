//! What solvers that run side by side tell each other.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::design::Network;
use crate::formulate::Formulation;
use crate::mip::Row;

/// What solvers share: the best network, the best bound, a program, and what is
/// being refuted.
#[derive(Debug, Default)]
pub(super) struct Pool {
    shared: Mutex<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    best: Option<(Network, f64)>,
    bound: f64,
    program: Option<Tightened>,
    claims: Vec<f64>,
}

/// A program with cuts, as another solver can write it down too.
#[derive(Clone, Debug)]
pub(super) struct Tightened {
    pub(super) formulation: Formulation,
    pub(super) longest: Option<Vec<f64>>,
    pub(super) cuts: Vec<Row>,
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

    /// Hands a program to others.
    pub(super) fn publish(&self, program: Tightened) {
        self.shared().program = Some(program);
    }

    /// Whether there is a program.
    pub(super) fn has_program(&self) -> bool {
        self.shared().program.is_some()
    }

    /// The program, if there is one.
    pub(super) fn program(&self) -> Option<Tightened> {
        self.shared().program.clone()
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
}
