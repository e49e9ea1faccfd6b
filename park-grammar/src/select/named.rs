//! Selectors by name.

use super::cardinal::{Cardinal, Way};
use super::{history, Frame, Selection};
use crate::shape::{Region, Role};

/// Selectors by name, for hints.
pub(crate) const NAMES: [&str; 21] = [
    "ALL",
    "Perimeter",
    "OUTER",
    "OUTER_EDGE",
    "BOUNDARY",
    "INCIDENT",
    "INNER",
    "PATH",
    "EDGE",
    "CORNER",
    "WEST",
    "NORTH",
    "EAST",
    "SOUTH",
    "HOLES",
    "PEELED_BASE",
    "PEELED_INNER",
    "PEELED_SEGMENT",
    "PB",
    "PI",
    "PS",
];

/// The selector of that name, if there is one.
pub(crate) fn named(region: &Region, name: &str) -> Option<Selection> {
    let peeled = |word| {
        history::history(
            region,
            "Peel",
            history::roles(word).unwrap_or(&[]),
            Some(-1),
        )
    };
    Some(match name {
        "ALL" | "Perimeter" => Selection::all(region),
        "OUTER" | "OUTER_EDGE" | "BOUNDARY" => {
            Selection::edges(region, |_, _, edge| edge.origin.boundary.is_some())
        }
        "INCIDENT" => incident(region),
        "INNER" => Selection::edges(region, |_, _, edge| edge.origin.boundary.is_none()),
        "PATH" => history::role(region, Role::Path),
        "EDGE" => Selection::edges(region, |_, _, edge| edge.side.is_some()),
        "HOLES" => Selection::numbered(region, |ring, _| ring > 0),
        "PEELED_BASE" | "PB" => peeled("BASE"),
        "PEELED_INNER" | "PI" => peeled("INNER"),
        "PEELED_SEGMENT" | "PS" => peeled("SEGMENT"),
        _ => Cardinal::named(name)?.select(region, Frame::of(region), Way::Corners),
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

/// Edges of the park's boundary in runs that reach one of the park's corners.
///
/// "Edges incident to iregion corners", where "we need to consider an edge
/// between two corners, not vertices": a run of one side of the park counts
/// whole, and the park's corners are where two of its sides meet.
fn incident(region: &Region) -> Selection {
    let mut wanted: Vec<Vec<bool>> = Vec::new();
    for edges in &region.edges {
        let n = edges.len();
        let side = |k: usize| edges[k % n].origin.boundary;
        let mut reached = vec![false; n];
        let corner = |k: usize| {
            let (before, after) = (side(k + n - 1), side(k));
            before.is_some() && after.is_some() && before != after
        };
        for k in (0..n).filter(|&k| corner(k)) {
            for j in (k..k + n).take_while(|&j| side(j) == side(k)) {
                reached[j % n] = true;
            }
            let back = (1..=n).map(|j| k + n - j);
            for j in back.take_while(|&j| side(j) == side(k + n - 1)) {
                reached[j % n] = true;
            }
        }
        wanted.push(reached);
    }
    Selection::numbered(region, |ring, k| wanted[ring][k])
}
