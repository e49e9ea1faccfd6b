//! Corners of a polygon of any shape, by length and angle.

use geo_types::Coord;

use super::Thresholds;
use crate::plane::{cross, dist, dot, Line, Ring};

/// The vertices that are corners, in the order of the ring.
///
/// Vertices are given up until those that are left turn enough, and the lines
/// between them are long enough: first the one that turns least, of chords to its
/// neighbours, then the shortest line. A line that is too short is a corner cut
/// off or rounded: the vertex of it that lies nearest to where its neighbours
/// meet takes its place.
pub(super) fn corners(ring: &Ring, thresholds: &Thresholds) -> Vec<usize> {
    let n = ring.len();
    let perimeter: f64 = crate::plane::sides(ring).map(|(a, b)| dist(a, b)).sum();
    let least = thresholds.length * perimeter;
    let mut kept: Vec<usize> = (0..n).collect();
    while kept.len() > 3 {
        let m = kept.len();
        let at = |k: usize| ring[kept[k % m]];
        let turn = |k: usize| {
            let (a, b, c) = (at(k + m - 1), at(k), at(k + 1));
            cross(b - a, c - b).atan2(dot(b - a, c - b)).abs()
        };
        let flattest = (0..m)
            .map(|k| (k, turn(k)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = flattest.filter(|(_, turn)| *turn < thresholds.angle) {
            kept.remove(k);
            continue;
        }
        let length = |k: usize| dist(at(k), at(k + 1));
        let shortest = (0..m)
            .map(|k| (k, length(k)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((k, _)) = shortest.filter(|(_, length)| *length < least) else {
            break;
        };
        let corner = merged(
            ring,
            [at(k + m - 1), at(k), at(k + 1), at(k + 2)],
            kept[k],
            kept[(k + 1) % m],
        );
        let next = (k + 1) % m;
        kept[k] = corner;
        kept.remove(next);
        kept.sort_unstable();
    }
    kept
}

/// Vertices are as near as each other if they differ by less, as a share of the
/// line that is given up.
const TIE: f64 = 1e-9;

/// The vertex from `first` to `last` that is nearest to where the lines beside
/// them meet; of several the one that turns most, so that no rounding decides.
fn merged(ring: &Ring, [a, b, c, d]: [Coord<f64>; 4], first: usize, last: usize) -> usize {
    let n = ring.len();
    let meeting = Line::new(a, b - a)
        .meets(&Line::new(c, d - c))
        // Lines that hardly meet have no say.
        .filter(|&p| dist(p, b) < 10.0 * dist(b, c))
        .unwrap_or((b + c) / 2.0);
    let count = (last + n - first) % n;
    let away = |k: usize| dist(ring[k], meeting);
    let turn = |k: usize| {
        let [u, v] = [ring[k] - ring[(k + n - 1) % n], ring[(k + 1) % n] - ring[k]];
        cross(u, v).atan2(dot(u, v)).abs()
    };
    let between = || (0..=count).map(|k| (first + k) % n);
    let least = between().map(away).fold(f64::INFINITY, f64::min);
    let tied = between().filter(|&k| away(k) <= least + TIE * dist(b, c));
    tied.max_by(|&i, &j| turn(i).total_cmp(&turn(j)))
        .unwrap_or(first)
}
