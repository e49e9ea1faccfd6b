//! Boxes around points, and quads.

use geo_types::Coord;

use super::{cross, dist, dot, right, unit, Ring};

/// Boxes whose areas differ by less, as a share, are equally good.
const SAME: f64 = 1e-6;

/// The convex hull, clockwise, without vertices on its edges.
pub(crate) fn hull(points: &[Coord<f64>]) -> Ring {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    let half = |points: &mut dyn Iterator<Item = Coord<f64>>| {
        let mut line: Ring = Vec::new();
        for p in points {
            while line.len() >= 2 {
                let (a, b) = (line[line.len() - 2], line[line.len() - 1]);
                if cross(b - a, p - a) < 0.0 {
                    break;
                }
                line.pop();
            }
            line.push(p);
        }
        line.pop();
        line
    };
    let mut upper = half(&mut sorted.iter().copied());
    upper.extend(half(&mut sorted.iter().rev().copied()));
    upper
}

/// The smallest box around points whose x axis has the direction of `x`: where
/// (0, 0), (0, 1), (1, 1) and (1, 0) of it lie.
pub(crate) fn box_along(points: &[Coord<f64>], x: Coord<f64>) -> [Coord<f64>; 4] {
    let x = unit(x);
    let y = right(x) * -1.0;
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for &p in points {
        for (k, axis) in [x, y].into_iter().enumerate() {
            let along = dot(p, axis);
            low[k] = low[k].min(along);
            high[k] = high[k].max(along);
        }
    }
    let at = |a: f64, b: f64| x * a + y * b;
    [
        at(low[0], low[1]),
        at(low[0], high[1]),
        at(high[0], high[1]),
        at(high[0], low[1]),
    ]
}

/// The box of least area around points, in any direction. Its x axis points east,
/// or within 45 degrees of it.
///
/// Of several (a triangle has three) the one along the longest edge, whichever way
/// the points are turned; of those the one that is turned least from the axes of
/// the plane.
pub(crate) fn oriented_box(points: &[Coord<f64>]) -> [Coord<f64>; 4] {
    let hull = hull(points);
    let mut boxes = Vec::with_capacity(hull.len());
    for (a, b) in super::sides(&hull) {
        // All four directions of an edge make one box.
        let mut x = unit(b - a);
        while x.x < x.y.abs() || (x.x == x.y.abs() && x.y < 0.0) {
            x = right(x);
        }
        let found = box_along(&hull, x);
        boxes.push((found, quad_area(&found), dist(a, b), x.y.abs()));
    }
    let least = boxes.iter().map(|b| b.1).fold(f64::INFINITY, f64::min);
    boxes.retain(|b| b.1 <= least * (1.0 + SAME));
    let longest = boxes.iter().map(|b| b.2).fold(0.0, f64::max);
    boxes.retain(|b| b.2 >= longest * (1.0 - SAME));
    let best = boxes.into_iter().min_by(|a, b| a.3.total_cmp(&b.3));
    let upright = Coord { x: 1.0, y: 0.0 };
    best.map_or_else(|| box_along(points, upright), |best| best.0)
}

/// Area of a quad, whichever way it is wound.
pub(crate) fn quad_area(quad: &[Coord<f64>; 4]) -> f64 {
    super::signed_area(quad).abs()
}

/// The angle between the two edges at each corner of a quad that is convex;
/// `None` for any other.
pub(crate) fn quad_angles(quad: &[Coord<f64>; 4]) -> Option<[f64; 4]> {
    let mut angles = [0.0; 4];
    let wound = super::signed_area(quad).signum();
    for (k, angle) in angles.iter_mut().enumerate() {
        let (a, b, c) = (quad[(k + 3) % 4], quad[k], quad[(k + 1) % 4]);
        let (before, after) = (unit(b - a), unit(c - b));
        if cross(before, after) * wound <= 1e-9 {
            return None;
        }
        *angle = std::f64::consts::PI - cross(before, after).abs().atan2(dot(before, after));
    }
    Some(angles)
}

/// Whether a quad is convex.
pub(crate) fn quad_is_convex(quad: &[Coord<f64>; 4]) -> bool {
    let wound = super::signed_area(quad).signum();
    (0..4).all(|k| {
        let (a, b, c) = (quad[k], quad[(k + 1) % 4], quad[(k + 2) % 4]);
        let (before, after) = (b - a, c - b);
        let turn = cross(before, after) * wound;
        turn * turn.abs() > 1e-18 * dot(before, before) * dot(after, after)
    })
}

/// The same quad as local coordinates of axes near to `x` and `y` have it:
/// beginning with the corner that is lowest along both.
pub(crate) fn named_by(quad: [Coord<f64>; 4], x: Coord<f64>, y: Coord<f64>) -> [Coord<f64>; 4] {
    let mut quad = quad;
    // (0, 0), (0, 1), (1, 1) turns to the right unless the axes are mirrored.
    let mirrored = cross(x, y) < 0.0;
    if (super::signed_area(&quad) > 0.0) != mirrored {
        quad.reverse();
    }
    let score = |start: usize| {
        let at = |k: usize| quad[(start + k) % 4];
        let along = unit((at(3) - at(0)) + (at(2) - at(1)));
        let up = unit((at(1) - at(0)) + (at(2) - at(3)));
        dot(along, x) + dot(up, y)
    };
    let mut best = 0;
    for start in 1..4 {
        if score(start) > score(best) + 1e-9 {
            best = start;
        }
    }
    [0, 1, 2, 3].map(|k| quad[(best + k) % 4])
}

/// Length of the middle line of a quad along x, and along y.
pub(crate) fn quad_extent(quad: &[Coord<f64>; 4]) -> [f64; 2] {
    let [a, b, c, d] = *quad;
    [
        dist((a + b) / 2.0, (c + d) / 2.0),
        dist((a + d) / 2.0, (b + c) / 2.0),
    ]
}

/// The point of a quad at coordinates, bilinear.
pub(crate) fn quad_point(quad: &[Coord<f64>; 4], at: Coord<f64>) -> Coord<f64> {
    let [a, b, c, d] = *quad;
    a * ((1.0 - at.x) * (1.0 - at.y))
        + b * ((1.0 - at.x) * at.y)
        + c * (at.x * at.y)
        + d * (at.x * (1.0 - at.y))
}

/// The coordinates of a point in a convex quad: [`quad_point`] turned round, by
/// Newton's method, which for a parallelogram is done after one step.
pub(crate) fn quad_coordinates(quad: &[Coord<f64>; 4], p: Coord<f64>) -> Coord<f64> {
    let [a, b, c, d] = *quad;
    let mut at = Coord { x: 0.5, y: 0.5 };
    for _ in 0..12 {
        let off = p - quad_point(quad, at);
        let x = (d - a) * (1.0 - at.y) + (c - b) * at.y;
        let y = (b - a) * (1.0 - at.x) + (c - d) * at.x;
        let det = cross(x, y);
        if det == 0.0 {
            break;
        }
        let step = Coord {
            x: cross(off, y) / det,
            y: cross(x, off) / det,
        };
        at = at + step;
        if step.x.abs().max(step.y.abs()) < 1e-13 {
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn a_turned_rectangle_is_its_own_box() {
        // 5 x 10, turned so that its long edge rises 3 in 4.
        let quad = [
            coord! { x: 0., y: 0. },
            coord! { x: -3., y: 4. },
            coord! { x: 5., y: 10. },
            coord! { x: 8., y: 6. },
        ];
        let inside = coord! { x: 2., y: 5. };
        let mut points = quad.to_vec();
        points.push(inside);
        assert_eq!(hull(&points).len(), 4);
        let found = oriented_box(&points);
        for (a, b) in found.iter().zip(&quad) {
            assert!(dist(*a, *b) < 1e-12, "{found:?}");
        }
        let extent = quad_extent(&found);
        assert!((extent[0] - 10.0).abs() < 1e-12 && (extent[1] - 5.0).abs() < 1e-12);
    }

    #[test]
    fn coordinates_of_a_quad() {
        let quad = [
            coord! { x: 0., y: 0. },
            coord! { x: 1., y: 5. },
            coord! { x: 9., y: 6. },
            coord! { x: 8., y: 0. },
        ];
        let at = coord! { x: 0.3, y: 0.8 };
        let back = quad_coordinates(&quad, quad_point(&quad, at));
        assert!(dist(at, back) < 1e-12, "{back:?}");
        let angles = quad_angles(&quad).expect("convex");
        assert!((angles.iter().sum::<f64>() - std::f64::consts::TAU).abs() < 1e-12);
        let dart = [quad[0], quad[1], coord! { x: 1., y: 1. }, quad[3]];
        assert_eq!(quad_angles(&dart), None);
    }

    #[test]
    fn quads_are_named_by_axes() {
        let quad = box_along(
            &[coord! { x: 0., y: 0. }, coord! { x: 3., y: 2. }],
            coord! { x: 0., y: 1. },
        );
        let (x, y) = (coord! { x: 1., y: 0. }, coord! { x: 0., y: 1. });
        let found = named_by(quad, x, y);
        assert_eq!(found[0], coord! { x: 0., y: 0. });
        assert_eq!(found[1], coord! { x: 0., y: 2. });
        let found = named_by(quad, x * -1.0, y);
        assert_eq!(found[0], coord! { x: 3., y: 0. });
        assert_eq!(found[3], coord! { x: 0., y: 0. });
    }
}
