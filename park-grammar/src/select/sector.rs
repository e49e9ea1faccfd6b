//! `Sector([-45, 45])`: what lies between two rays from the centre.
//!
//! "Select edges that lay within or partially within the radial region": edges
//! are cut where the rays meet them. Hidden edges of a concave region count too.
//! Angles run from the region's own east towards its own north, from the first
//! to the second.

use std::f64::consts::{PI, TAU};

use geo_types::Coord;

use super::frame::Frame;
use super::{Selection, Stretch};
use crate::plane::{cross, dist, norm};
use crate::shape::Region;

/// Distances from a ray that are rounding, as a share of those to the centre.
const ON: f64 = 1e-12;

/// What lies between the rays at two angles, radians, from `centre`.
pub(super) fn between(
    region: &Region,
    frame: Frame,
    centre: Coord<f64>,
    [low, high]: [f64; 2],
) -> Selection {
    if high - low >= TAU {
        return Selection::all(region);
    }
    let sweep = (high - low).rem_euclid(TAU);
    if sweep > PI {
        // The rest is convex.
        return between(region, frame, centre, [high, high + TAU - sweep]).not(region);
    }
    let (mut from, mut to) = (frame.direction(low), frame.direction(high));
    if frame.mirrored {
        std::mem::swap(&mut from, &mut to);
    }
    pieces(region, |a, b| {
        let (a, b) = (a - centre, b - centre);
        // An edge that lies on a ray is within, whatever its rounding.
        let tiny = ON * (norm(a) + norm(b));
        let first = positive(cross(from, a) + tiny, cross(from, b) + tiny);
        let second = positive(cross(a, to) + tiny, cross(b, to) + tiny);
        [first[0].max(second[0]), first[1].min(second[1])]
    })
}

/// The part of each edge between two shares of it.
pub(super) fn pieces(
    region: &Region,
    cut: impl Fn(Coord<f64>, Coord<f64>) -> [f64; 2],
) -> Selection {
    let mut stretches = Vec::new();
    for ring in 0..region.rings() {
        let mut along = 0.0;
        for (a, b, _) in region.edges(ring) {
            let step = dist(a, b);
            let [from, to] = cut(a, b);
            if to > from {
                // An end that is not cut is the vertex, to the last digit.
                let at = |t: f64| {
                    if t >= 1.0 {
                        along + step
                    } else {
                        along + t * step
                    }
                };
                stretches.push(Stretch {
                    ring,
                    from: at(from),
                    to: at(to),
                });
            }
            along += step;
        }
    }
    Selection::new(stretches)
}

/// Between which shares of the way a value that goes from `a` to `b` is not
/// negative.
pub(super) fn positive(a: f64, b: f64) -> [f64; 2] {
    match (a >= 0.0, b >= 0.0) {
        (true, true) => [0.0, 1.0],
        (false, false) => [1.0, 0.0],
        (true, false) => [0.0, a / (a - b)],
        (false, true) => [a / (a - b), 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Area;
    use geo_types::coord;

    #[test]
    fn edges_are_cut_by_the_rays() {
        let ring = [(-1., -1.), (-1., 1.), (1., 1.), (1., -1.)];
        let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        let region = Region::bare(Area::new(ring, Vec::new()));
        let sector = |low: f64, high: f64| {
            let angles = [low, high].map(f64::to_radians);
            between(&region, Frame::COMPASS, Coord::default(), angles).length()
        };
        assert!((sector(-45.0, 45.0) - 2.0).abs() < 1e-9);
        assert!((sector(0.0, 90.0) - 2.0).abs() < 1e-9);
        // tan 30 of the east side above the middle.
        assert!((sector(0.0, 30.0) - 30_f64.to_radians().tan()).abs() < 1e-9);
        assert!((sector(45.0, -45.0) - 6.0).abs() < 1e-9);
        assert_eq!(sector(0.0, 360.0), 8.0);
    }
}
