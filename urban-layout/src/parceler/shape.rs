//! A piece of land with its street edges, its fronts, and how to cut it.

use super::geom::{angle, area, dist, inside, left, lerp, meet, norm, unit, P};
use super::ParcelOptions;

/// A simple counter-clockwise ring whose edges know whether they give access.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    /// Open ring.
    pub(super) ring: Vec<P>,
    /// `front[i]`: edge `ring[i]` to `ring[i + 1]` lies on a street.
    pub(super) front: Vec<bool>,
}

/// A place on a shape's ring: a point of edge `edge`, or vertex `edge`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    pub(super) edge: usize,
    pub(super) vertex: bool,
    pub(super) at: P,
}

/// A stretch of street edges without a corner: edges `start .. start + count`,
/// counted around the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chain {
    pub(super) start: usize,
    pub(super) count: usize,
    pub(super) length: f64,
}

impl Shape {
    pub(super) fn len(&self) -> usize {
        self.ring.len()
    }

    pub(super) fn area(&self) -> f64 {
        area(&self.ring)
    }

    pub(super) fn edge(&self, i: usize) -> (P, P) {
        (self.ring[i], self.ring[(i + 1) % self.len()])
    }

    /// Metres of street edges.
    pub(super) fn frontage(&self) -> f64 {
        (0..self.len())
            .filter(|&i| self.front[i])
            .map(|i| {
                let (a, b) = self.edge(i);
                dist(a, b)
            })
            .sum()
    }

    /// The same shape, its ring starting at vertex `start`.
    pub(super) fn rotated(&self, start: usize) -> Self {
        let mut s = self.clone();
        s.ring.rotate_left(start);
        s.front.rotate_left(start);
        s
    }

    /// The mark for the point `at` of edge `edge`, moved to an end of the edge
    /// when that is within `snap`.
    pub(super) fn mark(&self, edge: usize, at: P, snap: f64) -> Mark {
        let (a, b) = self.edge(edge);
        let (da, db) = (dist(a, at), dist(b, at));
        if da <= snap && da <= db {
            Mark {
                edge,
                vertex: true,
                at: a,
            }
        } else if db <= snap {
            Mark {
                edge: (edge + 1) % self.len(),
                vertex: true,
                at: b,
            }
        } else {
            Mark {
                edge,
                vertex: false,
                at,
            }
        }
    }

    /// Whether the open segment from mark `a` to mark `b` runs inside.
    ///
    /// `a` or `b` may be `None` in the middle of a cut; then that end must lie
    /// inside and off the ring.
    pub(super) fn sees(&self, p: P, a: Option<Mark>, q: P, b: Option<Mark>) -> bool {
        let n = self.len();
        if dist(p, q) < 1e-9 || !inside(&self.ring, lerp(p, q, 0.5)) {
            return false;
        }
        let touches = |m: Option<Mark>, i: usize| {
            m.is_some_and(|m| m.edge == i || (m.vertex && (i + 1) % n == m.edge))
        };
        for i in 0..n {
            let (c, d) = self.edge(i);
            let (ta, tb) = (touches(a, i), touches(b, i));
            if ta && tb {
                return false;
            }
            if ta || tb {
                // The edge holds this end of the segment: it must not hold
                // any other point of it, which only an overlap could bring.
                let (s, o) = if ta { (p, q) } else { (q, p) };
                let far = if dist(c, s) > dist(d, s) { c } else { d };
                let (u, v) = (o - s, far - s);
                if super::geom::cross(u, v).abs() <= 1e-9 * norm(u) * norm(v)
                    && super::geom::dot(u, v) > 0.0
                {
                    return false;
                }
            } else if meet(p, q, c, d) {
                return false;
            }
        }
        true
    }

    /// Cuts the shape along the path `a`, `inner`, `b` into the part left of
    /// it and the part right of it; `None` if the path does not run inside.
    pub(super) fn cut(&self, a: Mark, inner: &[P], b: Mark) -> Option<(Self, Self)> {
        let mut last = (a.at, Some(a));
        for &q in inner {
            if !self.sees(last.0, last.1, q, None) {
                return None;
            }
            last = (q, None);
        }
        if !self.sees(last.0, last.1, b.at, Some(b)) {
            return None;
        }
        let back: Vec<P> = inner.iter().rev().copied().collect();
        // The left part follows the path from a to b, then the ring from b
        // round to a; the right part the other way.
        Some((self.side(a, inner, b)?, self.side(b, &back, a)?))
    }

    /// The part to the left of the path `a`, `inner`, `b`.
    fn side(&self, a: Mark, inner: &[P], b: Mark) -> Option<Self> {
        let n = self.len();
        let mut ring = vec![a.at];
        let mut front = Vec::new();
        for &q in inner {
            front.push(false);
            ring.push(q);
        }
        front.push(false);
        ring.push(b.at);
        // From b along the ring to a.
        let mut i = b.edge;
        front.push(self.front[i]);
        let mut steps = 0;
        while i != a.edge || (steps == 0 && !after(self, a, b)) {
            i = (i + 1) % n;
            steps += 1;
            if i == a.edge && a.vertex {
                break;
            }
            ring.push(self.ring[i]);
            front.push(self.front[i]);
            if steps > n {
                return None;
            }
        }
        debug_assert_eq!(ring.len(), front.len());
        (ring.len() >= 3 && area(&ring) > 0.0).then_some(Self { ring, front })
    }

    /// The fronts: runs of street edges, split at corners and where a run
    /// bends round so far that it faces itself.
    pub(super) fn chains(&self, options: &ParcelOptions) -> Vec<Chain> {
        let n = self.len();
        let mut out = Vec::new();
        let open = (0..n).find(|&i| !self.front[i]);
        let runs: Vec<(usize, usize)> = match open {
            None => vec![(self.sharpest(options), n)],
            Some(o) => {
                let mut runs = Vec::new();
                let mut i = 1;
                while i < n {
                    let s = (o + i) % n;
                    let mut c = 0;
                    while i + c < n && self.front[(s + c) % n] {
                        c += 1;
                    }
                    if c > 0 {
                        runs.push((s, c));
                    }
                    i += c.max(1);
                }
                runs
            }
        };
        for (s, c) in runs {
            self.split_run(s, c, options, &mut out);
        }
        out
    }

    /// The vertex where an all-street ring turns most: its runs start there.
    fn sharpest(&self, options: &ParcelOptions) -> usize {
        let n = self.len();
        let arc = Arc::new(self, 0, n);
        let mut best = (f64::NEG_INFINITY, 0);
        for i in 0..n {
            let r = 0.5 * options.width;
            let t = arc.turn_wrapped(arc.s[i], r);
            if t > best.0 + 1e-9 {
                best = (t, i);
            }
        }
        best.1
    }

    fn split_run(&self, start: usize, count: usize, options: &ParcelOptions, out: &mut Vec<Chain>) {
        let n = self.len();
        let arc = Arc::new(self, start, count);
        let total = arc.total();
        let r = 0.5 * options.width;
        // Turn at each inner vertex over a window, so that a rounded corner
        // counts as one corner and a gentle curve as none.
        let turns: Vec<f64> = (0..=count)
            .map(|k| {
                if k == 0 || k == count {
                    0.0
                } else {
                    arc.turn(arc.s[k], r)
                }
            })
            .collect();
        let mut cuts: Vec<usize> = Vec::new();
        let limit = 35f64.to_radians();
        let mut order: Vec<usize> = (1..count).filter(|&k| turns[k].abs() > limit).collect();
        order.sort_by(|&i, &j| turns[j].abs().total_cmp(&turns[i].abs()).then(i.cmp(&j)));
        for k in order {
            if cuts.iter().all(|&c| (arc.s[c] - arc.s[k]).abs() > 1.2 * r) {
                cuts.push(k);
            }
        }
        cuts.push(0);
        cuts.push(count);
        cuts.sort_unstable();
        // A stretch that bends by more than about 110 degrees cannot be one
        // row's front: halve it by its turn.
        let mut stack: Vec<(usize, usize)> = cuts.windows(2).map(|w| (w[0], w[1])).rev().collect();
        while let Some((i, j)) = stack.pop() {
            let length = arc.s[j] - arc.s[i];
            let mut sum = 0.0;
            let mut partial = vec![0.0];
            for k in i + 1..j {
                sum += angle(arc.p[k] - arc.p[k - 1], arc.p[k + 1] - arc.p[k]);
                partial.push(sum);
            }
            if j - i >= 2 && sum.abs() > 110f64.to_radians() && length > 3.0 * options.width {
                let half = (1..partial.len())
                    .min_by(|&x, &y| {
                        let f = |k: usize| (partial[k] - 0.5 * sum).abs();
                        f(x).total_cmp(&f(y))
                    })
                    .unwrap_or(1);
                stack.push((i + half, j));
                stack.push((i, i + half));
                continue;
            }
            out.push(Chain {
                start: (start + i) % n,
                count: j - i,
                length,
            });
        }
        debug_assert!(total >= 0.0);
    }

    /// The points of a chain, `count + 1` of them.
    pub(super) fn chain_points(&self, c: &Chain) -> Vec<P> {
        (0..=c.count)
            .map(|k| self.ring[(c.start + k) % self.len()])
            .collect()
    }
}

/// Whether mark `a` comes after mark `b` on their common edge.
fn after(shape: &Shape, a: Mark, b: Mark) -> bool {
    let o = shape.ring[a.edge];
    !a.vertex && dist(o, a.at) > dist(o, b.at)
}

/// A polyline by arc length.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    pub(super) p: Vec<P>,
    pub(super) s: Vec<f64>,
}

impl Arc {
    pub(super) fn new(shape: &Shape, start: usize, count: usize) -> Self {
        let p: Vec<P> = (0..=count)
            .map(|k| shape.ring[(start + k) % shape.len()])
            .collect();
        let mut s = vec![0.0];
        for w in p.windows(2) {
            s.push(s[s.len() - 1] + dist(w[0], w[1]));
        }
        Self { p, s }
    }

    pub(super) fn total(&self) -> f64 {
        self.s[self.s.len() - 1]
    }

    /// Segment and point at arc length `s`, clamped to the ends.
    pub(super) fn at(&self, s: f64) -> (usize, P) {
        let k = self
            .s
            .partition_point(|&v| v <= s)
            .clamp(1, self.p.len() - 1);
        let (a, b) = (self.s[k - 1], self.s[k]);
        let t = if b > a {
            ((s - a) / (b - a)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (k - 1, lerp(self.p[k - 1], self.p[k], t))
    }

    /// Turn between the chords over `r` before and after `s`.
    fn turn(&self, s: f64, r: f64) -> f64 {
        let q = self.at(s).1;
        let (a, b) = (self.at(s - r).1, self.at(s + r).1);
        angle(q - a, b - q)
    }

    fn turn_wrapped(&self, s: f64, r: f64) -> f64 {
        let l = self.total();
        let q = self.at(s).1;
        let (a, b) = (
            self.at((s - r).rem_euclid(l)).1,
            self.at((s + r).rem_euclid(l)).1,
        );
        angle(q - a, b - q)
    }

    /// Unit normal to the left, smoothed over `r` to either side.
    pub(super) fn normal(&self, s: f64, r: f64) -> P {
        let l = self.total();
        let (a, b) = ((s - r).max(0.0), (s + r).min(l));
        let d = self.at(b).1 - self.at(a).1;
        unit(d)
            .or_else(|| unit(self.p[self.p.len() - 1] - self.p[0]))
            .map_or(P { x: 0.0, y: 1.0 }, left)
    }
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::*;

    fn box_40_by_30() -> Shape {
        Shape {
            ring: vec![pt(0., 0.), pt(40., 0.), pt(40., 30.), pt(0., 30.)],
            front: vec![true, false, true, true],
        }
    }

    #[test]
    fn a_cut_keeps_area_and_flags() {
        let s = box_40_by_30();
        let a = s.mark(0, pt(10., 0.), 0.1);
        let b = s.mark(2, pt(20., 30.), 0.1);
        let (l, r) = s.cut(a, &[pt(15., 15.)], b).expect("the path runs inside");
        assert!((l.area() + r.area() - 1200.0).abs() < 1e-9);
        assert!((l.area() - (30. * 15.)).abs() < 1e-9, "{}", l.area());
        assert!((l.frontage() + r.frontage() - s.frontage()).abs() < 1e-9);
        assert!(is_simple_both(&l, &r));
        // Through a vertex, and to one.
        let (l, r) = s
            .cut(
                s.mark(0, pt(0.01, 0.), 0.1),
                &[],
                s.mark(2, pt(39.99, 30.), 0.1),
            )
            .expect("the diagonal");
        assert_eq!((l.len(), r.len()), (3, 3));
        // Along the boundary: no cut.
        assert!(s
            .cut(s.mark(0, pt(0., 0.), 0.1), &[], s.mark(0, pt(20., 0.), 0.1))
            .is_none());
    }

    fn is_simple_both(l: &Shape, r: &Shape) -> bool {
        super::super::geom::is_simple(&l.ring) && super::super::geom::is_simple(&r.ring)
    }

    #[test]
    fn fronts_split_at_corners() {
        let s = box_40_by_30();
        let c = s.chains(&ParcelOptions::default());
        let mut lengths: Vec<f64> = c.iter().map(|c| c.length).collect();
        lengths.sort_by(f64::total_cmp);
        assert_eq!(lengths, vec![30.0, 40.0, 40.0]);
    }

    #[test]
    fn a_round_block_has_several_fronts() {
        let ring: Vec<P> = (0..60)
            .map(|i| {
                let a = f64::from(i) / 60.0 * std::f64::consts::TAU;
                pt(50.0 * a.cos(), 50.0 * a.sin())
            })
            .collect();
        let s = Shape {
            front: vec![true; 60],
            ring,
        };
        assert!(s.chains(&ParcelOptions::default()).len() >= 3);
    }
}
