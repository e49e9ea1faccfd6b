//! Selectors by name.

use super::Selection;
use crate::shape::Region;

/// The selector of that name, if there is one.
pub(crate) fn named(region: &Region, name: &str) -> Option<Selection> {
    Some(match name {
        "ALL" | "Perimeter" => Selection::all(region),
        "OUTER" | "OUTER_EDGE" | "BOUNDARY" => {
            Selection::edges(region, |_, _, edge| edge.origin.boundary.is_some())
        }
        "INNER" => Selection::edges(region, |_, _, edge| edge.origin.boundary.is_none()),
        "EDGE" => Selection::edges(region, |_, _, edge| edge.side.is_some()),
        _ => return None,
    })
}

/// The sides of these numbers; negative ones count from the last.
pub(crate) fn sides(region: &Region, wanted: &[i64]) -> Selection {
    let count = i64::try_from(region.sides).unwrap_or(i64::MAX).max(1);
    let wanted: Vec<usize> = wanted
        .iter()
        .map(|k| usize::try_from(k.rem_euclid(count)).unwrap_or(0))
        .collect();
    Selection::edges(region, |_, _, edge| {
        edge.side.is_some_and(|side| wanted.contains(&side))
    })
}
