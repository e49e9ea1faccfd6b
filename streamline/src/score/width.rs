//! opt(y): how well a distance is a sum of template depths.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Greatest number of sums and of cells; coarser inputs stay far below.
const LIMIT: usize = 1_000_000;

/// How far a distance is from the nearest sum of given widths, each used any
/// number of times, at least one in all: opt(y) of the paper.
///
/// A width is what one row of template takes, its street included: 15 m of
/// street and two parcels of 30 m make 75 m, one parcel 45 m. No width at all
/// (distance 0) is no sum: a street cannot lie on the boundary.
///
/// Sums are found once, by exhaustive search up to a threshold; a lookup then
/// takes constant time.
///
/// # Examples
///
/// ```
/// use streamline::WidthTable;
///
/// let table = WidthTable::new(&[45.0, 75.0], 400.0, 0.1);
/// assert_eq!(table.cost(75.0), 0.0);
/// assert_eq!(table.cost(120.0), 0.0); // 45 + 75
/// assert_eq!(table.cost(60.0), 15.0);
/// assert_eq!(table.cost(10.0), 35.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WidthTable {
    widths: Vec<f64>,
    max: f64,
    cell: f64,
    /// Ascending, each beyond `max` by less than the smallest width.
    sums: Vec<f64>,
    /// For each cell the first sum not below its lower end.
    first: Vec<u32>,
}

impl WidthTable {
    /// Tabulates all sums of `widths` up to `max` metres, merging sums nearer
    /// than `resolution` metres would tell apart (costs are off by at most
    /// half of it).
    ///
    /// Widths that are not positive and finite are left out; without any, all
    /// costs are 0. A `max` below the largest width is raised to it, a
    /// `resolution` that is not positive, or too fine for a table of some
    /// millions, is coarsened.
    #[must_use]
    pub fn new(widths: &[f64], max: f64, resolution: f64) -> Self {
        let mut widths: Vec<f64> = widths
            .iter()
            .copied()
            .filter(|w| *w > 0.0 && w.is_finite())
            .collect();
        widths.sort_by(f64::total_cmp);
        widths.dedup();
        let (Some(&least), Some(&greatest)) = (widths.first(), widths.last()) else {
            return Self {
                widths,
                max: 0.0,
                cell: 1.0,
                sums: Vec::new(),
                first: Vec::new(),
            };
        };
        let max = if max.is_finite() {
            max.max(greatest)
        } else {
            100.0 * greatest
        };
        let reach = max + least;
        // A merged sum is at most `merge` off its neighbour, and passes that on
        // to the sums built on it: at most reach / least times in a row.
        let finest = (2.0 * reach * reach / (least * LIMIT as f64)).max(reach / LIMIT as f64);
        let resolution = if resolution.is_finite() {
            resolution.max(finest)
        } else {
            finest
        };
        let merge = 0.5 * resolution * least / reach;
        let mut sums: Vec<f64> = Vec::new();
        let mut heap: BinaryHeap<Reverse<Ordered>> =
            widths.iter().map(|&w| Reverse(Ordered(w))).collect();
        while let Some(Reverse(Ordered(sum))) = heap.pop() {
            if sum > reach || sums.last().is_some_and(|last| sum - last <= merge) {
                continue;
            }
            sums.push(sum);
            heap.extend(widths.iter().map(|w| Reverse(Ordered(sum + w))));
        }
        // At least one cell a sum, so that a lookup scans one or two sums.
        let cells = (reach / resolution).ceil().max(sums.len() as f64);
        let cell = reach / cells;
        let mut first = Vec::with_capacity(cells as usize + 1);
        let mut next = 0;
        for i in 0..=cells as usize {
            while next < sums.len() && sums[next] < i as f64 * cell {
                next += 1;
            }
            first.push(next as u32);
        }
        Self {
            widths,
            max,
            cell,
            sums,
            first,
        }
    }

    /// The widths in use, ascending.
    #[must_use]
    pub fn widths(&self) -> &[f64] {
        &self.widths
    }

    /// Distance in metres from `y` to the nearest sum. Negative distances are
    /// that much farther from the smallest; NaN stays NaN.
    ///
    /// Beyond the threshold `y` is lowered by multiples of the smallest width,
    /// which adds an upper bound that soon is exact: every sum stays one when
    /// the smallest width is added.
    #[must_use]
    pub fn cost(&self, y: f64) -> f64 {
        let (Some(&least), Some(&smallest)) = (self.widths.first(), self.sums.first()) else {
            return 0.0;
        };
        if y <= smallest || y.is_nan() {
            return smallest - y;
        }
        if y.is_infinite() {
            return 0.0;
        }
        let y = if y > self.max {
            y - ((y - self.max) / least).ceil() * least
        } else {
            y
        };
        let cell = ((y / self.cell).max(0.0) as usize).min(self.first.len() - 1);
        let mut i = self.first[cell] as usize;
        // Rounding may place `y` a cell too high.
        while i > 0 && self.sums[i - 1] >= y {
            i -= 1;
        }
        while i < self.sums.len() && self.sums[i] < y {
            i += 1;
        }
        let above = self.sums.get(i).map_or(f64::INFINITY, |sum| sum - y);
        let below = i.checked_sub(1).map_or(f64::INFINITY, |i| y - self.sums[i]);
        above.min(below)
    }
}

/// A finite number in the order of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All sums of 45 and 75 by two loops.
    fn plain(y: f64) -> f64 {
        let sums = (0..40)
            .flat_map(|i| (0..40).map(move |j| 45.0 * i as f64 + 75.0 * j as f64))
            .filter(|s| *s > 0.0);
        sums.map(|s| (s - y).abs()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn agrees_with_two_loops_within_and_beyond_the_table() {
        let table = WidthTable::new(&[75.0, 45.0, 45.0], 500.0, 0.25);
        assert_eq!(table.widths(), [45.0, 75.0]);
        for i in 0..4000 {
            let y = i as f64 * 0.31 - 20.0;
            assert!(
                (table.cost(y) - plain(y)).abs() <= 0.125,
                "{y}: {} {}",
                table.cost(y),
                plain(y)
            );
        }
    }

    #[test]
    fn odd_input_has_an_answer() {
        assert_eq!(WidthTable::new(&[], 100.0, 0.1).cost(3.0), 0.0);
        assert_eq!(
            WidthTable::new(&[f64::NAN, -1.0, 0.0], 100.0, 0.1).cost(3.0),
            0.0
        );
        let table = WidthTable::new(&[30.0], f64::NAN, f64::NAN);
        assert!((table.cost(44.0) - 14.0).abs() < 1e-6 && table.cost(f64::NAN).is_nan());
        assert_eq!(table.cost(f64::INFINITY), 0.0);
        assert!(table.cost(f64::NEG_INFINITY).is_infinite());
        // A table that would be huge is coarsened.
        let fine = WidthTable::new(&[0.01, 0.013], 1000.0, 1e-9);
        assert!(fine.sums.len() <= 2 * LIMIT && fine.cost(500.0) < 0.02);
    }
}
