//! A bulk-loaded R-tree of segments: the one place that knows `rstar`.

use super::predicates::P;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

type Item = GeomWithData<Rectangle<[f64; 2]>, u32>;

/// Segments by their boxes, each with the number it was given.
#[derive(Clone, Debug)]
pub(crate) struct SegmentIndex {
    tree: RTree<Item>,
}

impl SegmentIndex {
    /// Indexes segments `(number, a, b)`; O(n log n).
    pub(crate) fn new(segments: impl Iterator<Item = (u32, P, P)>) -> Self {
        let items = segments
            .map(|(i, a, b)| GeomWithData::new(Rectangle::from_corners([a.x, a.y], [b.x, b.y]), i))
            .collect();
        Self {
            tree: RTree::bulk_load(items),
        }
    }

    /// Numbers of the segments whose boxes meet the box of `a` and `b`
    /// widened by `pad`, ascending.
    pub(crate) fn near(&self, a: P, b: P, pad: f64, out: &mut Vec<u32>) {
        out.clear();
        let query = AABB::from_corners(
            [a.x.min(b.x) - pad, a.y.min(b.y) - pad],
            [a.x.max(b.x) + pad, a.y.max(b.y) + pad],
        );
        out.extend(
            self.tree
                .locate_in_envelope_intersecting(&query)
                .map(|item| item.data),
        );
        out.sort_unstable();
    }

    /// Numbers of all segments in growing distance of their **boxes** from
    /// `p`, with that distance squared.
    pub(crate) fn by_distance(&self, p: P) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.tree
            .nearest_neighbor_iter_with_distance_2(&[p.x, p.y])
            .map(|(item, d2)| (item.data, d2))
    }
}
