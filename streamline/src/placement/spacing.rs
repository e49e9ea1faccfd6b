//! The separation at a point: that of the family times the scale there.

use crate::candidates::Seed;
use crate::error::TraceError;
use crate::vector::Point;

/// Separation by place and family.
pub(super) struct Spacing<'a> {
    separation: [f64; 2],
    scale: &'a (dyn Fn(Point) -> f64 + Sync),
    /// Least and greatest scale at the seeds: holds everywhere, so that a wild
    /// function can neither stall the placement nor empty it.
    low: f64,
    high: f64,
    /// Mean over the seeds.
    mean: f64,
}

impl<'a> Spacing<'a> {
    pub(super) fn new(
        separation: [f64; 2],
        scale: &'a (dyn Fn(Point) -> f64 + Sync),
        seeds: &[Seed],
    ) -> Result<Self, TraceError> {
        let (mut low, mut high, mut sum) = (f64::INFINITY, 0.0_f64, 0.0);
        for (index, seed) in seeds.iter().enumerate() {
            let value = scale(seed.at);
            if !(value > 0.0 && value.is_finite()) {
                return Err(TraceError::BadScale {
                    index,
                    x: seed.at.x,
                    y: seed.at.y,
                    value,
                });
            }
            (low, high, sum) = (low.min(value), high.max(value), sum + value);
        }
        if seeds.is_empty() {
            (low, high, sum) = (1.0, 1.0, 1.0);
        }
        Ok(Self {
            separation,
            scale,
            low,
            high,
            mean: sum / seeds.len().max(1) as f64,
        })
    }

    /// Separation of lines of `family` at `p`, in metres.
    pub(super) fn at(&self, p: Point, family: u8) -> f64 {
        let separation = self.separation[usize::from(family)];
        if self.low == self.high {
            return separation * self.low;
        }
        // The maximum of a number and NaN is the number.
        separation * (self.scale)(p).max(self.low).min(self.high)
    }

    /// The smaller separation, as it is on average.
    pub(super) fn typical(&self) -> f64 {
        self.separation[0].min(self.separation[1]) * self.mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    fn seed(x: f64) -> Seed {
        Seed {
            at: point(x, 0.0),
            directions: [point(1.0, 0.0), point(0.0, 1.0)],
        }
    }

    #[test]
    fn scale_is_checked_at_seeds_and_held_between_them() {
        let scale = |p: Point| if p.x > 5.0 { f64::NAN } else { 1.0 + p.x };
        let spacing = Spacing::new([10.0, 20.0], &scale, &[seed(0.0), seed(1.0)]).unwrap();
        assert_eq!(spacing.at(point(0.5, 0.0), 1), 30.0);
        assert_eq!(spacing.at(point(4.0, 0.0), 0), 20.0);
        assert_eq!(spacing.at(point(-4.0, 0.0), 0), 10.0);
        assert_eq!(spacing.at(point(9.0, 0.0), 0), 10.0);
        assert_eq!(spacing.typical(), 15.0);
        match Spacing::new([10.0, 20.0], &scale, &[seed(0.0), seed(-1.0)]) {
            Err(TraceError::BadScale {
                index: 1, value, ..
            }) => assert_eq!(value, 0.0),
            other => panic!("{:?}", other.err()),
        }
    }
}
