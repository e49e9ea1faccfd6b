//! Chance that can be had again: each node of a derivation has a stream of its
//! own, from the seed and its place in the tree alone.

use rand_pcg::rand_core::Rng;
use rand_pcg::Pcg32;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Stream {
    seed: u64,
    children: u64,
    pcg: Pcg32,
}

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            seed,
            children: 0,
            pcg: Pcg32::new(seed, 0xda3e_39cb_94b9_5bdb),
        }
    }

    /// The stream of the next child.
    pub(crate) fn child(&mut self) -> Self {
        self.children += 1;
        Self::new(mixed(self.seed ^ mixed(self.children)))
    }

    /// From 0 up to but not 1.
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.pcg.next_u32()) / (f64::from(u32::MAX) + 1.0)
    }

    pub(crate) fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of so many.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }
}

/// Steele, Lea and Flood's finaliser of `SplitMix`: neighbours become strangers.
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
