//! Random streams by node: each region's is a function of the user's seed and
//! of its path in the split tree alone, so that a region can be re-rolled
//! while every other keeps its own.

use std::fmt;

/// Place of a region in the split tree: the root's path is `0`, its children
/// `0.0`, `0.1` and so on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Path(Vec<u16>);

impl Path {
    /// The path above all roots: everything lies within it.
    #[must_use]
    pub const fn everything() -> Self {
        Self(Vec::new())
    }

    /// The path of the `index`-th root region.
    #[must_use]
    pub fn root(index: usize) -> Self {
        Self(vec![u16::try_from(index).unwrap_or(u16::MAX)])
    }

    /// The path of this region's `index`-th child.
    #[must_use]
    pub fn child(&self, index: usize) -> Self {
        let mut steps = self.0.clone();
        steps.push(u16::try_from(index).unwrap_or(u16::MAX));
        Self(steps)
    }

    /// Steps from the root, one number a level.
    #[must_use]
    pub fn steps(&self) -> &[u16] {
        &self.0
    }

    /// How many splits lie above.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Whether `self` is `other` or lies below it.
    #[must_use]
    pub fn is_within(&self, other: &Self) -> bool {
        self.0.starts_with(&other.0)
    }

    /// The region around this one; `None` for a root.
    #[must_use]
    pub fn parent(&self) -> Option<Self> {
        let (_, above) = self.0.split_last()?;
        (!above.is_empty()).then(|| Self(above.to_vec()))
    }

    /// The smallest region that holds both; [`Path::everything`] if none does.
    #[must_use]
    pub fn common(&self, other: &Self) -> Self {
        let same = self.0.iter().zip(&other.0).take_while(|(a, b)| a == b);
        Self(self.0[..same.count()].to_vec())
    }

    /// Reads `0.1.1.0`; `None` if a step is no number.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let steps: Option<Vec<u16>> = text.split('.').map(|s| s.parse().ok()).collect();
        steps.filter(|s| !s.is_empty()).map(Self)
    }

    /// A number for this path under `seed`: the start of the region's random
    /// stream, and with a fixed seed its stable id. SplitMix64 over the steps.
    #[must_use]
    pub fn hash(&self, seed: u64) -> u64 {
        self.0
            .iter()
            .fold(mix(seed ^ 0x9e37_79b9_7f4a_7c15), |h, &step| {
                mix(h ^ (u64::from(step) + 1))
            })
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str(".")?;
            }
            write!(f, "{step}")?;
        }
        Ok(())
    }
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014), named here so
/// that the numbers stay the same whatever a library does.
#[must_use]
pub fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splitmix_is_the_published_one() {
        // First output of SplitMix64 started at 0, from its reference code.
        assert_eq!(mix(0), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn paths_round_trip_and_differ() {
        let path = Path::root(0).child(1).child(1).child(0);
        assert_eq!(path.to_string(), "0.1.1.0");
        assert_eq!(Path::parse("0.1.1.0"), Some(path.clone()));
        assert!(path.is_within(&Path::root(0).child(1)));
        assert!(!path.is_within(&Path::root(0).child(0)));
        assert_eq!(
            path.parent().map(|p| p.to_string()).as_deref(),
            Some("0.1.1")
        );
        assert_eq!(Path::root(3).parent(), None);
        let cousin = Path::root(0).child(1).child(0);
        assert_eq!(path.common(&cousin).to_string(), "0.1");
        assert_eq!(path.common(&Path::root(1)), Path::everything());
        assert_ne!(path.hash(1), path.hash(2));
        assert_ne!(
            path.hash(1),
            Path::root(0).child(1).child(0).child(1).hash(1)
        );
    }
}
