//! A parcel's shape in two figures: corner deviation and box ratio.
//!
//! Paper (Yang et al. 2013) section 7, parcel metrics 2 and 3: the average angle
//! deviation from 90 degrees over all parcel corners, and the area of the
//! minimum bounding rectangle over the parcel's own.

use geo_types::{Coord, Polygon};

use super::plane::{cross, distance, dot, minus, open_ring, polygon_area, signed_area, turn_deg};

/// A vertex is a corner where the outline turns by more than this, degrees.
const CORNER_TURN_DEG: f64 = 20.0;
/// Vertices that turn by less than this are on a straight side, degrees.
const STRAIGHT_TURN_DEG: f64 = 0.5;
/// Vertices closer than this are one, metres.
const SAME_POINT: f64 = 1e-6;

/// A parcel's mean corner deviation (degrees) and box ratio (1 at best).
///
/// A corner is a vertex of the exterior that turns by more than 20 degrees once
/// collinear vertices are gone; its deviation is the smaller of |a - 90| and
/// |a - 270| for the interior angle a, so a reflex right angle is a right angle.
/// An outline without corners deviates by 0. The box is the rectangle of least
/// area around the exterior, in any direction; its ratio is infinite for a
/// polygon without area.
///
/// # Examples
///
/// ```
/// use geo_types::polygon;
/// use urban_layout::layout::measure_parcel;
///
/// let parcel = polygon![(x: 0., y: 0.), (x: 18., y: 0.), (x: 18., y: 30.), (x: 0., y: 30.)];
/// let (deviation, ratio) = measure_parcel(&parcel);
/// assert!(deviation < 1e-9 && (ratio - 1.0).abs() < 1e-9);
/// ```
#[must_use]
pub fn measure_parcel(ring: &Polygon<f64>) -> (f64, f64) {
    let corners = corner_deviations(ring);
    let mean = if corners.is_empty() {
        0.0
    } else {
        corners.iter().sum::<f64>() / corners.len() as f64
    };
    let area = polygon_area(ring);
    let ratio = if area > 0.0 {
        min_box_area(ring) / area
    } else {
        f64::INFINITY
    };
    (mean, ratio)
}

/// Whether a parcel of this corner deviation (degrees) and box ratio is
/// undesirable: over 15 degrees, or over 1.2 (paper section 8, figure 12).
#[must_use]
pub fn is_undesirable(corner_deviation_deg: f64, box_ratio: f64) -> bool {
    corner_deviation_deg > 15.0 || box_ratio > 1.2
}

/// Deviation from a right angle of each corner of the exterior, degrees, in the
/// order of the ring; see [`measure_parcel`] for what a corner is.
#[must_use]
pub fn corner_deviations(ring: &Polygon<f64>) -> Vec<f64> {
    let mut points = open_ring(ring.exterior()).to_vec();
    if signed_area(&ring.exterior().0) < 0.0 {
        // Reversed as a closed ring, so that the first vertex stays the first.
        points.reverse();
        points.rotate_right(1);
    }
    points.dedup_by(|next, kept| distance(*next, *kept) <= SAME_POINT);
    drop_straight(&mut points);
    let n = points.len();
    (0..n)
        .filter_map(|i| {
            let turn = turn_deg(points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
            let angle = 180.0 - turn;
            (turn.abs() > CORNER_TURN_DEG).then(|| (angle - 90.0).abs().min((angle - 270.0).abs()))
        })
        .collect()
}

/// Removes vertices on straight sides one at a time, always the first of the
/// ring that is straight, so that an arc is not lost bit by bit. After a
/// removal only the two neighbours' turns have changed, so the search goes on
/// there instead of at the start.
fn drop_straight(points: &mut Vec<Coord<f64>>) {
    let mut i = 0;
    while points.len() > 3 && i < points.len() {
        let n = points.len();
        let turn = turn_deg(points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        if turn.abs() < STRAIGHT_TURN_DEG {
            points.remove(i);
            i = if i + 1 == n { 0 } else { i.saturating_sub(1) };
        } else {
            i += 1;
        }
    }
}

/// Area of the rectangle of least area around the exterior, in any direction.
///
/// One side of it lies on a side of the convex hull; the hull's extreme points
/// are followed round by rotating calipers.
///
/// # Complexity
///
/// O(n log n) for n vertices.
#[must_use]
pub fn min_box_area(ring: &Polygon<f64>) -> f64 {
    let hull = convex_hull(open_ring(ring.exterior()));
    let n = hull.len();
    if n < 3 {
        return 0.0;
    }
    let side = |i: usize| minus(hull[(i + 1) % n], hull[i % n]);
    // Advances to the vertex farthest along `direction`, at most once round.
    let farthest = |mut at: usize, direction: Coord<f64>| {
        for _ in 0..n {
            if dot(side(at), direction) <= 0.0 {
                break;
            }
            at = (at + 1) % n;
        }
        at
    };
    let (mut ahead, mut across, mut behind) = (0, 0, 0);
    let mut least = f64::INFINITY;
    for i in 0..n {
        let u = side(i);
        let square = dot(u, u);
        let normal = Coord { x: -u.y, y: u.x };
        let back = Coord { x: -u.x, y: -u.y };
        if i == 0 {
            (ahead, across, behind) = (1 % n, 1 % n, 1 % n);
        }
        ahead = farthest(ahead, u);
        across = farthest(if i == 0 { ahead } else { across }, normal);
        behind = farthest(if i == 0 { across } else { behind }, back);
        let width = dot(minus(hull[ahead], hull[behind]), u);
        let height = cross(u, minus(hull[across], hull[i]));
        least = least.min(width * height / square);
    }
    least
}

/// Convex hull, counter-clockwise, without collinear vertices (Andrew's
/// monotone chain).
fn convex_hull(points: &[Coord<f64>]) -> Vec<Coord<f64>> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull: Vec<Coord<f64>> = Vec::with_capacity(2 * sorted.len());
    let chain = |points: &mut dyn Iterator<Item = Coord<f64>>, hull: &mut Vec<Coord<f64>>| {
        let start = hull.len();
        for p in points {
            while hull.len() >= start + 2 {
                let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                if cross(minus(b, a), minus(p, b)) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop(); // it starts the other chain
    };
    chain(&mut sorted.iter().copied(), &mut hull);
    chain(&mut sorted.iter().rev().copied(), &mut hull);
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{polygon, LineString};

    fn regular(n: usize, radius: f64) -> Polygon<f64> {
        let ring: LineString<f64> = (0..n)
            .map(|i| {
                let a = std::f64::consts::TAU * i as f64 / n as f64;
                Coord {
                    x: radius * a.cos(),
                    y: radius * a.sin(),
                }
            })
            .collect();
        Polygon::new(ring, vec![])
    }

    #[test]
    fn an_l_has_only_right_angles() {
        let l = polygon![(x: 0., y: 0.), (x: 4., y: 0.), (x: 4., y: 2.), (x: 2., y: 2.), (x: 2., y: 4.), (x: 0., y: 4.)];
        let (deviation, ratio) = measure_parcel(&l);
        assert!(deviation < 1e-9);
        assert!((ratio - 16.0 / 12.0).abs() < 1e-12);
        assert_eq!(corner_deviations(&l).len(), 6);
    }

    #[test]
    fn a_right_triangle_deviates_by_its_sharp_corners() {
        let t = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 0., y: 1.)];
        let (deviation, ratio) = measure_parcel(&t);
        assert!((deviation - 30.0).abs() < 1e-9); // (0 + 45 + 45) / 3
        assert!((ratio - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_smooth_outline_has_no_corners() {
        let disc = regular(36, 10.0);
        let (deviation, ratio) = measure_parcel(&disc);
        assert_eq!(deviation, 0.0);
        assert!((ratio - 4.0 / std::f64::consts::PI).abs() < 0.01);
    }

    #[test]
    fn extra_vertices_on_the_sides_change_nothing() {
        let plain = polygon![(x: 0., y: 0.), (x: 18., y: 0.), (x: 20., y: 30.), (x: 0., y: 30.)];
        let busy = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 18., y: 0.), (x: 19., y: 15.), (x: 20., y: 30.),
            (x: 10., y: 30.), (x: 0., y: 30.), (x: 0., y: 15.), (x: 0., y: 1e-7)];
        assert!((measure_parcel(&plain).0 - measure_parcel(&busy).0).abs() < 1e-5);
        assert!((measure_parcel(&plain).1 - measure_parcel(&busy).1).abs() < 1e-9);
    }

    #[test]
    fn no_area_is_no_panic() {
        let line = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 2., y: 0.)];
        assert_eq!(measure_parcel(&line).1, f64::INFINITY);
        assert_eq!(
            measure_parcel(&Polygon::new(LineString::new(vec![]), vec![])).1,
            f64::INFINITY
        );
    }
}
