//! How long the edges of the mesh should be, from place to place.

use super::ring::Ring;
use super::DomainOptions;
use crate::footpoint::{Bound, Tree};
use crate::plane::{nearest_on_segment, V2};

/// The wanted edge length: on the boundary `boundary`, less near edges of the
/// rings that are shorter, and growing by `grading` a metre inwards up to
/// `step`.
#[derive(Debug)]
pub(crate) struct Sizing {
    /// Far from the boundary.
    pub(crate) step: f64,
    /// On the boundary.
    pub(crate) boundary: f64,
    /// Growth, metres a metre; 0 for an even mesh.
    pub(crate) grading: f64,
    /// Halvings of `step` that the mesh goes through.
    pub(crate) levels: u32,
    /// Vertices of an even mesh.
    expected: f64,
    short: Vec<(V2, V2)>,
    tree: Tree,
}

/// Below some thousand vertices the band along the boundary is most of it.
const LARGE: f64 = 6000.0;

/// Most halvings: an edge length of a thousandth of the wanted one.
const MOST_LEVELS: u32 = 10;

impl Sizing {
    pub(crate) fn new(rings: &[Ring], step: f64, options: &DomainOptions) -> Self {
        let grading = options.grading;
        let mut short = Vec::new();
        let mut boundary = step;
        let mut least = step;
        if grading > 0.0 {
            if options.boundary_length > 0.0 {
                boundary = options.boundary_length.min(step);
            }
            least = boundary;
            for ring in rings {
                for k in 0..ring.len() {
                    let (a, b) = ring.edge(k);
                    let length = (b - a).norm();
                    if length < boundary {
                        short.push((a, b));
                        least = least.min(length);
                    }
                }
            }
        }
        let levels = (step / least)
            .log2()
            .ceil()
            .clamp(0.0, f64::from(MOST_LEVELS)) as u32;
        let bounds: Vec<Bound> = short
            .iter()
            .map(|&(a, b)| Bound::of_segment(a, b, grading.recip()))
            .collect();
        let area: f64 = rings.iter().map(Ring::area).sum();
        Self {
            step,
            expected: area / (0.87 * step * step),
            boundary,
            grading,
            levels,
            tree: Tree::new(&bounds),
            short,
        }
    }

    /// Whether the mesh has so many vertices that its core is worth being
    /// triangulated apart.
    pub(crate) fn is_large(&self) -> bool {
        self.expected > LARGE
    }

    /// Wanted length at `p` on the boundary.
    fn on_boundary(&self, p: V2) -> f64 {
        let finest = self.step * 0.5_f64.powi(self.levels as i32);
        let of = |k: usize| {
            let (a, b) = self.short[k];
            let off = (p - nearest_on_segment(p, a, b)).norm();
            Some((b - a).norm().max(finest) + self.grading * off)
        };
        self.tree
            .nearest(p, self.boundary, of)
            .map_or(self.boundary, |(_, length)| length)
    }

    /// The points that subdivide the segment from `a` to `b`, without its
    /// ends; `least` parts at least, and of more than `most` points so many.
    pub(crate) fn subdivide(&self, a: V2, b: V2, least: usize, most: usize) -> Vec<V2> {
        if self.short.is_empty() {
            let parts = ((b - a).norm() / self.boundary).ceil().max(1.0) as usize;
            let parts = parts.max(least);
            return (1..parts)
                .take(most)
                .map(|part| a + (b - a) * (part as f64 / parts as f64))
                .collect();
        }
        // Halves until each part is as short as its middle wants it.
        let mut points = Vec::new();
        let mut stack = vec![(0.0, 1.0)];
        let length = (b - a).norm();
        while let Some((from, to)) = stack.pop() {
            if points.len() >= most {
                break;
            }
            let middle = (from + to) / 2.0;
            let wanted = self.on_boundary(a + (b - a) * middle);
            let halve =
                (to - from) * length > wanted * (1.0 + 1e-9) || (least > 1 && to - from == 1.0);
            if halve {
                stack.push((middle, to));
                stack.push((from, middle));
            } else if from > 0.0 {
                points.push(a + (b - a) * from);
            }
        }
        points
    }

    /// How far from a segment of length `length` points of the lattice of
    /// `level` halvings are wanted; `None` if nowhere. From one halving on.
    pub(crate) fn reach(&self, length: f64, level: u32) -> Option<f64> {
        // The finer lattice begins where the length is nearer to it than to
        // the coarser one, in ratio.
        let step = self.step * 0.5_f64.powi(level as i32) * std::f64::consts::SQRT_2;
        (length < step).then(|| (step - length) / self.grading)
    }
}
