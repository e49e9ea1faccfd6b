//! The integer grid that an arrangement is computed on.
//!
//! Its spacing is a power of two and its origin a multiple of it, both so
//! coarse that every grid point is a floating-point number: going back from the
//! grid rounds nothing. Coordinates of the domain stay below 2^38 in magnitude
//! and those of clipped lines below 2^39, so that all predicates are exact in
//! 128-bit integers (the largest product, in `snap`, is below 2^122).

use crate::error::TraceError;
use crate::vector::{is_finite, point, Point};
use geo_types::Polygon;

/// A point of the grid.
pub(super) type Node = (i64, i64);

/// Extents and coordinates beyond these have squares that leave the range of
/// the arithmetic.
const LARGEST: f64 = 1e100;
const SMALLEST: f64 = 1e-100;

#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: Point,
    pub(super) spacing: f64,
    /// Half the extent of the box that lines are clipped to.
    reach: f64,
}

impl Grid {
    /// A grid for the domain, with its checks.
    pub(super) fn new(domain: &Polygon<f64>) -> Result<Self, TraceError> {
        let mut low = point(f64::INFINITY, f64::INFINITY);
        let mut high = point(f64::NEG_INFINITY, f64::NEG_INFINITY);
        let rings = std::iter::once(domain.exterior()).chain(domain.interiors());
        for (ring, line) in rings.enumerate() {
            for &p in &line.0 {
                if !usable(p) {
                    return Err(TraceError::DomainNotFinite {
                        ring,
                        x: p.x,
                        y: p.y,
                    });
                }
                low = point(low.x.min(p.x), low.y.min(p.y));
                high = point(high.x.max(p.x), high.y.max(p.y));
            }
        }
        let size = (high.x - low.x).max(high.y - low.y);
        if !(high.x - low.x > 0.0 && high.y - low.y > 0.0 && size > SMALLEST) {
            return Err(TraceError::DomainWithoutArea);
        }
        let magnitude = [low.x, low.y, high.x, high.y]
            .iter()
            .fold(0.0_f64, |m, v| m.max(v.abs()));
        // Two units in the last place of the largest coordinate, at least.
        let spacing =
            power_above(size / 2.0_f64.powi(39)).max(power_above(magnitude) / 2.0_f64.powi(51));
        let centre = (low + high) / 2.0;
        let origin = point(
            (centre.x / spacing).round() * spacing,
            (centre.y / spacing).round() * spacing,
        );
        Ok(Self {
            origin,
            spacing,
            reach: 0.6 * size,
        })
    }

    /// In units of the grid, not rounded.
    pub(super) fn scaled(&self, p: Point) -> Point {
        (p - self.origin) / self.spacing
    }

    pub(super) fn coord(&self, node: Node) -> Point {
        self.origin + point(node.0 as f64, node.1 as f64) * self.spacing
    }

    /// The part of the segment `a b` in a box somewhat larger than the domain.
    /// Ends in the box stay what they are, to the last bit.
    pub(super) fn clip(&self, a: Point, b: Point) -> Option<(Point, Point)> {
        let (mut p, mut q) = (a - self.origin, b - self.origin);
        for quarter in 0..4 {
            // Each side of the box in turn to the east of it.
            let (u, v) = (quarter_turns(p, quarter), quarter_turns(q, quarter));
            if u.x > self.reach && v.x > self.reach {
                return None;
            }
            let back = (4 - quarter) % 4;
            // From the end that stays, whose coordinates are the smaller.
            let cut = |far: Point, near: Point| {
                let part = (self.reach - near.x) / (far.x - near.x);
                quarter_turns(point(self.reach, near.y + (far.y - near.y) * part), back)
            };
            if u.x > self.reach {
                p = cut(u, v);
            } else if v.x > self.reach {
                q = cut(v, u);
            }
        }
        let inside = |r: Point| r.x.abs() <= self.reach && r.y.abs() <= self.reach;
        let end = |given: Point, cut: Point| {
            if inside(given - self.origin) {
                given
            } else {
                self.origin + cut
            }
        };
        Some((end(a, p), end(b, q)))
    }
}

/// Turned clockwise by so many right angles.
fn quarter_turns(a: Point, quarters: usize) -> Point {
    match quarters {
        0 => a,
        1 => point(a.y, -a.x),
        2 => point(-a.x, -a.y),
        _ => point(-a.y, a.x),
    }
}

/// True for coordinates that the grid can work with.
pub(super) fn usable(p: Point) -> bool {
    is_finite(p) && p.x.abs() <= LARGEST && p.y.abs() <= LARGEST
}

/// The node whose half-open pixel holds the point.
pub(super) fn rounded(p: Point) -> Node {
    ((p.x + 0.5).floor() as i64, (p.y + 0.5).floor() as i64)
}

/// The least power of two that is not below `x`, a positive normal number.
fn power_above(x: f64) -> f64 {
    let mut power = x.log2().ceil().exp2();
    // The logarithm is rounded: put right what it got wrong.
    while power < x {
        power *= 2.0;
    }
    while power / 2.0 >= x {
        power /= 2.0;
    }
    power
}

/// Twice the signed area of the triangle `o a b`: positive to the left.
pub(super) fn orient(o: Node, a: Node, b: Node) -> i128 {
    area2(sub(a, o), sub(b, o))
}

pub(super) fn sub(a: Node, b: Node) -> Node {
    (a.0 - b.0, a.1 - b.1)
}

/// The cross product, exactly.
pub(super) fn area2(a: Node, b: Node) -> i128 {
    i128::from(a.0) * i128::from(b.1) - i128::from(a.1) * i128::from(b.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{polygon, Polygon};

    fn square(x: f64, y: f64, size: f64) -> Polygon<f64> {
        polygon![(x: x, y: y), (x: x + size, y: y), (x: x + size, y: y + size), (x: x, y: y + size)]
    }

    #[test]
    fn the_grid_is_made_of_numbers_and_finer_than_a_trillionth() {
        for (x, y, size) in [
            (0.0, 0.0, 100.0),
            (477_118.926, 5_550_910.149, 812.3),
            (1e-7, -3e-7, 1e-8),
            (-4e60, 1e59, 1e58),
        ] {
            let grid = Grid::new(&square(x, y, size)).unwrap();
            // 2^-38 of the size, or four units in the last place of 6e6.
            assert!(
                grid.spacing
                    <= (size * 3.7e-12).max(4.0 * f64::EPSILON * x.abs().max(y.abs() + size))
            );
            for node in [(0, 0), (12_345_678_901, -98_765_432_109), (-1, 1)] {
                assert_eq!(rounded(grid.scaled(grid.coord(node))), node);
            }
        }
    }

    #[test]
    fn powers_of_two_are_exact() {
        assert_eq!(power_above(8.0), 8.0);
        assert_eq!(power_above(8.1), 16.0);
        assert_eq!(power_above(0.25), 0.25);
    }

    #[test]
    fn clipping_keeps_the_inside_and_drops_the_rest() {
        let grid = Grid::new(&square(0.0, 0.0, 100.0)).unwrap();
        let inside = (point(3.0, 4.0), point(50.0, 60.0));
        assert_eq!(grid.clip(inside.0, inside.1), Some(inside));
        assert_eq!(grid.clip(point(-500.0, 3.0), point(-400.0, 50.0)), None);
        let (a, b) = grid.clip(point(-1e90, 20.0), point(50.0, 20.0)).unwrap();
        assert!((a.x + 10.0).abs() < 1e-6 && (a.y - 20.0).abs() < 1e-6 && b == point(50.0, 20.0));
    }

    #[test]
    fn domains_without_extent_are_refused() {
        let flat = polygon![(x: 0., y: 1.), (x: 5., y: 1.), (x: 9., y: 1.)];
        assert_eq!(Grid::new(&flat).unwrap_err(), TraceError::DomainWithoutArea);
        assert!(matches!(
            Grid::new(&square(f64::NAN, 0.0, 1.0)),
            Err(TraceError::DomainNotFinite { ring: 0, .. })
        ));
        assert!(matches!(
            Grid::new(&square(1e200, 0.0, 1e199)),
            Err(TraceError::DomainNotFinite { .. })
        ));
    }
}
