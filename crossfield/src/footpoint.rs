//! A bounding-volume tree for nearest points under weighted distances.
//!
//! An r-tree from the shelf finds the nearest item by Euclidean distance.
//! Here each item has its own distance, which is only known to be at least
//! (distance to its box) / gain: the tree keeps the largest gain below each
//! node and prunes by that.

use crate::domain::Ring;
use crate::plane::{left, nearest_on_segment, V2};

/// An item's box and its gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    low: V2,
    high: V2,
    /// Every distance of the item is at least its box distance over this.
    gain: f64,
}

impl Bound {
    pub(crate) fn of_segment(a: V2, b: V2, gain: f64) -> Self {
        Self {
            low: a.inf(&b),
            high: a.sup(&b),
            gain,
        }
    }

    fn join(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
            gain: self.gain.max(other.gain),
        }
    }

    /// Whether the segment `a b` may meet the box: not if their shadows on
    /// one of the axes, or on the normal of the segment, lie apart.
    fn meets(&self, a: V2, b: V2) -> bool {
        let (low, high) = (a.inf(&b), a.sup(&b));
        if low.x > self.high.x || low.y > self.high.y || high.x < self.low.x || high.y < self.low.y
        {
            return false;
        }
        let normal = left(b - a);
        let half = (self.high - self.low) / 2.0;
        let reach = normal.x.abs() * half.x + normal.y.abs() * half.y;
        let off = normal.dot(&(self.low + half - a)).abs();
        // What rounding may add, far below the size of any box that matters.
        off <= reach * (1.0 + 1e-12) + 1e-14 * normal.norm() * (a.amax() + b.amax())
    }

    /// Lower bound of all distances within, from `p`.
    fn distance(&self, p: V2) -> f64 {
        let x = (self.low.x - p.x).max(p.x - self.high.x).max(0.0);
        let y = (self.low.y - p.y).max(p.y - self.high.y).max(0.0);
        (x * x + y * y).sqrt() / self.gain
    }
}

/// Items per leaf: evaluating one costs about as much as bounding one.
const LEAF: usize = 4;

#[derive(Clone, Debug)]
struct Node {
    bound: Bound,
    /// A leaf: its range of `order`. A branch: its two children.
    first: u32,
    second: u32,
    leaf: bool,
}

/// The tree; items are known by their index.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    /// A balanced tree, split at the median of the wider side.
    pub(crate) fn new(bounds: &[Bound]) -> Self {
        let mut tree = Self {
            nodes: Vec::with_capacity(bounds.len()),
            order: (0..bounds.len() as u32).collect(),
        };
        if !bounds.is_empty() {
            tree.build(bounds, 0, bounds.len());
        }
        tree
    }

    /// Depth of the recursion: log2 of the number of items.
    fn build(&mut self, bounds: &[Bound], from: usize, to: usize) -> u32 {
        let items = &mut self.order[from..to];
        let bound = items
            .iter()
            .map(|&item| bounds[item as usize])
            .reduce(Bound::join)
            .expect("ranges are never empty");
        let index = self.nodes.len() as u32;
        let leaf = to - from <= LEAF;
        self.nodes.push(Node {
            bound,
            first: from as u32,
            second: to as u32,
            leaf,
        });
        if leaf {
            return index;
        }
        let extent = bound.high - bound.low;
        let axis = usize::from(extent.y > extent.x);
        let middle = (to - from) / 2;
        let centre = |item: u32| {
            let bound = bounds[item as usize];
            bound.low[axis] + bound.high[axis]
        };
        items.select_nth_unstable_by(middle, |&a, &b| {
            centre(a).total_cmp(&centre(b)).then(a.cmp(&b))
        });
        let first = self.build(bounds, from, from + middle);
        let second = self.build(bounds, from + middle, to);
        let node = &mut self.nodes[index as usize];
        (node.first, node.second) = (first, second);
        index
    }

    /// The item with the smallest distance, and that distance.
    ///
    /// `distance` may decline an item. Only items nearer than `limit` are
    /// looked for. Equal distances go to the item of lower index.
    pub(crate) fn nearest(
        &self,
        p: V2,
        limit: f64,
        distance: impl Fn(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let mut best = (usize::MAX, limit);
        // Deep enough for 2^63 items: one entry a level and one more.
        let mut stack = [(0_u32, 0.0_f64); 66];
        let mut top = 0;
        if let Some(root) = self.nodes.first() {
            stack[0] = (0, root.bound.distance(p));
            top = 1;
        }
        while top > 0 {
            top -= 1;
            let (index, bound) = stack[top];
            if bound > best.1 {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.leaf {
                for &item in &self.order[node.first as usize..node.second as usize] {
                    let item = item as usize;
                    if let Some(d) = distance(item) {
                        if d < best.1 || (d == best.1 && item < best.0) {
                            best = (item, d);
                        }
                    }
                }
            } else {
                let entry = |child: u32| (child, self.nodes[child as usize].bound.distance(p));
                let (near, far) = {
                    let (a, b) = (entry(node.first), entry(node.second));
                    if b.1 < a.1 {
                        (b, a)
                    } else {
                        (a, b)
                    }
                };
                stack[top] = far;
                stack[top + 1] = near;
                top += 2;
            }
        }
        (best.0 != usize::MAX).then_some(best)
    }
}

impl Tree {
    /// The order of the items along the leaves. The tree is left with items
    /// numbered in that order.
    pub(crate) fn take_order(&mut self) -> Vec<u32> {
        let count = self.order.len() as u32;
        std::mem::replace(&mut self.order, (0..count).collect())
    }

    /// All items whose distance is at most `widened` of the smallest one.
    ///
    /// `distance` may decline an item, and `accept`, which is only asked for
    /// items that would be taken, may too. Only items up to `limit` are looked
    /// for. Appended to `found` with their distances, in an order that does
    /// not depend on `limit` if that is not below the last one's distance.
    pub(crate) fn nearest_and_ties(
        &self,
        p: V2,
        mut limit: f64,
        widened: impl Fn(f64) -> f64,
        distance: impl Fn(usize) -> Option<f64>,
        accept: impl Fn(usize) -> bool,
        found: &mut Vec<(u32, f64)>,
    ) {
        // As in `nearest`.
        let mut stack = [(0_u32, 0.0_f64); 66];
        let mut top = usize::from(!self.nodes.is_empty());
        let mut least = f64::INFINITY;
        while top > 0 {
            top -= 1;
            let (index, bound) = stack[top];
            if bound > limit {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.leaf {
                for &item in &self.order[node.first as usize..node.second as usize] {
                    let Some(d) = distance(item as usize) else {
                        continue;
                    };
                    if d <= limit && accept(item as usize) {
                        found.push((item, d));
                        if d < least {
                            least = d;
                            limit = limit.min(widened(d));
                        }
                    }
                }
            } else {
                let entry = |child: u32| (child, self.nodes[child as usize].bound.distance(p));
                let (a, b) = (entry(node.first), entry(node.second));
                let (near, far) = if b.1 < a.1 { (b, a) } else { (a, b) };
                stack[top] = far;
                stack[top + 1] = near;
                top += 2;
            }
        }
        found.retain(|&(_, d)| d <= limit);
    }

    /// Whether `hit` is true for an item whose box meets the segment `a b`.
    pub(crate) fn any_along(&self, a: V2, b: V2, mut hit: impl FnMut(usize) -> bool) -> bool {
        let mut stack = [0_u32; 66];
        let mut top = usize::from(!self.nodes.is_empty());
        while top > 0 {
            top -= 1;
            let node = &self.nodes[stack[top] as usize];
            if !node.bound.meets(a, b) {
                continue;
            }
            if node.leaf {
                let items = &self.order[node.first as usize..node.second as usize];
                if items.iter().any(|&item| hit(item as usize)) {
                    return true;
                }
            } else {
                stack[top] = node.first;
                stack[top + 1] = node.second;
                top += 2;
            }
        }
        false
    }
}

/// All ring edges, for plain nearest points.
#[derive(Clone, Debug)]
pub(crate) struct EdgeTree {
    tree: Tree,
    /// Ring and edge of each item.
    names: Vec<(u32, u32)>,
}

impl EdgeTree {
    pub(crate) fn new(rings: &[Ring]) -> Self {
        let mut names = Vec::new();
        let mut bounds = Vec::new();
        for (ring, points) in rings.iter().enumerate() {
            for k in 0..points.len() {
                let (a, b) = points.edge(k);
                names.push((ring as u32, k as u32));
                bounds.push(Bound::of_segment(a, b, 1.0));
            }
        }
        Self {
            tree: Tree::new(&bounds),
            names,
        }
    }

    /// The nearest boundary point with its ring and edge.
    pub(crate) fn nearest(&self, rings: &[Ring], p: V2) -> (V2, u32, u32) {
        let foot = |item: usize| {
            let (ring, edge) = self.names[item];
            let (a, b) = rings[ring as usize].edge(edge as usize);
            nearest_on_segment(p, a, b)
        };
        let found = self
            .tree
            .nearest(p, f64::INFINITY, |item| Some((foot(item) - p).norm()));
        // Every distance may be infinite or undefined for a point that is.
        let item = found.map_or(0, |(item, _)| item);
        let (ring, edge) = self.names[item];
        (foot(item), ring, edge)
    }

    /// Whether `hit` is true for an edge, given by ring and number, whose box
    /// meets the segment `a b`.
    pub(crate) fn any_along(&self, a: V2, b: V2, mut hit: impl FnMut(u32, u32) -> bool) -> bool {
        self.tree.any_along(a, b, |item| {
            let (ring, edge) = self.names[item];
            hit(ring, edge)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator for scattered points (Knuth's MMIX constants).
    fn scattered(count: usize) -> impl Iterator<Item = V2> {
        let mut state = 1_u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(move |_| V2::new(next(), next()))
    }

    #[test]
    fn the_tree_agrees_with_trying_all() {
        let ends: Vec<V2> = scattered(400).collect();
        let segments: Vec<(V2, V2, f64)> = ends
            .chunks_exact(2)
            .map(|pair| (pair[0], pair[0] + pair[1] * 0.1, 0.2 + 3.0 * pair[1].x))
            .collect();
        let bounds: Vec<Bound> = segments
            .iter()
            .map(|&(a, b, w)| Bound::of_segment(a, b, w))
            .collect();
        let tree = Tree::new(&bounds);
        for p in scattered(300) {
            let distance = |k: usize| {
                let (a, b, w) = segments[k];
                // Some items decline.
                (k % 7 != 3).then(|| (nearest_on_segment(p, a, b) - p).norm() / w)
            };
            let slow = (0..segments.len())
                .filter_map(|k| distance(k).map(|d| (k, d)))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            assert_eq!(tree.nearest(p, f64::INFINITY, distance), slow);
            // Whatever is at most half as far again as the nearest.
            let limit = slow.map_or(0.0, |(_, d)| 1.5 * d);
            let near = |k: &usize| distance(*k).is_some_and(|d| d <= limit);
            let mut found = Vec::new();
            tree.nearest_and_ties(
                p,
                f64::INFINITY,
                |d| 1.5 * d,
                distance,
                |_| true,
                &mut found,
            );
            let mut found: Vec<usize> = found.iter().map(|f| f.0 as usize).collect();
            found.sort_unstable();
            let all: Vec<usize> = (0..segments.len()).filter(near).collect();
            assert_eq!(found, all);
        }
    }

    #[test]
    fn segments_meet_the_boxes_of_what_they_cross() {
        let ends: Vec<V2> = scattered(400).collect();
        let items: Vec<(V2, V2)> = ends
            .chunks_exact(2)
            .map(|e| (e[0], e[0] + e[1] * 0.1))
            .collect();
        let bounds: Vec<Bound> = items
            .iter()
            .map(|&(a, b)| Bound::of_segment(a, b, 1.0))
            .collect();
        let tree = Tree::new(&bounds);
        for pair in ends.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let mut met = vec![false; items.len()];
            tree.any_along(a, b, |k| {
                met[k] = true;
                false
            });
            // Every point of the segment lies in boxes that were met only.
            for step in 0..=50 {
                let p = a + (b - a) * (f64::from(step) / 50.0);
                for (k, bound) in bounds.iter().enumerate() {
                    assert!(met[k] || bound.distance(p) > 0.0);
                }
            }
        }
    }

    #[test]
    fn an_empty_tree_finds_nothing() {
        let tree = Tree::new(&[]);
        assert!(tree.nearest(V2::zeros(), 1.0, |_| Some(0.0)).is_none());
    }
}
