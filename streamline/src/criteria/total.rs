//! From segments to lines to one figure, and from tiles to one.

/// A criterion over all streamlines. Which of its figures to compare depends on
/// the question: a larger site has a larger sum, and one bad line among a
/// hundred hardly shows in the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Total {
    /// The criterion integrated along all lines: its unit times metres. Of
    /// continuity it is the number of turns.
    pub sum: f64,
    /// The mean by length: `sum` over the length that has a value. 0 if none
    /// has.
    pub mean: f64,
    /// The mean of the lines' own figures, short lines counting as much as
    /// long ones. 0 if none has one.
    pub line_mean: f64,
    /// The largest of the lines' own figures. 0 if none has one.
    pub worst: f64,
    /// The share of the lines' length that has a value, from 0 to 1. Where it
    /// is 0, all else says nothing.
    pub measured: f64,
}

/// What one line adds to a [`Total`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    /// Values times lengths, and the lengths that have one.
    pub(super) sum: f64,
    pub(super) measured: f64,
    /// Length of the line.
    pub(super) length: f64,
}

impl Share {
    /// Adds up pieces of a line: a value, and the length that it holds for.
    pub(super) fn new(pieces: impl Iterator<Item = (Option<f64>, f64)>) -> Self {
        let mut share = Self::default();
        for (value, length) in pieces {
            share.length += length;
            if let Some(value) = value {
                share.sum += value * length;
                share.measured += length;
            }
        }
        share
    }

    /// The mean along the line.
    pub(super) fn mean(&self) -> Option<f64> {
        (self.measured > 0.0).then(|| self.sum / self.measured)
    }
}

impl Total {
    pub(super) fn new(shares: impl Iterator<Item = Share>) -> Self {
        let mut all = Share::default();
        let mut total = Self::default();
        let mut lines = 0.0;
        for share in shares {
            all.sum += share.sum;
            all.measured += share.measured;
            all.length += share.length;
            if let Some(mean) = share.mean() {
                total.line_mean += mean;
                total.worst = total.worst.max(mean);
                lines += 1.0;
            }
        }
        if lines > 0.0 {
            total.sum = all.sum;
            total.mean = all.sum / all.measured;
            total.line_mean /= lines;
            total.measured = (all.measured / all.length).min(1.0);
        }
        total
    }
}

/// How a figure is distributed over tiles, each counting once except in
/// `area_mean`. All 0 without tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spread {
    /// How many tiles count.
    pub count: usize,
    /// The sum over the tiles.
    pub sum: f64,
    /// The mean over the tiles.
    pub mean: f64,
    /// The mean by area.
    pub area_mean: f64,
    /// Standard deviation, of all tiles rather than of a sample.
    pub deviation: f64,
    /// What a tenth, a quarter, half, three quarters and nine tenths of the
    /// tiles stay at or below, interpolated between tiles.
    pub quantiles: [f64; 5],
    /// The largest.
    pub worst: f64,
}

impl Spread {
    /// Of values with the areas of their tiles.
    pub(super) fn new(tiles: &[(f64, f64)]) -> Self {
        let mut values: Vec<f64> = tiles.iter().map(|tile| tile.0).collect();
        values.sort_by(f64::total_cmp);
        let Some(&worst) = values.last() else {
            return Self::default();
        };
        let n = values.len() as f64;
        let sum: f64 = values.iter().sum();
        let mean = sum / n;
        let area: f64 = tiles.iter().map(|tile| tile.1).sum();
        let by_area: f64 = tiles.iter().map(|tile| tile.0 * tile.1).sum();
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let quantile = |q: f64| {
            let place = q * (n - 1.0);
            let (low, part) = (place as usize, place.fract());
            let high = (low + 1).min(values.len() - 1);
            values[low] + (values[high] - values[low]) * part
        };
        Self {
            count: values.len(),
            sum,
            mean,
            area_mean: if area > 0.0 { by_area / area } else { mean },
            deviation: (squares / n).sqrt(),
            quantiles: [0.1, 0.25, 0.5, 0.75, 0.9].map(quantile),
            worst,
        }
    }

    /// From the first quartile to the third: half of the tiles lie between.
    #[must_use]
    pub fn interquartile(&self) -> f64 {
        self.quantiles[3] - self.quantiles[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_weigh_in_the_mean_and_lines_in_the_mean_of_lines() {
        let long = Share::new([(Some(0.2), 30.0), (None, 50.0), (Some(0.6), 10.0)].into_iter());
        let short = Share::new([(Some(0.9), 10.0)].into_iter());
        let silent = Share::new([(None, 100.0)].into_iter());
        assert_eq!((long.mean(), silent.mean()), (Some(0.3), None));
        let total = Total::new([long, short, silent, Share::default()].into_iter());
        assert!((total.sum - 21.0).abs() < 1e-12);
        assert!((total.mean - 21.0 / 50.0).abs() < 1e-12);
        assert!((total.line_mean - 0.6).abs() < 1e-12);
        assert!((total.worst - 0.9).abs() < 1e-12);
        assert!((total.measured - 0.25).abs() < 1e-12);
        assert_eq!(Total::new([silent].into_iter()), Total::default());
    }

    #[test]
    fn spread_of_five_tiles() {
        let tiles = [(0.4, 1.0), (0.0, 5.0), (0.2, 1.0), (0.1, 2.0), (0.3, 1.0)];
        let spread = Spread::new(&tiles);
        assert_eq!((spread.count, spread.worst), (5, 0.4));
        assert!((spread.mean - 0.2).abs() < 1e-15 && (spread.sum - 1.0).abs() < 1e-15);
        assert!((spread.area_mean - 0.11).abs() < 1e-15);
        assert!((spread.deviation - 0.02_f64.sqrt()).abs() < 1e-15);
        for (found, wanted) in spread
            .quantiles
            .into_iter()
            .zip([0.04, 0.1, 0.2, 0.3, 0.36])
        {
            assert!((found - wanted).abs() < 1e-15);
        }
        assert!((spread.interquartile() - 0.2).abs() < 1e-15);
        assert_eq!(Spread::new(&[]), Spread::default());
        assert_eq!(Spread::new(&[(0.7, 0.0)]).area_mean, 0.7);
    }
}
