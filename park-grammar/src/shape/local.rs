//! Coordinates that a region has to itself, so that one rule serves all regions
//! that are mirror images.

use geo_types::Coord;

use crate::plane::{cross, quad_point, unit, Ring};

/// Local coordinates of a region: (0, 0) at the corner of it that lies nearest
/// to a corner of the region it was cut from, (1, 1) at the opposite one.
///
/// A map of the unit square onto four points of the plane, bilinear; for a
/// rectangle an affine one. In some cells of a grid coordinates begin elsewhere
/// than at 0, or all come to the middle: see [`Reach`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Local {
    /// Where (0, 0), (0, 1), (1, 1) and (1, 0) lie, apart from the reach.
    pub(crate) corners: [Coord<f64>; 4],
    /// Which coordinates lie here, along x and along y.
    pub(crate) reach: [Reach; 2],
}

/// Which coordinates a region has along one of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reach {
    /// So much to 1 more. 0 everywhere but in the inner cells of a grid with
    /// extended addressing, which go on where their neighbour ends.
    From(f64),
    /// All of them, and all in the middle: a cell on the middle axis of a grid.
    Centre,
}

impl Reach {
    /// From 0 to 1.
    pub(crate) const WHOLE: Self = Self::From(0.0);

    /// Where a coordinate lies, from 0 to 1; `None` if it does not lie here.
    fn place(self, x: f64) -> Option<f64> {
        // What was meant to lie on an edge lies there.
        const EDGE: f64 = 1e-9;
        match self {
            Self::Centre => Some(0.5),
            Self::From(start) => {
                let x = x - start;
                (-EDGE..=1.0 + EDGE).contains(&x).then(|| x.clamp(0.0, 1.0))
            }
        }
    }
}

/// A region as a cell of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cell {
    /// Column and row, from 0 in the south-west.
    pub at: [usize; 2],
    /// Columns and rows of the grid.
    pub of: [usize; 2],
}

impl Cell {
    /// The notes' boundary metric: how many cells lie between this one and the
    /// nearer boundary of the grid, along x and along y. Cells of one metric are
    /// mirror images of each other.
    #[must_use]
    pub fn metric(self) -> [usize; 2] {
        [0, 1].map(|k| self.at[k].min(self.of[k] - 1 - self.at[k]))
    }

    /// Whether this cell lies on the middle axis of an odd grid, along x and
    /// along y.
    #[must_use]
    pub fn middle(self) -> [bool; 2] {
        [0, 1].map(|k| 2 * self.at[k] + 1 == self.of[k])
    }
}

impl Local {
    /// Coordinates from 0 to 1 between where (0, 0), (0, 1), (1, 1) and (1, 0)
    /// lie.
    pub(crate) fn new(corners: [Coord<f64>; 4]) -> Self {
        Self {
            corners,
            reach: [Reach::WHOLE; 2],
        }
    }

    /// The coordinates of a region on its own: those of its box, from the
    /// south-west on.
    pub(crate) fn upright(ring: &Ring) -> Self {
        let (low, high) = crate::plane::extent(ring);
        Self::new([
            low,
            Coord {
                x: low.x,
                y: high.y,
            },
            high,
            Coord {
                x: high.x,
                y: low.y,
            },
        ])
    }

    /// The point of the plane at local coordinates; `None` where the region has
    /// no such coordinates: beyond it, or in a cell with extended addressing,
    /// where the notes have nothing drawn.
    #[must_use]
    pub fn point(&self, at: Coord<f64>) -> Option<Coord<f64>> {
        let [x, y] = self.reach;
        let at = Coord {
            x: x.place(at.x)?,
            y: y.place(at.y)?,
        };
        Some(quad_point(&self.corners, at))
    }

    /// Directions of the local axes along the middle of the region.
    pub(crate) fn axes(&self) -> [Coord<f64>; 2] {
        let [a, b, c, d] = self.corners;
        [unit((d - a) + (c - b)), unit((b - a) + (c - d))]
    }

    /// Whether sides are counted counter-clockwise here.
    #[must_use]
    pub fn mirrored(&self) -> bool {
        let [a, b, c, _] = self.corners;
        // Upright (0, 0), (0, 1), (1, 1) turns to the right.
        cross(b - a, c - b) > 0.0
    }

    /// The same square seen with x or y from the other end.
    #[must_use]
    pub(crate) fn flipped(self, x: bool, y: bool) -> Self {
        let [a, b, c, d] = self.corners;
        let [a, b, c, d] = if x { [d, c, b, a] } else { [a, b, c, d] };
        Self {
            corners: if y { [b, a, d, c] } else { [a, b, c, d] },
            reach: self.reach,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// The notes' numbers in a grid of 5 x 5: nine metrics, the middle (2, 2).
    #[test]
    fn metrics_of_a_grid() {
        let cell = |x, y| Cell {
            at: [x, y],
            of: [5, 5],
        };
        assert_eq!(cell(0, 0).metric(), [0, 0]);
        assert_eq!(cell(4, 1).metric(), [0, 1]);
        assert_eq!(cell(2, 2).metric(), [2, 2]);
        assert_eq!(cell(2, 4).middle(), [true, false]);
        let mut all: Vec<_> = (0..25).map(|k| cell(k % 5, k / 5).metric()).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 9);
    }

    #[test]
    fn local_coordinates_are_mirrored() {
        let ring = vec![
            coord! { x: 0., y: 0. },
            coord! { x: 0., y: 2. },
            coord! { x: 4., y: 2. },
            coord! { x: 4., y: 0. },
        ];
        let plain = Local::upright(&ring);
        let at = coord! { x: 0.25, y: 0.25 };
        assert_eq!(plain.point(at), Some(coord! { x: 1.0, y: 0.5 }));
        assert!(!plain.mirrored());
        let flipped = plain.flipped(true, false);
        assert_eq!(flipped.point(at), Some(coord! { x: 3.0, y: 0.5 }));
        assert!(flipped.mirrored() && !flipped.flipped(false, true).mirrored());
    }

    #[test]
    fn extended_coordinates_go_on() {
        let ring = vec![
            coord! { x: 0., y: 0. },
            coord! { x: 0., y: 2. },
            coord! { x: 4., y: 2. },
            coord! { x: 4., y: 0. },
        ];
        let mut local = Local::upright(&ring);
        local.reach = [Reach::From(1.0), Reach::Centre];
        assert_eq!(local.point(coord! { x: 0.8, y: 0.1 }), None);
        let found = local.point(coord! { x: 1.25, y: 0.1 });
        assert_eq!(found, Some(coord! { x: 1.0, y: 1.0 }));
    }
}
