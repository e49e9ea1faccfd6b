//! Four groups of edges by the directions west, north, east and south.
//!
//! The corner between two groups is the vertex that lies farthest in the
//! direction between them. So the groups are runs of edges whatever the shape,
//! and of a convex one each edge belongs to the direction that it faces most. An
//! edge that faces exactly between two belongs to west or east: the notes ask
//! that this be decided so that mirror images have mirrored groups.

use geo_types::Coord;

use crate::plane::{cross, Ring};

/// Vertices this near to the farthest one, as a share of the ring's size, are as
/// far.
const TIE: f64 = 1e-7;

/// The vertices at (0, 0), (0, 1), (1, 1) and (1, 0) of axes `x` and `y`: the
/// corners between the groups.
pub(super) fn corners(ring: &Ring, x: Coord<f64>, y: Coord<f64>) -> [usize; 4] {
    let det = cross(x, y);
    // Axes need not be at right angles.
    let own: Vec<[f64; 2]> = ring
        .iter()
        .map(|&p| {
            if det.abs() > 1e-9 {
                [cross(p, y) / det, cross(x, p) / det]
            } else {
                [p.x, p.y]
            }
        })
        .collect();
    let largest = |values: &dyn Fn(&[f64; 2]) -> f64| {
        own.iter().map(values).fold(f64::NEG_INFINITY, f64::max)
    };
    let size =
        (largest(&|p| p[0]) + largest(&|p| -p[0])).max(largest(&|p| p[1]) + largest(&|p| -p[1]));
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(a, b)| {
        let far = |p: &[f64; 2]| a * p[0] + b * p[1];
        let best = largest(&far);
        let tied = (0..own.len()).filter(|&k| far(&own[k]) >= best - TIE * size);
        // The end that leaves the edges between to west and east.
        let found = tied.max_by(|&i, &j| (b * own[i][1]).total_cmp(&(b * own[j][1])));
        found.unwrap_or(0)
    })
}

/// The group of each edge of a clockwise ring, by the corners between them;
/// `mirrored` for axes that turn counter-clockwise.
pub(super) fn groups(count: usize, corners: [usize; 4], mirrored: bool) -> Vec<usize> {
    let mut groups = vec![0; count];
    for side in 0..4 {
        // Side k runs from corner k to the next one; seen from behind, back.
        let (from, to) = if mirrored {
            (corners[(side + 1) % 4], corners[side])
        } else {
            (corners[side], corners[(side + 1) % 4])
        };
        let mut k = from;
        while k != to {
            groups[k] = side;
            k = (k + 1) % count;
        }
    }
    groups
}
