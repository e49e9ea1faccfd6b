//! How far one sees inside an area.
//!
//! Lines that touch the boundary, or run along it, go on.

use geo_types::Coord;

use super::{cross, dist, dot, lerp, Area};

/// Distances this small, as a share of the area's size, are none.
const NEAR: f64 = 1e-9;

/// The shares of the way from `a` to `b` at which it meets the boundary, sorted,
/// with 0 and 1; ends of edges along the way among them.
fn meetings(area: &Area, a: Coord<f64>, b: Coord<f64>, near: f64) -> Vec<f64> {
    let way = b - a;
    let square = dot(way, way);
    let long = square.sqrt();
    let mut at = vec![0.0, 1.0];
    for (p, q) in area.rings().flat_map(|ring| super::sides(ring)) {
        // How far the ends of the edge lie aside, and along.
        let [u, v] = [p, q].map(|x| cross(way, x - a) / long);
        let mut on = |x: Coord<f64>| {
            let share = dot(x - a, way) / square;
            if share > 0.0 && share < 1.0 {
                at.push(share);
            }
        };
        if u.abs() <= near {
            on(p);
        } else if v.abs() > near && (u > 0.0) != (v > 0.0) {
            on(lerp(p, q, u / (u - v)));
        }
    }
    at.sort_by(f64::total_cmp);
    at
}

fn tolerance(area: &Area) -> f64 {
    let (low, high) = area.extent();
    NEAR * (high.x - low.x).max(high.y - low.y)
}

/// The share of the way from `a` to `b` up to which it runs inside the area or
/// along its boundary.
fn sight(area: &Area, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let near = tolerance(area);
    let long = dist(a, b);
    if long <= near {
        return 1.0;
    }
    for pair in meetings(area, a, b, near).windows(2) {
        if (pair[1] - pair[0]) * long <= near {
            continue;
        }
        let middle = lerp(a, b, 0.5 * (pair[0] + pair[1]));
        if !area.contains(middle) && area.nearest(middle).1 > near {
            return pair[0];
        }
    }
    1.0
}

/// Whether the way from `a` to `b` runs inside the area or along its boundary.
pub(crate) fn sees(area: &Area, a: Coord<f64>, b: Coord<f64>) -> bool {
    sight(area, a, b) * dist(a, b) >= dist(a, b) - tolerance(area)
}

/// Where a ray leaves the area; `None` for one that begins by leaving it.
pub(crate) fn leaves(area: &Area, from: Coord<f64>, along: Coord<f64>) -> Option<Coord<f64>> {
    let (low, high) = area.extent();
    let far = 2.0 * (dist(low, high) + dist(from, low));
    let end = from + along * far;
    let share = sight(area, from, end);
    (share * far > tolerance(area)).then(|| lerp(from, end, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn l() -> Area {
        area(&[(0., 0.), (0., 9.), (3., 9.), (3., 3.), (9., 3.), (9., 0.)])
    }

    #[test]
    fn rays_end_where_they_leave() {
        let from = coord! { x: 1., y: 1. };
        let to = |x: f64, y: f64| leaves(&l(), from, crate::plane::unit(coord! { x: x, y: y }));
        assert_eq!(to(1., 0.), Some(coord! { x: 9., y: 1. }));
        assert_eq!(to(-1., 0.), Some(coord! { x: 0., y: 1. }));
        // Through the inner corner at (3, 3) nothing is left to see.
        let corner = to(1., 1.).expect("leaves");
        assert!(dist(corner, coord! { x: 3., y: 3. }) < 1e-9);
    }

    /// Ways along the boundary and past a corner are inside.
    #[test]
    fn touching_is_seeing() {
        let p = |x: f64, y: f64| coord! { x: x, y: y };
        assert!(sees(&l(), p(0., 0.), p(0., 9.)));
        assert!(sees(&l(), p(3., 9.), p(3., 0.)));
        assert!(sees(&l(), p(0., 3.), p(9., 3.)));
        assert!(!sees(&l(), p(2., 8.), p(8., 2.)));
        assert_eq!(sight(&l(), p(2., 4.), p(4., 4.)), 0.5);
    }

    /// What begins on the boundary may lead inwards or outwards.
    #[test]
    fn rays_from_the_boundary() {
        let from = coord! { x: 0., y: 4. };
        let (inwards, outwards) = (coord! { x: 1., y: 0. }, coord! { x: -1., y: 0. });
        assert_eq!(leaves(&l(), from, inwards), Some(coord! { x: 3., y: 4. }));
        assert_eq!(leaves(&l(), from, outwards), None);
    }
}
