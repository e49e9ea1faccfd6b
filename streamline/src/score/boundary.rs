//! Do whole rows of templates fit between the line and the boundary?

use super::rays::{square_distance, RayGrid, Wall};
use super::{Score, WidthTable};
use crate::field::DirectionField;
use crate::streamline::Streamline;
use crate::vector::{left, point, Point};
use geo_types::Coord;
use rstar::{PointDistance, RTree, RTreeObject, AABB};

/// From where to where the distance to the boundary is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BoundaryMeasure {
    /// Along both normals of the line to the first boundary segment there: the
    /// space that a row of templates would fill on either side.
    #[default]
    Normals,
    /// To the nearest point of the boundary, whichever way: dist(x), as the
    /// paper has it.
    Nearest,
}

/// How the distance to the boundary is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundaryOptions {
    /// Greatest distance between samples along the line, in metres.
    ///
    /// Default value: 5 m.
    pub step: f64,
    /// What is measured.
    ///
    /// Default value: [`BoundaryMeasure::Normals`].
    pub measure: BoundaryMeasure,
}

impl Default for BoundaryOptions {
    fn default() -> Self {
        Self {
            step: 5.0,
            measure: BoundaryMeasure::default(),
        }
    }
}

/// DB(s) of the paper: the average along the line of opt(distance to the
/// boundary), in metres: how badly templates of given widths fit beside it.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{from_fn, trace, BoundaryDistance, BoundaryOptions, Score, TraceOptions, WidthTable};
///
/// let domain = polygon![(x: 0., y: 0.), (x: 400., y: 0.), (x: 400., y: 150.), (x: 0., y: 150.)];
/// let walls: Vec<_> = domain.exterior().lines().map(|l| (l.start, l.end, 0.0)).collect();
/// let east = from_fn(domain, |_, _| Some(coord! { x: 1.0, y: 0.0 }));
/// let score = BoundaryDistance::new(&walls, WidthTable::new(&[75.0], 600.0, 0.1), BoundaryOptions::default());
/// let line = |y| trace(&east, coord! { x: 9., y: y }, coord! { x: 1., y: 0. }, &TraceOptions::default());
/// assert!(score.cost(&line(75.0)?, &east) < 1e-9); // 75 m to either side
/// assert!((score.cost(&line(85.0)?, &east) - 10.0).abs() < 1e-9); // 85 and 65
/// # Ok::<(), streamline::TraceError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundaryDistance {
    walls: Walls,
    table: WidthTable,
    step: f64,
}

/// The boundary under the index that the measure needs.
#[derive(Clone, Debug)]
enum Walls {
    Rays(RayGrid),
    Tree { origin: Point, tree: RTree<Wall> },
}

impl RTreeObject for Wall {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners([self.a.x, self.a.y], [self.b.x, self.b.y])
    }
}

impl PointDistance for Wall {
    fn distance_2(&self, p: &[f64; 2]) -> f64 {
        square_distance(point(p[0], p[1]), self)
    }
}

impl BoundaryDistance {
    /// Measures to `segments`: two ends and an offset in metres that is
    /// subtracted from distances to the segment, for instance half the width
    /// of the street that runs along it. Segments that are not finite, or have
    /// no length, are left out.
    #[must_use]
    pub fn new(
        segments: &[(Coord<f64>, Coord<f64>, f64)],
        table: WidthTable,
        options: BoundaryOptions,
    ) -> Self {
        let walls = segments.iter().map(|&(a, b, offset)| Wall { a, b, offset });
        let walls = match options.measure {
            BoundaryMeasure::Normals => Walls::Rays(RayGrid::new(walls)),
            BoundaryMeasure::Nearest => {
                let fit = |w: &Wall| {
                    [w.a.x, w.a.y, w.b.x, w.b.y, w.offset]
                        .iter()
                        .all(|v| v.is_finite())
                };
                let walls: Vec<Wall> = walls.filter(fit).collect();
                let origin = walls.first().map_or(Coord::zero(), |w| w.a);
                let local = walls.into_iter().map(|w| Wall {
                    a: w.a - origin,
                    b: w.b - origin,
                    ..w
                });
                Walls::Tree {
                    origin,
                    tree: RTree::bulk_load(local.collect()),
                }
            }
        };
        Self {
            walls,
            table,
            step: options.step,
        }
    }

    /// Sum and number of opt(y) of the distances measured at one sample.
    fn at(&self, at: Point, tangent: Point) -> (f64, f64) {
        match &self.walls {
            Walls::Rays(grid) => {
                let mut found = (0.0, 0.0);
                for way in [left(tangent), left(tangent) * -1.0] {
                    if let Some((distance, wall)) = grid.first_hit(at, way) {
                        found.0 += self.table.cost(distance - wall.offset);
                        found.1 += 1.0;
                    }
                }
                found
            }
            Walls::Tree { origin, tree } => {
                let p = at - *origin;
                let nearest = tree.nearest_neighbor(&[p.x, p.y]);
                nearest.map_or((0.0, 0.0), |wall| {
                    (
                        self.table
                            .cost(square_distance(p, wall).sqrt() - wall.offset),
                        1.0,
                    )
                })
            }
        }
    }
}

impl Score for BoundaryDistance {
    fn name(&self) -> &str {
        "boundary"
    }

    /// 0 where no boundary is met anywhere; NaN for a line without length.
    fn cost(&self, line: &Streamline, _: &dyn DirectionField) -> f64 {
        let samples = line.samples(self.step);
        if samples.is_empty() {
            return f64::NAN;
        }
        let (mut sum, mut count) = (0.0, 0.0);
        for sample in &samples {
            let (costs, number) = self.at(sample.at, sample.tangent);
            sum += costs;
            count += number;
        }
        if count > 0.0 {
            sum / count
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::from_fn;
    use crate::trace::{trace, TraceOptions};
    use geo_types::polygon;

    /// A corridor from (0, 0) to (300, 100), its upper wall with an offset.
    fn cost(y: f64, options: BoundaryOptions, widths: &[f64]) -> f64 {
        let domain =
            polygon![(x: 0., y: 0.), (x: 300., y: 0.), (x: 300., y: 100.), (x: 0., y: 100.)];
        let offset = |line: &geo_types::Line<f64>| {
            if line.start.y == 100.0 && line.end.y == 100.0 {
                8.0
            } else {
                0.0
            }
        };
        let walls: Vec<_> = domain
            .exterior()
            .lines()
            .map(|l| (l.start, l.end, offset(&l)))
            .collect();
        let east = from_fn(domain, |_, _| Some(point(1.0, 0.0)));
        let line = trace(
            &east,
            point(150.0, y),
            point(1.0, 0.0),
            &TraceOptions::default(),
        )
        .unwrap();
        BoundaryDistance::new(&walls, WidthTable::new(widths, 500.0, 0.1), options)
            .cost(&line, &east)
    }

    #[test]
    fn both_sides_and_offsets_count() {
        let normals = BoundaryOptions::default();
        // 40 below; 60 - 8 = 52 above.
        assert!((cost(40.0, normals, &[40.0, 52.0]) - 0.0).abs() < 1e-9);
        assert!((cost(40.0, normals, &[40.0]) - 6.0).abs() < 1e-9);
        // Lines along the lower wall leave no space there.
        assert!(cost(1.0, normals, &[45.0]) > 20.0);
    }

    #[test]
    fn nearest_point_is_the_papers_option() {
        let nearest = BoundaryOptions {
            measure: BoundaryMeasure::Nearest,
            step: 1.0,
        };
        // 40 m, 10 m short of 2 * 25, everywhere but within 40 m of the two ends,
        // where it falls to 0: the triangles below 25, up to 37.5, and back.
        let ends = 25.0 * 25.0 / 2.0 + 12.5 * 12.5 / 2.0 + 2.5 * (12.5 + 10.0) / 2.0;
        let expected = (10.0 * 220.0 + 2.0 * ends) / 300.0;
        assert!((cost(40.0, nearest, &[25.0, 1000.0]) - expected).abs() < 0.01);
    }

    #[test]
    fn no_walls_cost_nothing() {
        let east = from_fn(
            polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.)],
            |_, _| Some(point(1.0, 0.0)),
        );
        let line = trace(
            &east,
            point(5.0, 2.0),
            point(1.0, 0.0),
            &TraceOptions::default(),
        )
        .unwrap();
        for measure in [BoundaryMeasure::Normals, BoundaryMeasure::Nearest] {
            let options = BoundaryOptions {
                measure,
                ..BoundaryOptions::default()
            };
            let score = BoundaryDistance::new(&[], WidthTable::new(&[30.0], 90.0, 0.1), options);
            assert_eq!(score.cost(&line, &east), 0.0);
        }
    }
}
