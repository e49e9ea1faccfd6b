//! Smoothing of rings.
//!
//! Three kernels, each with vertices that may be pinned: a pinned vertex stays
//! where it is, and an edge between two of them is left alone, so that a border
//! can be smoothed while what it ends at is not moved.
//!
//! * [`Smoothing::Average`]: each pass halves the edges and averages every vertex
//!   with its neighbours, with weights 1, 2, 1: Lane and Riesenfeld's subdivision,
//!   whose limit is the cubic B-spline. "A theoretical development for the computer
//!   generation and display of piecewise polynomial surfaces", 1980.
//! * [`Smoothing::Chaikin`]: each pass cuts off the corners at a quarter of the
//!   edges; the limit is the quadratic B-spline, which touches every edge. "An
//!   algorithm for high speed curve generation", 1974.
//! * [`Smoothing::Round`]: corners become arcs of a radius, as far as the edges
//!   are long enough.
//!
//! All stay within the triangles of three neighbouring vertices, so that a convex
//! ring becomes a convex one inside. A ring that is not convex may come to cross
//! itself, and leaves its land at corners that turn inwards: whoever wants neither
//! takes the intersection with the land.

use geo_types::Coord;

use super::{cross, dist, dot, lerp, unit, Ring};

/// Arcs turn by this much at each vertex at most, radians.
const ARC: f64 = std::f64::consts::PI / 18.0;

/// A whole number of pieces is one, whatever rounding makes of it.
const WHOLE: f64 = 1e-6;

/// Vertices that turn by less are no corners, radians.
const STRAIGHT: f64 = 1e-6;

/// A way to smooth a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Smoothing {
    /// Averages with the neighbours, so many passes.
    Average(usize),
    /// Cuts off corners, so many passes.
    Chaikin(usize),
    /// Rounds corners with arcs of a radius, metres.
    Round(f64),
}

/// A vertex, and whether it stays.
type Vertex = (Coord<f64>, bool);

/// A ring smoothed; `pinned` says of each vertex whether it stays.
///
/// With a `reach` only what lies within it of a vertex changes, along the edges:
/// else a corner between long edges is cut off far away.
pub(crate) fn smooth(
    ring: &[Coord<f64>],
    pinned: &[bool],
    smoothing: Smoothing,
    reach: Option<f64>,
) -> Ring {
    let mut line: Vec<Vertex> = ring.iter().copied().zip(pinned.iter().copied()).collect();
    line = without_straights(line);
    if line.len() < 3 {
        return ring.to_vec();
    }
    if let Some(reach) = reach {
        line = supported(&line, reach);
    }
    match smoothing {
        Smoothing::Average(passes) => (0..passes).for_each(|_| line = averaged(&line)),
        Smoothing::Chaikin(passes) => (0..passes).for_each(|_| line = cut(&line)),
        Smoothing::Round(radius) => line = rounded(&line, radius),
    }
    let mut ring: Ring = line.into_iter().map(|(at, _)| at).collect();
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

/// Without free vertices at which the ring does not turn: what a boolean leaves on
/// an edge must not change what becomes of its corners.
fn without_straights(line: Vec<Vertex>) -> Vec<Vertex> {
    let n = line.len();
    let turns = |k: &usize| {
        let (before, (at, stays), after) = (line[(k + n - 1) % n], line[*k], line[(k + 1) % n]);
        let (u, v) = (unit(at - before.0), unit(after.0 - at));
        stays || cross(u, v).abs() > STRAIGHT || dot(u, v) < 0.0
    };
    (0..n).filter(turns).map(|k| line[k]).collect()
}

/// Each vertex with the next one.
fn pairs(line: &[Vertex]) -> impl Iterator<Item = (Vertex, Vertex)> + '_ {
    let next = line.iter().cycle().skip(1);
    line.iter().copied().zip(next.copied())
}

/// With vertices at a distance from each that is free, where an edge is long
/// enough for both of its ends; and others beyond, since an average reaches over
/// the next vertex.
fn supported(line: &[Vertex], reach: f64) -> Vec<Vertex> {
    let mut found = Vec::with_capacity(5 * line.len());
    for (a, b) in pairs(line) {
        found.push(a);
        let whole = dist(a.0, b.0);
        if whole > 2.0 * reach {
            let near = reach / whole;
            let next = (2.0 * near).min(0.5);
            let mut shares = Vec::new();
            if !a.1 {
                shares.extend([near, next]);
            }
            if !b.1 {
                shares.extend([1.0 - next, 1.0 - near]);
            }
            shares.dedup();
            found.extend(shares.into_iter().map(|t| (lerp(a.0, b.0, t), false)));
        }
    }
    found
}

/// One pass of doubling and averaging: the old vertices by 1/8, 6/8, 1/8, and the
/// middles of the edges.
fn averaged(line: &[Vertex]) -> Vec<Vertex> {
    let n = line.len();
    let mut found = Vec::with_capacity(2 * n);
    for k in 0..n {
        let (before, (at, stays), after) = (line[(k + n - 1) % n], line[k], line[(k + 1) % n]);
        let averaged = at * 0.75 + (before.0 + after.0) * 0.125;
        found.push((if stays { at } else { averaged }, stays));
        if !(stays && after.1) {
            found.push((lerp(at, after.0, 0.5), false));
        }
    }
    found
}

/// One pass of cutting corners off.
fn cut(line: &[Vertex]) -> Vec<Vertex> {
    let mut found = Vec::with_capacity(2 * line.len());
    for (a, b) in pairs(line) {
        if a.1 {
            found.push(a);
        } else {
            found.push((lerp(a.0, b.0, 0.25), false));
        }
        if !b.1 {
            found.push((lerp(a.0, b.0, 0.75), false));
        }
    }
    found
}

/// Corners as arcs. An arc takes no more than half of an edge, or all of it
/// where the other end stays as it is.
fn rounded(line: &[Vertex], radius: f64) -> Vec<Vertex> {
    let n = line.len();
    let mut found = Vec::with_capacity(4 * n);
    for k in 0..n {
        let (before, (at, stays), after) = (line[(k + n - 1) % n], line[k], line[(k + 1) % n]);
        let (u, v) = (unit(at - before.0), unit(after.0 - at));
        let turn = cross(u, v).atan2(dot(u, v));
        let half = (0.5 * turn.abs()).tan();
        if stays || radius <= 0.0 || turn.abs() < STRAIGHT {
            found.push((at, stays));
            continue;
        }
        let share = |other: Vertex| dist(at, other.0) * if other.1 { 1.0 } else { 0.5 };
        // A turn back on itself has no arc that begins on an edge.
        let taken = (radius * half).min(share(before)).min(share(after));
        let arc = taken / half;
        let inward = Coord { x: -u.y, y: u.x } * turn.signum();
        let (start, middle) = (at - u * taken, at - u * taken + inward * arc);
        let pieces = (turn.abs() / ARC - WHOLE).ceil().max(1.0);
        let spoke = start - middle;
        let step = |j: usize| {
            let (sin, cos) = (turn * j as f64 / pieces).sin_cos();
            middle
                + Coord {
                    x: spoke.x * cos - spoke.y * sin,
                    y: spoke.x * sin + spoke.y * cos,
                }
        };
        found.push((start, false));
        found.extend((1..pieces as usize).map(|j| (step(j), false)));
        found.push((at + v * taken, false));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{signed_area, Area};
    use geo_types::coord;

    fn square(side: f64) -> Ring {
        [(0., 0.), (0., side), (side, side), (side, 0.)]
            .map(|(x, y)| coord! { x: x, y: y })
            .to_vec()
    }

    fn free(ring: &[Coord<f64>]) -> Vec<bool> {
        vec![false; ring.len()]
    }

    fn size(ring: &[Coord<f64>]) -> f64 {
        signed_area(ring).abs()
    }

    #[test]
    fn corners_are_cut_at_a_quarter() {
        let ring = square(4.0);
        let found = smooth(&ring, &free(&ring), Smoothing::Chaikin(1), None);
        assert_eq!(found.len(), 8);
        // Four triangles of 1 x 1.
        assert!((size(&found) - 14.0).abs() < 1e-12);
        let found = smooth(&ring, &free(&ring), Smoothing::Chaikin(2), None);
        // Two points at a quarter of 2 along an edge and of its diagonal.
        assert_eq!(found.len(), 16);
        // Each corner of 135 degrees between 2 and sqrt 2 loses a triangle.
        let lost = 0.5 * 0.5 * (0.25 * 2f64.sqrt()) * (0.75 * std::f64::consts::PI).sin();
        assert!((size(&found) - (14.0 - 8.0 * lost)).abs() < 1e-12);
    }

    /// The cubic B-spline of a square's corners has a known area: each of its four
    /// pieces spans 61/720 of the square more than the triangle from the middle.
    #[test]
    fn averages_lead_to_the_spline() {
        let ring = square(1.0);
        let one = smooth(&ring, &free(&ring), Smoothing::Average(1), None);
        // Corners at 1/8, 1/8 and middles of edges.
        assert_eq!(one.len(), 8);
        assert!(dist(one[0], coord! { x: 0.125, y: 0.125 }) < 1e-12);
        let many = smooth(&ring, &free(&ring), Smoothing::Average(8), None);
        // The limit at a corner is (1, 4, 1) / 6 of it and its neighbours.
        let near = many
            .iter()
            .map(|&p| dist(p, coord! { x: 1. / 6., y: 1. / 6. }));
        assert!(near.fold(f64::MAX, f64::min) < 1e-4);
    }

    #[test]
    fn arcs_have_their_radius() {
        let ring = square(10.0);
        let found = smooth(&ring, &free(&ring), Smoothing::Round(2.0), None);
        for p in &found {
            let x = p.x.clamp(2.0, 8.0);
            let y = p.y.clamp(2.0, 8.0);
            let away = dist(*p, coord! { x: x, y: y });
            assert!((away - 2.0).abs() < 1e-9, "{p:?}");
        }
        // Without room for the radius: the largest circle, of 36 corners.
        let found = smooth(&ring, &free(&ring), Smoothing::Round(50.0), None);
        assert!((size(&found) - 18.0 * 25.0 * 10f64.to_radians().sin()).abs() < 1e-9);
    }

    #[test]
    fn pinned_vertices_stay() {
        let ring = square(8.0);
        let pinned = [true, true, false, false];
        for smoothing in [
            Smoothing::Average(3),
            Smoothing::Chaikin(3),
            Smoothing::Round(3.0),
        ] {
            let found = smooth(&ring, &pinned, smoothing, None);
            // The western edge is as it was, its ends next to each other.
            let at = found.iter().position(|p| *p == ring[0]).expect("stays");
            assert_eq!(found[(at + 1) % found.len()], ring[1], "{smoothing:?}");
            assert!(!found.contains(&ring[2]) && size(&found) < 64.0);
        }
    }

    #[test]
    fn reach_keeps_the_middle_of_long_edges() {
        let ring = square(100.0);
        for smoothing in [Smoothing::Average(4), Smoothing::Chaikin(4)] {
            let found = smooth(&ring, &free(&ring), smoothing, Some(4.0));
            let lost = 100.0 * 100.0 - size(&found);
            // Of the quadratic spline two thirds of a square metre for each corner,
            // of the cubic one twice as much; the triangle between the supports has
            // eight.
            let limit = if matches!(smoothing, Smoothing::Average(_)) {
                4.0
            } else {
                2.0
            };
            assert!((lost - 4.0 * limit / 3.0).abs() < 0.05, "{lost}");
            let straight = found.iter().filter(|p| p.x.abs() < 1e-12);
            let low = straight.map(|p| p.y).fold(f64::MAX, f64::min);
            assert!(low < 4.0 + 1e-12, "{low}");
            let area = Area::new(found, Vec::new());
            assert!(area.nearest(coord! { x: 0., y: 50. }).1 < 1e-12);
        }
    }
}
