//! Shortest ways from or to a node, and traffic poured down them.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::graph::StreetGraph;

/// The links that leave and that reach each node, in order of their numbers.
#[derive(Debug)]
pub(super) struct Network<'g> {
    graph: &'g StreetGraph,
    out: Lists,
    into: Lists,
}

/// Lists of links by node, one after the other.
#[derive(Debug)]
struct Lists {
    first: Vec<usize>,
    links: Vec<usize>,
}

impl Lists {
    fn new(nodes: usize, node: impl Iterator<Item = usize> + Clone) -> Self {
        let mut first = vec![0; nodes + 1];
        node.clone().for_each(|n| first[n + 1] += 1);
        for n in 0..nodes {
            first[n + 1] += first[n];
        }
        let mut next = first.clone();
        let mut links = vec![0; first[nodes]];
        for (link, n) in node.enumerate() {
            links[next[n]] = link;
            next[n] += 1;
        }
        Self { first, links }
    }

    fn of(&self, node: usize) -> &[usize] {
        &self.links[self.first[node]..self.first[node + 1]]
    }
}

/// Which way a tree is travelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Towards {
    /// From everywhere to the roots.
    Roots,
    /// From the roots to everywhere.
    Leaves,
}

/// Shortest ways to or from some roots; kept for its memory.
#[derive(Debug, Default)]
pub(super) struct Tree {
    /// Seconds, and of equally quick ways the metres of the shortest.
    pub(super) cost: Vec<(f64, f64)>,
    /// The link at each node on its way from or to the root.
    pub(super) link: Vec<usize>,
    /// The root that each node belongs to.
    root: Vec<usize>,
    /// Nodes in the order in which they were reached for good.
    pub(super) order: Vec<usize>,
    settled: Vec<bool>,
    heap: BinaryHeap<Entry>,
}

const NONE: usize = usize::MAX;

/// The quickest first, then the shortest, then by number.
#[derive(Debug, PartialEq)]
struct Entry {
    cost: (f64, f64),
    node: usize,
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        let (a, b) = (self.cost, other.cost);
        b.0.total_cmp(&a.0)
            .then(b.1.total_cmp(&a.1))
            .then(other.node.cmp(&self.node))
    }
}

impl<'g> Network<'g> {
    pub(super) fn new(graph: &'g StreetGraph) -> Self {
        let nodes = graph.nodes.len();
        Self {
            graph,
            out: Lists::new(nodes, graph.links.iter().map(|l| l.from)),
            into: Lists::new(nodes, graph.links.iter().map(|l| l.to)),
        }
    }

    /// Shortest ways between the roots and all that is connected with them, by
    /// Dijkstra's algorithm; stops when `wanted` nodes that `is_wanted` are
    /// reached.
    pub(super) fn grow(
        &self,
        tree: &mut Tree,
        times: &[f64],
        roots: &[usize],
        towards: Towards,
        wanted: usize,
        is_wanted: &dyn Fn(usize) -> bool,
    ) {
        let nodes = self.graph.nodes.len();
        tree.cost.clear();
        tree.cost.resize(nodes, (f64::INFINITY, f64::INFINITY));
        tree.link.clear();
        tree.link.resize(nodes, NONE);
        tree.root.clear();
        tree.root.resize(nodes, NONE);
        tree.settled.clear();
        tree.settled.resize(nodes, false);
        tree.order.clear();
        tree.heap.clear();
        for &root in roots {
            tree.cost[root] = (0.0, 0.0);
            tree.root[root] = root;
            tree.heap.push(Entry {
                cost: (0.0, 0.0),
                node: root,
            });
        }
        let mut left = wanted;
        while let Some(Entry { cost, node }) = tree.heap.pop() {
            // Reached by a better way before.
            if std::mem::replace(&mut tree.settled[node], true) {
                continue;
            }
            tree.order.push(node);
            if is_wanted(node) {
                left = left.saturating_sub(1);
                if left == 0 {
                    return;
                }
            }
            let links = match towards {
                Towards::Roots => self.into.of(node),
                Towards::Leaves => self.out.of(node),
            };
            for &l in links {
                let link = &self.graph.links[l];
                let next = match towards {
                    Towards::Roots => link.from,
                    Towards::Leaves => link.to,
                };
                let there = (cost.0 + times[l], cost.1 + link.length);
                if there < tree.cost[next] {
                    tree.cost[next] = there;
                    tree.link[next] = l;
                    tree.root[next] = tree.root[node];
                    tree.heap.push(Entry {
                        cost: there,
                        node: next,
                    });
                }
            }
        }
    }

    /// Pours what is at each node down to the root, over the links of the tree;
    /// the loads are spent.
    pub(super) fn pour(&self, tree: &Tree, loads: &mut [f64], flow: &mut [f64]) {
        for &node in tree.order.iter().rev() {
            let load = std::mem::take(&mut loads[node]);
            let l = tree.link[node];
            if load > 0.0 && l != NONE {
                flow[l] += load;
                let link = &self.graph.links[l];
                let nearer = if link.from == node {
                    link.to
                } else {
                    link.from
                };
                loads[nearer] += load;
            }
        }
    }

    /// The root that is reached first from each node, or that reaches it first.
    pub(super) fn nearest(
        &self,
        times: &[f64],
        roots: &[usize],
        towards: Towards,
    ) -> Vec<Option<usize>> {
        let mut tree = Tree::default();
        self.grow(&mut tree, times, roots, towards, NONE, &|_| false);
        tree.root
            .iter()
            .map(|&root| (root != NONE).then_some(root))
            .collect()
    }
}
