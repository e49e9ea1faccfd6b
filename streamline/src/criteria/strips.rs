//! Boundary parallelism: the strips between adjacent streamlines, and the
//! pieces of the boundary that they end at.
//!
//! The two streamlines that cross a third one on either side of a segment of it
//! go on to the boundary, and split a piece off it; that is what the segment is
//! compared with. Between them lies a row of tiles, which the segment's own
//! line and its neighbours cut across; so the piece is found by walking from
//! tile to tile, in at one side and out at those that are opposite.
//!
//! What is *opposite* is decided by the tiles' corners: a tile's ring is cut
//! into sides where it turns by more than 40 degrees and where the boundary
//! begins and ends, and all sides but the entered one and the two next to it
//! are opposite; so are its other rings. A triangle has none: what it has of
//! the boundary is beside the segment, and counts. Where several sides are
//! opposite, each has the weight of its shadow on the entered side: what share
//! of the strip it lies before.

use super::angle::doubled;
use crate::tiles::Tiling;
use crate::vector::{dot, norm, turn, unit, Point};
use geo_types::Coord;

/// A turn of a tile's ring that makes a corner: less than the 45 degrees that
/// lines cross at, at least, so that every crossing is one.
const CORNER: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// A run of half-edges of one tile without a corner in between. Half-edges are
/// numbered: twice the edge, and one more if it is followed backwards.
struct Side {
    tile: usize,
    half_edges: Vec<usize>,
    boundary: bool,
    /// The sides before and behind it in its ring.
    beside: [usize; 2],
}

/// The end of a strip, seen from where it is entered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shore {
    /// How many tiles the strip runs through besides the one at the boundary.
    pub(super) tiles: usize,
    /// Mean of the doubled unit directions of the boundary there.
    pub(super) direction: Point,
}

/// For each half-edge: where the strip that is entered across it, into the tile
/// to its left, meets the boundary.
pub(super) struct Strips {
    sides: Vec<Side>,
    side_of: Vec<Option<usize>>,
    of_tile: Vec<Vec<usize>>,
    shores: Vec<Option<Shore>>,
}

impl Strips {
    pub(super) fn new(tiling: &Tiling) -> Self {
        let mut strips = Self {
            sides: Vec::new(),
            side_of: vec![None; 2 * tiling.edges.len()],
            of_tile: vec![Vec::new(); tiling.tiles.len()],
            shores: Vec::new(),
        };
        for tile in 0..tiling.tiles.len() {
            for ring in &tiling.tiles[tile].rings {
                let ring: Vec<usize> = ring
                    .iter()
                    .map(|h| 2 * h.edge + usize::from(!h.forward))
                    .collect();
                strips.cut(tiling, tile, &ring);
            }
        }
        strips.shores = vec![None; strips.sides.len()];
        strips.walk(tiling);
        strips
    }

    /// What the strip across this edge meets, to its left and to its right.
    pub(super) fn shores(&self, edge: usize) -> [Option<Shore>; 2] {
        [2 * edge, 2 * edge + 1].map(|h| self.side_of[h].and_then(|side| self.shores[side]))
    }

    /// Cuts a ring into sides.
    fn cut(&mut self, tiling: &Tiling, tile: usize, ring: &[usize]) {
        let is_boundary = |h: usize| tiling.edges[h / 2].boundary.is_some();
        let n = ring.len();
        let corner = |i: usize| {
            let (before, here) = (ring[(i + n - 1) % n], ring[i]);
            is_boundary(before) != is_boundary(here)
                || turn(way(tiling, before), way(tiling, here)).abs() > CORNER
        };
        // A ring without a corner is one side, wherever it begins.
        let start = (0..n).find(|&i| corner(i)).unwrap_or(0);
        let first = self.sides.len();
        for k in 0..n {
            let i = (start + k) % n;
            if k == 0 || corner(i) {
                self.of_tile[tile].push(self.sides.len());
                self.sides.push(Side {
                    tile,
                    half_edges: Vec::new(),
                    boundary: is_boundary(ring[i]),
                    beside: [0, 0],
                });
            }
            let side = self.sides.len() - 1;
            self.sides[side].half_edges.push(ring[i]);
            self.side_of[ring[i]] = Some(side);
        }
        let count = self.sides.len() - first;
        for k in 0..count {
            self.sides[first + k].beside =
                [(k + count - 1) % count, (k + 1) % count].map(|other| first + other);
        }
    }

    /// The sides opposite to one.
    fn opposite(&self, side: usize) -> impl Iterator<Item = usize> + '_ {
        let entered = &self.sides[side];
        let others = self.of_tile[entered.tile].iter().copied();
        others.filter(move |&other| other != side && !entered.beside.contains(&other))
    }

    /// Mean direction of the boundary among these sides, for who enters by one.
    fn shore(
        &self,
        tiling: &Tiling,
        entered: usize,
        sides: impl Iterator<Item = usize>,
    ) -> Option<Shore> {
        let screen = self.screen(tiling, entered);
        let mut mean = Mean::default();
        for side in sides.filter(|&side| self.sides[side].boundary) {
            for &h in &self.sides[side].half_edges {
                let along = way(tiling, h);
                let direction = unit(along).map_or(Coord::zero(), doubled);
                mean.add(direction, shadow(along, screen));
            }
        }
        mean.direction().map(|direction| Shore {
            tiles: 0,
            direction,
        })
    }

    /// What shadows fall on: the unit vector from one end of a side to the
    /// other; `None` for one that closes on itself.
    fn screen(&self, tiling: &Tiling, side: usize) -> Option<Point> {
        let half_edges = self.sides[side].half_edges.iter();
        unit(half_edges.fold(Coord::zero(), |sum, &h| sum + way(tiling, h)))
    }

    /// Finds all shores, nearest first: those in the entered tile, then those
    /// one tile farther, and so on. Strips that go round and round have none.
    fn walk(&mut self, tiling: &Tiling) {
        // The sides from which a strip comes to this one next.
        let mut from: Vec<Vec<usize>> = vec![Vec::new(); self.sides.len()];
        let mut front = Vec::new();
        for side in 0..self.sides.len() {
            if self.sides[side].boundary {
                continue; // Nobody enters from outside.
            }
            let shore = if self.opposite(side).next().is_some() {
                self.shore(tiling, side, self.opposite(side))
            } else {
                let beside = self.sides[side].beside;
                let once = beside
                    .into_iter()
                    .take(if beside[0] == beside[1] { 1 } else { 2 });
                self.shore(tiling, side, once.filter(|&other| other != side))
            };
            if shore.is_some() {
                self.shores[side] = shore;
                front.push(side);
                continue;
            }
            for (next, _) in self.next(side) {
                // Half-edges between the same two tiles follow each other.
                if from[next].last() != Some(&side) {
                    from[next].push(side);
                }
            }
        }
        let mut tiles = 0;
        while !front.is_empty() {
            tiles += 1;
            let mut reached: Vec<usize> = front
                .iter()
                .flat_map(|&side| from[side].iter().copied())
                .filter(|&side| self.shores[side].is_none())
                .collect();
            reached.sort_unstable();
            reached.dedup();
            // All of a round are found before any is written down, so that
            // none is taken for one of the round before.
            let found: Vec<Option<Shore>> = reached
                .iter()
                .map(|&side| {
                    let screen = self.screen(tiling, side);
                    let mut mean = Mean::default();
                    for (next, half_edge) in self.next(side) {
                        if let Some(shore) = self.shores[next] {
                            mean.add(shore.direction, shadow(way(tiling, half_edge), screen));
                        }
                    }
                    mean.direction().map(|direction| Shore { tiles, direction })
                })
                .collect();
            for (&side, shore) in reached.iter().zip(found) {
                self.shores[side] = shore;
            }
            front = reached;
        }
    }

    /// Where a strip that enters a tile by this side goes on to: the sides by
    /// which it enters the next tiles, each with the half-edge that leads there.
    fn next(&self, side: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.opposite(side)
            .flat_map(|other| self.sides[other].half_edges.iter())
            .filter_map(|&h| self.side_of[h ^ 1].map(|next| (next, h)))
    }
}

/// A weighted mean of doubled directions.
#[derive(Default)]
struct Mean {
    sum: Option<Point>,
    weight: f64,
}

impl Mean {
    fn add(&mut self, direction: Point, weight: f64) {
        self.sum = Some(self.sum.unwrap_or(Coord::zero()) + direction * weight);
        self.weight += weight;
    }

    fn direction(&self) -> Option<Point> {
        self.sum
            .filter(|_| self.weight > 0.0)
            .map(|sum| sum / self.weight)
    }
}

/// Length of the shadow of a vector on a screen; its own if there is none.
fn shadow(along: Point, screen: Option<Point>) -> f64 {
    screen.map_or(norm(along), |screen| dot(along, screen).abs())
}

/// A half-edge as a vector.
fn way(tiling: &Tiling, h: usize) -> Point {
    let [a, b] = tiling.edges[h / 2].vertices;
    let along = tiling.vertices[b] - tiling.vertices[a];
    if h & 1 == 0 {
        along
    } else {
        along * -1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criteria::angle::off_parallel;
    use crate::tiles::{tiles, Dangling, TileOptions};
    use crate::vector::point;
    use geo_types::{line_string, polygon, LineString, Polygon};

    fn keep(land: &Polygon<f64>, lines: &[LineString<f64>]) -> Tiling {
        let options = TileOptions {
            dangling: Dangling::Keep,
            ..TileOptions::default()
        };
        tiles(land, lines, &options).unwrap()
    }

    /// Shores of the edge of line `line` whose middle is nearest to `at`: tiles
    /// and angle to the edge in degrees, in ascending order.
    fn seen(tiling: &Tiling, line: usize, at: Point) -> Vec<(usize, f64)> {
        let middle = |e: usize| {
            let [a, b] = tiling.edges[e].vertices.map(|v| tiling.vertices[v]);
            (a + b) / 2.0
        };
        let edges = (0..tiling.edges.len()).filter(|&e| tiling.edges[e].lines.contains(&line));
        let edge = edges
            .min_by(|&a, &b| norm(middle(a) - at).total_cmp(&norm(middle(b) - at)))
            .unwrap();
        let shores = Strips::new(tiling).shores(edge);
        let mut seen: Vec<(usize, f64)> = shores
            .iter()
            .flatten()
            .map(|shore| {
                let off = off_parallel(way(tiling, 2 * edge), shore.direction).unwrap();
                (shore.tiles, (off * 90.0 * 1e6).round() / 1e6)
            })
            .collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen
    }

    fn grid(xs: &[f64], ys: &[f64]) -> Vec<LineString<f64>> {
        let upright = xs
            .iter()
            .map(|&x| line_string![(x: x, y: -50.), (x: x, y: 500.)]);
        let flat = ys
            .iter()
            .map(|&y| line_string![(x: -50., y: y), (x: 500., y: y)]);
        upright.chain(flat).collect()
    }

    /// The top rises by 20 degrees, all lines are upright or flat.
    #[test]
    fn a_strip_ends_where_its_two_lines_do() {
        let rise = 100.0 * 20_f64.to_radians().tan();
        let land =
            polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100. + rise), (x: 0., y: 100.)];
        let tiling = keep(&land, &grid(&[30.0, 60.0], &[20.0, 50.0, 90.0]));
        let flat = |line, x, y| seen(&tiling, line, point(x, y));
        assert_eq!(flat(2, 45.0, 20.0), [(0, 0.0), (2, 20.0)]);
        assert_eq!(flat(3, 45.0, 50.0), [(1, 0.0), (1, 20.0)]);
        assert_eq!(flat(4, 45.0, 90.0), [(0, 20.0), (2, 0.0)]);
        // The strip of the last row runs between a line and the slope.
        assert_eq!(flat(0, 30.0, 95.0), [(0, 0.0), (1, 0.0)]);
    }

    #[test]
    fn a_triangle_has_the_boundary_beside() {
        // A corner is cut off by 45 degrees.
        let land = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 100., y: 40.), (x: 100., y: 100.), (x: 0., y: 100.)];
        let tiling = keep(&land, &grid(&[70.0], &[30.0]));
        // Below lies the triangle (70, 10), (90, 30), (70, 30). Above, the end
        // of the slope is beside, and the right side is upright: the top alone
        // has a shadow.
        assert_eq!(seen(&tiling, 1, point(80.0, 30.0)), [(0, 0.0), (0, 45.0)]);
        // A pentagon with the slope ahead, next to the bottom: 60 m of that and
        // 10 m of shadow.
        let shores = seen(&tiling, 1, point(35.0, 30.0));
        assert_eq!(shores[0], (0, 0.0), "the top");
        // Doubled directions (1, 0) and (0, 1) with weights 60 and 10.
        let wanted = 10_f64.atan2(60.0).to_degrees() / 2.0;
        assert!((shores[1].1 - wanted).abs() < 1e-5);
    }

    /// What a strip meets first counts, though it branches and goes on.
    #[test]
    fn the_nearest_end_of_a_branching_strip() {
        let land = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 130.), (x: 45., y: 100.), (x: 0., y: 100.)];
        let lines = [
            line_string![(x: 0., y: 30.), (x: 90., y: 30.)],
            line_string![(x: 0., y: 60.), (x: 90., y: 60.)],
            line_string![(x: 45., y: 60.), (x: 45., y: 100.)],
            line_string![(x: 0., y: 80.), (x: 45., y: 80.)],
        ];
        let tiling = keep(&land, &lines);
        let slope = 30_f64.atan2(45.0).to_degrees();
        let shores = seen(&tiling, 0, point(45.0, 30.0));
        assert_eq!(shores[0], (0, 0.0));
        assert_eq!(shores[1].0, 1, "one tile before that under the slope");
        assert!((shores[1].1 - slope).abs() < 1e-6);
    }

    #[test]
    fn other_rings_are_opposite() {
        // Between two concentric squares: a line around. Of the hole and of the
        // outer boundary, the sides in its shadow count.
        let land = polygon!(
            exterior: [(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 90.), (x: 0., y: 90.)],
            interiors: [[(x: 30., y: 30.), (x: 60., y: 30.), (x: 60., y: 60.), (x: 30., y: 60.)]],
        );
        let around = line_string![(x: 20., y: 20.), (x: 70., y: 20.), (x: 70., y: 70.), (x: 20., y: 70.), (x: 20., y: 20.)];
        let tiling = keep(&land, std::slice::from_ref(&around));
        for at in [point(20.0, 45.0), point(45.0, 20.0)] {
            assert_eq!(seen(&tiling, 0, at), [(0, 0.0), (0, 0.0)]);
        }
    }

    #[test]
    fn a_circular_strip_has_none() {
        let circle = |r: f64| {
            let at = |i: i32| f64::from(i) * std::f64::consts::TAU / 64.0;
            LineString(
                (0..=64)
                    .map(|i| point(at(i % 64).cos(), at(i % 64).sin()) * r)
                    .collect(),
            )
        };
        let land = Polygon::new(circle(100.0), vec![circle(40.0)]);
        let ray = |i: i32| {
            let (sin, cos) = f64::to_radians(f64::from(i) * 72.0 + 1.0).sin_cos();
            LineString(vec![point(cos, sin) * 39.0, point(cos, sin) * 101.0])
        };
        let lines: Vec<_> = [circle(60.0), circle(80.0)]
            .into_iter()
            .chain((0..5).map(ray))
            .collect();
        let tiling = keep(&land, &lines);
        let (sin, cos) = 1_f64.to_radians().sin_cos();
        assert_eq!(seen(&tiling, 2, point(cos, sin) * 70.0), []);
        // The circles look out and in along the rays, onto 72 degrees of the
        // boundary.
        let shores = seen(&tiling, 0, point(0.0, 60.0));
        assert_eq!(shores.iter().map(|s| s.0).collect::<Vec<_>>(), [0, 1]);
    }
}
