//! Segments under a uniform grid: what a ray meets first.

use crate::vector::{cross, dot, is_finite, norm, point, Point};

/// Most cells along one side of the grid.
const SIDE: f64 = 512.0;

/// A segment and what is subtracted from distances to it, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wall {
    pub(super) a: Point,
    pub(super) b: Point,
    pub(super) offset: f64,
}

/// Walls in square cells; each cell lists the walls that meet it.
#[derive(Clone, Debug)]
pub(super) struct RayGrid {
    walls: Vec<Wall>,
    low: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    begin: Vec<u32>,
    listed: Vec<u32>,
}

impl RayGrid {
    /// Walls with a coordinate that is not finite, or without length, are left
    /// out. About two cells a wall, never more than 512 a side.
    pub(super) fn new(walls: impl IntoIterator<Item = Wall>) -> Self {
        let fit = |w: &Wall| is_finite(w.a) && is_finite(w.b) && w.offset.is_finite() && w.a != w.b;
        let walls: Vec<Wall> = walls.into_iter().filter(fit).collect();
        let mut low = point(f64::INFINITY, f64::INFINITY);
        let mut high = point(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in walls.iter().flat_map(|w| [w.a, w.b]) {
            low = point(low.x.min(p.x), low.y.min(p.y));
            high = point(high.x.max(p.x), high.y.max(p.y));
        }
        if walls.is_empty() {
            (low, high) = (point(0.0, 0.0), point(0.0, 0.0));
        }
        let (width, height) = (high.x - low.x, high.y - low.y);
        let longest = width.max(height);
        let wanted = (width * height / (2.0 * walls.len() as f64 + 1.0)).sqrt();
        let mut cell = wanted.max(longest / SIDE);
        if cell.is_nan() || cell <= 0.0 {
            cell = 1.0;
        }
        let columns = (width / cell) as usize + 1;
        let rows = (height / cell) as usize + 1;
        let mut grid = Self {
            walls,
            low,
            cell,
            columns,
            rows,
            begin: Vec::new(),
            listed: Vec::new(),
        };
        grid.fill();
        grid
    }

    fn fill(&mut self) {
        let mut begin = vec![0_u32; self.columns * self.rows + 1];
        for wall in &self.walls {
            self.cells_of(wall, |c| begin[c + 1] += 1);
        }
        for i in 1..begin.len() {
            begin[i] += begin[i - 1];
        }
        let mut next = begin.clone();
        let mut listed = vec![0; begin[begin.len() - 1] as usize];
        for (i, wall) in self.walls.iter().enumerate() {
            self.cells_of(wall, |c| {
                listed[next[c] as usize] = i as u32;
                next[c] += 1;
            });
        }
        (self.begin, self.listed) = (begin, listed);
    }

    /// Every cell that the wall meets, and maybe some beside it: column by
    /// column the rows between the wall's two crossings of its sides.
    fn cells_of(&self, wall: &Wall, mut visit: impl FnMut(usize)) {
        let (a, b) = (
            (wall.a - self.low) / self.cell,
            (wall.b - self.low) / self.cell,
        );
        let (a, b) = if a.x <= b.x { (a, b) } else { (b, a) };
        // Widened by what rounding may hide.
        const SLACK: f64 = 1e-9;
        let column = |x: f64| (x.max(0.0) as usize).min(self.columns - 1);
        let row = |y: f64| (y.max(0.0) as usize).min(self.rows - 1);
        for x in column(a.x - SLACK)..=column(b.x + SLACK) {
            let at = |x: f64| {
                let t = if b.x > a.x {
                    ((x - a.x) / (b.x - a.x)).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                a.y + (b.y - a.y) * t
            };
            let (mut y0, mut y1) = (at(x as f64 - SLACK), at(x as f64 + 1.0 + SLACK));
            if b.x - a.x <= 2.0 * SLACK {
                (y0, y1) = (a.y, b.y);
            }
            for y in row(y0.min(y1) - SLACK)..=row(y0.max(y1) + SLACK) {
                visit(y * self.columns + x);
            }
        }
    }

    /// Distance from `from` along the unit vector `way` to the first wall, and
    /// the wall; `None` if the ray meets none.
    ///
    /// Walks the cells along the ray (J. Amanatides, A. Woo, *A Fast Voxel
    /// Traversal Algorithm for Ray Tracing*, 1987).
    pub(super) fn first_hit(&self, from: Point, way: Point) -> Option<(f64, &Wall)> {
        if self.walls.is_empty() || !is_finite(from) || !is_finite(way) {
            return None;
        }
        let p = (from - self.low) / self.cell;
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for (p, way, count) in [(p.x, way.x, self.columns), (p.y, way.y, self.rows)] {
            let (a, b) = ((-p) / way, (count as f64 - p) / way);
            if way == 0.0 {
                if p < 0.0 || p > count as f64 {
                    return None;
                }
            } else {
                near = near.max(a.min(b));
                far = far.min(a.max(b));
            }
        }
        if near > far {
            return None;
        }
        let enter = p + way * near;
        let mut x = (enter.x.max(0.0) as usize).min(self.columns - 1);
        let mut y = (enter.y.max(0.0) as usize).min(self.rows - 1);
        let edge = |p: f64, way: f64, i: usize| {
            if way > 0.0 {
                (i as f64 + 1.0 - p) / way
            } else if way < 0.0 {
                (i as f64 - p) / way
            } else {
                f64::INFINITY
            }
        };
        let mut best: Option<(f64, &Wall)> = None;
        loop {
            let c = y * self.columns + x;
            for &i in &self.listed[self.begin[c] as usize..self.begin[c + 1] as usize] {
                let wall = &self.walls[i as usize];
                if let Some(t) = hit(from, way, wall) {
                    if best.is_none_or(|(least, _)| t < least) {
                        best = Some((t, wall));
                    }
                }
            }
            let (tx, ty) = (edge(p.x, way.x, x), edge(p.y, way.y, y));
            let leave = tx.min(ty);
            if best.is_some_and(|(t, _)| t <= leave * self.cell) || leave > far {
                return best;
            }
            // A step outside the grid ends the walk.
            let inside = if tx < ty {
                step(&mut x, way.x, self.columns)
            } else {
                step(&mut y, way.y, self.rows)
            };
            if !inside {
                return best;
            }
        }
    }
}

fn step(i: &mut usize, way: f64, count: usize) -> bool {
    if way > 0.0 {
        *i += 1;
        *i < count
    } else if *i > 0 {
        *i -= 1;
        true
    } else {
        false
    }
}

/// Where the ray meets the wall; none if it runs along it, or only starts on
/// it. Walls are a hair longer than they are, so that no ray slips through
/// where two meet.
fn hit(from: Point, way: Point, wall: &Wall) -> Option<f64> {
    let side = wall.b - wall.a;
    let area = cross(way, side);
    let length = norm(side);
    if area.abs() <= 1e-12 * length {
        return None;
    }
    let reach = wall.a - from;
    let (t, u) = (cross(reach, side) / area, cross(reach, way) / area);
    let size = norm(reach) + length;
    ((-1e-9..=1.0 + 1e-9).contains(&u) && t > 1e-9 * size).then_some(t)
}

/// Squared distance from a point to a wall, for the nearest-wall search.
pub(super) fn square_distance(p: Point, wall: &Wall) -> f64 {
    let gap = crate::vector::nearest_on_segment(p, wall.a, wall.b) - p;
    dot(gap, gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walls() -> Vec<Wall> {
        let number = |i: usize, k: usize| ((i * k) % 997) as f64;
        (1..300)
            .map(|i| {
                let a = point(number(i, 389), number(i, 613) * 0.4);
                let b = a + point(number(i, 71) - 498.0, number(i, 53) - 498.0) * 0.08;
                Wall {
                    a,
                    b,
                    offset: i as f64,
                }
            })
            .collect()
    }

    #[test]
    fn first_hit_agrees_with_trying_all_walls() {
        let walls = walls();
        let grid = RayGrid::new(walls.clone());
        let mut hits = 0;
        for i in 0..2000 {
            let from = point(
                (i * 37 % 1201) as f64 - 100.0,
                (i * 91 % 601) as f64 - 100.0,
            );
            let angle = match i % 5 {
                0 => (i / 5) as f64 * std::f64::consts::FRAC_PI_2,
                _ => i as f64 * 0.77,
            };
            let way = if i % 5 == 0 {
                [point(1., 0.), point(0., 1.), point(-1., 0.), point(0., -1.)][i / 5 % 4]
            } else {
                point(angle.cos(), angle.sin())
            };
            let plain = walls
                .iter()
                .filter_map(|w| hit(from, way, w))
                .fold(f64::INFINITY, f64::min);
            let quick = grid.first_hit(from, way).map_or(f64::INFINITY, |(t, _)| t);
            assert_eq!(plain, quick, "{from:?} {way:?}");
            hits += usize::from(quick.is_finite());
        }
        assert!((500..2000).contains(&hits), "{hits}");
    }

    #[test]
    fn degenerate_walls_are_harmless() {
        let one = Wall {
            a: point(5., 0.),
            b: point(5., 9.),
            offset: 2.0,
        };
        let bad = Wall {
            a: point(f64::NAN, 0.),
            ..one
        };
        let dot = Wall { a: one.b, ..one };
        let grid = RayGrid::new([bad, dot, one]);
        assert_eq!(
            grid.first_hit(point(0., 3.), point(1., 0.)),
            Some((5.0, &one))
        );
        assert_eq!(grid.first_hit(point(0., 3.), point(-1., 0.)), None);
        assert_eq!(
            grid.first_hit(point(5., 20.), point(0., -1.)),
            None,
            "along the wall"
        );
        assert_eq!(
            RayGrid::new([]).first_hit(point(0., 0.), point(1., 0.)),
            None
        );
    }
}
