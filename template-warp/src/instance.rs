//! A template set onto a particular region: parts counted, nodes numbered,
//! faces cut into the cells that are registered.

use crate::geometry::{cross, dist, dot, left, norm, p, signed_area, Path, P};
use crate::initial::{divide_of, mean_value_weights, side_arc_lengths};
use crate::region::EdgeUse;
use crate::solve::{Align, Anchor, Cell, Problem};
use crate::template::model::{Divide, Template};
use std::collections::BTreeMap;

/// Most parts into which an edge is divided; a bound against absurd input.
const MAX_PARTS: usize = 2000;

/// Turn between successive vertices of an arc, degrees. Below the 10 degrees
/// that arcs may turn at a vertex, so that the warp has some play.
const ARC_STEP_DEG: f64 = 8.0;

/// A polygon whose corners are known: its sides in counter-clockwise order.
#[derive(Clone, Debug)]
pub(crate) struct Domain {
    pub(crate) sides: Vec<DomainSide>,
}

/// The boundary between two corners.
#[derive(Clone, Debug)]
pub(crate) struct DomainSide {
    pub(crate) path: Path,
    /// Use of each segment of the path.
    pub(crate) uses: Vec<EdgeUse>,
}

/// What the parts of a warped template are made of.
#[derive(Debug)]
pub(crate) struct Instance<'a> {
    pub(crate) template: &'a Template,
    pub(crate) problem: Problem,
    /// Nodes strictly inside an edge of the drawing, keyed by its two points in
    /// increasing order and listed in that direction.
    pub(crate) inner: BTreeMap<(usize, usize), Vec<usize>>,
    /// Cells of each face, as a range into the problem's cells.
    pub(crate) cells_of: Vec<std::ops::Range<usize>>,
    /// For each cell its area as drawn, square metres.
    pub(crate) ideal_area: Vec<f64>,
}

/// Number of parts of ideal length `part` along `length`: the n that minimises
/// max(length / (n part), n part / length), ties to more parts (paper, Fig. 5:
/// "the number of parcels per row").
pub(crate) fn part_count(length: f64, part: f64, min: usize) -> usize {
    let x = length / part;
    let low = x.floor().max(1.0);
    let high = low + 1.0;
    // Compare x / low with high / x without dividing: a tie takes the higher.
    let n = if x < low || x * x < low * high {
        low
    } else {
        high
    };
    (n.min(MAX_PARTS as f64) as usize).max(min)
}

/// Most metres, as a share of the ideal part, by which an end part is widened.
const MAX_EXTRA: f64 = 0.5;

/// How an edge is divided.
#[derive(Clone, Debug)]
struct Parts {
    /// Shares of the length at the divisions, without 0 and 1.
    at: Vec<f64>,
    /// Share of an ordinary part.
    share: f64,
    /// Length on the region over length in the drawing.
    stretch: f64,
    /// Factor on the ideal part.
    adapt: f64,
}

impl Parts {
    fn new(length: f64, stretch: f64, divide: &Divide, ends: [f64; 2]) -> Self {
        let extra = ends[0] + ends[1];
        let rest = (length - extra).max(0.5 * length);
        let n = part_count(rest, divide.length, divide.min);
        let (n, rest, first) = if n < 2 || extra > 0.5 * length {
            (part_count(length, divide.length, divide.min), length, 0.0)
        } else {
            (n, rest, ends[0])
        };
        let share = rest / (length * n as f64);
        let at = (1..n).map(|k| first / length + k as f64 * share).collect();
        let adapt = (rest / (n as f64 * divide.length)).clamp(divide.adapt[0], divide.adapt[1]);
        Self {
            at,
            share,
            stretch,
            adapt,
        }
    }

    /// The divisions seen from the start of the edge or from its end.
    fn inner(&self, reversed: bool) -> Vec<f64> {
        if reversed {
            self.at.iter().rev().map(|t| 1.0 - t).collect()
        } else {
            self.at.clone()
        }
    }
}

/// Half the base of the triangle that each end of a row cuts from a rectangle,
/// metres: at the start and at the end of side `k` of a domain with four sides.
/// Seen from the direction of the side at that end, so that rows along curves
/// have none.
fn slanted_ends(domain: &Domain, k: usize) -> [f64; 2] {
    let n = domain.sides.len();
    if n != 4 {
        return [0.0, 0.0];
    }
    let front = &domain.sides[k].path;
    let back = &domain.sides[(k + 2) % n].path;
    let l = front.length();
    let at = |path: &Path, start: bool, depth: f64| {
        let l = path.length();
        let reach = 0.5 * depth.min(0.5 * l);
        let d = if start {
            path.at(reach) - path.at(0.0)
        } else {
            path.at(l) - path.at(l - reach)
        };
        d / norm(d).max(f64::MIN_POSITIVE)
    };
    let end = |start: bool| {
        let (a, b) = if start {
            (front.at(0.0), back.at(back.length()))
        } else {
            (front.at(l), back.at(0.0))
        };
        // Mean of both rows' directions, so that a taper is shared fairly.
        let u = at(front, start, norm(b - a)) - at(back, !start, norm(b - a));
        let u = u / norm(u).max(f64::MIN_POSITIVE);
        // A slant of up to about 17 degrees needs no wider parcel.
        let (off, depth) = (dot(b - a, u).abs(), cross(u, b - a).abs());
        0.5 * (off - 0.3 * depth).max(0.0)
    };
    [end(true), end(false)]
}

impl<'a> Instance<'a> {
    /// Sets the template's corner i at the start of the domain's side i. Both
    /// have equally many sides.
    pub(crate) fn new(template: &'a Template, domain: &Domain) -> Self {
        let points = template.points.len();
        let mut pos = vec![p(0.0, 0.0); points];
        let mut anchor = vec![Anchor::Free; points];
        let mut param = vec![0.0; points];
        // Points of the outline.
        for (k, (side, target)) in template.sides.iter().zip(&domain.sides).enumerate() {
            let at = side_arc_lengths(template, side, target.path.length());
            for (&node, &s) in side.nodes.iter().zip(&at).take(side.nodes.len() - 1) {
                pos[node] = target.path.at(s);
                param[node] = s;
                anchor[node] = if s == 0.0 {
                    Anchor::Corner
                } else {
                    Anchor::Side(k)
                };
            }
        }
        let end_of = |k: usize, node: usize, param: &[f64]| -> f64 {
            // A side ends at the corner where the next one starts.
            if Some(&node) == template.sides[k].nodes.last() {
                domain.sides[k].path.length()
            } else if Some(&node) == template.sides[k].nodes.first() {
                0.0
            } else {
                param[node]
            }
        };
        let side_of = |a: usize, b: usize| {
            template.sides.iter().position(|s| {
                s.nodes
                    .windows(2)
                    .any(|e| (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a))
            })
        };

        // Count the parts of each divide from the lengths on the boundary.
        let parts: Vec<Parts> = template
            .divides
            .iter()
            .map(|d| {
                let on_rim = |e: &[usize; 2]| side_of(e[0], e[1]).map(|k| (k, *e));
                let rim: Vec<(usize, [usize; 2])> = d.edges.iter().filter_map(on_rim).collect();
                let lengths: Vec<f64> = rim
                    .iter()
                    .map(|&(k, [a, b])| (end_of(k, a, &param) - end_of(k, b, &param)).abs())
                    .collect();
                let of = |e: &[usize; 2]| dist(template.points[e[0]], template.points[e[1]]);
                let (mean, drawn) = if lengths.is_empty() {
                    (of(&d.edges[0]), of(&d.edges[0]))
                } else {
                    let n = lengths.len() as f64;
                    (
                        lengths.iter().sum::<f64>() / n,
                        rim.iter().map(|(_, e)| of(e)).sum::<f64>() / n,
                    )
                };
                let ends = match rim.first() {
                    Some(&(k, [a, b])) if d.wide_ends > 0.0 => {
                        let extra = slanted_ends(domain, k)
                            .map(|e| (e * d.wide_ends).min(MAX_EXTRA * d.length));
                        // The side runs from its first node; the edge may not.
                        if end_of(k, a, &param) > end_of(k, b, &param) {
                            [extra[1], extra[0]]
                        } else {
                            extra
                        }
                    }
                    _ => [0.0, 0.0],
                };
                Parts::new(mean, mean / drawn, d, ends)
            })
            .collect();

        // Nodes inside divided edges and arcs, first in the drawing.
        let mut drawn = template.points.clone();
        let mut inner: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (d, parts) in template.divides.iter().zip(&parts) {
            for &[a, b] in &d.edges {
                let (i, j) = (a.min(b), a.max(b));
                let side = side_of(a, b);
                let mut nodes = Vec::new();
                let reversed = (a, b) != (i, j);
                for t in parts.inner(reversed) {
                    nodes.push(drawn.len());
                    drawn.push(template.points[i] + (template.points[j] - template.points[i]) * t);
                    match side {
                        Some(side) => {
                            let (s0, s1) = (end_of(side, i, &param), end_of(side, j, &param));
                            let s = s0 + (s1 - s0) * t;
                            anchor.push(Anchor::Side(side));
                            param.push(s);
                            pos.push(domain.sides[side].path.at(s));
                        }
                        None => {
                            anchor.push(Anchor::Free);
                            param.push(0.0);
                            pos.push(p(0.0, 0.0));
                        }
                    }
                }
                inner.insert((i, j), nodes);
            }
        }
        for arc in &template.arcs {
            for e in arc.points.windows(2) {
                let (i, j) = (e[0].min(e[1]), e[0].max(e[1]));
                let (a, b) = (
                    template.points[i] - arc.centre,
                    template.points[j] - arc.centre,
                );
                let angle = cross(a, b).atan2(dot(a, b));
                let k = (angle.abs().to_degrees() / ARC_STEP_DEG - 1e-9)
                    .ceil()
                    .max(1.0) as usize;
                let mut nodes = Vec::new();
                for part in 1..k {
                    let (s, c) = (angle * part as f64 / k as f64).sin_cos();
                    nodes.push(drawn.len());
                    drawn.push(arc.centre + a * c + left(a) * s);
                    anchor.push(Anchor::Free);
                    param.push(0.0);
                    pos.push(p(0.0, 0.0));
                }
                inner.insert((i, j), nodes);
            }
        }
        let chain = |a: usize, b: usize| -> Vec<usize> {
            let mut v = vec![a];
            if let Some(nodes) = inner.get(&(a.min(b), a.max(b))) {
                if a < b {
                    v.extend(nodes.iter());
                } else {
                    v.extend(nodes.iter().rev());
                }
            }
            v
        };

        // Inside points by mean value coordinates of the refined outline.
        let mut rim: Vec<usize> = Vec::new();
        for side in &template.sides {
            for e in side.nodes.windows(2) {
                rim.extend(chain(e[0], e[1]));
            }
        }
        let rim_drawn: Vec<P> = rim.iter().map(|&i| drawn[i]).collect();
        for i in 0..drawn.len() {
            if anchor[i] == Anchor::Free {
                let weights = mean_value_weights(&rim_drawn, drawn[i]);
                let mut q = p(0.0, 0.0);
                for (&r, &w) in rim.iter().zip(&weights) {
                    q = q + pos[r] * w;
                }
                pos[i] = q;
            }
        }

        // Nodes along each side in order.
        let on_side: Vec<Vec<usize>> = template
            .sides
            .iter()
            .map(|side| {
                side.nodes
                    .windows(2)
                    .flat_map(|e| chain(e[0], e[1]))
                    .skip(1)
                    .collect()
            })
            .collect();

        let mut cells = Vec::new();
        let mut cells_of = Vec::new();
        let mut ideal_area = Vec::new();
        for face in &template.faces {
            let start = cells.len();
            let (shapes, adapt) = cut(template, face, &chain, &drawn, &parts);
            for (nodes, reference) in shapes {
                // The ideal is the drawing before it followed the region.
                ideal_area.push(signed_area(&reference) / adapt);
                cells.push(Cell::new(
                    nodes,
                    reference,
                    1.0 / face.tolerance,
                    face.class.clone(),
                ));
            }
            cells_of.push(start..cells.len());
        }
        let aligns = template
            .alignments
            .iter()
            .map(|a| {
                let mut nodes: Vec<usize> = a
                    .points
                    .windows(2)
                    .flat_map(|e| chain(e[0], e[1]))
                    .collect();
                nodes.extend(a.points.last());
                Align::new(a.kind, nodes)
            })
            .collect();
        let paths = domain.sides.iter().map(|s| s.path.clone()).collect();
        let problem = Problem::new(pos, param, anchor, paths, on_side, cells, aligns);
        Self {
            template,
            problem,
            inner,
            cells_of,
            ideal_area,
        }
    }
}

/// The nodes of a cell and its reference shape.
type Shape = (Vec<usize>, Vec<P>);

/// Cells of a face: one for each part if two of its edges are divided together,
/// the whole face otherwise. Returns nodes and reference shapes; a reference is
/// drawn in a frame whose x axis follows the face's first edge.
fn cut(
    template: &Template,
    face: &crate::template::model::Face,
    chain: &dyn Fn(usize, usize) -> Vec<usize>,
    drawn: &[P],
    counted: &[Parts],
) -> (Vec<Shape>, f64) {
    let n = face.points.len();
    let edge = |i: usize| (face.points[i % n], face.points[(i + 1) % n]);
    let mut pair = None;
    'search: for i in 0..n {
        let Some(d) = divide_of(template, edge(i).0, edge(i).1) else {
            continue;
        };
        for j in i + 1..n {
            if divide_of(template, edge(j).0, edge(j).1) == Some(d) {
                pair = Some((i, j, d));
                break 'search;
            }
        }
    }
    let frame = |a: usize, b: usize| {
        let u = template.points[b] - template.points[a];
        let l = norm(u);
        (template.points[a], u / l, l)
    };
    let Some((i, j, d)) = pair else {
        let nodes: Vec<usize> = (0..n).flat_map(|i| chain(edge(i).0, edge(i).1)).collect();
        let (o, u, _) = frame(face.corners[0], face.corners[1 % face.corners.len()]);
        let reference = nodes
            .iter()
            .map(|&k| p(dot(drawn[k] - o, u), cross(u, drawn[k] - o)))
            .collect();
        return (vec![(nodes, reference)], 1.0);
    };
    let mut bottom = chain(edge(i).0, edge(i).1);
    bottom.push(edge(i).1);
    let mut top = chain(edge(j).0, edge(j).1);
    top.push(edge(j).1);
    top.reverse();
    let parts = bottom.len() - 1;
    let (o, u, l) = frame(edge(i).0, edge(i).1);
    // The drawing's divided edge holds some number of parts; stretch it along
    // its own direction until each part has its ideal length. Areas are cut only
    // to follow the region: their cells take the length that there is.
    let stretch = if face.is_area() {
        counted[d].stretch
    } else {
        template.divides[d].length * counted[d].adapt / (counted[d].share * l)
    };
    let to_frame = |k: usize| {
        let r = drawn[k] - o;
        let x = dot(r, u);
        // What is drawn beyond the divided edge's ends keeps its size.
        let x = if x < 0.0 {
            x
        } else if x > l {
            x - l + l * stretch
        } else {
            x * stretch
        };
        p(x, cross(u, r))
    };
    let chained = |from: usize, to: usize| -> Vec<usize> {
        // Ring nodes strictly between the end of edge `from` and the start of `to`.
        let mut v = Vec::new();
        let mut k = from + 1;
        while k % n != to % n {
            v.extend(chain(edge(k).0, edge(k).1));
            k += 1;
        }
        if !v.is_empty() {
            v.remove(0);
        }
        v
    };
    let adapt = if face.is_area() {
        counted[d].stretch
    } else {
        counted[d].adapt
    };
    let cells = (0..parts)
        .map(|c| {
            let mut nodes = vec![bottom[c], bottom[c + 1]];
            if c + 1 == parts {
                nodes.extend(chained(i, j));
            }
            nodes.push(top[c + 1]);
            nodes.push(top[c]);
            if c == 0 {
                nodes.extend(chained(j, i + n));
            }
            // Where the divided edges meet in a point (a wedge's tip) it appears twice.
            nodes.dedup();
            if nodes.first() == nodes.last() {
                nodes.pop();
            }
            let reference = nodes.iter().map(|&k| to_frame(k)).collect();
            (nodes, reference)
        })
        .collect();
    (cells, adapt)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn part_count_minimises_the_worse_ratio() {
        for i in 1..2000 {
            let length = 0.37 * f64::from(i);
            let cost = |n: usize| (length / (n as f64 * 18.0)).max(n as f64 * 18.0 / length);
            let best = (1..100).map(cost).fold(f64::INFINITY, f64::min);
            assert!(
                cost(part_count(length, 18.0, 1)) <= best * (1.0 + 1e-12),
                "{length}"
            );
        }
        // A tie at the geometric mean goes to more parts.
        assert_eq!(part_count(2f64.sqrt() * 18.0 * (1.0 + 1e-15), 18.0, 1), 2);
        assert_eq!(part_count(5.0, 18.0, 1), 1);
    }
}
