//! A bounding-volume tree for nearest points under weighted distances.
//!
//! An r-tree from the shelf finds the nearest item by Euclidean distance.
//! Here each item has its own distance, which is only known to be at least
//! (distance to its box) / gain: the tree keeps the largest gain below each
//! node and prunes by that.

use crate::domain::Ring;
use crate::plane::{nearest_on_segment, V2};

/// An item's box and its gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    pub(crate) low: V2,
    pub(crate) high: V2,
    /// Every distance of the item is at least its box distance over this.
    pub(crate) gain: f64,
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
    /// Calls `visit` with every item whose box may hold a distance of at most
    /// `limit` from `p`, in no particular order.
    pub(crate) fn within(&self, p: V2, limit: f64, mut visit: impl FnMut(usize)) {
        let mut stack = [0_u32; 66];
        let mut top = usize::from(!self.nodes.is_empty());
        while top > 0 {
            top -= 1;
            let node = &self.nodes[stack[top] as usize];
            if node.bound.distance(p) > limit {
                continue;
            }
            if node.leaf {
                let items = &self.order[node.first as usize..node.second as usize];
                items.iter().for_each(|&item| visit(item as usize));
            } else {
                stack[top] = node.first;
                stack[top + 1] = node.second;
                top += 2;
            }
        }
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
            let limit = slow.map_or(0.0, |(_, d)| 2.0 * d);
            let near = |k: &usize| distance(*k).is_some_and(|d| d <= limit);
            let mut found = Vec::new();
            tree.within(p, limit, |k| found.push(k));
            found.retain(near);
            found.sort_unstable();
            let all: Vec<usize> = (0..segments.len()).filter(near).collect();
            assert_eq!(found, all);
        }
    }

    #[test]
    fn an_empty_tree_finds_nothing() {
        let tree = Tree::new(&[]);
        assert!(tree.nearest(V2::zeros(), 1.0, |_| Some(0.0)).is_none());
    }
}
