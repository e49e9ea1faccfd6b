//! The rectangle that differs least from an area.
//!
//! The notes want an "optimised box that occupies area sufficient for a park" and
//! call it a harder problem. What is optimised here is what the two have in common
//! as a share of what either covers: a box inside that leaves much out and a box
//! around that is half empty both lose. How much is sufficient is `min_area`.

use geo_types::Coord;

use super::{inscribed, Quad};
use crate::plane::{climb, clipped, dist, oriented_box, quad_area, right, signed_area, Area, Line};

pub(super) fn nearest(area: &Area) -> Option<Quad> {
    let around = oriented_box(&area.outer);
    let within = inscribed::largest(area);
    let between = within.map(|quad| {
        let quad = crate::plane::named_by(quad, around[3] - around[0], around[1] - around[0]);
        [0, 1, 2, 3].map(|k| (quad[k] + around[k]) / 2.0)
    });
    let share = |draft: &[f64; 5]| common_share(area, &quad(draft));
    let step = |at: &[f64; 5]| {
        let [_, _, _, width, height] = at.map(|s| 0.05 * s);
        [width, height, 0.05, width, height]
    };
    // The best after a rough climb goes on to the top.
    let starts = [Some(around), within, between].into_iter().flatten();
    let rough = starts.map(|start| {
        let start = draft(&start);
        climb(start, step(&start), 1e-2, share)
    });
    let (best, _) = rough.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let (best, common) = climb(best, step(&best), 1e-9, share);
    (common > 0.0).then(|| quad(&best))
}

/// Middle, direction, width and height.
fn draft(quad: &Quad) -> [f64; 5] {
    let [a, b, c, d] = *quad;
    let middle = (a + b + c + d) / 4.0;
    let x = d - a;
    [middle.x, middle.y, x.y.atan2(x.x), dist(a, d), dist(a, b)]
}

fn quad(&[x, y, angle, width, height]: &[f64; 5]) -> Quad {
    let along = Coord {
        x: angle.cos(),
        y: angle.sin(),
    };
    let (u, v) = (along * (0.5 * width), right(along) * (-0.5 * height));
    let middle = Coord { x, y };
    [
        middle - u - v,
        middle - u + v,
        middle + u + v,
        middle + u - v,
    ]
}

/// What a quad and an area have in common, as a share of what either covers.
fn common_share(area: &Area, quad: &Quad) -> f64 {
    if signed_area(quad) >= 0.0 {
        // Turned inside out.
        return 0.0;
    }
    let rings = area.rings().map(|ring| {
        let mut ring = ring.clone();
        for k in 0..4 {
            // A clip by a convex quad has the right area whatever the ring.
            let line = Line::new(quad[k], quad[(k + 1) % 4] - quad[k]);
            ring = clipped(&ring, &|p| line.aside(p));
        }
        -signed_area(&ring)
    });
    let common: f64 = rings.sum();
    common / (area.size() + quad_area(quad) - common)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// A square with a spike and a nick stays the square.
    #[test]
    fn spikes_and_nicks_are_passed_over() {
        let points = [
            (0., 0.),
            (0., 4.9),
            (1., 5.),
            (0., 5.1),
            (0., 10.),
            (10., 10.),
            (10., 5.1),
            (14., 5.),
            (10., 4.9),
            (10., 0.),
        ];
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        let found = nearest(&Area::new(ring, Vec::new())).expect("fits");
        for (p, (x, y)) in found
            .iter()
            .zip([(0., 0.), (0., 10.), (10., 10.), (10., 0.)])
        {
            assert!(dist(*p, coord! { x: x, y: y }) < 0.05, "{found:?}");
        }
    }
}
