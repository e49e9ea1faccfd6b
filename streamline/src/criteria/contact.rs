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
