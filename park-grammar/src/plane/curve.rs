//! Curves through points, as lines of short segments.

use geo_types::Coord;

use super::{dist, lerp, right, unit};

/// Segments of a curve between two points, at least.
const FEWEST: usize = 8;

/// Segments of a curve between two points, at most.
const MOST: usize = 400;

/// Arcs turn by this much at each vertex at most, radians.
const ARC: f64 = std::f64::consts::PI / 18.0;

/// How a line goes from point to point; lengths to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Course {
    Straight,
    /// A centripetal Catmull-Rom spline through all points.
    Smooth,
    /// An arc from each point to the next, so far from the chord in its middle.
    Arc(f64),
    /// A sine from each point to the next: amplitude, and waves.
    Sinus(f64, usize),
}

/// The line through points.
pub(crate) fn curve(points: &[Coord<f64>], course: Course) -> Vec<Coord<f64>> {
    let mut line: Vec<Coord<f64>> = points.first().copied().into_iter().collect();
    for (k, pair) in points.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let chord = dist(a, b);
        let left = -right(unit(b - a));
        match course {
            Course::Straight => {}
            Course::Smooth => line.extend(spline(points, k)),
            Course::Arc(bulge) => {
                // Half of the angle that it turns by.
                let half = 2.0 * (2.0 * bulge / chord).atan();
                let pieces = count(2.0 * half.abs() / ARC);
                let at = |t: f64| {
                    // The chord from the start to a point of the arc turns evenly.
                    let turned = half * (1.0 - t);
                    let reach = chord * (half * t).sin() / half.sin();
                    a + (unit(b - a) * turned.cos() + left * turned.sin()) * reach
                };
                if half != 0.0 {
                    line.extend((1..pieces).map(|j| at(j as f64 / pieces as f64)));
                }
            }
            Course::Sinus(amplitude, waves) => {
                let pieces = count(waves as f64 * std::f64::consts::TAU / ARC);
                let at = |j: usize| {
                    let t = j as f64 / pieces as f64;
                    let wave = (t * waves as f64 * std::f64::consts::TAU).sin();
                    lerp(a, b, t) + left * (amplitude * wave)
                };
                line.extend((1..pieces).map(at));
            }
        }
        line.push(b);
    }
    line.dedup();
    line
}

fn count(pieces: f64) -> usize {
    // A whole number is one, whatever rounding makes of it.
    ((pieces - 1e-6).ceil() as usize).clamp(FEWEST, MOST)
}

/// What lies between point `k` and the next, by Barry and Goldman's pyramid with
/// the square roots of distances as knots: it has no loops however unevenly the
/// points lie.
fn spline(points: &[Coord<f64>], k: usize) -> Vec<Coord<f64>> {
    let (b, c) = (points[k], points[k + 1]);
    // Beyond the ends the curve goes on as a mirror image.
    let a = k.checked_sub(1).map_or(b * 2.0 - c, |k| points[k]);
    let d = points.get(k + 2).copied().unwrap_or(c * 2.0 - b);
    let knot = |p: Coord<f64>, q: Coord<f64>| dist(p, q).sqrt().max(1e-9);
    let t1 = knot(a, b);
    let t2 = t1 + knot(b, c);
    let t3 = t2 + knot(c, d);
    let pieces = 16;
    let between = |p: Coord<f64>, q: Coord<f64>, from: f64, to: f64, t: f64| {
        lerp(p, q, (t - from) / (to - from))
    };
    let at = |j: usize| {
        let t = t1 + (t2 - t1) * j as f64 / f64::from(pieces);
        let (ab, bc, cd) = (
            between(a, b, 0.0, t1, t),
            between(b, c, t1, t2, t),
            between(c, d, t2, t3, t),
        );
        let (abc, bcd) = (between(ab, bc, 0.0, t2, t), between(bc, cd, t1, t3, t));
        between(abc, bcd, t1, t2, t)
    };
    (1..pieces as usize).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    const ENDS: [Coord<f64>; 2] = [Coord { x: 0.0, y: 0.0 }, Coord { x: 10.0, y: 0.0 }];

    #[test]
    fn arcs_bulge_to_the_left() {
        // Half a circle around the middle.
        let line = curve(&ENDS, Course::Arc(5.0));
        let middle = coord! { x: 5., y: 0. };
        assert!(line
            .iter()
            .all(|&p| (dist(p, middle) - 5.0).abs() < 1e-9 && p.y > -1e-9));
        let line = curve(&ENDS, Course::Arc(-1.0));
        let low = line.iter().map(|p| p.y).fold(0.0, f64::min);
        assert!((low + 1.0).abs() < 1e-9, "{low}");
    }

    #[test]
    fn waves_swing_to_both_sides() {
        let line = curve(&ENDS, Course::Sinus(2.0, 1));
        let high = line.iter().map(|p| p.y).fold(0.0, f64::max);
        let low = line.iter().map(|p| p.y).fold(0.0, f64::min);
        assert!((high - 2.0).abs() < 1e-9 && (low + 2.0).abs() < 1e-9);
        assert_eq!(line.last(), Some(&ENDS[1]));
    }

    #[test]
    fn splines_go_through_their_points() {
        let points = [(0., 0.), (1., 5.), (9., 6.), (10., 0.)].map(|(x, y)| coord! { x: x, y: y });
        let line = curve(&points, Course::Smooth);
        assert!(points.iter().all(|p| line.contains(p)));
        assert_eq!(line.len(), 3 * 16 + 1);
        // Points on a line stay on it.
        let flat = [(0., 0.), (1., 1.), (9., 9.)].map(|(x, y)| coord! { x: x, y: y });
        assert!(curve(&flat, Course::Smooth)
            .iter()
            .all(|p| (p.x - p.y).abs() < 1e-12));
    }
}
