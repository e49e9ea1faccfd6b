//! The streamline itself: a polyline that knows how it ended.

use crate::trace::Stop;
use crate::vector::{
    cross, distance, dot, nearest_on_segment, norm, segments_cross, turn, unit, Point,
};
use geo_types::{Coord, LineString};
use rstar::{primitives::GeomWithData, primitives::Line, RTree, AABB};

/// Most pieces that a line is cut into: bounds the memory of an absurd step.
pub(crate) const MOST: f64 = 1e7;

/// A traced streamline. Coordinates in metres.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Streamline {
    /// Points along the line, in order; a closed line repeats its first point
    /// at the end.
    pub points: Vec<Coord<f64>>,
    /// How the end at the first point came about.
    pub start: Stop,
    /// How the end at the last point came about.
    pub end: Stop,
    /// Where it was traced from; one of the points.
    pub seed: Coord<f64>,
    /// Which of the two orientations of the cross at the seed it follows, the
    /// first (0) or the second (1). Not global: around a singularity of a
    /// quarter turn the two change places.
    pub family: u8,
    /// Position of the seed in the list given to
    /// [`candidates`](crate::candidates).
    pub seed_index: usize,
}

/// One of the equal pieces of a line, see [`Streamline::samples`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample {
    /// The middle of the piece, on the polyline.
    pub at: Coord<f64>,
    /// The unit tangent there.
    pub tangent: Coord<f64>,
    /// Length of the piece, in metres.
    pub length: f64,
}

impl Streamline {
    /// Length of the polyline, in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|p| distance(p[0], p[1])).sum()
    }

    /// True if the line came back to its seed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.end == Stop::ClosedLoop
    }

    /// The piece that holds arc length `s`, and the fraction of it.
    fn locate(&self, s: f64) -> Option<(usize, f64)> {
        let pieces = self.points.len().checked_sub(1).filter(|&n| n > 0)?;
        let mut rest = s.max(0.0);
        for i in 0..pieces {
            let length = distance(self.points[i], self.points[i + 1]);
            if rest <= length && length > 0.0 {
                return Some((i, rest / length));
            }
            rest -= length;
        }
        Some((pieces - 1, 1.0))
    }

    /// The point at arc length `s` metres from the start, clamped to the ends;
    /// the seed if the line has no points. Walks the line.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Coord<f64> {
        match self.locate(s) {
            Some((i, t)) => self.points[i] + (self.points[i + 1] - self.points[i]) * t,
            None => self.points.first().copied().unwrap_or(self.seed),
        }
    }

    /// The unit tangent at arc length `s` metres from the start, pointing
    /// towards the end: exact on straight lines and at the points of circular
    /// ones, between points the mean of theirs. Zero on a line without length.
    #[must_use]
    pub fn tangent_at(&self, s: f64) -> Coord<f64> {
        self.locate(s)
            .map_or(Coord::zero(), |(i, t)| self.tangent_between(i, t))
    }

    fn tangent_between(&self, i: usize, t: f64) -> Point {
        self.mix(i, t, self.vertex_tangent(i), self.vertex_tangent(i + 1))
    }

    /// The tangent at fraction `t` of piece `i`, given those at its ends.
    fn mix(&self, i: usize, t: f64, from: Point, to: Point) -> Point {
        unit(from * (1.0 - t) + to * t)
            .or_else(|| unit(self.points[i + 1] - self.points[i]))
            .unwrap_or(Coord::zero())
    }

    /// Tangent at a point of the line, from the circle through it and its two
    /// neighbours.
    fn vertex_tangent(&self, i: usize) -> Point {
        let points = &self.points;
        let last = points.len() - 1;
        let chord = |i: usize, j: usize| points[j] - points[i];
        let through = |before: Point, after: Point| {
            let (a, b) = (norm(before), norm(after));
            match (unit(before), unit(after)) {
                // Each chord's angle lags the tangent in proportion to its length.
                (Some(u), Some(v)) => unit(u * b + v * a).unwrap_or(v),
                (u, v) => v.or(u).unwrap_or(Coord::zero()),
            }
        };
        if last == 0 {
            return Coord::zero();
        }
        if 0 < i && i < last {
            return through(chord(i - 1, i), chord(i, i + 1));
        }
        if self.is_closed() && last > 1 {
            return through(chord(last - 1, last), chord(0, 1));
        }
        let end = if i == 0 {
            chord(0, 1)
        } else {
            chord(last - 1, last)
        };
        let Some(along) = unit(end) else {
            return Coord::zero();
        };
        if last == 1 {
            return along;
        }
        // On a circle the tangents at the two ends of a chord mirror each
        // other in it.
        let inner = self.vertex_tangent(if i == 0 { 1 } else { last - 1 });
        unit(along * (2.0 * dot(along, inner)) - inner).unwrap_or(along)
    }

    /// Outward unit direction at the first point: where the line would go on
    /// to. Zero on a line without length.
    #[must_use]
    pub fn start_tangent(&self) -> Coord<f64> {
        if self.points.len() < 2 {
            return Coord::zero();
        }
        self.vertex_tangent(0) * -1.0
    }

    /// Outward unit direction at the last point. Zero on a line without length.
    #[must_use]
    pub fn end_tangent(&self) -> Coord<f64> {
        if self.points.len() < 2 {
            return Coord::zero();
        }
        self.vertex_tangent(self.points.len() - 1)
    }

    /// The line cut into equal pieces of at most `step` metres, each given by
    /// its middle (ten million pieces at most): what the scores integrate over.
    /// Empty on a line without
    /// length, or if `step` is not positive.
    #[must_use]
    pub fn samples(&self, step: f64) -> Vec<Sample> {
        let length = self.length();
        if !(step > 0.0 && length > 0.0 && length.is_finite()) {
            return Vec::new();
        }
        let count = (length / step).ceil().clamp(1.0, MOST);
        let piece = length / count;
        let mut samples = Vec::with_capacity(count as usize);
        let (mut i, mut passed) = (0, 0.0);
        let mut edge = distance(self.points[0], self.points[1]);
        let mut ends = (self.vertex_tangent(0), self.vertex_tangent(1));
        let mut known = 0;
        for k in 0..count as usize {
            let s = (k as f64 + 0.5) * piece;
            while s > passed + edge && i + 2 < self.points.len() {
                passed += edge;
                i += 1;
                edge = distance(self.points[i], self.points[i + 1]);
            }
            // Tangents are found once a piece, and shared with the next one.
            if i == known + 1 {
                ends = (ends.1, self.vertex_tangent(i + 1));
            } else if i != known {
                ends = (self.vertex_tangent(i), self.vertex_tangent(i + 1));
            }
            known = i;
            let t = if edge > 0.0 {
                ((s - passed) / edge).min(1.0)
            } else {
                0.0
            };
            let at = self.points[i] + (self.points[i + 1] - self.points[i]) * t;
            samples.push(Sample {
                at,
                tangent: self.mix(i, t, ends.0, ends.1),
                length: piece,
            });
        }
        samples
    }

    /// The same line with equally spaced points at most `step` metres apart
    /// along it, ends kept. New points lie on the old polyline; where it bends
    /// at angle a, the new one cuts the corner by up to step/2 * sin(a/2). Ten
    /// million points at most.
    ///
    /// Unchanged if `step` is not positive.
    #[must_use]
    pub fn resample(&self, step: f64) -> Self {
        let length = self.length();
        if !(step > 0.0 && length > 0.0 && length.is_finite()) {
            return self.clone();
        }
        let count = (length / step).ceil().clamp(1.0, MOST) as usize;
        let mut points = Vec::with_capacity(count + 1);
        points.push(self.points[0]);
        let (mut i, mut passed) = (0, 0.0);
        let mut edge = distance(self.points[0], self.points[1]);
        for k in 1..count {
            let s = length * k as f64 / count as f64;
            while s > passed + edge && i + 2 < self.points.len() {
                passed += edge;
                i += 1;
                edge = distance(self.points[i], self.points[i + 1]);
            }
            let t = if edge > 0.0 {
                ((s - passed) / edge).min(1.0)
            } else {
                0.0
            };
            points.push(self.points[i] + (self.points[i + 1] - self.points[i]) * t);
        }
        points.extend(self.points.last());
        Self {
            points,
            ..self.clone()
        }
    }

    /// The same line with fewer points (Douglas-Peucker): the Hausdorff
    /// distance between the two is at most `tolerance` metres. Ends are kept,
    /// and on a closed line its shape; that no crossing arises is not promised.
    ///
    /// Unchanged if `tolerance` is not positive.
    #[must_use]
    pub fn simplify(&self, tolerance: f64) -> Self {
        if tolerance.is_nan() || tolerance <= 0.0 || self.points.len() < 3 {
            return self.clone();
        }
        let points = &self.points;
        let mut keep = vec![false; points.len()];
        let last = points.len() - 1;
        (keep[0], keep[last]) = (true, true);
        let mut open = vec![(0, last)];
        while let Some((low, high)) = open.pop() {
            let off = |i: usize| {
                distance(
                    points[i],
                    nearest_on_segment(points[i], points[low], points[high]),
                )
            };
            let far = (low + 1..high)
                .map(|i| (off(i), i))
                .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            if let Some((_, i)) = far.filter(|far| far.0 > tolerance) {
                keep[i] = true;
                open.push((low, i));
                open.push((i, high));
            }
        }
        let points = points
            .iter()
            .zip(&keep)
            .filter(|(_, &keep)| keep)
            .map(|(&p, _)| p)
            .collect();
        Self {
            points,
            ..self.clone()
        }
    }

    /// True if the line neither crosses nor touches itself (a closed line
    /// meets itself at its seed).
    ///
    /// A line whose tangents span less than half a turn cannot, and is not
    /// tested; otherwise O(n log n) in its points.
    #[must_use]
    pub fn is_simple(&self) -> bool {
        let points = &self.points;
        let (mut angle, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
        for p in points.windows(3) {
            angle += turn(p[1] - p[0], p[2] - p[1]);
            (low, high) = (low.min(angle), high.max(angle));
        }
        if high - low < std::f64::consts::PI {
            return true;
        }
        let origin = points[0];
        let pieces = points.windows(2).enumerate().map(|(i, p)| {
            let (a, b) = (p[0] - origin, p[1] - origin);
            GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), i)
        });
        let tree = RTree::bulk_load(pieces.collect());
        let last = points.len() - 2;
        let crossed = points.windows(2).enumerate().any(|(i, p)| {
            let (a, b) = (p[0] - origin, p[1] - origin);
            let near = AABB::from_corners([a.x, a.y], [b.x, b.y]);
            tree.locate_in_envelope_intersecting(&near).any(|other| {
                let j = other.data;
                let neighbours = j <= i + 1 || (self.is_closed() && i == 0 && j == last);
                !neighbours && segments_cross(p[0], p[1], points[j], points[j + 1])
            })
        });
        !crossed
    }

    /// The polyline alone.
    #[must_use]
    pub fn to_line_string(&self) -> LineString<f64> {
        LineString(self.points.clone())
    }

    /// Least distance from `p` to the line, in metres; infinite for a line
    /// without points.
    ///
    /// Skips along the line as far as the best distance so far allows: a point
    /// `d` away from a place on the line is at least `d - s` away from a place
    /// `s` further on.
    #[must_use]
    pub fn distance_to(&self, p: Coord<f64>) -> f64 {
        let points = &self.points;
        let mut best = points
            .first()
            .map_or(f64::INFINITY, |&first| distance(first, p));
        let mut skip = 0.0;
        for pair in points.windows(2) {
            let length = distance(pair[0], pair[1]);
            if skip >= length {
                skip -= length;
                continue;
            }
            best = best.min(distance(nearest_on_segment(p, pair[0], pair[1]), p));
            skip = distance(pair[1], p) - best;
        }
        best
    }

    /// Signed total turn from start to end, in radians.
    #[must_use]
    pub fn total_turn(&self) -> f64 {
        self.points
            .windows(3)
            .map(|p| cross(p[1] - p[0], p[2] - p[1]).atan2(dot(p[1] - p[0], p[2] - p[1])))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;
    use std::f64::consts::PI;

    fn line(points: Vec<Point>) -> Streamline {
        Streamline {
            seed: points[0],
            points,
            start: Stop::LengthLimit,
            end: Stop::LengthLimit,
            family: 0,
            seed_index: 0,
        }
    }

    fn arc(radius: f64, angle: f64, pieces: usize) -> Streamline {
        line(
            (0..=pieces)
                .map(|i| angle * i as f64 / pieces as f64)
                .map(|a| point(a.cos(), a.sin()) * radius)
                .collect(),
        )
    }

    #[test]
    fn points_and_tangents_along() {
        let l = line(vec![point(0., 0.), point(10., 0.), point(10., 5.)]);
        assert_eq!(l.length(), 15.0);
        assert_eq!(l.point_at(4.0), point(4.0, 0.0));
        assert_eq!(l.point_at(12.0), point(10.0, 2.0));
        assert_eq!(
            (l.point_at(-1.0), l.point_at(99.0)),
            (point(0., 0.), point(10., 5.))
        );
        assert!((l.total_turn() - PI / 2.0).abs() < 1e-15);
    }

    #[test]
    fn tangents_are_exact_on_unequal_pieces_of_a_circle() {
        let angles = [0.0, 0.1, 0.13, 0.3, 0.35];
        let l = line(
            angles
                .iter()
                .map(|a: &f64| point(a.cos(), a.sin()) * 40.0)
                .collect(),
        );
        assert!(distance(l.end_tangent(), point(-(0.35_f64.sin()), 0.35_f64.cos())) < 2e-4);
        assert!(distance(l.start_tangent(), point(0.0, -1.0)) < 2e-4);
        assert_eq!(line(vec![point(1., 1.)]).end_tangent(), Coord::zero());
        let s = line(vec![point(0., 0.), point(3., 4.)]);
        assert!(distance(s.start_tangent(), point(-0.6, -0.8)) < 1e-15);
        assert!(distance(s.end_tangent(), point(0.6, 0.8)) < 1e-15);
    }

    #[test]
    fn samples_tile_the_line() {
        let l = arc(100.0, 2.0, 41);
        let samples = l.samples(7.0);
        assert!((samples.iter().map(|s| s.length).sum::<f64>() - l.length()).abs() < 1e-9);
        for s in &samples {
            assert!(s.length <= 7.0 && (norm(s.tangent) - 1.0).abs() < 1e-12);
            assert!(dot(s.tangent, s.at).abs() < 0.5, "tangent to the circle");
        }
        assert!(l.samples(0.0).is_empty() && line(vec![point(0., 0.)]).samples(1.0).is_empty());
    }

    #[test]
    fn resample_and_simplify_keep_what_they_promise() {
        let l = arc(100.0, 2.0, 60);
        let r = l.resample(3.0);
        assert_eq!(
            (r.points[0], r.points[r.points.len() - 1]),
            (l.points[0], l.points[60])
        );
        assert!(r
            .points
            .windows(2)
            .all(|p| distance(p[0], p[1]) <= 3.0 + 1e-9));
        let s = l.simplify(0.5);
        assert!(s.points.len() < 20 && s.points.len() > 4);
        assert!(l.points.iter().all(|&p| s.distance_to(p) <= 0.5));
        assert_eq!(l.simplify(0.0), l);
        assert_eq!(l.resample(f64::NAN), l);
    }

    #[test]
    fn simple_or_not() {
        assert!(arc(10.0, 6.0, 50).is_simple());
        let mut eight = vec![
            point(0., 0.),
            point(10., 10.),
            point(20., 0.),
            point(20., 10.),
        ];
        assert!(line(eight.clone()).is_simple());
        eight.extend([point(10., 0.), point(0., 10.)]);
        assert!(!line(eight).is_simple());
        let closed = Streamline {
            start: Stop::ClosedLoop,
            end: Stop::ClosedLoop,
            ..arc(10.0, 2.0 * PI, 30)
        };
        assert!(closed.is_simple());
    }

    #[test]
    fn distance_to_agrees_with_looking_everywhere() {
        let l = arc(100.0, 5.0, 200);
        for i in 0..50 {
            let p = point((i * 37 % 250) as f64 - 120.0, (i * 91 % 240) as f64 - 130.0);
            let plain = l
                .points
                .windows(2)
                .map(|s| distance(p, nearest_on_segment(p, s[0], s[1])))
                .fold(f64::INFINITY, f64::min);
            assert!((l.distance_to(p) - plain).abs() < 1e-12);
        }
    }
}
