//! Heights on a regular grid.

use geo_types::Coord;

use crate::FieldError;

/// Heights at the nodes of a regular grid, bilinear in between: a digital
/// terrain model.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Raster {
    origin: Coord<f64>,
    cell: f64,
    columns: usize,
    heights: Vec<f64>,
}

impl Raster {
    /// A raster whose first height is at `origin`, the following ones every
    /// `cell` metres to the east; each row of `columns` heights is followed by
    /// the next one to the north. Missing heights are NaN.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the cell size is not positive and finite,
    /// the origin not finite, there are fewer than two columns or rows, or the
    /// last row is not full.
    pub fn new(
        origin: Coord<f64>,
        cell: f64,
        columns: usize,
        heights: Vec<f64>,
    ) -> Result<Self, FieldError> {
        if !(cell > 0.0 && cell.is_finite() && origin.x.is_finite() && origin.y.is_finite()) {
            return Err(FieldError::option(
                "cell",
                format!(
                    "of a raster is {cell}, its origin ({}, {}); give a positive size and a \
                     finite place",
                    origin.x, origin.y
                ),
            ));
        }
        if columns < 2 || heights.len() < 2 * columns || !heights.len().is_multiple_of(columns) {
            return Err(FieldError::option(
                "heights",
                format!(
                    "of a raster has {} numbers for {columns} columns; give two full rows or \
                     more, of two or more columns",
                    heights.len()
                ),
            ));
        }
        Ok(Self {
            origin,
            cell,
            columns,
            heights,
        })
    }

    /// The height at `at`; `None` outside the grid, and next to a missing
    /// height.
    #[must_use]
    pub fn height(&self, at: Coord<f64>) -> Option<f64> {
        let rows = self.heights.len() / self.columns;
        // Node numbers, with rounding at the last node forgiven.
        let place = |value: f64, start: f64, count: usize| {
            let t = (value - start) / self.cell;
            let last = (count - 1) as f64;
            let slack = 1e-9 * (1.0 + last);
            if !(t >= -slack && t <= last + slack) {
                return None;
            }
            let t = t.clamp(0.0, last);
            let node = (t as usize).min(count - 2);
            Some((node, t - node as f64))
        };
        let (column, x) = place(at.x, self.origin.x, self.columns)?;
        let (row, y) = place(at.y, self.origin.y, rows)?;
        let first = row * self.columns + column;
        let south = self.heights[first] * (1.0 - x) + self.heights[first + 1] * x;
        let above = first + self.columns;
        let north = self.heights[above] * (1.0 - x) + self.heights[above + 1] * x;
        let height = south * (1.0 - y) + north * y;
        height.is_finite().then_some(height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn bilinear_functions_are_met_exactly() {
        let z = |x: f64, y: f64| 3.0 + 0.5 * x - 2.0 * y + 0.25 * x * y;
        let heights = (0..5)
            .flat_map(|j| (0..4).map(move |i| (i, j)))
            .map(|(i, j)| z(100.0 + 2.0 * f64::from(i), 2.0 * f64::from(j)))
            .collect();
        let raster = Raster::new(coord! {x: 100.0, y: 0.0}, 2.0, 4, heights).expect("full");
        for (x, y) in [(100.0, 0.0), (106.0, 8.0), (103.3, 1.9), (106.0, 0.1)] {
            let found = raster.height(coord! {x: x, y: y}).expect("inside");
            assert!((found - z(x, y)).abs() < 1e-9);
        }
        for (x, y) in [(99.9, 1.0), (106.1, 1.0), (101.0, 8.2), (f64::NAN, 1.0)] {
            assert_eq!(raster.height(coord! {x: x, y: y}), None);
        }
    }

    #[test]
    fn ragged_rasters_are_refused_and_gaps_stay_gaps() {
        let at = coord! {x: 0.0, y: 0.0};
        for (cell, columns, count) in [(0.0, 2, 4), (1.0, 1, 4), (1.0, 3, 5), (1.0, 3, 3)] {
            assert!(Raster::new(at, cell, columns, vec![0.0; count]).is_err());
        }
        let raster = Raster::new(at, 1.0, 2, vec![1.0, f64::NAN, 1.0, 1.0]).expect("full");
        assert_eq!(raster.height(coord! {x: 0.5, y: 0.5}), None);
    }
}
