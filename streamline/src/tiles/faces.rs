//! The faces of a planar graph with exact vertices.
//!
//! Half-edge `2 e` runs along edge `e`, half-edge `2 e + 1` against it; a face
//! lies to the left of its half-edges.

use super::grid::{area2, sub, Node};
use rstar::{primitives::GeomWithData, primitives::Rectangle, RTree, AABB};
use std::cmp::Ordering;

/// A closed walk along the border of a face.
#[derive(Clone, Debug)]
pub(super) struct Cycle {
    pub(super) half_edges: Vec<usize>,
    /// Twice the signed area: positive for the outer border of a face.
    pub(super) area2: i128,
    pub(super) face: usize,
}

/// Faces of the graph; face 0 is the unbounded one.
#[derive(Debug)]
pub(super) struct Faces {
    pub(super) cycles: Vec<Cycle>,
    /// The face to the left of each half-edge.
    pub(super) left: Vec<usize>,
    pub(super) count: usize,
}

/// An edge as the two vertices that it joins.
pub(super) type Ends = (usize, usize);

fn tail(edges: &[Ends], h: usize) -> usize {
    if h & 1 == 0 {
        edges[h / 2].0
    } else {
        edges[h / 2].1
    }
}

/// All faces. `nodes` must be the vertices of a planar drawing: `edges` meet in
/// common vertices only, and no two join the same pair.
pub(super) fn faces(nodes: &[Node], edges: &[Ends]) -> Faces {
    let next = successors(nodes, edges);
    let mut left = vec![usize::MAX; next.len()];
    let mut cycles: Vec<Cycle> = Vec::new();
    for start in 0..next.len() {
        if left[start] != usize::MAX {
            continue;
        }
        let mut half_edges = Vec::new();
        let mut area = 0;
        let mut h = start;
        while left[h] == usize::MAX {
            left[h] = cycles.len();
            half_edges.push(h);
            area += area2(nodes[tail(edges, h)], nodes[tail(edges, h ^ 1)]);
            h = next[h];
        }
        cycles.push(Cycle {
            half_edges,
            area2: area,
            face: 0,
        });
    }
    let mut count = 1;
    for cycle in cycles.iter_mut().filter(|c| c.area2 > 0) {
        cycle.face = count;
        count += 1;
    }
    nest(nodes, edges, &mut cycles, &left);
    for half in &mut left {
        *half = cycles[*half].face;
    }
    Faces {
        cycles,
        left,
        count,
    }
}

/// The half-edge that follows each along the border of the face to its left:
/// at the head the next one clockwise.
fn successors(nodes: &[Node], edges: &[Ends]) -> Vec<usize> {
    let mut around: Vec<usize> = (0..2 * edges.len()).collect();
    let way = |h: usize| sub(nodes[tail(edges, h ^ 1)], nodes[tail(edges, h)]);
    around.sort_unstable_by(|&g, &h| {
        tail(edges, g)
            .cmp(&tail(edges, h))
            .then_with(|| by_angle(way(g), way(h)))
    });
    let mut next = vec![0; around.len()];
    for star in around.chunk_by(|&g, &h| tail(edges, g) == tail(edges, h)) {
        for (i, &h) in star.iter().enumerate() {
            // `h` leaves; its twin arrives, and goes on to the one before.
            next[h ^ 1] = star[(i + star.len() - 1) % star.len()];
        }
    }
    next
}

/// Directions by angle from east, anticlockwise, exactly.
fn by_angle(a: Node, b: Node) -> Ordering {
    let lower = |v: Node| v.1 < 0 || (v.1 == 0 && v.0 < 0);
    lower(a).cmp(&lower(b)).then_with(|| 0.cmp(&area2(a, b)))
}

/// Gives each inner border the face that it lies in: that of the first edge to
/// the left of its least vertex.
fn nest(nodes: &[Node], edges: &[Ends], cycles: &mut [Cycle], left: &[usize]) {
    let least = |cycle: &Cycle| {
        let tails = cycle.half_edges.iter().map(|&h| nodes[tail(edges, h)]);
        tails.min().unwrap_or((0, 0))
    };
    let mut inner: Vec<(Node, usize)> = (0..cycles.len())
        .filter(|&c| cycles[c].area2 <= 0)
        .map(|c| (least(&cycles[c]), c))
        .collect();
    // What lies to the left of a component has a lesser vertex: it comes first.
    inner.sort_unstable();
    if inner.len() < 2 {
        return; // One component: its border is that of the unbounded face.
    }
    let corner = |n: Node| [n.0 as f64, n.1 as f64];
    let boxes = edges.iter().enumerate().map(|(e, &(a, b))| {
        GeomWithData::new(
            Rectangle::from_corners(corner(nodes[a]), corner(nodes[b])),
            e,
        )
    });
    let tree = RTree::bulk_load(boxes.collect());
    let west = nodes.iter().map(|n| n.0).min().unwrap_or(0);
    for (from, cycle) in inner {
        let ray = AABB::from_corners(corner((west, from.1)), corner(from));
        let wall = tree
            .locate_in_envelope_intersecting(&ray)
            .filter_map(|found| Wall::new(nodes, edges, found.data, from))
            .max_by(Wall::cmp);
        cycles[cycle].face = wall.map_or(0, |w| cycles[left[w.half_edge]].face);
    }
}

/// An edge that a leftward ray meets.
struct Wall {
    /// The one of the two half-edges that runs down: the ray comes from its
    /// left.
    half_edge: usize,
    /// Where it is met: a fraction with a positive denominator.
    over: i128,
    under: i128,
    way: Node,
}

impl Wall {
    /// `None` if the ray from `p` just misses it. An upper end does not belong
    /// to an edge, so that a vertex is not met twice.
    fn new(nodes: &[Node], edges: &[Ends], edge: usize, p: Node) -> Option<Self> {
        let (a, b) = (nodes[edges[edge].0], nodes[edges[edge].1]);
        let (low, high, half_edge) = if a.1 < b.1 {
            (a, b, 2 * edge + 1)
        } else {
            (b, a, 2 * edge)
        };
        if !(low.1 <= p.1 && p.1 < high.1) {
            return None;
        }
        let way = sub(high, low);
        let under = i128::from(way.1);
        let over = i128::from(low.0) * under + i128::from(p.1 - low.1) * i128::from(way.0);
        (over < i128::from(p.0) * under).then_some(Self {
            half_edge,
            over,
            under,
            way,
        })
    }

    /// From left to right; of those met in one point, just above it.
    fn cmp(&self, other: &Self) -> Ordering {
        (self.over * other.under)
            .cmp(&(other.over * self.under))
            .then_with(|| 0.cmp(&area2(self.way, other.way)).reverse())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square in a square, with a spur inside the inner one.
    fn nested() -> (Vec<Node>, Vec<Ends>) {
        let nodes = vec![
            (0, 0),
            (9, 0),
            (9, 9),
            (0, 9),
            (2, 2),
            (6, 2),
            (6, 6),
            (2, 6),
            (3, 3),
            (4, 4),
        ];
        let ring = |s: usize| (0..4).map(move |i| (s + i, s + (i + 1) % 4));
        let edges = ring(0).chain(ring(4)).chain([(8, 9)]).collect();
        (nodes, edges)
    }

    #[test]
    fn components_lie_in_their_faces() {
        let (nodes, edges) = nested();
        let found = faces(&nodes, &edges);
        assert_eq!((found.count, found.cycles.len()), (3, 5));
        // Outside, between, inside.
        let (outer, inner) = (found.left[0], found.left[8]);
        assert_eq!(found.left[1], 0);
        assert_eq!(found.left[9], outer);
        assert_eq!((found.left[16], found.left[17]), (inner, inner));
        // V - E + F = 1 + C.
        assert_eq!(10 - 9 + found.count, 1 + 3);
        let areas: Vec<i128> = found.cycles.iter().map(|c| c.area2).collect();
        assert_eq!(areas.iter().sum::<i128>(), 0);
        assert!(areas.contains(&162) && areas.contains(&-32) && areas.contains(&0));
    }

    #[test]
    fn of_walls_met_in_one_vertex_the_right_one_counts() {
        // A ray from (5, 0) meets the vertex (0, 0), where two edges go up: the
        // one to the right comes first.
        let nodes = vec![(0, 0), (-3, 5), (3, 5), (0, -5), (5, 0), (6, 0)];
        let edges = vec![(0, 1), (0, 2), (1, 2), (0, 3), (4, 5)];
        let found = faces(&nodes, &edges);
        assert_eq!(found.count, 2);
        assert_eq!((found.left[8], found.left[9]), (0, 0));
        let wall = |e| Wall::new(&nodes, &edges, e, (5, 0)).unwrap();
        assert_eq!(wall(1).cmp(&wall(0)), Ordering::Greater);
    }
}
