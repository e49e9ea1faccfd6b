//! Points of an area, each as likely as any other.

use geo_types::Coord;

use super::{lerp, sides, Area};

/// A part of an area between two heights and two edges.
#[derive(Clone, Copy, Debug)]
struct Trapezoid {
    /// Left and right at the bottom, then at the top.
    bottom: [Coord<f64>; 2],
    top: [Coord<f64>; 2],
}

/// Draws points of an area.
///
/// The area is cut into trapezoids between the heights of its vertices, so that
/// three numbers from 0 to 1 are a point, and no point is drawn in vain however
/// thin or crooked the area is.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    pieces: Vec<Trapezoid>,
    /// Area of all pieces up to and with each.
    sums: Vec<f64>,
}

impl Trapezoid {
    fn widths(&self) -> [f64; 2] {
        [self.bottom, self.top].map(|[a, b]| (b.x - a.x).max(0.0))
    }

    fn size(&self) -> f64 {
        let [a, b] = self.widths();
        0.5 * (a + b) * (self.top[0].y - self.bottom[0].y)
    }
}

impl Sampler {
    pub(crate) fn new(area: &Area) -> Self {
        let mut heights: Vec<f64> = area.rings().flatten().map(|p| p.y).collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        let mut pieces = Vec::new();
        for pair in heights.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let middle = 0.5 * (low + high);
            let at = |a: Coord<f64>, b: Coord<f64>, y: f64| Coord {
                x: a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y),
                y,
            };
            let mut edges: Vec<(f64, Coord<f64>, Coord<f64>)> = area
                .rings()
                .flat_map(|ring| sides(ring))
                .filter(|(a, b)| (a.y > middle) != (b.y > middle))
                .map(|(a, b)| (at(a, b, middle).x, a, b))
                .collect();
            edges.sort_by(|p, q| p.0.total_cmp(&q.0));
            for sides in edges.chunks_exact(2) {
                let ends = |y: f64| [0, 1].map(|k: usize| at(sides[k].1, sides[k].2, y));
                pieces.push(Trapezoid {
                    bottom: ends(low),
                    top: ends(high),
                });
            }
        }
        let mut sum = 0.0;
        let sums = pieces
            .iter()
            .map(|piece| {
                sum += piece.size();
                sum
            })
            .collect();
        Self { pieces, sums }
    }

    /// Square metres.
    pub(crate) fn size(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The point for three numbers from 0 to 1; `None` if there is no area.
    pub(crate) fn point(&self, [piece, up, along]: [f64; 3]) -> Option<Coord<f64>> {
        let wanted = piece * self.size();
        let k = self.sums.partition_point(|&sum| sum <= wanted);
        let piece = self.pieces.get(k.min(self.pieces.len().checked_sub(1)?))?;
        let [a, b] = piece.widths();
        // The height below which lies this share: (b - a) t^2 + 2 a t = (a + b) up.
        let share = (a + b) * up;
        let root = (a * a + (b - a) * share).max(0.0).sqrt();
        let t = if a + root > 0.0 {
            share / (a + root)
        } else {
            up
        };
        let left = lerp(piece.bottom[0], piece.top[0], t);
        let right = lerp(piece.bottom[1], piece.top[1], t);
        Some(lerp(left, right, along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn a_triangle_is_filled_evenly() {
        let ring = vec![
            coord! { x: 0., y: 0. },
            coord! { x: 0., y: 4. },
            coord! { x: 4., y: 0. },
        ];
        let area = Area::new(ring, Vec::new());
        let sampler = Sampler::new(&area);
        assert!((sampler.size() - 8.0).abs() < 1e-12);
        // A quarter of the triangle lies above half of its height.
        let at = sampler.point([0.3, 0.75, 0.5]);
        assert!(at.is_some_and(|p| (p.y - 2.0).abs() < 1e-12 && (p.x - 1.0).abs() < 1e-12));
        let mean = (0..1000).filter_map(|k| {
            let unit = |m: f64| (f64::from(k) * m).fract();
            sampler.point([unit(0.618_034), unit(0.754_878), unit(0.569_840)])
        });
        let sum = mean.fold(Coord::default(), |sum, p| sum + p) / 1000.0;
        assert!(
            (sum.x - 4.0 / 3.0).abs() < 0.05 && (sum.y - 4.0 / 3.0).abs() < 0.05,
            "{sum:?}"
        );
    }

    #[test]
    fn holes_are_left_out() {
        let square = |low: f64, high: f64| {
            [(low, low), (low, high), (high, high), (high, low)]
                .map(|(x, y)| coord! { x: x, y: y })
                .to_vec()
        };
        let area = Area::new(square(0.0, 4.0), vec![square(1.0, 3.0)]);
        let sampler = Sampler::new(&area);
        assert!((sampler.size() - 12.0).abs() < 1e-12);
        for k in 0..200 {
            let unit = |m: f64| (f64::from(k) * m).fract();
            let at = sampler.point([unit(0.618_034), unit(0.754_878), unit(0.569_840)]);
            assert!(at.is_some_and(|p| area.contains(p) || area.nearest(p).1 < 1e-9));
        }
    }
}
