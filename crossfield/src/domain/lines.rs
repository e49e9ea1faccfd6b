//! Constraint lines inside a domain: cut where they meet the boundary and
//! each other, so that the triangulation sees none that cross.

use geo_types::LineString;

use super::ring::{Frame, Ring};
use crate::footpoint::{Bound, EdgeTree, Tree};
use crate::plane::{nearest_on_segment, orient, orient_exact, vector, V2};
use crate::FieldError;

/// A straight piece of a constraint line that crosses nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinePiece {
    pub(crate) from: V2,
    pub(crate) to: V2,
    /// Which line of the input.
    pub(crate) line: u32,
}

/// Lines cut into pieces, and where these meet the boundary.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    pub(crate) pieces: Vec<LinePiece>,
    /// Ring, edge and point, in order of ring, edge and distance from its
    /// start.
    cuts: Vec<(u32, u32, V2)>,
}

impl Lines {
    /// Points at which lines meet the inside of an edge, along the edge.
    pub(crate) fn cuts(&self, ring: usize, edge: usize) -> &[(u32, u32, V2)] {
        let key = (ring as u32, edge as u32);
        let from = self.cuts.partition_point(|c| (c.0, c.1) < key);
        let to = self.cuts.partition_point(|c| (c.0, c.1) <= key);
        &self.cuts[from..to]
    }

    /// Cuts `lines` at the rings and at each other, and leaves out what lies
    /// outside or along the boundary.
    ///
    /// Points nearer to each other than 1e-9 of the domain's size are one.
    ///
    /// Expected O((n + k) log n) for n segments and edges and k crossings,
    /// and O(edges) a piece for telling inside from outside.
    pub(crate) fn new(
        lines: &[LineString<f64>],
        rings: &[Ring],
        frame: Frame,
    ) -> Result<Self, FieldError> {
        if lines.is_empty() {
            return Ok(Self::default());
        }
        let mut noder = Noder {
            rings,
            edges: EdgeTree::new(rings),
            near: 1e-9 * frame.size,
            cuts: Vec::new(),
        };
        let mut segments: Vec<LinePiece> = Vec::new();
        for (index, line) in lines.iter().enumerate() {
            let mut last: Option<V2> = None;
            for (vertex, &c) in line.0.iter().enumerate() {
                if !(c.x.is_finite() && c.y.is_finite() && c.x.abs().max(c.y.abs()) < 1e150) {
                    return Err(FieldError::BadLine {
                        line: index,
                        why: format!("has a vertex, number {vertex}, that is not a usable number"),
                    });
                }
                let p = noder.on_boundary(vector(c) - frame.origin);
                if let Some(from) = last.filter(|&from| (p - from).norm() > noder.near) {
                    segments.push(LinePiece {
                        from,
                        to: p,
                        line: index as u32,
                    });
                } else if last.is_some() {
                    continue;
                }
                last = Some(p);
            }
        }
        let pieces = noder.pieces(&segments);
        let mut cuts = noder.cuts;
        let along = |c: &(u32, u32, V2)| {
            let (a, _) = rings[c.0 as usize].edge(c.1 as usize);
            (c.2 - a).norm()
        };
        cuts.sort_by(|a, b| {
            (a.0, a.1)
                .cmp(&(b.0, b.1))
                .then(along(a).total_cmp(&along(b)))
        });
        Ok(Self { pieces, cuts })
    }
}

/// Finds the points at which lines are cut.
struct Noder<'a> {
    rings: &'a [Ring],
    edges: EdgeTree,
    near: f64,
    cuts: Vec<(u32, u32, V2)>,
}

impl Noder<'_> {
    /// `p`, or the boundary point that it means.
    fn on_boundary(&mut self, p: V2) -> V2 {
        let (foot, ring, edge) = self.edges.nearest(self.rings, p);
        if (foot - p).norm() <= self.near {
            self.cut(ring, edge, foot)
        } else {
            p
        }
    }

    /// The vertex or cut of an edge at `p`, which is added if there is none.
    fn cut(&mut self, ring: u32, edge: u32, p: V2) -> V2 {
        let (a, b) = self.rings[ring as usize].edge(edge as usize);
        let known = self.cuts.iter().filter(|c| (c.0, c.1) == (ring, edge));
        let nearest = known
            .map(|c| c.2)
            .chain([a, b])
            .find(|q| (q - p).norm() <= self.near);
        nearest.unwrap_or_else(|| {
            self.cuts.push((ring, edge, p));
            p
        })
    }

    fn pieces(&mut self, segments: &[LinePiece]) -> Vec<LinePiece> {
        let mut nodes: Vec<Vec<V2>> = segments.iter().map(|s| vec![s.from, s.to]).collect();
        for (segment, nodes) in segments.iter().zip(&mut nodes) {
            let mut met = Vec::new();
            self.edges
                .any_along(segment.from, segment.to, |ring, edge| {
                    met.push((ring, edge));
                    false
                });
            met.sort_unstable();
            for (ring, edge) in met {
                let (a, b) = self.rings[ring as usize].edge(edge as usize);
                if self.near_segment(a, segment.from, segment.to) {
                    nodes.push(a);
                } else if let Some(p) = meeting(segment.from, segment.to, a, b) {
                    nodes.push(self.cut(ring, edge, p));
                }
            }
        }
        let bounds: Vec<Bound> = segments
            .iter()
            .map(|s| Bound::of_segment(s.from, s.to, 1.0))
            .collect();
        let tree = Tree::new(&bounds);
        for (k, one) in segments.iter().enumerate() {
            let mut met = Vec::new();
            tree.any_along(one.from, one.to, |other| {
                met.push(other);
                false
            });
            met.sort_unstable();
            for other in met.into_iter().filter(|&other| other != k) {
                let two = segments[other];
                for end in [two.from, two.to] {
                    if self.near_segment(end, one.from, one.to) {
                        nodes[k].push(end);
                    }
                }
                if other > k {
                    if let Some(p) = meeting(one.from, one.to, two.from, two.to) {
                        // Where three lines meet in a point, it is one point.
                        let known = |list: &[V2]| {
                            list.iter().find(|q| (*q - p).norm() <= self.near).copied()
                        };
                        let p = known(&nodes[k])
                            .or_else(|| known(&nodes[other]))
                            .unwrap_or(p);
                        nodes[k].push(p);
                        nodes[other].push(p);
                    }
                }
            }
        }
        let mut pieces = Vec::new();
        for (segment, mut nodes) in segments.iter().zip(nodes) {
            let along = |p: &V2| (p - segment.from).dot(&(segment.to - segment.from));
            nodes.sort_by(|a, b| along(a).total_cmp(&along(b)));
            nodes.dedup_by(|a, b| (*a - *b).norm() <= self.near);
            for pair in nodes.windows(2) {
                if self.inside((pair[0] + pair[1]) / 2.0) {
                    pieces.push(LinePiece {
                        from: pair[0],
                        to: pair[1],
                        line: segment.line,
                    });
                }
            }
        }
        pieces
    }

    fn near_segment(&self, p: V2, a: V2, b: V2) -> bool {
        (p - nearest_on_segment(p, a, b)).norm() <= self.near
    }

    /// Inside the domain, and not along its boundary.
    fn inside(&self, p: V2) -> bool {
        let (foot, ..) = self.edges.nearest(self.rings, p);
        (foot - p).norm() > self.near
            && self.rings.iter().filter(|ring| ring.contains(p)).count() == 1
    }
}

/// Where two segments cross in a point inside both.
fn meeting(a: V2, b: V2, c: V2, d: V2) -> Option<V2> {
    let apart = |u: f64, v: f64| (u > 0.0 && v < 0.0) || (u < 0.0 && v > 0.0);
    let crosses = apart(orient_exact(a, b, c), orient_exact(a, b, d))
        && apart(orient_exact(c, d, a), orient_exact(c, d, b));
    crosses.then(|| {
        let (u, v) = (orient(a, b, c), orient(a, b, d));
        let t = (u / (u - v)).clamp(0.0, 1.0);
        c + (d - c) * t
    })
}
