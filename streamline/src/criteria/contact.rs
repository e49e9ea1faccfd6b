//! Boundary perpendicularity: does a line meet the boundary at a right angle,
//! and keep to that?

use super::angle::off_perpendicular;
use super::nearby::Nearby;
use super::CriteriaOptions;
use crate::streamline::{Sample, Streamline};
use crate::trace::Stop;
use crate::vector::Point;

/// Two ends are as near if their distances differ by less than this share of
/// the length: rounding must not choose.
const TIE: f64 = 1e-9;

/// The edges of the boundary that a line touches, with its start and with its
/// end. There are several at a corner of the boundary.
pub(super) struct Contacts {
    ends: [Vec<Point>; 2],
    length: f64,
}

impl Contacts {
    /// An end touches all edges within [`CriteriaOptions::snap`] of it; if it
    /// says that it lies on the boundary, the nearest at least.
    pub(super) fn new(
        line: &Streamline,
        length: f64,
        boundary: &[(Point, Point)],
        nearby: &Nearby,
        options: &CriteriaOptions,
    ) -> Self {
        let touched = |at: Option<&Point>, stop: Stop| -> Vec<Point> {
            let Some(&at) = at.filter(|_| stop != Stop::ClosedLoop) else {
                return Vec::new();
            };
            let mut edges: Vec<usize> = nearby
                .within(at, options.snap)
                .into_iter()
                .map(|(edge, _)| edge)
                .collect();
            if edges.is_empty() && stop.is_boundary() {
                edges.extend(nearby.nearest(at).map(|(edge, _)| edge));
            }
            let ways = edges.into_iter().map(|e| boundary[e].1 - boundary[e].0);
            ways.collect()
        };
        Self {
            ends: [
                touched(line.points.first(), line.start),
                touched(line.points.last(), line.end),
            ],
            length,
        }
    }

    /// How far a segment of the line, its middle `s` metres from the start, is
    /// from perpendicular to the edge touched by the end that is nearer along
    /// the line; of several at a corner, to the one that it fits best. `None`
    /// if the line touches none.
    pub(super) fn off(&self, sample: &Sample, s: f64) -> Option<f64> {
        let best = |end: &Vec<Point>| {
            let angles = end
                .iter()
                .filter_map(|&way| off_perpendicular(sample.tangent, way));
            angles.min_by(f64::total_cmp)
        };
        let [start, end] = [&self.ends[0], &self.ends[1]].map(best);
        let (Some(start), Some(end)) = (start, end) else {
            return start.or(end);
        };
        let ahead = self.length - s;
        Some(if (s - ahead).abs() <= TIE * self.length {
            (start + end) / 2.0
        } else if s < ahead {
            start
        } else {
            end
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{distance, point};

    /// A room whose right wall leans by 30 degrees.
    fn room() -> Vec<(Point, Point)> {
        let lean = 60.0 * 30_f64.to_radians().tan();
        let corners = [
            (0., 0.),
            (100., 0.),
            (100. + lean, 60.),
            (0., 60.),
            (0., 0.),
        ];
        let points = corners.map(|(x, y)| point(x, y));
        points.windows(2).map(|p| (p[0], p[1])).collect()
    }

    /// What is seen a quarter and three quarters along the way from `a` to `b`.
    fn seen(a: Point, b: Point, stops: [Stop; 2]) -> [Option<f64>; 2] {
        let line = Streamline {
            points: vec![a, b],
            start: stops[0],
            end: stops[1],
            seed: a,
            family: 0,
            seed_index: 0,
        };
        let boundary = room();
        let nearby = Nearby::new(boundary.iter().copied());
        let length = distance(a, b);
        let options = CriteriaOptions::default();
        let contacts = Contacts::new(&line, length, &boundary, &nearby, &options);
        let samples = line.samples(length / 2.0);
        [0, 1].map(|i| {
            let degrees = |off: f64| (off * 90.0 * 1e9).round() / 1e9;
            contacts
                .off(&samples[i], (i as f64 + 0.5) * length / 2.0)
                .map(degrees)
        })
    }

    const OPEN: [Stop; 2] = [Stop::LengthLimit; 2];

    #[test]
    fn each_half_is_compared_with_its_own_end() {
        let wall = point(100.0 + 20.0 * 30_f64.to_radians().tan(), 20.0);
        let at_both = seen(point(0.0, 20.0), wall, OPEN);
        assert_eq!(at_both, [Some(0.0), Some(30.0)]);
        // The only end there is serves all of the line.
        let at_one = seen(point(50.0, 20.0), wall, OPEN);
        assert_eq!(at_one, [Some(30.0), Some(30.0)]);
        let at_none = seen(point(40.0, 20.0), point(60.0, 20.0), OPEN);
        assert_eq!(at_none, [None, None]);
    }

    #[test]
    fn a_corner_has_two_edges_to_fit() {
        // 60 degrees off the bottom's right angle, 30 off the left wall's.
        let inwards = point(30_f64.to_radians().cos(), 30_f64.to_radians().sin()) * 40.0;
        let from_corner = seen(point(0.0, 0.0), inwards, OPEN);
        assert_eq!(from_corner, [Some(30.0), Some(30.0)]);
    }

    #[test]
    fn an_end_that_knows_where_it_is_may_be_inexact() {
        // 5 m short of the left wall.
        let short = |stop| {
            let stops = [stop, Stop::Neighbour];
            seen(point(5.0, 20.0), point(50.0, 20.0), stops)
        };
        let known = Stop::Boundary { ring: 0, edge: 3 };
        assert_eq!(short(known), [Some(0.0), Some(0.0)]);
        assert_eq!(short(Stop::Neighbour), [None, None]);
    }

    #[test]
    fn a_closed_line_has_no_ends() {
        let closed = seen(point(0.0, 20.0), point(50.0, 20.0), [Stop::ClosedLoop; 2]);
        assert_eq!(closed, [None, None]);
    }
}
