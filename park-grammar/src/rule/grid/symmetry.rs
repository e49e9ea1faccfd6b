//! How the cells of a grid stand to each other: their coordinates and sides.
//!
//! The notes want one rule to serve all cells that are mirror images: local
//! coordinates begin at the corner of a cell that lies nearest to a corner of the
//! region, so that `Place((0.8, 0.1))` is near the paths in all four quadrants. The
//! logical sides are mirrored with them: 0 lies towards the western or eastern
//! edge of the region, whichever is nearer, 2 towards the middle; and likewise 3
//! and 1.
//!
//! Cells of a middle column (odd grids), by `middle =`:
//!
//! - `centre` (the default): all x coordinates come to the middle of the cell. Its
//!   western and eastern edges are both side 2, since both lie towards the inside.
//! - `right`: coordinates go on from the left neighbour, from 1 to 2; `left`: from
//!   the right neighbour. What a rule puts at 0.8 is not drawn here.
//! - `local`: from 0 to 1 again, left to right. This is not symmetric.
//!
//! Inner columns (grids of four or more), by `symmetry =`:
//!
//! - `mirror` (the default): all columns up to the middle are as the first one, the
//!   others mirrored against the centre.
//! - `pair`: columns are mirrored in pairs, from both ends.
//! - `extended`: coordinates count on from the region's edge: column k has those
//!   from k to k + 1, up to the middle. What a rule puts at 0.8 is not drawn in
//!   inner columns, and what it puts at 1.8 is drawn in the second alone.
//!
//! The same for rows. A dimension of one cell is not divided, and so has nothing to
//! mirror: it keeps the coordinates of the region.

use crate::derive::Scope;
use crate::error::Failure;
use crate::rule::Arguments;
use crate::shape::{Cell, Local, Reach, Region};

/// What the words of `middle =` mean.
const MIDDLES: [(&str, Middle); 4] = [
    ("centre", Middle::Centre),
    ("left", Middle::Left),
    ("right", Middle::Right),
    ("local", Middle::Local),
];

/// What the words of `symmetry =` mean.
const INNER: [(&str, Inner); 3] = [
    ("mirror", Inner::Mirror),
    ("pair", Inner::Pair),
    ("extended", Inner::Extended),
];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Middle {
    #[default]
    Centre,
    Left,
    Right,
    Local,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Inner {
    #[default]
    Mirror,
    Pair,
    Extended,
}

/// What the arguments `middle` and `symmetry` say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Symmetry {
    middle: Middle,
    inner: Inner,
}

impl Symmetry {
    pub(super) fn read(
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
    ) -> Result<Self, Failure> {
        let middle = arguments.mode(scope, "middle", &MIDDLES)?;
        let inner = arguments.mode(scope, "symmetry", &INNER)?;
        Ok(Self {
            middle: middle.unwrap_or_default(),
            inner: inner.unwrap_or_default(),
        })
    }

    /// Whether a cell is seen from the other end along one axis, and which
    /// coordinates it has there.
    fn axis(self, at: usize, of: usize) -> (bool, Reach) {
        if of == 1 {
            return (false, Reach::WHOLE);
        }
        let metric = at.min(of - 1 - at);
        if 2 * at + 1 == of {
            let start = match self.inner {
                Inner::Extended => metric as f64,
                _ => 1.0,
            };
            return match self.middle {
                Middle::Centre => (false, Reach::Centre),
                Middle::Right => (false, Reach::From(start)),
                Middle::Left => (true, Reach::From(start)),
                Middle::Local => (false, Reach::WHOLE),
            };
        }
        let far = 2 * at + 1 > of;
        match self.inner {
            Inner::Mirror => (far, Reach::WHOLE),
            Inner::Pair => (far != (metric % 2 == 1), Reach::WHOLE),
            Inner::Extended => (far, Reach::From(metric as f64)),
        }
    }

    /// The local coordinates of a cell, from those that it has as a part of the
    /// grid.
    pub(super) fn local(self, plain: Local, cell: Cell) -> Local {
        let (flip_x, x) = self.axis(cell.at[0], cell.of[0]);
        let (flip_y, y) = self.axis(cell.at[1], cell.of[1]);
        let mut local = plain.flipped(flip_x, flip_y);
        local.reach = [x, y];
        local
    }
}

/// Numbers the sides of a cell by its coordinates. A side that a centred cell has
/// twice has one number.
pub(super) fn number_sides(region: &mut Region) {
    crate::index::by_local(region);
    let [x, y] = region.local.reach.map(|reach| reach == Reach::Centre);
    for edge in &mut region.edges[0] {
        edge.side = edge.side.map(|side| match side {
            0 if x => 2,
            3 if y => 1,
            other => other,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(middle: Middle, inner: Inner, of: usize) -> Vec<(bool, Reach)> {
        let symmetry = Symmetry { middle, inner };
        (0..of).map(|at| symmetry.axis(at, of)).collect()
    }

    /// The notes' pictures of 3 and 4 columns.
    #[test]
    fn columns_of_the_notes() {
        let zero = Reach::From(0.0);
        let one = Reach::From(1.0);
        let found = axes(Middle::Right, Inner::Mirror, 3);
        assert_eq!(found, [(false, zero), (false, one), (true, zero)]);
        let found = axes(Middle::Left, Inner::Mirror, 3);
        assert_eq!(found, [(false, zero), (true, one), (true, zero)]);
        let found = axes(Middle::Local, Inner::Mirror, 3);
        assert_eq!(found[1], found[0]);
        let flips =
            |inner| -> Vec<bool> { axes(Middle::Centre, inner, 4).iter().map(|a| a.0).collect() };
        assert_eq!(flips(Inner::Pair), [false, true, false, true]);
        assert_eq!(flips(Inner::Mirror), [false, false, true, true]);
        let found = axes(Middle::Centre, Inner::Extended, 4);
        assert_eq!(
            found,
            [(false, zero), (false, one), (true, one), (true, zero)]
        );
    }

    /// Whatever the treatment but the local one, the far half mirrors the near.
    #[test]
    fn halves_are_mirrored() {
        for inner in [Inner::Mirror, Inner::Pair, Inner::Extended] {
            for of in 2..9 {
                let found = axes(Middle::Centre, inner, of);
                for at in 0..of / 2 {
                    let (near, far) = (found[at], found[of - 1 - at]);
                    assert_eq!((near.0, near.1), (!far.0, far.1), "{inner:?} {at} of {of}");
                }
            }
        }
    }
}
