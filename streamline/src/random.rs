//! A named, portable stream of random numbers: PCG XSL RR 128/64 (`Pcg64`).
//!
//! Draws below a bound and in the unit interval are spelled out here, so that
//! a new release of `rand` cannot change which plan a seed stands for.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

#[derive(Debug)]
pub(crate) struct Stream(Pcg64);

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// A uniform integer in `0..bound`; 0 if the bound is 0.
    ///
    /// Widening multiplication; the bias is below `bound / 2^64`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.0.next_u64()) * bound as u128) >> 64) as usize
    }

    /// A uniform number in [0, 1), of 53 random bits.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Fisher-Yates, from the back.
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_pinned() {
        let mut stream = Stream::new(42);
        let drawn: Vec<usize> = (0..6).map(|_| stream.below(1000)).collect();
        assert_eq!(drawn, [226, 239, 760, 527, 970, 375]);
        let mut items: Vec<u8> = (0..8).collect();
        Stream::new(7).shuffle(&mut items);
        assert_eq!(items, [2, 7, 3, 6, 4, 5, 1, 0]);
    }

    #[test]
    fn unit_stays_in_its_interval_and_spreads() {
        let mut stream = Stream::new(1);
        let mean = (0..10_000)
            .map(|_| stream.unit())
            .inspect(|u| assert!((0.0..1.0).contains(u)))
            .sum::<f64>()
            / 1e4;
        // The standard deviation of the mean of 10^4 uniform draws is 0.0029.
        assert!((mean - 0.5).abs() < 0.015, "{mean}");
    }
}
