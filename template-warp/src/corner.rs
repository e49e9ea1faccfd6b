//! Corners of a region: where its boundary turns, and how firmly.
//!
//! The paper (section 4.1, Initialization) detects "the convex and concave
//! corners" without saying how. Insets of real blocks have corners that are cut
//! or rounded by several short edges, and sides that bend gently over their
//! whole length, so one angle per vertex does not do: turns are summed over a
//! short stretch of boundary, and a stretch is a corner only if the boundary
//! turns clearly less before and after it.

use crate::geometry::{dist, turn, P};

/// Turn, radians, below which a vertex cannot start a corner: it lies on a
/// straight side.
const FLAT: f64 = 1e-6;

/// Parameters of corner detection.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerOptions {
    /// Least turn of a corner, degrees. Default 30.
    pub corner_deg: f64,
    /// Corners that turn by less than this, degrees, may be taken as an
    /// ordinary bend of a side when a template has fewer corners. Default 58.
    pub firm_deg: f64,
    /// Length of boundary, metres, over which successive turns make one corner.
    /// Default 12.
    pub span: f64,
}

impl Default for CornerOptions {
    fn default() -> Self {
        Self {
            corner_deg: 30.0,
            firm_deg: 58.0,
            span: 12.0,
        }
    }
}

/// A corner of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Vertex that stands for the corner.
    pub vertex: usize,
    /// Turn, radians: positive where the region is convex.
    pub turn: f64,
    /// Whether a match must use it: weaker corners may be passed over.
    pub firm: bool,
}

/// Finds the corners of a counter-clockwise ring, in the order of its vertices.
///
/// A quarter turn spread over an arc of up to about `span` is one corner; a
/// curve that keeps turning at the same rate is none; a quarter turn spread
/// over up to three times `span` is a weak corner, which matching may use.
///
/// # Complexity
///
/// O(n log n) for n vertices; where the boundary turns, times the number of
/// vertices within the span.
#[must_use]
pub fn corners(ring: &[P], options: &CornerOptions) -> Vec<Corner> {
    let n = ring.len();
    if n < 3 {
        return Vec::new();
    }
    let turns: Vec<f64> = (0..n)
        .map(|i| {
            let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            turn(b - a, c - b)
        })
        .collect();
    let edges: Vec<f64> = (0..n).map(|i| dist(ring[i], ring[(i + 1) % n])).collect();
    let perimeter: f64 = edges.iter().sum();
    // On a region hardly larger than the span, the span would swallow sides.
    let span = options.span.min(perimeter / 12.0);
    let threshold = options.corner_deg.to_radians();
    let firm = options.firm_deg.to_radians();
    let stretch = Stretch {
        turns: &turns,
        edges: &edges,
    };

    let mut found: Vec<(usize, f64, bool)> = Vec::new();
    let mut taken = vec![false; n];
    // Sharpest vertex first: it gathers the turns around it. The wider sums
    // decide among the vertices of an arc for the one in its middle.
    let mut order: Vec<usize> = (0..n).collect();
    let sums = Sums::new(&turns, &edges);
    let scores: Vec<f64> = (0..n)
        .map(|i| {
            let (near, wide) = (sums.signed(i, 0.5 * span), sums.signed(i, 1.5 * span));
            near.abs() + 0.5 * turns[i].abs() + 0.2 * wide.abs()
        })
        .collect();
    order.sort_by(|&i, &j| scores[j].total_cmp(&scores[i]).then(i.cmp(&j)));
    for &i in &order {
        if taken[i] {
            continue;
        }
        // Too little turning all around: spares the search on straight sides.
        if turns[i].abs() < FLAT || sums.absolute(i, span) < 0.999 * threshold {
            continue;
        }
        let sharp = turns[i].abs() >= threshold;
        let (near, members) = stretch.gather(i, span, &taken);
        let (wide, _) = stretch.sum(i, 1.5 * span, &taken);
        let mut total = near;
        let mut gathered = members;
        if sharp && near.abs() > 125f64.to_radians() {
            // Two real corners closer than the span (a blunt tip): stay apart.
            total = turns[i];
            gathered = vec![i];
        }
        // Turning on at the same rate outside the span means a curve.
        let curve = (wide - near).abs() > 0.9 * near.abs() && turns[i].abs() < 0.7 * near.abs();
        if curve {
            // A quarter turn or so within three spans is offered to matching,
            // though never forced on it; a longer curve is offered in pieces.
            (total, gathered) = stretch.gather(i, 3.0 * span, &taken);
            if total.abs() < firm {
                continue;
            }
        } else if total.abs() < threshold {
            continue;
        }
        found.push((
            centre_of(&gathered, &turns, i),
            total,
            !curve && total.abs() >= firm,
        ));
        for &j in &gathered {
            taken[j] = true;
        }
    }
    // Rounder still: the turn within the span is no corner, within three it is.
    for &i in &order {
        if taken[i] || turns[i].abs() < FLAT || sums.absolute(i, 3.0 * span) < 0.999 * firm {
            continue;
        }
        let (total, members) = stretch.gather(i, 3.0 * span, &taken);
        if total.abs() >= firm {
            found.push((centre_of(&members, &turns, i), total, false));
            for &j in &members {
                taken[j] = true;
            }
        }
    }
    found.sort_unstable_by_key(|c| c.0);
    found.dedup_by_key(|c| c.0);
    found
        .into_iter()
        .map(|(vertex, turn, firm)| Corner { vertex, turn, firm })
        .collect()
}

/// The vertex that stands for a group: the one that holds most of the turn, or
/// else the one nearest to the middle of the turning.
fn centre_of(members: &[usize], turns: &[f64], seed: usize) -> usize {
    let total: f64 = members.iter().map(|&j| turns[j]).sum();
    if turns[seed].abs() >= 0.6 * total.abs() {
        return seed;
    }
    let mut sum = 0.0;
    for &j in members {
        sum += turns[j];
        if sum.abs() >= 0.5 * total.abs() - 1e-9 {
            return j;
        }
    }
    seed
}

/// Sums of turns over windows of boundary, in O(log n) each.
struct Sums {
    /// Arc length, and sums of turns and of their sizes up to each vertex, over
    /// three rounds of the ring.
    along: Vec<f64>,
    signed: Vec<f64>,
    absolute: Vec<f64>,
}

impl Sums {
    fn new(turns: &[f64], edges: &[f64]) -> Self {
        let n = turns.len();
        let (mut along, mut signed, mut absolute) = (vec![0.0], vec![0.0], vec![0.0]);
        for k in 0..3 * n {
            along.push(along[k] + edges[k % n]);
            signed.push(signed[k] + turns[k % n]);
            absolute.push(absolute[k] + turns[k % n].abs());
        }
        Self {
            along,
            signed,
            absolute,
        }
    }

    /// First and last (exclusive) vertex within `reach` of vertex `i` of the
    /// middle round, at most one round in all.
    fn window(&self, i: usize, reach: f64) -> (usize, usize) {
        let n = (self.along.len() - 1) / 3;
        let at = self.along[n + i];
        let lo = self.along.partition_point(|&a| a < at - reach).max(i + 1);
        let hi = self.along.partition_point(|&a| a <= at + reach).min(lo + n);
        (lo, hi.max(n + i + 1))
    }

    fn signed(&self, i: usize, reach: f64) -> f64 {
        let (lo, hi) = self.window(i, reach);
        self.signed[hi] - self.signed[lo]
    }

    fn absolute(&self, i: usize, reach: f64) -> f64 {
        let (lo, hi) = self.window(i, reach);
        self.absolute[hi] - self.absolute[lo]
    }
}

struct Stretch<'a> {
    turns: &'a [f64],
    edges: &'a [f64],
}

impl Stretch<'_> {
    /// Sum of the turns of vertex `i` and of those around it that turn the same
    /// way, gathered nearest first while they all lie within `extent` metres of
    /// boundary. The members are in boundary order.
    fn gather(&self, i: usize, extent: f64, taken: &[bool]) -> (f64, Vec<usize>) {
        let n = self.turns.len();
        let mut members = std::collections::VecDeque::from([i]);
        let (mut first, mut last) = (i, i);
        let (mut sum, mut length) = (self.turns[i], 0.0);
        while members.len() + 1 < n {
            let (before, after) = ((first + n - 1) % n, (last + 1) % n);
            let fits = |j: usize, l: f64| {
                !taken[j] && length + l <= extent && self.turns[j] * self.turns[i] >= 0.0
            };
            let (back, ahead) = (self.edges[before], self.edges[last]);
            let (go_back, go_ahead) = (fits(before, back), fits(after, ahead));
            if go_back && (!go_ahead || back <= ahead) {
                first = before;
                length += back;
                sum += self.turns[before];
                members.push_front(before);
            } else if go_ahead {
                last = after;
                length += ahead;
                sum += self.turns[after];
                members.push_back(after);
            } else {
                break;
            }
        }
        (sum, members.into())
    }

    /// Sum of the turns within `reach` of vertex `i` along the boundary, and
    /// the vertices that took part, in boundary order. Vertices already taken
    /// by another corner end the stretch.
    fn sum(&self, i: usize, reach: f64, taken: &[bool]) -> (f64, Vec<usize>) {
        let n = self.turns.len();
        let free = |j: usize| taken.get(j) != Some(&true);
        let mut members = Vec::new();
        let mut sum = self.turns[i];
        let (mut s, mut j) = (0.0, i);
        loop {
            let previous = (j + n - 1) % n;
            s += self.edges[previous];
            if s > reach || previous == i || !free(previous) {
                break;
            }
            j = previous;
            sum += self.turns[j];
            members.push(j);
        }
        let first = j;
        members.reverse();
        members.push(i);
        let (mut s, mut j) = (0.0, i);
        loop {
            s += self.edges[j];
            j = (j + 1) % n;
            if s > reach || j == i || j == first || !free(j) {
                break;
            }
            sum += self.turns[j];
            members.push(j);
        }
        (sum, members)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::p;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// A rectangle whose corners are arcs of `n` vertices and radius `r`.
    fn rounded(w: f64, h: f64, r: f64, n: usize) -> Vec<P> {
        let centres = [p(w - r, r), p(w - r, h - r), p(r, h - r), p(r, r)];
        let mut ring = Vec::new();
        for (k, c) in centres.iter().enumerate() {
            for i in 0..n {
                let a = -FRAC_PI_2 + FRAC_PI_2 * (k as f64 + i as f64 / (n as f64 - 1.0));
                ring.push(*c + p(a.cos(), a.sin()) * r);
            }
        }
        ring
    }

    #[test]
    fn a_rounded_quarter_turn_is_one_corner() {
        let found = corners(&rounded(90.0, 60.0, 7.0, 7), &CornerOptions::default());
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(found.iter().all(|c| c.firm && c.turn > 1.3));
        // The middle vertex of the seven stands for the arc.
        assert!(found.iter().all(|c| c.vertex % 7 == 3), "{found:?}");
    }

    #[test]
    fn a_broad_rounding_is_a_weak_corner() {
        let found = corners(&rounded(150.0, 90.0, 20.0, 9), &CornerOptions::default());
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(found.iter().all(|c| !c.firm));
    }

    #[test]
    fn a_circle_and_a_gentle_bend_have_none() {
        let circle: Vec<P> = (0..24)
            .map(|i| i as f64 * PI / 12.0)
            .map(|a| p(a.cos(), a.sin()) * 60.0)
            .collect();
        assert!(corners(&circle, &CornerOptions::default())
            .iter()
            .all(|c| !c.firm));
        let mut strip: Vec<P> = (0..=10)
            .map(|i| 0.1 * i as f64)
            .map(|a| p(a.sin(), -a.cos()) * 140.0)
            .collect();
        strip.extend(
            (0..=10)
                .rev()
                .map(|i| 0.1 * i as f64)
                .map(|a| p(a.sin(), -a.cos()) * 80.0),
        );
        let found = corners(&strip, &CornerOptions::default());
        assert_eq!(
            found.iter().map(|c| c.vertex).collect::<Vec<_>>(),
            vec![0, 10, 11, 21]
        );
    }

    #[test]
    fn a_blunt_tip_keeps_two_corners_and_a_chamfer_makes_one() {
        let blunt = [p(0., 0.), p(90., 0.), p(90., 9.), p(0., 60.)];
        assert_eq!(corners(&blunt, &CornerOptions::default()).len(), 4);
        let chamfer = [p(0., 0.), p(85., 0.), p(90., 5.), p(90., 60.), p(0., 60.)];
        let found = corners(&chamfer, &CornerOptions::default());
        assert_eq!(found.len(), 4, "{found:?}");
        assert!((found[1].turn - FRAC_PI_2).abs() < 1e-9);
    }
}
