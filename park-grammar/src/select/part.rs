//! `Part(OUTER, [0.2, 0.8])` and `Parametrise([0.02, 1], [0, 1], [], 0)`: ranges
//! of parameters.
//!
//! Parameters of `Part` run over the combined length of a selection, from 0 to 1
//! in the order of [`Lines`]; a number with a unit is metres or per cent. A range
//! whose end comes before its beginning runs over the end: `[0.8, 0.2]` is the
//! last fifth and the first.
//!
//! `Parametrise` has one range for each side of the region, from side 0 on; `[]`
//! is nothing of it. The bare number after the ranges, which the notes leave
//! unexplained, is the side that the first range belongs to. Sides without a
//! range have nothing, ranges beyond the last side are of no use (one rule
//! serves regions of three sides and of four). What it gives can be drawn in
//! from the boundary, by the notes' block `{ Contract(1, area) }` or by
//! `inset = 1`; the second value of `Contract` is what is parametrised, the
//! whole perimeter unless said.

use super::walk::Lines;
use super::{named, Selection};
use crate::derive::Number;
use crate::shape::Region;

/// The part of a selection between two parameters.
pub(super) fn part(
    region: &Region,
    selection: &Selection,
    range: [Number; 2],
) -> Option<Selection> {
    let lines = Lines::new(selection, region);
    let whole = lines.length();
    if whole <= 0.0 {
        return Some(Selection::default());
    }
    let [from, to] = range.map(|n| n.share(whole).map(|share| share * whole));
    let (from, to) = (from?, to?);
    Some(if from <= to {
        lines.between(from, to)
    } else {
        lines.between(from, whole).or(&lines.between(0.0, to))
    })
}

/// One range for each side of a region, from side `first` on, within `of`.
pub(crate) fn parametrise(
    region: &Region,
    of: &Selection,
    ranges: &[Option<[Number; 2]>],
    first: i64,
) -> Option<Selection> {
    let mut all = Selection::default();
    for (k, range) in ranges.iter().enumerate().take(region.sides) {
        let Some(range) = range else {
            continue;
        };
        let side = first + i64::try_from(k).unwrap_or(0);
        let whole = named::sides(region, &[side]).and(of);
        all = all.or(&part(region, &whole, *range)?);
    }
    Some(all)
}
