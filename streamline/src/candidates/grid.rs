//! Seeds in a uniform grid: which of them lie near a line?

use crate::vector::{distance, nearest_on_segment, point, Point};

/// Finite points in square cells, compressed by row (counting sort).
#[derive(Debug)]
pub(super) struct SeedGrid<'a> {
    seeds: &'a [Point],
    low: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where each cell's seeds begin in `order`.
    begin: Vec<u32>,
    order: Vec<u32>,
    /// For each seed the round in which it was last near a line, its distance
    /// to that line and its place in the answer.
    noted: Vec<Noted>,
    round: u32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Noted {
    round: u32,
    gap: f64,
    place: usize,
}

/// A seed near a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Near {
    pub(super) seed: usize,
    /// The line's direction where it comes nearest, of any length.
    pub(super) tangent: Point,
}

impl<'a> SeedGrid<'a> {
    /// Cells of about `reach`, or wider where that would make far more cells
    /// than seeds.
    pub(super) fn new(seeds: &'a [Point], reach: f64) -> Self {
        let mut low = point(f64::INFINITY, f64::INFINITY);
        let mut high = point(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in seeds {
            low = point(low.x.min(p.x), low.y.min(p.y));
            high = point(high.x.max(p.x), high.y.max(p.y));
        }
        let (width, height) = if seeds.is_empty() {
            (0.0, 0.0)
        } else {
            (high.x - low.x, high.y - low.y)
        };
        let limit = 4.0 * seeds.len() as f64 + 64.0;
        // Either bound alone keeps the number of cells near the limit, for
        // square and for needle-thin extents.
        let cell = reach
            .max((width * height / limit).sqrt())
            .max(width.max(height) / limit);
        let columns = (width / cell) as usize + 1;
        let rows = (height / cell) as usize + 1;
        let cell_of = |p: &Point| {
            let (x, y) = (
                ((p.x - low.x) / cell) as usize,
                ((p.y - low.y) / cell) as usize,
            );
            y.min(rows - 1) * columns + x.min(columns - 1)
        };
        let mut begin = vec![0_u32; columns * rows + 1];
        for p in seeds {
            begin[cell_of(p) + 1] += 1;
        }
        for i in 1..begin.len() {
            begin[i] += begin[i - 1];
        }
        let mut next = begin.clone();
        let mut order = vec![0; seeds.len()];
        for (i, p) in seeds.iter().enumerate() {
            let slot = &mut next[cell_of(p)];
            order[*slot as usize] = i as u32;
            *slot += 1;
        }
        Self {
            seeds,
            low,
            cell,
            columns,
            rows,
            begin,
            order,
            noted: vec![Noted::default(); seeds.len()],
            round: 0,
        }
    }

    /// All seeds within `reach` of the polyline, each once.
    pub(super) fn near(&mut self, line: &[Point], reach: f64) -> Vec<Near> {
        self.round += 1;
        let mut found: Vec<Near> = Vec::new();
        for pair in line.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let (x0, x1) = self.span(
                a.x.min(b.x) - reach,
                a.x.max(b.x) + reach,
                self.low.x,
                self.columns,
            );
            let (y0, y1) = self.span(
                a.y.min(b.y) - reach,
                a.y.max(b.y) + reach,
                self.low.y,
                self.rows,
            );
            for y in y0..y1 {
                // Cells of a row are neighbours in `order`.
                let (first, last) = (
                    self.begin[y * self.columns + x0],
                    self.begin[y * self.columns + x1],
                );
                for k in first..last {
                    let seed = self.order[k as usize] as usize;
                    let gap =
                        distance(nearest_on_segment(self.seeds[seed], a, b), self.seeds[seed]);
                    if gap > reach {
                        continue;
                    }
                    let noted = &mut self.noted[seed];
                    if noted.round != self.round {
                        *noted = Noted {
                            round: self.round,
                            gap,
                            place: found.len(),
                        };
                        found.push(Near {
                            seed,
                            tangent: b - a,
                        });
                    } else if gap < noted.gap {
                        noted.gap = gap;
                        found[noted.place].tangent = b - a;
                    }
                }
            }
        }
        found
    }

    /// Half-open range of the cells that meet an interval; empty if none does.
    fn span(&self, from: f64, to: f64, low: f64, count: usize) -> (usize, usize) {
        let first = ((from - low) / self.cell).floor().max(0.0) as usize;
        let last = ((to - low) / self.cell).floor();
        if last < 0.0 || first >= count {
            return (0, 0);
        }
        (first, (last as usize + 1).min(count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_agrees_with_looking_at_all_pairs() {
        let seeds: Vec<Point> = (0..400)
            .map(|i| point((i * 73 % 401) as f64, (i * 151 % 397) as f64 * 0.5))
            .collect();
        let line: Vec<Point> = (0..60)
            .map(|i| point(i as f64 * 8.0 - 20.0, 90.0 + 60.0 * (i as f64 * 0.15).sin()))
            .collect();
        for reach in [0.5, 9.0, 70.0] {
            let mut grid = SeedGrid::new(&seeds, reach);
            for _ in 0..2 {
                let mut near = grid.near(&line, reach);
                near.sort_by_key(|n| n.seed);
                let mut expected = Vec::new();
                for (seed, &p) in seeds.iter().enumerate() {
                    let gap = |s: &[Point]| distance(nearest_on_segment(p, s[0], s[1]), p);
                    let best = line
                        .windows(2)
                        .min_by(|s, t| gap(s).total_cmp(&gap(t)))
                        .unwrap();
                    if gap(best) <= reach {
                        expected.push(Near {
                            seed,
                            tangent: best[1] - best[0],
                        });
                    }
                }
                assert_eq!(near.len(), expected.len());
                assert!(near.iter().zip(&expected).all(|(a, b)| a.seed == b.seed));
            }
        }
    }

    #[test]
    fn needles_and_nothing_stay_small() {
        let needle: Vec<Point> = (0..100).map(|i| point(i as f64 * 1e5, 0.0)).collect();
        let grid = SeedGrid::new(&needle, 1.0);
        assert!(grid.columns * grid.rows < 1000);
        assert!(SeedGrid::new(&[], 9.0)
            .near(&[point(0., 0.), point(9., 0.)], 5.0)
            .is_empty());
        let mut one = SeedGrid::new(&needle[..1], 9.0);
        assert_eq!(one.near(&[point(-5., 3.), point(5., 3.)], 3.0).len(), 1);
    }
}
