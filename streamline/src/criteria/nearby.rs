//! Segments under an index: which are near a point.

use crate::vector::Point;
use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

/// Segments with their positions in the input, relative to the first.
pub(super) struct Nearby {
    tree: RTree<GeomWithData<Line<[f64; 2]>, usize>>,
    origin: Point,
}

impl Nearby {
    pub(super) fn new(segments: impl Iterator<Item = (Point, Point)>) -> Self {
        let mut segments = segments.enumerate().peekable();
        let origin = segments.peek().map_or(Point::zero(), |(_, s)| s.0);
        let lines = segments.map(|(i, (a, b))| {
            let (a, b) = (a - origin, b - origin);
            GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), i)
        });
        Self {
            tree: RTree::bulk_load(lines.collect()),
            origin,
        }
    }

    /// The nearest segment and its distance.
    pub(super) fn nearest(&self, p: Point) -> Option<(usize, f64)> {
        let p = p - self.origin;
        let found = self.tree.nearest_neighbor(&[p.x, p.y])?;
        Some((found.data, found.distance_2(&[p.x, p.y]).sqrt()))
    }

    /// All segments within a distance, with theirs, in the order of the input.
    pub(super) fn within(&self, p: Point, distance: f64) -> Vec<(usize, f64)> {
        let p = p - self.origin;
        let mut found: Vec<(usize, f64)> = self
            .tree
            .locate_within_distance([p.x, p.y], distance * distance)
            .map(|s| (s.data, s.distance_2(&[p.x, p.y]).sqrt()))
            .collect();
        found.sort_unstable_by_key(|&(i, _)| i);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    #[test]
    fn far_from_the_origin_too() {
        let at = point(5e5, 7e6);
        let corner = [(0., 0.), (30., 0.), (30., 40.)].map(|(x, y)| at + point(x, y));
        let nearby = Nearby::new(corner.windows(2).map(|p| (p[0], p[1])));
        assert_eq!(nearby.nearest(at + point(5.0, 3.0)), Some((0, 3.0)));
        assert_eq!(nearby.within(at + point(28.0, 2.0), 1.9), []);
        assert_eq!(
            nearby.within(at + point(28.0, 2.0), 2.0),
            [(0, 2.0), (1, 2.0)]
        );
        assert_eq!(Nearby::new(std::iter::empty()).nearest(at), None);
    }
}
