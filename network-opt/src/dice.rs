//! Dice: random numbers by seed.

use rand_pcg::rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A stream of random numbers that is the same everywhere.
#[derive(Debug)]
pub(crate) struct Dice(Pcg64Mcg);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// One of `0..count`, which is not empty.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// From 0 to less than 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// One of the things, if there is any.
    pub(crate) fn pick<T: Copy>(&mut self, things: &[T]) -> Option<T> {
        if things.is_empty() {
            return None;
        }
        Some(things[self.below(things.len())])
    }

    /// Puts things into a random order.
    pub(crate) fn shuffle<T>(&mut self, things: &mut [T]) {
        for k in (1..things.len()).rev() {
            things.swap(k, self.below(k + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dice_are_fair_and_repeatable() {
        let (mut a, mut b) = (Dice::new(5), Dice::new(5));
        let mut counts = [0; 6];
        for _ in 0..6000 {
            let k = a.below(6);
            assert_eq!(k, b.below(6));
            counts[k] += 1;
        }
        // The deviation of each count is sqrt(6000 * 1/6 * 5/6) = 29; six of them.
        assert!(
            counts.iter().all(|&c: &i32| (c - 1000).abs() < 174),
            "{counts:?}"
        );
        assert_eq!(a.pick::<usize>(&[]), None);
    }

    #[test]
    fn every_order_comes_as_often() {
        let mut dice = Dice::new(9);
        let mut counts = std::collections::BTreeMap::new();
        for _ in 0..6000 {
            let mut things = [0, 1, 2];
            dice.shuffle(&mut things);
            *counts.entry(things).or_insert(0_i32) += 1;
        }
        // As above.
        assert_eq!(counts.len(), 6);
        assert!(
            counts.values().all(|c| (c - 1000).abs() < 174),
            "{counts:?}"
        );
    }
}
