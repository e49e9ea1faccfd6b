//! What stands on a region already.
//!
//! The law: footprints lie in their region, outside of the shapes cut out of it,
//! and share no ground with each other nor with hedges and walls. Since pieces of
//! ground do not overlap, footprints of different regions do not either, and
//! none lies on a path that was cut from the region.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::Patches;
use crate::plane::{dot, Area};

/// Shares of distances that are rounding.
const ROUNDING: f64 = 1e-9;

/// A footprint, with what it reaches to above the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    pub(crate) at: Coord<f64>,
    pub(crate) radius: f64,
    pub(crate) spread: f64,
}

impl Disc {
    /// One that reaches no farther above the ground.
    pub(crate) fn new(at: Coord<f64>, radius: f64) -> Self {
        Self {
            at,
            radius,
            spread: radius,
        }
    }
}

/// Footprints and volumes of a region.
#[derive(Clone, Debug, Default)]
pub(crate) struct Standing {
    discs: Vec<Disc>,
    /// Numbers of the discs in each square of a grid, by row and column.
    cells: BTreeMap<(i64, i64), Vec<usize>>,
    /// Side of a square; 0 before the first disc.
    cell: f64,
    widest: f64,
    pub(crate) built: Patches,
    /// The objects of the scene that stand here.
    pub(crate) objects: Vec<usize>,
}

impl Standing {
    pub(crate) fn is_empty(&self) -> bool {
        self.discs.is_empty() && self.built.is_empty()
    }

    pub(crate) fn add(&mut self, disc: Disc) {
        if self.cell == 0.0 {
            // What stands here will mostly be of one size.
            self.cell = (4.0 * disc.spread.max(disc.radius)).max(0.5);
        }
        let square = self.square(disc.at);
        self.cells.entry(square).or_default().push(self.discs.len());
        self.widest = self.widest.max(disc.spread).max(disc.radius);
        self.discs.push(disc);
    }

    /// The footprints that may meet a box.
    pub(crate) fn near(&self, low: Coord<f64>, high: Coord<f64>) -> Vec<Disc> {
        if self.discs.is_empty() {
            return Vec::new();
        }
        let by = Coord {
            x: self.widest,
            y: self.widest,
        };
        let mut found = self.within(low - by, high + by).collect::<Vec<_>>();
        found.sort_unstable();
        found.into_iter().map(|k| self.discs[k]).collect()
    }

    /// The numbers of the discs in the squares that a box meets.
    fn within(&self, low: Coord<f64>, high: Coord<f64>) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (self.square(low), self.square(high));
        (low.0..=high.0).flat_map(move |row| {
            let row = self.cells.range((row, low.1)..=(row, high.1));
            row.flat_map(|(_, here)| here.iter().copied())
        })
    }

    fn square(&self, at: Coord<f64>) -> (i64, i64) {
        let number = |x: f64| (x / self.cell).floor() as i64;
        (number(at.y), number(at.x))
    }

    /// Whether a footprint has its own ground, `reach` from all that others reach
    /// to: footprints never overlap, and `reach` beyond the own one keeps crowns
    /// apart too.
    pub(crate) fn apart(&self, at: Coord<f64>, radius: f64, reach: f64) -> bool {
        self.apart_from_discs(at, radius, reach) && self.built.clear(at, radius)
    }

    fn apart_from_discs(&self, at: Coord<f64>, radius: f64, reach: f64) -> bool {
        if self.discs.is_empty() {
            return true;
        }
        let range = reach.max(radius) + self.widest;
        let by = Coord { x: range, y: range };
        let free = |k: usize| {
            let disc = self.discs[k];
            let mut least = radius + disc.radius;
            if reach > radius {
                least = least.max(reach + disc.spread);
            }
            let away = at - disc.at;
            dot(away, away) >= (least * (1.0 - ROUNDING)).powi(2)
        };
        self.within(at - by, at + by).all(free)
    }
}

/// Whether a disc lies outside of an area.
pub(crate) fn clear(area: &Area, at: Coord<f64>, radius: f64) -> bool {
    area.keeps_away(at, radius * (1.0 - ROUNDING)) && !area.contains(at)
}

/// Whether a disc lies in an area.
pub(crate) fn inside(area: &Area, at: Coord<f64>, radius: f64) -> bool {
    area.keeps_away(at, radius * (1.0 - ROUNDING)) && area.contains(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn footprints_keep_apart() {
        let mut standing = Standing::default();
        standing.add(Disc {
            at: coord! { x: 0., y: 0. },
            radius: 1.0,
            spread: 3.0,
        });
        let apart =
            |x: f64, radius: f64, reach: f64| standing.apart(coord! { x: x, y: 0. }, radius, reach);
        assert!(apart(2.0, 1.0, 1.0) && !apart(1.9, 1.0, 1.0));
        // Crowns of 3 and 2.
        assert!(apart(5.0, 1.0, 2.0) && !apart(4.9, 1.0, 2.0));
        assert!(apart(-5.0, 1.0, 2.0) && !apart(-4.9, 1.0, 2.0));
    }
}
