//! A bounding-volume tree for nearest points under weighted distances.
//!
//! An r-tree from the shelf finds the nearest item by Euclidean distance.
//! Here each item has its own distance, which is only known to be at least
//! (distance to its segment) / gain: the tree keeps the largest gain below
//! each node and prunes by that.
//!
//! Nodes are bounded by capsules, all points within a radius of a chord, and
//! not by boxes: a stretch of a finely sampled curve is much thinner than its
//! box when it runs aslant, and from far away some hundred such boxes seem as
//! near as the nearest edge.

use crate::domain::Ring;
use crate::plane::{left, nearest_on_segment, V2};

/// The segment that an item lies on, and its gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    from: V2,
    to: V2,
    /// Every distance of the item is at least that of its segment over this.
    gain: f64,
}

impl Bound {
    pub(crate) fn of_segment(a: V2, b: V2, gain: f64) -> Self {
        Self {
            from: a,
            to: b,
            gain,
        }
    }

    fn ends(&self) -> [V2; 2] {
        [self.from, self.to]
    }
}

/// All points within `radius` of a chord.
#[derive(Clone, Copy, Debug)]
struct Capsule {
    start: V2,
    direction: V2,
    length: f64,
    radius: f64,
    per_gain: f64,
}

impl Capsule {
    /// Around all items, its chord between the two ends that lie farthest
    /// apart along the wider side of their box.
    fn around<'a>(items: impl Iterator<Item = &'a Bound> + Clone) -> Self {
        let ends = || items.clone().flat_map(Bound::ends);
        let first = ends().next().unwrap_or_else(V2::zeros);
        let (low, high) = ends().fold((first, first), |(l, h), p| (l.inf(&p), h.sup(&p)));
        let axis = usize::from(high.y - low.y > high.x - low.x);
        let (mut start, mut end) = (first, first);
        for p in ends() {
            if p[axis] < start[axis] {
                start = p;
            }
            if p[axis] > end[axis] {
                end = p;
            }
        }
        let length = (end - start).norm();
        let direction = if length > 0.0 {
            (end - start) / length
        } else {
            V2::zeros()
        };
        let mut capsule = Self {
            start,
            direction,
            length,
            radius: 0.0,
            per_gain: 1.0,
        };
        // Segments are no farther from the chord than their ends. What
        // rounding may take away is added.
        let radius = ends().map(|p| capsule.off(p)).fold(0.0, f64::max);
        capsule.radius = radius * (1.0 + 1e-12) + 1e-15 * (low.amax() + high.amax());
        capsule.per_gain = items.map(|item| item.gain).fold(0.0, f64::max).recip();
        capsule
    }

    /// Distance from the chord.
    fn off(&self, p: V2) -> f64 {
        let d = p - self.start;
        let along = self.direction.dot(&d).clamp(0.0, self.length);
        (d - self.direction * along).norm()
    }

    /// Lower bound of all distances within, from `p`.
    fn distance(&self, p: V2) -> f64 {
        // Of the distance from the chord itself some digits are rounding.
        let off = self.off(p);
        (off * (1.0 - 1e-15) - self.radius).max(0.0) * self.per_gain
    }

    /// Whether the segment `a b` may meet the capsule: not if their shadows
    /// along the segment, across it, or across the chord lie apart.
    fn meets(&self, a: V2, b: V2) -> bool {
        let apart = |axis: V2, [p, q]: [V2; 2], [r, s]: [V2; 2]| {
            let [p, q, r, s] = [p, q, r, s].map(|v| axis.dot(&(v - a)));
            let slack = self.radius * axis.norm() * (1.0 + 1e-12);
            p.max(q) + slack < r.min(s) || r.max(s) + slack < p.min(q)
        };
        let chord = [self.start, self.start + self.direction * self.length];
        let way = b - a;
        [way, left(way), left(self.direction)]
            .into_iter()
            .all(|axis| !apart(axis, chord, [a, b]))
    }
}

/// Items per leaf: evaluating one costs about as much as bounding one.
const LEAF: usize = 4;

#[derive(Clone, Debug)]
struct Node {
    bound: Capsule,
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
        let of_items = items.iter().map(|&item| &bounds[item as usize]);
        let bound = Capsule::around(of_items);
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
        let axis = usize::from(bound.direction.y.abs() > bound.direction.x.abs());
        let middle = (to - from) / 2;
        let centre = |item: u32| {
            let [a, b] = bounds[item as usize].ends();
            a[axis] + b[axis]
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

    /// Whether `hit` is true for an item that the segment `a b` comes near to.
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

    /// Whether `hit` is true for an edge, given by ring and number, that the
    /// segment `a b` comes near to: all that it meets are asked.
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
    use crate::plane::orient;
    use std::cell::Cell;

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
    fn segments_meet_the_capsules_of_what_they_cross() {
        let ends: Vec<V2> = scattered(400).collect();
        let items: Vec<(V2, V2)> = ends
            .chunks_exact(2)
            .map(|e| (e[0], e[0] + (e[1] - e[0]) * 0.2))
            .collect();
        let bounds: Vec<Bound> = items
            .iter()
            .map(|&(a, b)| Bound::of_segment(a, b, 1.0))
            .collect();
        let tree = Tree::new(&bounds);
        let mut crossed = 0;
        for pair in ends.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let mut met = vec![false; items.len()];
            tree.any_along(a, b, |k| {
                met[k] = true;
                false
            });
            for (k, &(c, d)) in items.iter().enumerate() {
                let sides = orient(a, b, c) * orient(a, b, d) <= 0.0
                    && orient(c, d, a) * orient(c, d, b) <= 0.0;
                crossed += usize::from(sides);
                assert!(met[k] || !sides);
            }
        }
        assert!(crossed > 1000);
    }

    #[test]
    fn a_fine_curve_is_searched_in_few_steps() {
        // From inside a circle of 10 000 edges, off its centre.
        let at = |k: usize| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / 1e4).sin_cos();
            V2::new(c, s)
        };
        let bounds: Vec<Bound> = (0..10_000)
            .map(|k| Bound::of_segment(at(k), at(k + 1), 1.0))
            .collect();
        let tree = Tree::new(&bounds);
        let asked = Cell::new(0);
        let mut count = 0;
        for p in scattered(200).map(|p| (p - V2::new(0.5, 0.5)) * 1.2) {
            if (0.1..0.9).contains(&p.norm()) {
                count += 1;
                let found = tree.nearest(p, f64::INFINITY, |k| {
                    asked.set(asked.get() + 1);
                    Some((nearest_on_segment(p, bounds[k].from, bounds[k].to) - p).norm())
                });
                let gap = 1.0 - p.norm();
                assert!((found.expect("an edge").1 - gap).abs() < 1e-7);
            }
        }
        // Boxes ask some hundred.
        assert!(asked.get() < 30 * count, "{} of {count}", asked.get());
    }

    #[test]
    fn an_empty_tree_finds_nothing() {
        let tree = Tree::new(&[]);
        assert!(tree.nearest(V2::zeros(), 1.0, |_| Some(0.0)).is_none());
    }
}
