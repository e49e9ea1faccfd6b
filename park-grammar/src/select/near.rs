//! `Nearest(CENTRE, 2)`, `Nearest((0, 0.5))`, `Nearest(EDGE[0])`: the edges that
//! lie nearest to a point or to a selection.
//!
//! Physical edges are ranked by how far they are from a point; from a selection,
//! which others touch, by how far their middles are, its own edges left out.
//! Edges as near as the last one chosen are chosen too: symmetric regions have
//! symmetric answers.

use geo_types::Coord;

use super::Selection;
use crate::plane::{dist, lerp, nearest_on};
use crate::shape::Region;

/// Distances this much apart are equal, as a share of the larger.
const SAME: f64 = 1e-9;

/// The edges nearest to points.
pub(super) fn to_points(region: &Region, points: &[Coord<f64>], count: usize) -> Selection {
    let away = |a, b| {
        let far = points.iter().map(|&p| dist(nearest_on(a, b, p), p));
        Some(far.fold(f64::INFINITY, f64::min))
    };
    ranked(region, away, count)
}

/// The edges nearest to a selection.
pub(super) fn to_selection(region: &Region, selection: &Selection, count: usize) -> Selection {
    let lines = selection.lines(region);
    let to_lines = |p: Coord<f64>| {
        let pieces = lines.iter().flat_map(|line| line.windows(2));
        pieces
            .map(|pair| dist(nearest_on(pair[0], pair[1], p), p))
            .fold(f64::INFINITY, f64::min)
    };
    let away = |a, b| {
        let middle = to_lines(lerp(a, b, 0.5));
        (middle > SAME * dist(a, b)).then_some(middle)
    };
    ranked(region, away, count)
}

fn ranked(
    region: &Region,
    away: impl Fn(Coord<f64>, Coord<f64>) -> Option<f64>,
    count: usize,
) -> Selection {
    let mut all: Vec<f64> = (0..region.rings())
        .flat_map(|ring| region.edges(ring))
        .filter_map(|(a, b, _)| away(a, b))
        .collect();
    all.sort_by(f64::total_cmp);
    let Some(last) = count.checked_sub(1).map(|k| k.min(all.len().max(1) - 1)) else {
        return Selection::default();
    };
    let Some(&limit) = all.get(last) else {
        return Selection::default();
    };
    let limit = limit + SAME * (1.0 + limit);
    Selection::edges(region, |a, b, _| away(a, b).is_some_and(|far| far <= limit))
}
