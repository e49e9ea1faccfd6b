//! A streamline judged segment by segment.

use super::angle::{doubled, off_parallel};
use super::contact::Contacts;
use super::nearby::Nearby;
use super::strips::{Shore, Strips};
use super::total::Share;
use super::turns::{turning, turns};
use super::{CriteriaOptions, LineCriteria, SegmentCriteria};
use crate::field::DirectionField;
use crate::score::divergence_along;
use crate::streamline::{Sample, Streamline};
use crate::tiles::Tiling;
use crate::vector::Point;

/// Pieces of a line's border that are as near to a segment but for this share
/// of its length are equally near.
const TIE: f64 = 1e-6;

/// What segments are compared with.
pub(super) struct Judge<'a> {
    field: &'a dyn DirectionField,
    tiling: &'a Tiling,
    strips: Strips,
    /// Edges of tiles that lines run along, and an index over them.
    borders: Vec<usize>,
    near_borders: Nearby,
    boundary: Vec<(Point, Point)>,
    near_boundary: Nearby,
    options: &'a CriteriaOptions,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        field: &'a dyn DirectionField,
        boundary: Vec<(Point, Point)>,
        tiling: &'a Tiling,
        options: &'a CriteriaOptions,
    ) -> Self {
        let borders: Vec<usize> = (0..tiling.edges.len())
            .filter(|&e| !tiling.edges[e].lines.is_empty())
            .collect();
        let ends = |&e: &usize| {
            let [a, b] = tiling.edges[e].vertices;
            (tiling.vertices[a], tiling.vertices[b])
        };
        Self {
            field,
            tiling,
            strips: Strips::new(tiling),
            near_borders: Nearby::new(borders.iter().map(ends)),
            borders,
            near_boundary: Nearby::new(boundary.iter().copied()),
            boundary,
            options,
        }
    }

    /// Judges one line, given its position in the input.
    pub(super) fn line(&self, index: usize, line: &Streamline) -> LineCriteria {
        let length = line.length();
        let contacts = Contacts::new(
            line,
            length,
            &self.boundary,
            &self.near_boundary,
            self.options,
        );
        let mut net = Vec::new();
        let mut segments: Vec<SegmentCriteria> = Vec::new();
        for (piece, divergence) in divergence_along(line, self.field, self.options.step) {
            let s = (segments.len() as f64 + 0.5) * piece.length;
            let near = self.options.reach.is_none_or(|reach| {
                let found = self.near_boundary.nearest(piece.at);
                found.is_some_and(|(_, distance)| distance <= reach)
            });
            let divergence = divergence.filter(|d| d.is_finite());
            net.push((divergence, piece.length));
            segments.push(SegmentCriteria {
                piece,
                divergence: divergence.map(f64::abs),
                turns: 0,
                parallelism: self.parallelism(index, &piece).filter(|_| near),
                perpendicularity: contacts.off(&piece, s).filter(|_| near),
            });
        }
        let turns = turns(line, self.options);
        if let Some(piece) = segments.first().map(|segment| segment.piece.length) {
            let last = segments.len() - 1;
            for at in &turns {
                segments[((at / piece) as usize).min(last)].turns += 1;
            }
        }
        let mut judged = LineCriteria {
            length,
            divergence: None,
            turns: turns.len(),
            continuity: if length > 0.0 {
                turns.len() as f64 / length
            } else {
                0.0
            },
            turning: turning(line),
            parallelism: None,
            perpendicularity: None,
            segments,
        };
        judged.parallelism = judged.share(|s| s.parallelism).mean();
        judged.perpendicularity = judged.share(|s| s.perpendicularity).mean();
        judged.divergence = if self.options.signed {
            Share::new(net.into_iter()).mean().map(f64::abs)
        } else {
            judged.share(|s| s.divergence).mean()
        };
        judged
    }

    /// The mean over the edges of tiles that the segment's middle lies on: one,
    /// or two at a vertex.
    fn parallelism(&self, line: usize, piece: &Sample) -> Option<f64> {
        let tolerance = self.options.snap + 4.0 * self.tiling.precision();
        let mut on: Vec<(usize, f64)> = self
            .near_borders
            .within(piece.at, tolerance)
            .into_iter()
            .map(|(i, distance)| (self.borders[i], distance))
            .filter(|&(e, _)| {
                // Where the line crosses itself, the branch that this is.
                let along = doubled(self.along(e));
                self.tiling.edges[e].lines.contains(&line)
                    && off_parallel(piece.tangent, along).is_some_and(|off| off < 0.5)
            })
            .collect();
        let nearest = on.iter().map(|&(_, distance)| distance).reduce(f64::min)?;
        on.retain(|&(_, distance)| distance <= nearest + TIE * piece.length);
        mean(
            on.iter()
                .filter_map(|&(e, _)| self.across(e, piece.tangent)),
        )
    }

    /// How far a direction is from the boundary at the nearer end, in tiles, of
    /// the strips to both sides of an edge; the mean if both are as near.
    fn across(&self, edge: usize, direction: Point) -> Option<f64> {
        if self.tiling.edges[edge].boundary.is_some() {
            return off_parallel(direction, doubled(self.along(edge)));
        }
        let shores = self.strips.shores(edge);
        let nearest = shores.iter().flatten().map(|shore| shore.tiles).min()?;
        let ends = shores.iter().flatten().filter(|s| s.tiles == nearest);
        mean(ends.filter_map(|shore: &Shore| off_parallel(direction, shore.direction)))
    }

    /// An edge as a vector.
    fn along(&self, edge: usize) -> Point {
        let [a, b] = self.tiling.edges[edge].vertices;
        self.tiling.vertices[b] - self.tiling.vertices[a]
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
