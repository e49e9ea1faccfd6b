//! Small planar geometry that the other rooms share; nothing here is public.

use geo_types::Coord;

/// Point or vector, metres.
pub(crate) type P = Coord<f64>;

pub(crate) fn p(x: f64, y: f64) -> P {
    Coord { x, y }
}

/// Whether `a` exceeds `b`; false, as wanted at every check, if one is NaN.
pub(crate) fn exceeds(a: f64, b: f64) -> bool {
    a > b
}

pub(crate) fn dot(a: P, b: P) -> f64 {
    a.x * b.x + a.y * b.y
}

pub(crate) fn cross(a: P, b: P) -> f64 {
    a.x * b.y - a.y * b.x
}

pub(crate) fn norm(a: P) -> f64 {
    a.x.hypot(a.y)
}

pub(crate) fn dist(a: P, b: P) -> f64 {
    norm(a - b)
}

/// Quarter turn to the left.
pub(crate) fn left(a: P) -> P {
    p(-a.y, a.x)
}

/// Signed angle from `a` to `b`, radians, in (-pi, pi].
pub(crate) fn turn(a: P, b: P) -> f64 {
    cross(a, b).atan2(dot(a, b))
}

/// Twice-halved shoelace: positive for counter-clockwise rings. Taken relative
/// to the first vertex, so that a ring far from the origin loses no digits.
pub(crate) fn signed_area(ring: &[P]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    let mut sum = 0.0;
    for i in 1..ring.len().saturating_sub(1) {
        sum += cross(ring[i] - o, ring[i + 1] - o);
    }
    0.5 * sum
}

/// Centre of the bounding box: the local origin of all work on a region.
pub(crate) fn box_centre(points: &[P]) -> P {
    let mut lo = p(f64::INFINITY, f64::INFINITY);
    let mut hi = p(f64::NEG_INFINITY, f64::NEG_INFINITY);
    for q in points {
        lo = p(lo.x.min(q.x), lo.y.min(q.y));
        hi = p(hi.x.max(q.x), hi.y.max(q.y));
    }
    (lo + hi) * 0.5
}

/// Parameter in [0, 1] of the point of segment `a b` nearest to `q`, and the
/// squared distance to it.
pub(crate) fn project(q: P, a: P, b: P) -> (f64, f64) {
    let d = b - a;
    let len2 = dot(d, d);
    let t = if len2 > 0.0 {
        (dot(q - a, d) / len2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let r = q - (a + d * t);
    (t, dot(r, r))
}

/// Whether segments `a b` and `c d` share a point.
pub(crate) fn segments_touch(a: P, b: P, c: P, d: P) -> bool {
    // Boxes first: nearly all pairs end here.
    if a.x.max(b.x) < c.x.min(d.x)
        || c.x.max(d.x) < a.x.min(b.x)
        || a.y.max(b.y) < c.y.min(d.y)
        || c.y.max(d.y) < a.y.min(b.y)
    {
        return false;
    }
    let d1 = cross(b - a, c - a);
    let d2 = cross(b - a, d - a);
    let d3 = cross(d - c, a - c);
    let d4 = cross(d - c, b - c);
    (d1 <= 0.0 || d2 <= 0.0)
        && (d1 >= 0.0 || d2 >= 0.0)
        && (d3 <= 0.0 || d4 <= 0.0)
        && (d3 >= 0.0 || d4 >= 0.0)
}

/// First pair of edges of the ring that cross or touch although they are not
/// neighbours, or that fold back onto their neighbour.
///
/// Sorted by x, so that rings with many vertices stay near O(n log n).
pub(crate) fn self_contact(ring: &[P]) -> Option<(usize, usize)> {
    let n = ring.len();
    let at = |i: usize| ring[i % n];
    for i in 0..n {
        let (u, v) = (at(i + 1) - at(i), at(i + 2) - at(i + 1));
        if cross(u, v).abs() <= 1e-14 * norm(u) * norm(v) && dot(u, v) < 0.0 {
            return Some((i, (i + 1) % n));
        }
    }
    let low = |i: usize| at(i).x.min(at(i + 1).x);
    let high = |i: usize| at(i).x.max(at(i + 1).x);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| low(i).total_cmp(&low(j)).then(i.cmp(&j)));
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            if low(j) > high(i) {
                break;
            }
            if (i + 1) % n == j || (j + 1) % n == i {
                continue;
            }
            if segments_touch(at(i), at(i + 1), at(j), at(j + 1)) {
                return Some((i.min(j), i.max(j)));
            }
        }
    }
    None
}

/// A polyline with its arc length.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    /// At least two vertices.
    pub(crate) points: Vec<P>,
    /// Arc length at each vertex, from 0.
    pub(crate) along: Vec<f64>,
}

impl Path {
    pub(crate) fn new(points: Vec<P>) -> Self {
        let mut along = Vec::with_capacity(points.len());
        let mut sum = 0.0;
        for (i, &q) in points.iter().enumerate() {
            if i > 0 {
                sum += dist(points[i - 1], q);
            }
            along.push(sum);
        }
        Self { points, along }
    }

    pub(crate) fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// Index of the segment that holds arc length `s`.
    fn segment(&self, s: f64) -> usize {
        let last = self.points.len() - 2;
        self.along
            .partition_point(|&a| a <= s)
            .saturating_sub(1)
            .min(last)
    }

    /// Point at arc length `s`; the vertices themselves come back bit for bit.
    pub(crate) fn at(&self, s: f64) -> P {
        let i = self.segment(s);
        let (s0, s1) = (self.along[i], self.along[i + 1]);
        if s <= s0 {
            return self.points[i];
        }
        if s >= s1 {
            return self.points[i + 1];
        }
        let (a, b) = (self.points[i], self.points[i + 1]);
        a + (b - a) * ((s - s0) / (s1 - s0))
    }

    /// Arc length of the point nearest to `q`; the lowest one among equals.
    pub(crate) fn nearest(&self, q: P) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for i in 0..self.points.len() - 1 {
            let (t, d2) = project(q, self.points[i], self.points[i + 1]);
            if d2 < best.0 {
                best = (d2, self.along[i] + t * (self.along[i + 1] - self.along[i]));
            }
        }
        best.1
    }

    /// Arc length of a point near `hint` that is nearest to `q`: only the stretch
    /// within three times the distance from the hint is searched, so that a side
    /// that bends back on itself cannot draw a point across, and a long side
    /// costs no more than a short one.
    pub(crate) fn nearest_from(&self, q: P, hint: f64) -> f64 {
        let reach = 3.0 * dist(q, self.at(hint));
        let (first, last) = (self.segment(hint - reach), self.segment(hint + reach));
        let mut best = (f64::INFINITY, hint);
        for i in first..=last {
            let (t, d2) = project(q, self.points[i], self.points[i + 1]);
            if d2 < best.0 {
                best = (d2, self.along[i] + t * (self.along[i + 1] - self.along[i]));
            }
        }
        best.1
    }

    /// `s`, or the arc length of a vertex nearer than `reach` to it.
    pub(crate) fn snap(&self, s: f64, reach: f64) -> f64 {
        let i = self.segment(s);
        let (a, b) = (self.along[i], self.along[i + 1]);
        if s - a <= reach && s - a <= b - s {
            a
        } else if b - s <= reach {
            b
        } else {
            s
        }
    }

    /// Vertices strictly between the two arc lengths, as indices.
    pub(crate) fn between(&self, s0: f64, s1: f64) -> std::ops::Range<usize> {
        let i = self.along.partition_point(|&a| a <= s0);
        let j = self.along.partition_point(|&a| a < s1);
        i..j.max(i)
    }
}

/// Drops inner vertices that lie within `tolerance` of the polyline's chord
/// (Douglas and Peucker 1973); both ends stay.
pub(crate) fn simplify(points: &[P], tolerance: f64) -> Vec<P> {
    let n = points.len();
    if n < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; n];
    keep[0] = true;
    keep[n - 1] = true;
    let mut stack = vec![(0, n - 1)];
    while let Some((i, j)) = stack.pop() {
        let mut far = (tolerance * tolerance, 0);
        for (k, &q) in points.iter().enumerate().take(j).skip(i + 1) {
            let (_, d2) = project(q, points[i], points[j]);
            if d2 > far.0 {
                far = (d2, k);
            }
        }
        if far.1 > 0 {
            keep[far.1] = true;
            stack.push((i, far.1));
            stack.push((far.1, j));
        }
    }
    (0..n).filter(|&i| keep[i]).map(|i| points[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_gives_back_its_vertices_bit_for_bit() {
        let path = Path::new(vec![p(0.1, 0.2), p(7.3, 0.4), p(7.9, 9.1)]);
        for (i, &q) in path.points.iter().enumerate() {
            assert_eq!(path.at(path.along[i]), q);
        }
        assert_eq!(path.between(0.0, path.length()), 1..2);
        assert!((path.nearest(p(7.6, 5.0)) - path.along[1]) > 3.0);
    }

    #[test]
    fn bow_tie_and_spike_touch_themselves_and_a_square_does_not() {
        let square = [p(0., 0.), p(1., 0.), p(1., 1.), p(0., 1.)];
        assert_eq!(self_contact(&square), None);
        assert_eq!(
            self_contact(&[p(0., 0.), p(1., 1.), p(1., 0.), p(0., 1.)]),
            Some((0, 2))
        );
        assert!(self_contact(&[p(0., 0.), p(2., 0.), p(1., 0.), p(1., 1.)]).is_some());
    }

    #[test]
    fn simplify_keeps_what_bends() {
        let line = [p(0., 0.), p(1., 0.001), p(2., 0.), p(3., 1.), p(4., 2.)];
        assert_eq!(simplify(&line, 0.01), vec![p(0., 0.), p(2., 0.), p(4., 2.)]);
    }
}
