//! Seeds on a lattice, for fields that have no mesh of their own.

use crate::candidates::Seed;
use crate::error::TraceError;
use crate::field::{Cursor, DirectionField};
use crate::vector::{is_finite, left, point, unit};
use geo_types::Rect;

/// Most seeds of a lattice.
const MOST: f64 = 1e8;

/// Seeds at the middles of the squares, `spacing` metres wide, of a lattice
/// over `extent`, wherever the field has a direction. The first family is the
/// arm nearest to the one before it in the row (to east at first), so that the
/// two families do not change places from seed to seed where that can be had.
///
/// # Errors
///
/// [`TraceError::BadOption`] unless `spacing` is positive and gives at most
/// 10^8 places, and the extent is finite.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon, Rect};
/// use streamline::{from_fn, lattice};
///
/// let triangle = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 0., y: 100.)];
/// let field = from_fn(triangle, |_, heading| Some(heading));
/// let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 100., y: 100. });
/// assert_eq!(lattice(&field, extent, 50.0)?.len(), 3);
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn lattice<F: DirectionField + ?Sized>(
    field: &F,
    extent: Rect<f64>,
    spacing: f64,
) -> Result<Vec<Seed>, TraceError> {
    let (low, high) = (extent.min(), extent.max());
    let columns = ((high.x - low.x) / spacing - 1e-9).ceil().max(1.0);
    let rows = ((high.y - low.y) / spacing - 1e-9).ceil().max(1.0);
    if !(spacing > 0.0 && is_finite(low) && is_finite(high) && columns * rows <= MOST) {
        return Err(TraceError::BadOption {
            name: "spacing",
            value: spacing,
            expected: "positive, and at most 10^8 places in a finite extent",
        });
    }
    let mut seeds = Vec::new();
    let mut cursor = Cursor::default();
    let mut row_heading = point(1.0, 0.0);
    for j in 0..rows as usize {
        let mut heading = row_heading;
        let mut first = true;
        for i in 0..columns as usize {
            let at = low + point(i as f64 + 0.5, j as f64 + 0.5) * spacing;
            let Some(arm) = field.direction(at, heading, &mut cursor).and_then(unit) else {
                continue;
            };
            heading = arm;
            if first {
                (row_heading, first) = (arm, false);
            }
            seeds.push(Seed {
                at,
                directions: [arm, left(arm)],
            });
        }
    }
    Ok(seeds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{arm_nearest, from_fn};
    use geo_types::{coord, polygon};

    #[test]
    fn families_do_not_jump() {
        // The angle runs through 150 degrees from south to north.
        let square = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 90.), (x: 0., y: 90.)];
        let field = from_fn(square, |at, heading| {
            Some(arm_nearest(at.y / 34.0, heading))
        });
        let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 90., y: 90. });
        let seeds = lattice(&field, extent, 10.0).unwrap();
        assert_eq!(seeds.len(), 81);
        for seed in seeds {
            let angle = seed.at.y / 34.0;
            let gap = seed.directions[0] - point(angle.cos(), angle.sin());
            assert!(gap.x.abs() + gap.y.abs() < 1e-12);
        }
        for spacing in [0.0, -1.0, f64::NAN, 1e-9] {
            assert!(lattice(&field, extent, spacing).is_err());
        }
    }
}
