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
use crate::vector::{unit, Point};

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
        // The points between the segments: they are as many and as long.
        let between = line.resample(self.options.step).points;
        let mut net = Vec::new();
        let mut segments: Vec<SegmentCriteria> = Vec::new();
        for (mut piece, divergence) in divergence_along(line, self.field, self.options.step) {
            let k = segments.len();
            let s = (k as f64 + 0.5) * piece.length;
            // The tangent is that of a smooth line through the points, which a
            // drawn one with few of them is not.
            if let Some(chord) = unit(between[k + 1] - between[k]) {
                piece.tangent = chord;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criteria::{criteria, Criteria};
    use crate::field::{arm_nearest, from_fn};
    use crate::tiles::{tiles, TileOptions};
    use crate::trace::Stop;
    use crate::vector::point;
    use geo_types::{polygon, Polygon};

    fn line(points: &[(f64, f64)]) -> Streamline {
        let points: Vec<Point> = points.iter().map(|&(x, y)| point(x, y)).collect();
        Streamline {
            seed: points[0],
            points,
            start: Stop::LengthLimit,
            end: Stop::LengthLimit,
            family: 0,
            seed_index: 0,
        }
    }

    fn judge(land: &Polygon<f64>, lines: &[Streamline], options: &CriteriaOptions) -> Criteria {
        let east = from_fn(land.clone(), |_, heading| Some(arm_nearest(0.0, heading)));
        let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
        let tiling = tiles(land, &strings, &TileOptions::default()).unwrap();
        criteria(&east, land, lines, &tiling, &[], options).unwrap()
    }

    /// The top rises by 20 degrees.
    fn shed() -> Polygon<f64> {
        let rise = 120.0 * 20_f64.to_radians().tan();
        polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 120., y: 100. + rise), (x: 0., y: 100.)]
    }

    fn flat(y: f64) -> Streamline {
        line(&[(0.0, y), (120.0, y)])
    }

    #[test]
    fn the_nearer_end_of_the_strip_counts() {
        let lines = [flat(20.0), flat(50.0), flat(90.0)];
        let found = judge(&shed(), &lines, &CriteriaOptions::default());
        let off = |i: usize| found.lines[i].parallelism.unwrap() * 90.0;
        assert_eq!(off(0), 0.0);
        assert!((off(1) - 10.0).abs() < 1e-9, "the mean of both");
        assert!((off(2) - 20.0).abs() < 1e-9);
    }

    #[test]
    fn a_line_on_the_boundary_is_parallel_to_it() {
        let found = judge(&shed(), &[flat(0.0)], &CriteriaOptions::default());
        assert_eq!(found.lines[0].parallelism, Some(0.0));
    }

    #[test]
    fn beyond_the_reach_nothing_is_compared() {
        let lines = [flat(20.0), flat(50.0)];
        let options = CriteriaOptions {
            reach: Some(24.0),
            ..CriteriaOptions::default()
        };
        let found = judge(&shed(), &lines, &options);
        assert_eq!(found.lines[0].parallelism, Some(0.0));
        // Of the second, what lies within 24 m of the two walls: six segments
        // of 4 m at either end.
        let measured = found.lines[1].segments.iter();
        assert_eq!(measured.filter(|s| s.parallelism.is_some()).count(), 12);
        assert_eq!(
            found.lines[1]
                .segments
                .iter()
                .filter(|s| s.perpendicularity.is_some())
                .count(),
            12
        );
    }

    #[test]
    fn each_segment_has_its_own_strip() {
        // A roof that is flat to x = 60 and leans from there.
        let land = polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 120., y: 130.), (x: 60., y: 100.), (x: 0., y: 100.)];
        let slope = 30_f64.atan2(60.0).to_degrees();
        let lines = [flat(90.0), flat(80.0), line(&[(60.0, 0.0), (60.0, 100.0)])];
        // However loosely the tiles are said to fit.
        let options = CriteriaOptions {
            snap: 9.0,
            ..CriteriaOptions::default()
        };
        let found = judge(&land, &lines, &options);
        for segment in &found.lines[0].segments {
            let wanted = if segment.piece.at.x < 60.0 {
                0.0
            } else {
                slope
            };
            let off = segment.parallelism.unwrap() * 90.0;
            assert!((off - wanted).abs() < 1e-9, "{segment:?}");
        }
    }

    /// Two segments have their middles where the line crosses itself.
    #[test]
    fn a_line_that_crosses_itself_keeps_to_its_branch() {
        let land = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)];
        let looped = line(&[(0., 50.), (90., 50.), (90., 96.), (50., 96.), (50., 0.)]);
        let found = judge(&land, &[looped], &CriteriaOptions::default());
        let crossing = point(50.0, 50.0);
        let segments = &found.lines[0].segments;
        let there = segments.iter().filter(|s| s.piece.at == crossing);
        assert_eq!(there.clone().count(), 2);
        let off: Vec<_> = there.map(|s| s.parallelism).collect();
        assert_eq!(off, [Some(0.0), Some(0.0)]);
    }

    #[test]
    fn turns_are_where_the_line_bends() {
        let bent = line(&[(0., 10.), (50., 10.), (50., 60.)]);
        let found = judge(&shed(), &[bent], &CriteriaOptions::default());
        let turns: Vec<usize> = found.lines[0].segments.iter().map(|s| s.turns).collect();
        assert_eq!((turns.len(), turns[12], found.lines[0].turns), (25, 1, 1));
        assert!((found.lines[0].continuity - 0.01).abs() < 1e-12);
        assert!((found.lines[0].turning - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn small_tiles_can_be_left_out() {
        let lines = [flat(2.0), flat(50.0)];
        let count = |min_tile_area: f64| {
            let options = CriteriaOptions {
                min_tile_area,
                ..CriteriaOptions::default()
            };
            let totals = judge(&shed(), &lines, &options).totals;
            (totals.tiles, totals.convexity.count)
        };
        assert_eq!(count(0.0), (3, 3));
        assert_eq!(count(241.0), (3, 2), "120 x 2");
    }
}
