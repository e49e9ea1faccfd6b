//! A grid over line segments: what a ray meets first, and what is nearest.

use geo_types::Coord;

use crate::plane::{at, dist, nearest_on, ray_hit};

/// Segments in a uniform grid, for rays and nearest-segment queries whose cost
/// follows what lies near, not the number of segments.
#[derive(Clone, Debug)]
pub(crate) struct SegmentGrid {
    segments: Vec<(Coord<f64>, Coord<f64>)>,
    cells: Vec<Vec<u32>>,
    low: Coord<f64>,
    size: f64,
    columns: i64,
    rows: i64,
}

/// What a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    /// Metres from the query point.
    pub(crate) distance: f64,
    /// Index of the segment.
    pub(crate) segment: usize,
    /// The point on it.
    pub(crate) point: Coord<f64>,
}

impl SegmentGrid {
    pub(crate) fn new(segments: Vec<(Coord<f64>, Coord<f64>)>) -> Self {
        let mut low = at(f64::INFINITY, f64::INFINITY);
        let mut high = at(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in segments.iter().flat_map(|s| [s.0, s.1]) {
            low = at(low.x.min(p.x), low.y.min(p.y));
            high = at(high.x.max(p.x), high.y.max(p.y));
        }
        if segments.is_empty() {
            (low, high) = (at(0.0, 0.0), at(0.0, 0.0));
        }
        let (width, height) = ((high.x - low.x).max(1e-9), (high.y - low.y).max(1e-9));
        // About one segment a cell, and never a grid much larger than its content.
        let wanted = (segments.len().max(1) as f64).clamp(1.0, 4e6);
        let size = (width * height / wanted)
            .sqrt()
            .max(width.max(height) / 2048.0)
            .max(1e-9);
        let columns = (width / size).floor() as i64 + 1;
        let rows = (height / size).floor() as i64 + 1;
        let mut grid = Self {
            segments,
            cells: vec![Vec::new(); (columns * rows) as usize],
            low,
            size,
            columns,
            rows,
        };
        for i in 0..grid.segments.len() {
            let (a, b) = grid.segments[i];
            grid.enter(a, b, u32::try_from(i).unwrap_or(u32::MAX));
        }
        grid
    }

    fn cell_of(&self, p: Coord<f64>) -> (i64, i64) {
        (
            ((p.x - self.low.x) / self.size).floor() as i64,
            ((p.y - self.low.y) / self.size).floor() as i64,
        )
    }

    fn cell(&self, column: i64, row: i64) -> &[u32] {
        if column < 0 || row < 0 || column >= self.columns || row >= self.rows {
            &[]
        } else {
            &self.cells[(row * self.columns + column) as usize]
        }
    }

    /// Puts a segment into each cell of the columns that it spans, row by row.
    fn enter(&mut self, a: Coord<f64>, b: Coord<f64>, index: u32) {
        let (p, q) = if a.x <= b.x { (a, b) } else { (b, a) };
        let (first, last) = (
            self.cell_of(p).0.max(0),
            self.cell_of(q).0.min(self.columns - 1),
        );
        for column in first..=last {
            let x0 = self.low.x + column as f64 * self.size;
            let clip = |x: f64| {
                let t = if q.x > p.x {
                    ((x - p.x) / (q.x - p.x)).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                p.y + t * (q.y - p.y)
            };
            let (mut y0, mut y1) = if q.x > p.x {
                (clip(x0), clip(x0 + self.size))
            } else {
                (p.y, q.y)
            };
            if y0 > y1 {
                std::mem::swap(&mut y0, &mut y1);
            }
            let slack = 1e-9 * self.size;
            let low = self.cell_of(at(x0, y0 - slack)).1.max(0);
            let high = self.cell_of(at(x0, y1 + slack)).1.min(self.rows - 1);
            for row in low..=high {
                self.cells[(row * self.columns + column) as usize].push(index);
            }
        }
    }

    /// The first segment that the ray from `from` along the unit vector `dir`
    /// meets farther than `least` and no farther than `most`.
    pub(crate) fn ray(
        &self,
        from: Coord<f64>,
        dir: Coord<f64>,
        least: f64,
        most: f64,
    ) -> Option<Hit> {
        let (mut column, mut row) = self.cell_of(from);
        let step = |d: f64| if d > 0.0 { 1 } else { -1 };
        let edge = |p: f64, low: f64, cell: i64, d: f64| {
            if d == 0.0 {
                f64::INFINITY
            } else {
                (low + (cell + i64::from(d > 0.0)) as f64 * self.size - p) / d
            }
        };
        let mut best: Option<Hit> = None;
        let mut travelled = 0.0;
        while travelled <= most {
            for &i in self.cell(column, row) {
                let (a, b) = self.segments[i as usize];
                if let Some(s) = ray_hit(from, dir, a, b) {
                    if s > least && s <= most && best.is_none_or(|h| s < h.distance) {
                        best = Some(Hit {
                            distance: s,
                            segment: i as usize,
                            point: from + dir * s,
                        });
                    }
                }
            }
            let (tx, ty) = (
                edge(from.x, self.low.x, column, dir.x),
                edge(from.y, self.low.y, row, dir.y),
            );
            travelled = tx.min(ty);
            if best.is_some_and(|h| h.distance <= travelled) {
                break;
            }
            if tx < ty {
                column += step(dir.x);
            } else {
                row += step(dir.y);
            }
            let gone = (dir.x > 0.0 && column >= self.columns)
                || (dir.x < 0.0 && column < 0)
                || (dir.y > 0.0 && row >= self.rows)
                || (dir.y < 0.0 && row < 0);
            if gone || !travelled.is_finite() {
                break;
            }
        }
        best
    }

    /// The segment nearest to `p` within `most` metres.
    pub(crate) fn nearest(&self, p: Coord<f64>, most: f64) -> Option<Hit> {
        if self.segments.is_empty() {
            return None;
        }
        let (column, row) = self.cell_of(p);
        let mut best: Option<Hit> = None;
        // Shells that touch the grid at all.
        let outside = |cell: i64, count: i64| (-cell).max(cell - count + 1).max(0);
        let across = |cell: i64, count: i64| cell.abs().max((cell - count + 1).abs());
        let first = outside(column, self.columns).max(outside(row, self.rows));
        let last = across(column, self.columns)
            .max(across(row, self.rows))
            .min((most / self.size).ceil() as i64 + 1);
        for radius in first..=last {
            for (c, r) in shell(column, row, radius) {
                for &i in self.cell(c, r) {
                    let (a, b) = self.segments[i as usize];
                    let point = nearest_on(a, b, p).0;
                    let distance = dist(p, point);
                    if distance <= most && best.is_none_or(|h| distance < h.distance) {
                        best = Some(Hit {
                            distance,
                            segment: i as usize,
                            point,
                        });
                    }
                }
            }
            // A cell `radius + 1` away is at least `radius * size` away.
            if best.is_some_and(|h| h.distance <= radius as f64 * self.size) {
                break;
            }
        }
        best
    }
}

/// Cells at Chebyshev distance `radius` from a centre.
fn shell(column: i64, row: i64, radius: i64) -> impl Iterator<Item = (i64, i64)> {
    let side = 2 * radius + 1;
    let count = if radius == 0 { 1 } else { 8 * radius };
    (0..count).map(move |k| {
        if radius == 0 {
            (column, row)
        } else if k < side {
            (column - radius + k, row - radius)
        } else if k < 2 * side {
            (column - radius + (k - side), row + radius)
        } else {
            let j = k - 2 * side;
            let x = if j % 2 == 0 {
                column - radius
            } else {
                column + radius
            };
            (x, row - radius + 1 + j / 2)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::unit;

    fn noise(i: u64) -> f64 {
        (crate::planner::seed::mix(i) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The grid agrees with trying every segment.
    #[test]
    fn queries_agree_with_brute_force() {
        let segments: Vec<_> = (0..300u64)
            .map(|i| {
                let a = at(noise(4 * i) * 100.0, noise(4 * i + 1) * 40.0);
                (
                    a,
                    a + at(noise(4 * i + 2) * 10.0 - 5.0, noise(4 * i + 3) * 10.0 - 5.0),
                )
            })
            .collect();
        let grid = SegmentGrid::new(segments.clone());
        for k in 0..400u64 {
            let from = at(
                noise(9000 + 3 * k) * 140.0 - 20.0,
                noise(9001 + 3 * k) * 80.0 - 20.0,
            );
            let dir = unit(at(noise(7000 + k) - 0.5, noise(8000 + k) - 0.5));
            let brute = segments
                .iter()
                .filter_map(|&(a, b)| ray_hit(from, dir, a, b))
                .filter(|&s| s > 0.0 && s <= 60.0)
                .min_by(f64::total_cmp);
            assert_eq!(
                grid.ray(from, dir, 0.0, 60.0).map(|h| h.distance),
                brute,
                "ray {k}"
            );
            let near = segments
                .iter()
                .map(|&(a, b)| dist(from, nearest_on(a, b, from).0))
                .min_by(f64::total_cmp);
            let found = grid.nearest(from, 200.0).map(|h| h.distance);
            assert_eq!(found, near, "nearest {k}");
        }
    }

    #[test]
    fn axis_parallel_rays_and_empty_grids() {
        let grid = SegmentGrid::new(vec![(at(5.0, -1.0), at(5.0, 1.0))]);
        assert_eq!(
            grid.ray(at(0.0, 0.0), at(1.0, 0.0), 0.0, 9.0)
                .map(|h| h.distance),
            Some(5.0)
        );
        assert!(grid.ray(at(0.0, 0.0), at(0.0, 1.0), 0.0, 9.0).is_none());
        assert!(SegmentGrid::new(Vec::new())
            .nearest(at(0.0, 0.0), 10.0)
            .is_none());
    }
}
