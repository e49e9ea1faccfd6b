//! Segments in a spatial index: nearest, crossings, and stretches within reach.

use geo_types::{Coord, LineString};
use rstar::{PointDistance, RTree, RTreeObject, AABB};

use super::contact::{nearest, side};

/// A directed segment, with its place among the rings or lines it is from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    pub(crate) a: Coord<f64>,
    pub(crate) b: Coord<f64>,
    /// Ring or line, and position of `a` in it.
    pub(crate) id: (usize, usize),
    /// How far its influence reaches, in metres; 0 where it has none.
    pub(crate) reach: f64,
}

impl RTreeObject for Segment {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let (a, b, r) = (self.a, self.b, self.reach);
        AABB::from_corners(
            [a.x.min(b.x) - r, a.y.min(b.y) - r],
            [a.x.max(b.x) + r, a.y.max(b.y) + r],
        )
    }
}

impl PointDistance for Segment {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let p = Coord {
            x: point[0],
            y: point[1],
        };
        let q = nearest(p, self.a, self.b).1;
        let d = p - q;
        d.x * d.x + d.y * d.y
    }
}

/// An immutable set of segments.
#[derive(Clone, Debug)]
pub(crate) struct Segments(RTree<Segment>);

impl Segments {
    pub(crate) fn new(segments: Vec<Segment>) -> Self {
        Self(RTree::bulk_load(segments))
    }

    /// The segments of lines (closed rings are closed lines), each with a reach.
    pub(crate) fn from_lines<'a>(lines: impl Iterator<Item = (&'a LineString<f64>, f64)>) -> Self {
        let segments = lines
            .enumerate()
            .flat_map(|(id, (line, reach))| {
                line.0.windows(2).enumerate().map(move |(k, w)| Segment {
                    a: w[0],
                    b: w[1],
                    id: (id, k),
                    reach,
                })
            })
            .collect();
        Self::new(segments)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.size() == 0
    }

    /// The nearest segment, with the parameter and point on it. Among equals
    /// the one with the lowest id, so that the answer is no accident of the tree.
    pub(crate) fn nearest(&self, p: Coord<f64>) -> Option<(Segment, f64, Coord<f64>)> {
        let mut best: Option<(f64, Segment)> = None;
        for (segment, d2) in self.0.nearest_neighbor_iter_with_distance_2(&[p.x, p.y]) {
            match best {
                Some((least, _)) if d2 > least => break,
                Some((_, found)) if found.id < segment.id => {}
                _ => best = Some((d2, *segment)),
            }
        }
        let (_, segment) = best?;
        let (t, q) = nearest(p, segment.a, segment.b);
        Some((segment, t, q))
    }

    /// The distance to the nearest segment; infinite when there is none.
    pub(crate) fn distance(&self, p: Coord<f64>) -> f64 {
        let point = [p.x, p.y];
        let near = self.0.nearest_neighbor(&point);
        near.map_or(f64::INFINITY, |s| s.distance_2(&point).sqrt())
    }

    /// Whether any segment's reach covers the point.
    pub(crate) fn covers(&self, p: Coord<f64>) -> bool {
        let point = [p.x, p.y];
        self.0
            .locate_in_envelope_intersecting(&AABB::from_point(point))
            .any(|s| s.distance_2(&point) <= s.reach * s.reach)
    }

    /// The segments whose box comes within `margin` of the box of `p q`, in the
    /// order of their ids.
    pub(crate) fn near(&self, p: Coord<f64>, q: Coord<f64>, margin: f64) -> Vec<Segment> {
        let around = Segment {
            a: p,
            b: q,
            id: (0, 0),
            reach: margin,
        };
        let mut near: Vec<Segment> = self
            .0
            .locate_in_envelope_intersecting(&around.envelope())
            .copied()
            .collect();
        near.sort_unstable_by_key(|s| s.id);
        near
    }

    /// The stretches of `p q` within a segment's reach, or within `reach` of a
    /// segment when it is given: disjoint intervals of its parameter, ascending.
    pub(crate) fn stretches(
        &self,
        p: Coord<f64>,
        q: Coord<f64>,
        reach: Option<f64>,
    ) -> Vec<(f64, f64)> {
        let found = self
            .near(p, q, reach.unwrap_or(0.0))
            .iter()
            .filter_map(|s| within(p, q, s.a, s.b, reach.unwrap_or(s.reach)))
            .collect();
        merged(found)
    }

    /// Whether a point lies inside the closed rings that the segments form, by
    /// the parity of the segments that an eastward ray crosses.
    pub(crate) fn encloses(&self, p: Coord<f64>) -> bool {
        let ray = AABB::from_corners([p.x, p.y], [f64::MAX, p.y]);
        let crossed = self
            .0
            .locate_in_envelope_intersecting(&ray)
            .filter(|s| {
                let (low, high) = if s.a.y < s.b.y {
                    (s.a, s.b)
                } else {
                    (s.b, s.a)
                };
                low.y <= p.y && p.y < high.y && side(low, high, p) > 0.0
            })
            .count();
        crossed % 2 == 1
    }
}

/// Joins intervals that overlap or touch.
pub(crate) fn merged(mut intervals: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut out: Vec<(f64, f64)> = Vec::new();
    for (low, high) in intervals {
        match out.last_mut() {
            Some(last) if low <= last.1 => last.1 = last.1.max(high),
            _ => out.push((low, high)),
        }
    }
    out
}

/// The parameters between which the segment `p q` lies within `reach` of the
/// segment `a b`. That set, a stadium, is convex: one interval says it all.
fn within(
    p: Coord<f64>,
    q: Coord<f64>,
    a: Coord<f64>,
    b: Coord<f64>,
    reach: f64,
) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut add = |found: Option<(f64, f64)>| {
        if let Some((from, to)) = found {
            low = low.min(from);
            high = high.max(to);
        }
    };
    add(within_disk(p, q, a, reach));
    add(within_disk(p, q, b, reach));
    // The rectangle between the two disks: clip by its two pairs of sides.
    let d = b - a;
    let length = d.x.hypot(d.y);
    if length > 0.0 {
        let (ux, uy) = (d.x / length, d.y / length);
        let along = |c: Coord<f64>| (c - a).x * ux + (c - a).y * uy;
        let across = |c: Coord<f64>| (c - a).y * ux - (c - a).x * uy;
        let first = between(along(p), along(q), 0.0, length);
        let second = between(across(p), across(q), -reach, reach);
        if let (Some((a, b)), Some((c, d))) = (first, second) {
            let (from, to) = (a.max(c), b.min(d));
            add((from <= to).then_some((from, to)));
        }
    }
    (low <= high).then_some((low, high))
}

/// Where the linear function from `v0` to `v1` lies in an interval.
fn between(v0: f64, v1: f64, low: f64, high: f64) -> Option<(f64, f64)> {
    let d = v1 - v0;
    if d == 0.0 {
        return (low <= v0 && v0 <= high).then_some((0.0, 1.0));
    }
    let (s, t) = ((low - v0) / d, (high - v0) / d);
    let (s, t) = (s.min(t).max(0.0), s.max(t).min(1.0));
    (s <= t).then_some((s, t))
}

fn within_disk(p: Coord<f64>, q: Coord<f64>, centre: Coord<f64>, r: f64) -> Option<(f64, f64)> {
    let (d, f) = (q - p, p - centre);
    let a = d.x * d.x + d.y * d.y;
    let c = f.x * f.x + f.y * f.y - r * r;
    if a == 0.0 {
        return (c <= 0.0).then_some((0.0, 1.0));
    }
    let half = f.x * d.x + f.y * d.y;
    let discriminant = half * half - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let (s, t) = (((-half - root) / a).max(0.0), ((-half + root) / a).min(1.0));
    (s <= t).then_some((s, t))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> Coord<f64> {
        Coord { x, y }
    }

    #[test]
    fn the_stadium_interval_agrees_with_sampling() {
        let cases = [
            (at(-10.0, 1.0), at(30.0, 1.5), at(0.0, 0.0), at(9.0, 3.0)),
            (at(3.0, -10.0), at(4.0, 10.0), at(0.0, 0.0), at(9.0, 0.0)),
            (at(0.0, 0.0), at(9.0, 0.0), at(0.0, 0.0), at(9.0, 0.0)),
            (at(-5.0, 9.0), at(5.0, 9.0), at(0.0, 0.0), at(0.0, 0.0)),
        ];
        for (p, q, a, b) in cases {
            for reach in [0.5, 2.0, 9.5] {
                let found = within(p, q, a, b, reach);
                for k in 0..=1000 {
                    let t = f64::from(k) / 1000.0;
                    let x = p + (q - p) * t;
                    let y = nearest(x, a, b).1;
                    let d = (x - y).x.hypot((x - y).y);
                    let says = found.is_some_and(|(s, e)| s <= t && t <= e);
                    assert!(
                        says == (d <= reach) || (d - reach).abs() < 1e-9,
                        "{t} {d} {reach}"
                    );
                }
            }
        }
    }

    #[test]
    fn enclosing_by_index_agrees_with_the_plain_count() {
        let ring: Vec<Coord<f64>> = (0..37)
            .map(|k| {
                let (angle, r) = (
                    f64::from(k) / 37.0 * std::f64::consts::TAU,
                    5.0 + f64::from(k * 7 % 5),
                );
                at(r * angle.cos(), r * angle.sin())
            })
            .collect();
        let mut closed = ring.clone();
        closed.push(ring[0]);
        let line = LineString(closed);
        let index = Segments::from_lines(std::iter::once((&line, 0.0)));
        for i in -10..=10 {
            for j in -10..=10 {
                let p = at(f64::from(i) * 1.01, f64::from(j) * 0.99);
                assert_eq!(index.encloses(p), super::super::contact::inside(&ring, p));
            }
        }
    }

    #[test]
    fn intervals_merge() {
        let found = merged(vec![(0.5, 0.7), (0.0, 0.2), (0.1, 0.3), (0.7, 0.8)]);
        assert_eq!(found, [(0.0, 0.3), (0.5, 0.8)]);
    }
}
