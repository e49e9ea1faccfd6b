//! Snap rounding: segments between grid points become edges that meet at
//! common vertices only.
//!
//! A pixel is *hot* if it holds an end of a segment or a crossing of two. Every
//! segment is led through the centres of all hot pixels that it passes. The
//! result has no crossing between vertices, and no vertex inside an edge: J. D.
//! Hobby, *Practical segment intersection with finite precision output*,
//! Computational Geometry 13 (1999); L. J. Guibas, D. H. Marimont, *Rounding
//! arrangements dynamically*, Int. J. Comput. Geom. Appl. 8 (1998). No segment
//! moves by more than the diagonal of half a pixel. All decisions are made in
//! integers.

use super::grid::{area2, orient, sub, Node};
use rstar::{primitives::GeomWithData, primitives::Rectangle, RTree, SelectionFunction, AABB};

/// A segment and where it comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: Node,
    pub(super) to: Node,
    pub(super) source: Source,
}

/// What a segment is a piece of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    Boundary { ring: usize, edge: usize },
    Line(usize),
}

/// A piece of a segment between two hot pixels, the lesser node first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Piece {
    pub(super) nodes: (Node, Node),
    pub(super) source: Source,
}

type Boxed = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Grid coordinates are far below 2^53: exact as floating-point numbers.
fn float(node: Node) -> [f64; 2] {
    [node.0 as f64, node.1 as f64]
}

/// The pieces of all segments, sorted; a piece that several segments share
/// occurs once for each.
pub(super) fn snap(segments: &[Segment]) -> Vec<Piece> {
    let mut hot: Vec<Node> = segments.iter().flat_map(|s| [s.from, s.to]).collect();
    hot.extend(crossings(segments));
    hot.sort_unstable();
    hot.dedup();
    let pixels = RTree::bulk_load(hot.iter().map(|&node| float(node)).collect());
    let mut pieces = Vec::with_capacity(2 * segments.len());
    let mut passed: Vec<Node> = Vec::new();
    for s in segments {
        passed.clear();
        let found = pixels.locate_with_selection_function(Beside::new(s.from, s.to));
        passed.extend(
            found
                .map(|p| (p[0] as i64, p[1] as i64))
                .filter(|&node| passes(s.from, s.to, node)),
        );
        // Along the segment; pixels side by side across it by their names.
        let way = sub(s.to, s.from);
        let along = |node: Node| {
            let v = sub(node, s.from);
            i128::from(v.0) * i128::from(way.0) + i128::from(v.1) * i128::from(way.1)
        };
        passed.sort_unstable_by_key(|&node| (along(node), node));
        pieces.extend(passed.windows(2).map(|pair| Piece {
            nodes: (pair[0].min(pair[1]), pair[0].max(pair[1])),
            source: s.source,
        }));
    }
    pieces.sort_unstable();
    pieces
}

/// The pixels of all proper crossings. Where segments touch or overlap, an end
/// of one of them is hot already.
fn crossings(segments: &[Segment]) -> Vec<Node> {
    let boxes = segments
        .iter()
        .enumerate()
        .map(|(i, s)| Boxed::new(Rectangle::from_corners(float(s.from), float(s.to)), i));
    let tree = RTree::bulk_load(boxes.collect());
    let mut nodes = Vec::new();
    for (i, s) in segments.iter().enumerate() {
        let envelope = AABB::from_corners(float(s.from), float(s.to));
        for other in tree.locate_in_envelope_intersecting(&envelope) {
            if other.data > i {
                let o = &segments[other.data];
                nodes.extend(crossing((s.from, s.to), (o.from, o.to)));
            }
        }
    }
    nodes
}

/// The pixel in which two segments cross properly.
fn crossing((a, b): (Node, Node), (c, d): (Node, Node)) -> Option<Node> {
    let (c_side, d_side) = (orient(a, b, c), orient(a, b, d));
    let (a_side, b_side) = (orient(c, d, a), orient(c, d, b));
    if c_side.signum() * d_side.signum() >= 0 || a_side.signum() * b_side.signum() >= 0 {
        return None;
    }
    // The fraction of `a b` is a_side / (a_side - b_side).
    let (mut over, mut under) = (a_side, a_side - b_side);
    if under < 0 {
        (over, under) = (-over, -under);
    }
    // floor(x + 1/2), the pixel's own rule. Below 2^122 in all.
    let at = |from: i64, to: i64| {
        from + ((2 * i128::from(to - from) * over + under).div_euclid(2 * under)) as i64
    };
    Some((at(a.0, b.0), at(a.1, b.1)))
}

/// Whether the closed segment meets the pixel of `node`, half-open: with its
/// left and lower sides, without its right and upper ones.
fn passes(from: Node, to: Node, node: Node) -> bool {
    // Twice the offsets from the centre, where the pixel is [-1, 1) squared.
    let (p, q) = (sub(from, node), sub(to, node));
    // Bounds of the parameter: numerator, denominator, whether it is excluded.
    let mut low = (0_i128, 1_i128, false);
    let mut high = (1_i128, 1_i128, false);
    for (start, end) in [(p.0, q.0), (p.1, q.1)] {
        let (start, run) = (2 * i128::from(start), 2 * i128::from(end - start));
        if run == 0 {
            if !(-1..1).contains(&start) {
                return false;
            }
            continue;
        }
        let (closed, open) = if run > 0 {
            (-1 - start, 1 - start)
        } else {
            (1 + start, start - 1)
        };
        let width = run.abs();
        let (enter, leave) = if run > 0 {
            ((closed, width, false), (open, width, true))
        } else {
            ((open, width, true), (closed, width, false))
        };
        let order = (enter.0 * low.1).cmp(&(low.0 * enter.1));
        if order.is_gt() || (order.is_eq() && enter.2) {
            low = enter;
        }
        let order = (leave.0 * high.1).cmp(&(high.0 * leave.1));
        if order.is_lt() || (order.is_eq() && leave.2) {
            high = leave;
        }
    }
    let order = (low.0 * high.1).cmp(&(high.0 * low.1));
    order.is_lt() || (order.is_eq() && !low.2 && !high.2)
}

/// Selects what lies within about a pixel of a segment, by boxes: a long
/// diagonal does not visit all that its own box holds.
struct Beside {
    from: Node,
    to: Node,
}

impl Beside {
    fn new(from: Node, to: Node) -> Self {
        Self { from, to }
    }

    fn meets(&self, low: [f64; 2], high: [f64; 2]) -> bool {
        // Nodes are whole numbers: a pixel more on each side is exact.
        let low = (low[0] as i64 - 1, low[1] as i64 - 1);
        let high = (high[0] as i64 + 1, high[1] as i64 + 1);
        let (a, b) = (self.from, self.to);
        if a.0.max(b.0) < low.0
            || a.0.min(b.0) > high.0
            || a.1.max(b.1) < low.1
            || a.1.min(b.1) > high.1
        {
            return false;
        }
        // All corners strictly on one side of the line: no.
        let way = sub(b, a);
        let side = |corner: Node| area2(way, sub(corner, a)).signum();
        let first = side(low);
        first == 0
            || [side(high), side((low.0, high.1)), side((high.0, low.1))]
                .iter()
                .any(|&s| s != first)
    }
}

impl SelectionFunction<[f64; 2]> for Beside {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 2]>) -> bool {
        self.meets(envelope.lower(), envelope.upper())
    }

    fn should_unpack_leaf(&self, leaf: &[f64; 2]) -> bool {
        self.meets(*leaf, *leaf)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: Node, to: Node, index: usize) -> Segment {
        Segment {
            from,
            to,
            source: Source::Line(index),
        }
    }

    fn nodes(segments: &[Segment]) -> Vec<(Node, Node)> {
        snap(segments).iter().map(|p| p.nodes).collect()
    }

    #[test]
    fn a_crossing_is_a_vertex_of_both() {
        let found = nodes(&[line((0, 0), (10, 10), 0), line((0, 11), (10, 0), 1)]);
        // They cross at 110 / 21 = 5.24.
        assert_eq!(
            found,
            [
                ((0, 0), (5, 5)),
                ((0, 11), (5, 5)),
                ((5, 5), (10, 0)),
                ((5, 5), (10, 10))
            ]
        );
    }

    #[test]
    fn touching_and_overlap_split_too() {
        let touch = nodes(&[line((0, 0), (10, 0), 0), line((4, 0), (4, 5), 1)]);
        assert_eq!(
            touch,
            [((0, 0), (4, 0)), ((4, 0), (4, 5)), ((4, 0), (10, 0))]
        );
        let overlap = nodes(&[line((0, 0), (10, 0), 0), line((14, 0), (4, 0), 1)]);
        assert_eq!(
            overlap,
            [
                ((0, 0), (4, 0)),
                ((4, 0), (10, 0)),
                ((4, 0), (10, 0)),
                ((10, 0), (14, 0))
            ]
        );
    }

    #[test]
    fn pixels_are_half_open() {
        // Through (1/2, 0) upwards: in the pixel of (1, 0), not in that of (0, 0).
        assert!(passes((0, -1), (1, 1), (1, 0)) && !passes((0, -2), (1, 2), (0, 1)));
        // The point (1/2, 1/2) belongs to (1, 1) alone.
        assert!(passes((0, 1), (1, 0), (1, 1)));
        assert!(passes((0, 1), (1, 0), (0, 1)) && passes((0, 1), (1, 0), (1, 0)));
        assert!(!passes((0, 1), (1, 0), (0, 0)));
        assert!(passes((3, 3), (3, 3), (3, 3)) && !passes((3, 3), (3, 3), (3, 4)));
    }

    #[test]
    fn boxes_select_all_that_is_passed() {
        // Every pixel that the exact test accepts must be offered to it.
        let mut state = 7_u64;
        let mut draw = |n: i64| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            ((state >> 33) as i64) % n
        };
        for _ in 0..2000 {
            let (a, b) = ((draw(30), draw(30)), (draw(30), draw(30)));
            let node = (draw(30), draw(30));
            if passes(a, b, node) {
                assert!(
                    Beside::new(a, b).meets(float(node), float(node)),
                    "{a:?} {b:?} {node:?}"
                );
            }
        }
    }
}
