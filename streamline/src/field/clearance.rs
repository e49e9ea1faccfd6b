//! How far is the boundary at least? A raster that answers for most points
//! without a look at any edge.
//!
//! Cells that no edge meets lie wholly inside or wholly outside. Each carries
//! its chessboard distance, in cells, to the nearest cell that an edge meets: a
//! point of a cell at distance k is at least k - 1 cells from every edge.

use crate::vector::{point, Point};

/// Cells along the longer side.
const SIDE: f64 = 128.0;
/// Widening of an edge in cells, for what rounding may hide.
const SLACK: f64 = 1e-9;

/// Signed distances of the cells: positive inside, negative outside, 0 where an
/// edge passes.
#[derive(Clone, Debug, Default)]
pub(super) struct Clearance {
    low: Point,
    cell: f64,
    /// 1 / `cell`.
    scale: f64,
    columns: usize,
    rows: usize,
    /// Empty for a domain without extent, for which nothing is known.
    steps: Vec<i16>,
}

impl Clearance {
    /// A raster over the box from `low` to `high`, which holds all edges.
    /// Edges count as `skin` wide to either side; `holds` says whether a point
    /// off them is inside.
    pub(super) fn new(
        edges: impl Iterator<Item = (Point, Point)>,
        (low, high): (Point, Point),
        skin: f64,
        holds: impl Fn(Point) -> bool,
    ) -> Self {
        let (width, height) = (high.x - low.x, high.y - low.y);
        let cell = width.max(height) / SIDE;
        let slack = SLACK + 2.0 * skin / cell;
        // A boundary as thick as a cell leaves none free.
        if !(cell > 0.0 && cell.is_finite() && slack < 0.25) {
            return Self::default();
        }
        let (columns, rows) = ((width / cell) as usize + 1, (height / cell) as usize + 1);
        let mut raster = Self {
            low,
            cell,
            scale: 1.0 / cell,
            columns,
            rows,
            steps: vec![i16::MAX; columns * rows],
        };
        for (a, b) in edges {
            raster.mark(a, b, slack);
        }
        raster.spread();
        raster.sign(holds);
        raster
    }

    /// Zero for every cell that the edge meets, and maybe some beside it:
    /// column by column the rows between the edge's crossings of its sides.
    fn mark(&mut self, a: Point, b: Point, slack: f64) {
        let (a, b) = ((a - self.low) / self.cell, (b - self.low) / self.cell);
        let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
        let column = |x: f64| (x.max(0.0) as usize).min(self.columns - 1);
        let row = |y: f64| (y.max(0.0) as usize).min(self.rows - 1);
        for x in column(a.x - slack)..=column(b.x + slack) {
            let at = |x: f64| a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)).clamp(0.0, 1.0);
            let (y0, y1) = if b.x - a.x <= 2.0 * slack {
                (a.y, b.y)
            } else {
                (at(x as f64 - slack), at(x as f64 + 1.0 + slack))
            };
            for y in row(y0.min(y1) - slack)..=row(y0.max(y1) + slack) {
                self.steps[y * self.columns + x] = 0;
            }
        }
    }

    /// Chessboard distances, by one pass forwards and one back.
    fn spread(&mut self) {
        let (columns, rows) = (self.columns, self.rows);
        let steps = &mut self.steps;
        let mut lower = |c: usize, others: [Option<usize>; 4]| {
            for other in others.into_iter().flatten() {
                steps[c] = steps[c].min(steps[other].saturating_add(1));
            }
        };
        for c in 0..columns * rows {
            let (x, y) = (c % columns, c / columns);
            let (west, south, east) = (x > 0, y > 0, x + 1 < columns);
            lower(
                c,
                [
                    west.then(|| c - 1),
                    south.then(|| c - columns),
                    (south && west).then(|| c - columns - 1),
                    (south && east).then(|| c + 1 - columns),
                ],
            );
        }
        for c in (0..columns * rows).rev() {
            let (x, y) = (c % columns, c / columns);
            let (west, north, east) = (x > 0, y + 1 < rows, x + 1 < columns);
            lower(
                c,
                [
                    east.then(|| c + 1),
                    north.then(|| c + columns),
                    (north && east).then(|| c + columns + 1),
                    (north && west).then(|| c + columns - 1),
                ],
            );
        }
    }

    /// Negative outside. Free cells in a row, and over each other, lie on the
    /// same side, so that few have to be asked for.
    fn sign(&mut self, holds: impl Fn(Point) -> bool) {
        for y in 0..self.rows {
            let row = y * self.columns;
            let mut x = 0;
            while x < self.columns {
                if self.steps[row + x] == 0 {
                    x += 1;
                    continue;
                }
                let mut end = x;
                while end < self.columns && self.steps[row + end] != 0 {
                    end += 1;
                }
                let below = (x..end)
                    .filter(|_| y > 0)
                    .map(|i| self.steps[row - self.columns + i])
                    .find(|&steps| steps != 0);
                let inside = below.map_or_else(
                    || holds(self.low + point(x as f64 + 0.5, y as f64 + 0.5) * self.cell),
                    |steps| steps > 0,
                );
                if !inside {
                    for steps in &mut self.steps[row + x..row + end] {
                        *steps = -*steps;
                    }
                }
                x = end;
            }
        }
    }

    #[inline]
    fn steps(&self, p: Point) -> i16 {
        let (x, y) = (
            (p.x - self.low.x) * self.scale,
            (p.y - self.low.y) * self.scale,
        );
        // Not so for NaN either.
        if !(x >= 0.0 && y >= 0.0) {
            return 0;
        }
        let (x, y) = (x as usize, y as usize);
        if x < self.columns && y < self.rows {
            self.steps
                .get(y * self.columns + x)
                .copied()
                .unwrap_or_default()
        } else {
            0
        }
    }

    /// Whether `p` is inside, where the raster knows.
    pub(super) fn holds(&self, p: Point) -> Option<bool> {
        match self.steps(p) {
            0 => None,
            steps => Some(steps > 0),
        }
    }

    /// No edge is nearer to `p` than this.
    pub(super) fn around(&self, p: Point) -> f64 {
        f64::from(self.steps(p).unsigned_abs().max(1) - 1) * self.cell
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{cross, distance, nearest_on_segment};

    #[test]
    fn agrees_with_looking_at_all_edges() {
        // A star with a hole, far from square.
        let star: Vec<Point> = (0..17)
            .map(|i| {
                let (r, u) = (100.0 - 60.0 * (i % 2) as f64, i as f64 * 0.3696);
                point(3.0 * r * u.cos(), r * u.sin())
            })
            .collect();
        let hole = [point(-30., -10.), point(-30., 12.), point(15., 3.)];
        let mut edges = Vec::new();
        for ring in [&star[..], &hole[..]] {
            edges.extend((0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
        }
        let holds = |p: Point| {
            let crossed = edges.iter().filter(|(a, b)| {
                let (low, high) = if a.y < b.y { (*a, *b) } else { (*b, *a) };
                low.y <= p.y && p.y < high.y && cross(high - low, p - low) > 0.0
            });
            crossed.count() % 2 == 1
        };
        let corners = (point(-300., -100.), point(300., 100.));
        let raster = Clearance::new(edges.iter().copied(), corners, 1e-9, holds);
        let (mut known, mut count) = (0, 0);
        for i in 0..160 {
            for j in 0..90 {
                let p = point(-310.0 + 3.9 * i as f64, -105.0 + 2.37 * j as f64);
                let off = edges
                    .iter()
                    .map(|&(a, b)| distance(nearest_on_segment(p, a, b), p))
                    .fold(f64::INFINITY, f64::min);
                assert!(raster.around(p) <= off, "{p:?}");
                if let Some(inside) = raster.holds(p) {
                    assert_eq!(inside, holds(p), "{p:?}");
                    known += 1;
                }
                count += 1;
            }
        }
        assert!(known * 10 > count * 7, "{known} of {count}");
        assert_eq!(raster.holds(point(f64::NAN, 0.0)), None);
    }

    #[test]
    fn domains_without_extent_know_nothing() {
        let p = point(3.0, 4.0);
        let raster = Clearance::new([(p, p)].into_iter(), (p, p), 1e-9, |_| true);
        assert_eq!((raster.holds(p), raster.around(p)), (None, 0.0));
        let thick = (point(0.0, 0.0), point(1.0, 1.0));
        let raster = Clearance::new([thick].into_iter(), thick, 0.01, |_| true);
        assert_eq!(raster.holds(point(0.9, 0.1)), None);
    }
}
