//! `Continuous(WEST)`, `Continuous(EDGE[0])`: a direction with what belongs to it.
//!
//! The notes' direction continuity "will also include edges not facing west, if
//! they resulted from an operation on a west-facing edge, or when they are
//! enclosed by west-facing edges". An edge resulted from such an edge if it
//! descends from the same side of the park, which [`Origin`] remembers. An edge
//! is enclosed if it lies in a gap between two selected lines of a ring that
//! turns back: whose turns add up to less than half a turn, as in a bay or a
//! niche. (Round the whole region they add up to a full one.)
//!
//! [`Origin`]: crate::shape::Origin

use std::f64::consts::PI;

use geo_types::Coord;

use super::cardinal::{nearest, Cardinal};
use super::frame::Frame;
use super::Selection;
use crate::plane::{cross, dot, unit};
use crate::shape::{Edge, Region};

/// A share of an edge this large in a selection counts as the edge.
const MOST: f64 = 0.5;

/// What faces a direction, more than any other, and what goes with it.
pub(super) fn towards(region: &Region, frame: Frame, cardinal: Cardinal) -> Selection {
    let quarter = std::f64::consts::FRAC_PI_4;
    let middle = cardinal.angle();
    let base = super::angle::facing(region, frame, [middle - quarter, middle + quarter]);
    // What came of the park's side in this direction, though it face elsewhere.
    let side = nearest(frame.direction(middle)).side();
    let descends = Selection::edges(region, |_, _, edge| edge.origin.descent == Some(side));
    of(region, &base.or(&descends))
}

/// A selection and what goes with it.
pub(super) fn of(region: &Region, base: &Selection) -> Selection {
    let sides = descents(region, base);
    let descends = Selection::edges(region, |_, _, edge: &Edge| {
        edge.origin
            .descent
            .is_some_and(|side| sides.contains(&side))
    });
    let all = base.or(&descends);
    enclosed(region, &all).or(&all)
}

/// The sides of the park that selected edges on its boundary belong to.
fn descents(region: &Region, base: &Selection) -> Vec<usize> {
    let mut sides = Vec::new();
    for (k, selected) in selected(region, base, 0).into_iter().enumerate() {
        let origin = &region.edges[0][k].origin;
        if selected && origin.boundary.is_some() {
            sides.extend(origin.descent);
        }
    }
    sides
}

/// For each edge of a ring whether it is selected, for the most part.
fn selected(region: &Region, selection: &Selection, ring: usize) -> Vec<bool> {
    let mut from = 0.0;
    region
        .edges(ring)
        .map(|(a, b, _)| {
            let to = from + crate::plane::dist(a, b);
            let common = selection.stretches().iter().filter(|s| s.ring == ring);
            let held: f64 = common
                .map(|s| (s.to.min(to) - s.from.max(from)).max(0.0))
                .sum();
            let share = held / (to - from);
            from = to;
            share >= MOST
        })
        .collect()
}

/// The edges in gaps that turn back.
fn enclosed(region: &Region, selection: &Selection) -> Selection {
    let mut wanted: Vec<Vec<bool>> = Vec::new();
    for ring in 0..region.rings() {
        let held = selected(region, selection, ring);
        let edges: Vec<(Coord<f64>, Coord<f64>)> =
            region.edges(ring).map(|(a, b, _)| (a, b)).collect();
        let n = edges.len();
        let mut fill = vec![false; n];
        let ends = (0..n).filter(|&k| held[k] && !held[(k + 1) % n]);
        for end in ends {
            let (mut k, mut turned, mut gap) = (end, 0.0, Vec::new());
            loop {
                let next = (k + 1) % n;
                turned += turn(edges[k], edges[next]);
                k = next;
                if held[k] {
                    break;
                }
                gap.push(k);
            }
            // Back to where it began is round, whatever the turns' rounding.
            if turned.abs() < PI - 1e-9 && k != end {
                gap.into_iter().for_each(|k| fill[k] = true);
            }
        }
        wanted.push(fill);
    }
    Selection::numbered(region, |ring, k| wanted[ring][k])
}

fn turn((a, b): (Coord<f64>, Coord<f64>), (c, d): (Coord<f64>, Coord<f64>)) -> f64 {
    let (u, v) = (unit(b - a), unit(d - c));
    cross(u, v).atan2(dot(u, v))
}
