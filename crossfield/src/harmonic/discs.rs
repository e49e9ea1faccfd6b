//! Discs that the energy leaves out.

use crate::plane::V2;

/// Discs, to be asked whether one of them contains a point.
///
/// They are few, and no larger than a piece of the domain: sorted by x, the
/// ones that may contain a point are a short run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Discs {
    /// Centre and radius.
    sorted: Vec<(V2, f64)>,
    largest: f64,
}

impl Discs {
    pub(crate) fn new(mut discs: Vec<(V2, f64)>) -> Self {
        discs.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        let largest = discs.iter().fold(0.0, |m: f64, disc| m.max(disc.1));
        Self {
            sorted: discs,
            largest,
        }
    }

    /// These discs, and others of one radius.
    pub(crate) fn with(&self, centres: Vec<V2>, radius: f64) -> Self {
        let more = centres.into_iter().map(|centre| (centre, radius));
        Self::new(self.sorted.iter().copied().chain(more).collect())
    }

    /// Whether a disc contains `p`.
    pub(crate) fn contain(&self, p: V2) -> bool {
        let first = self
            .sorted
            .partition_point(|disc| disc.0.x < p.x - self.largest);
        self.sorted[first..]
            .iter()
            .take_while(|disc| disc.0.x <= p.x + self.largest)
            .any(|(centre, radius)| (centre - p).norm_squared() < radius * radius)
    }

    #[cfg(test)]
    pub(crate) fn all(&self) -> &[(V2, f64)] {
        &self.sorted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_contain_what_lies_within_their_radius() {
        let discs = Discs::new(vec![(V2::new(5.0, 0.0), 2.0), (V2::new(0.0, 0.0), 0.5)])
            .with(vec![V2::new(5.0, 9.0)], 1.0);
        for (x, y, inside) in [
            (0.4, 0.0, true),
            (0.6, 0.0, false),
            (3.1, 0.0, true),
            (6.9, 0.1, true),
            (7.1, 0.0, false),
            (5.0, 8.1, true),
            (5.0, 7.0, false),
        ] {
            assert_eq!(discs.contain(V2::new(x, y)), inside, "{x} {y}");
        }
        assert!(!Discs::default().contain(V2::zeros()));
    }
}
