//! Strips along the boundary of an area, and lines at a distance from it.
//!
//! Lines have the land on their right. A strip is built on that side alone, from
//! a quadrangle for each segment and a wedge at each vertex where the land is
//! more than half a turn; at other vertices the quadrangles meet by themselves,
//! in a mitre. A line at a distance is the border of what a strip leaves, so that
//! it has no loops where the land is narrow.

use geo_types::Coord;

use super::{cross, difference, dist, dot, lerp, nearest_on, right, sides, unit, Area};

/// Arcs turn by this much at each vertex at most, radians.
const ARC: f64 = std::f64::consts::PI / 18.0;

/// Vertices that turn by less may as well not turn at all, radians.
pub(super) const STRAIGHT: f64 = 1e-9;

/// A whole number of pieces is one, whatever rounding makes of it.
const WHOLE: f64 = 1e-6;

/// A mitre reaches this many widths at most; beyond, the corner is round.
pub(super) const REACH: f64 = 4.0;

/// Distances this near are the same, as a share of them.
const SAME: f64 = 1e-7;

/// Shares of a distance to be kept that are rounding: less than what counts as
/// room for a footprint forgives.
const ROUNDING: f64 = 5e-10;

/// How a strip goes round a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Corner {
    Round,
    Mitre,
}

fn closed(line: &[Coord<f64>]) -> bool {
    line.len() > 3 && line.first() == line.last()
}

/// What lies within `width` to the right of a line; several areas that overlap.
pub(crate) fn strip(line: &[Coord<f64>], width: f64, corner: Corner) -> Vec<Area> {
    let mut areas = Vec::new();
    if width <= 0.0 {
        return areas;
    }
    let mut line: Vec<Coord<f64>> = line.to_vec();
    line.dedup();
    for pair in line.windows(2) {
        let aside = right(unit(pair[1] - pair[0])) * width;
        let quad = vec![pair[0], pair[1], pair[1] + aside, pair[0] + aside];
        areas.push(Area::new(quad, Vec::new()));
    }
    let n = line.len();
    let mut joints: Vec<[Coord<f64>; 3]> = line.windows(3).map(|w| [w[0], w[1], w[2]]).collect();
    if closed(&line) {
        joints.push([line[n - 2], line[0], line[1]]);
    }
    for [before, at, after] in joints {
        let (u, v) = (unit(at - before), unit(after - at));
        let turn = cross(u, v).atan2(dot(u, v));
        // However little: without a wedge a slit would be left.
        if turn > 0.0 {
            areas.push(Area::new(
                wedge(at, [right(u), right(v)], turn, width, corner),
                Vec::new(),
            ));
        }
    }
    areas
}

/// The land within half of `width` of an open line, with mitred corners: areas that
/// overlap.
///
/// A line of many short segments has smooth borders so, where discs at its vertices
/// would leave notches.
pub(crate) fn ribbon(line: &[Coord<f64>], width: f64) -> Vec<Area> {
    let half = 0.5 * width;
    let mut areas = Vec::new();
    for pair in line.windows(2) {
        let aside = right(unit(pair[1] - pair[0])) * half;
        // With the line's own vertices, which wedges have too.
        let quad = vec![
            pair[0] - aside,
            pair[1] - aside,
            pair[1],
            pair[1] + aside,
            pair[0] + aside,
            pair[0],
        ];
        areas.push(Area::new(quad, Vec::new()));
    }
    for joint in line.windows(3) {
        let (u, v) = (unit(joint[1] - joint[0]), unit(joint[2] - joint[1]));
        let turn = cross(u, v).atan2(dot(u, v));
        // Outside of the turn, walked so that it lies on the right; on both sides
        // where the line goes straight on, lest rounding leave a slit.
        for (from, to, turn) in [(u, v, turn), (-v, -u, -turn)] {
            if turn > -STRAIGHT {
                let sides = [right(from), right(to)];
                let ring = wedge(joint[1], sides, turn.max(0.0), half, Corner::Mitre);
                areas.push(Area::new(ring, Vec::new()));
            }
        }
    }
    areas
}

/// The land beside a vertex between the ends of two quadrangles: with their
/// corners to the last digit, so that no slit is left.
pub(super) fn wedge(
    at: Coord<f64>,
    [from, to]: [Coord<f64>; 2],
    turn: f64,
    width: f64,
    corner: Corner,
) -> Vec<Coord<f64>> {
    let turned = |angle: f64| Coord {
        x: from.x * angle.cos() - from.y * angle.sin(),
        y: from.x * angle.sin() + from.y * angle.cos(),
    };
    let half = (0.5 * turn).cos();
    let mut ring = vec![at];
    if corner == Corner::Mitre && half * REACH > 1.0 {
        ring.extend([
            at + from * width,
            at + turned(0.5 * turn) * (width / half),
            at + to * width,
        ]);
    } else {
        let pieces = (turn / ARC - WHOLE).ceil().max(1.0);
        let count = pieces as usize;
        ring.extend((0..count).map(|k| at + turned(turn * k as f64 / pieces) * width));
        ring.push(at + to * width);
    }
    ring
}

/// The lines so far to the right of others as the area has room for them, with
/// the land on their right; a whole ring ends where it began.
pub(crate) fn inset_lines(
    area: &Area,
    lines: &[Vec<Coord<f64>>],
    offset: f64,
) -> Vec<Vec<Coord<f64>>> {
    if offset <= 0.0 {
        return lines.to_vec();
    }
    let band: Vec<Area> = lines
        .iter()
        .flat_map(|line| strip(line, offset, Corner::Round))
        .collect();
    let away = |p: Coord<f64>| {
        let pieces = lines.iter().flat_map(|line| line.windows(2));
        pieces
            .map(|pair| dist(nearest_on(pair[0], pair[1], p), p))
            .fold(f64::INFINITY, f64::min)
    };
    // The chord of an arc comes this much nearer.
    let chord = offset * (0.5 * ARC).cos();
    let at_offset = |p: Coord<f64>| {
        let far = away(p);
        far >= chord - SAME * offset && far <= offset * (1.0 + SAME)
    };
    let mut found = Vec::new();
    for rest in difference(std::slice::from_ref(area), &band) {
        for ring in rest.rings() {
            let on: Vec<bool> = sides(ring)
                .map(|(a, b)| at_offset(a) && at_offset(b) && at_offset(lerp(a, b, 0.5)))
                .collect();
            found.extend(runs(ring, &on));
        }
    }
    found
        .into_iter()
        .map(|line| smooth(line, SAME * offset))
        .collect()
}

/// Without steps no longer than `tiny`.
fn smooth(line: Vec<Coord<f64>>, tiny: f64) -> Vec<Coord<f64>> {
    let last = line.last().copied();
    let mut kept: Vec<Coord<f64>> = Vec::with_capacity(line.len());
    for at in line {
        if kept.last().is_none_or(|&before| dist(before, at) > tiny) {
            kept.push(at);
        }
    }
    // The last one stays, and lines that come round are closed.
    let first = kept.first().copied();
    let round = kept.len() > 3 && first.zip(last).is_some_and(|(a, b)| dist(a, b) <= tiny);
    if let (Some(end), Some(last)) = (kept.last_mut(), if round { first } else { last }) {
        *end = last;
    }
    kept
}

/// The lines that the edges of a ring for which `on` holds make up.
fn runs(ring: &[Coord<f64>], on: &[bool]) -> Vec<Vec<Coord<f64>>> {
    let n = ring.len();
    let Some(gap) = (0..n).find(|&k| !on[k]) else {
        let mut whole = ring.to_vec();
        whole.extend(ring.first());
        return vec![whole];
    };
    let mut lines: Vec<Vec<Coord<f64>>> = Vec::new();
    let mut open = false;
    for k in (gap..gap + n).map(|k| k % n) {
        if on[k] {
            let end = ring[(k + 1) % n];
            match lines.last_mut().filter(|_| open) {
                Some(line) => line.push(end),
                None => lines.push(vec![ring[k], end]),
            }
        }
        open = on[k];
    }
    lines
}

/// Two ends.
pub(crate) type Segment = (Coord<f64>, Coord<f64>);

/// The parts of a line that keep a distance from all of some segments.
pub(crate) fn keep_apart(
    line: &[Coord<f64>],
    edges: &[Segment],
    distance: f64,
) -> Vec<Vec<Coord<f64>>> {
    let mut parts: Vec<Vec<Coord<f64>>> = Vec::new();
    let distance = distance * (1.0 - ROUNDING);
    // Whether the last part reaches the point where the next segment begins.
    let mut open = false;
    for pair in line.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let mut free: Vec<[f64; 2]> = vec![[0.0, 1.0]];
        for &(a, b) in edges {
            let Some([from, to]) = near(p, q, a, b, distance) else {
                continue;
            };
            free = free
                .into_iter()
                .flat_map(|[low, high]| [[low, high.min(from)], [low.max(to), high]])
                .filter(|[low, high]| high > low)
                .collect();
        }
        let mut reaches = false;
        for [low, high] in free {
            let end = lerp(p, q, high);
            match parts.last_mut().filter(|_| open && low == 0.0) {
                Some(part) => part.push(end),
                None => parts.push(vec![lerp(p, q, low), end]),
            }
            reaches = high == 1.0;
        }
        open = reaches;
    }
    // What a closed line was cut into may go on over its beginning.
    let over = closed(line) && open && parts.len() > 1 && parts[0].first() == line.first();
    if over {
        let first = parts.remove(0);
        if let Some(last) = parts.last_mut() {
            last.extend(first.into_iter().skip(1));
        }
    }
    parts
}

/// Between which shares of the way from `p` to `q` one is nearer than `distance`
/// to the segment from `a` to `b`: an interval, since what is near to a segment
/// is convex.
fn near(
    p: Coord<f64>,
    q: Coord<f64>,
    a: Coord<f64>,
    b: Coord<f64>,
    distance: f64,
) -> Option<[f64; 2]> {
    let d = q - p;
    let square = dot(d, d);
    if square == 0.0 || distance <= 0.0 {
        return None;
    }
    let mut ends: Vec<f64> = Vec::new();
    for centre in [a, b] {
        // |p + t d - centre| = distance
        let to = p - centre;
        let half = dot(to, d) / square;
        let rest = (dot(to, to) - distance * distance) / square;
        let root = half * half - rest;
        if root >= 0.0 {
            ends.extend([-half - root.sqrt(), -half + root.sqrt()]);
        }
    }
    let normal = right(unit(b - a));
    let (slope, from) = (dot(d, normal), dot(p - a, normal));
    if slope != 0.0 {
        ends.extend([(distance - from) / slope, (-distance - from) / slope]);
    }
    let tiny = 1e-6 * distance;
    let on = |t: &f64| {
        let x = lerp(p, q, *t);
        t.is_finite() && (dist(nearest_on(a, b, x), x) - distance).abs() <= tiny
    };
    ends.retain(on);
    let from = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let to = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // What touches only is not near.
    (to - from > 1e-12 && to > 0.0 && from < 1.0).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn edges(area: &Area) -> Vec<Segment> {
        sides(&area.outer).collect()
    }

    #[test]
    fn lines_are_drawn_in() {
        let square = area(&[(0., 0.), (0., 4.), (4., 4.), (4., 0.)]);
        let mut ring = square.outer.clone();
        ring.push(ring[0]);
        let lines = inset_lines(&square, &[ring], 1.0);
        assert_eq!(lines.len(), 1);
        assert!((super::super::length(&lines[0]) - 8.0).abs() < 1e-9);
        // The western side alone: the line reaches both neighbours.
        let west = vec![coord! { x: 0., y: 0. }, coord! { x: 0., y: 4. }];
        let lines = inset_lines(&square, &[west], 1.0);
        assert_eq!(lines, [[coord! { x: 1., y: 0. }, coord! { x: 1., y: 4. }]]);
        let kept = keep_apart(&lines[0], &edges(&square), 0.5);
        assert_eq!(kept.len(), 1);
        assert!((kept[0][0].y - 0.5).abs() < 1e-6 && (kept[0][1].y - 3.5).abs() < 1e-6);
    }

    #[test]
    fn corners_are_round_or_mitred() {
        // Two sides that meet in a corner of three quarters of a turn.
        let line: Vec<Coord<f64>> = [(0., 4.), (0., 0.), (-4., 0.)]
            .map(|(x, y)| coord! { x: x, y: y })
            .to_vec();
        let line: Vec<Coord<f64>> = line.into_iter().rev().collect();
        let size = |corner| -> f64 {
            let all = super::super::union(&strip(&line, 1.0, corner));
            all.iter().map(Area::size).sum()
        };
        assert!((size(Corner::Mitre) - 9.0).abs() < 1e-9);
        // A quarter of a polygon of 36 corners.
        let round = 8.0 + 9.0 * 0.5 * ARC.sin();
        assert!((size(Corner::Round) - round).abs() < 1e-9);
    }

    /// Vertices on a straight line, as booleans leave them there, turn by rounding.
    #[test]
    fn vertices_that_hardly_turn_leave_no_slits() {
        let bent = [3e-10, -3e-10, 1e-10].iter().zip(1..);
        let mut line = vec![coord! { x: 0., y: 0. }];
        line.extend(bent.map(|(&x, y)| coord! { x: x, y: f64::from(y) }));
        line.push(coord! { x: 0., y: 4. });
        let band = super::super::union(&strip(&line, 1.0, Corner::Round));
        assert_eq!(band.len(), 1);
        let square = area(&[(0., 0.), (0., 4.), (4., 4.), (4., 0.)]);
        assert_eq!(inset_lines(&square, &[line], 1.0).len(), 1);
    }

    #[test]
    fn distances_are_kept() {
        let square = area(&[(0., 0.), (0., 4.), (4., 4.), (4., 0.)]);
        let line = [coord! { x: 0., y: 2. }, coord! { x: 4., y: 2. }];
        let kept = keep_apart(&line, &edges(&square), 1.0);
        assert_eq!(kept.len(), 1, "{kept:?}");
        assert!((kept[0][0].x - 1.0).abs() < 1e-6 && (kept[0][1].x - 3.0).abs() < 1e-6);
        assert!(keep_apart(&line, &edges(&square), 2.5).is_empty());
    }
}
