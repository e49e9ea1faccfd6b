//! A row: a shape seen from one of its fronts, sliced by rungs.
//!
//! The shape's ring starts where the front starts, so that every place on it
//! has a number `u` (edge index plus fraction), front first. A rung is a chord
//! from the front to the first thing behind it. Rungs whose front ends go up
//! and whose back ends go down cannot cross, so a list of them divides the
//! shape exactly, whatever lies behind the front.

use super::geom::{angle, dist, dot, left, ray_hit, turned, P};
use super::quality::{cost, measure, Quality, Scratch};
use super::shape::{Arc, Chain, Shape};
use super::ParcelOptions;

/// A dividing line from the front (`uf`, `pf`) to the back (`ub`, `pb`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rung {
    pub(super) uf: f64,
    pub(super) pf: P,
    pub(super) ub: f64,
    pub(super) pb: P,
}

/// A shape turned so that its front comes first.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) shape: Shape,
    /// Edges of the front: edges 0 to `m - 1` of the ring.
    pub(super) m: usize,
    pub(super) arc: Arc,
    /// Slant of the side at the front's start and at its end against the
    /// front's normal, radians, counter-clockwise; 0 where the side is no side.
    pub(super) slant: [f64; 2],
    /// Mean depth behind the front.
    pub(super) depth: f64,
    snap: f64,
    /// Half the window over which the front's normal is smoothed.
    smooth: f64,
}

/// Buffers for cutting out and measuring one parcel after another.
#[derive(Debug, Default)]
pub(super) struct Bench {
    pub(super) ring: Vec<P>,
    pub(super) front: Vec<bool>,
    pub(super) scratch: Scratch,
    /// Work done so far, about in parcels measured: the search's budget
    /// counts it.
    pub(super) work: usize,
}

impl Row {
    /// The row behind a front; `None` if the front is too short to matter.
    pub(super) fn new(shape: &Shape, chain: &Chain, options: &ParcelOptions) -> Option<Self> {
        if chain.length < 0.5 * options.good_frontage || chain.count >= shape.len() {
            return None;
        }
        let shape = shape.rotated(chain.start);
        let arc = Arc::new(&shape, 0, chain.count);
        let mut row = Self {
            m: chain.count,
            arc,
            shape,
            slant: [0.0; 2],
            depth: 0.0,
            snap: options.snap(),
            smooth: 0.6 * options.width,
        };
        row.slant = row.slants(options);
        row.depth = row.mean_depth();
        (row.depth > 0.0).then_some(row)
    }

    pub(super) fn length(&self) -> f64 {
        self.arc.total()
    }

    pub(super) fn normal(&self, s: f64) -> P {
        self.arc.normal(s, self.smooth)
    }

    /// How far the sides at the two ends lean against the front's normal.
    fn slants(&self, options: &ParcelOptions) -> [f64; 2] {
        let n = self.shape.len();
        let reach = 0.6 * options.depth;
        let mut out = [0.0; 2];
        for (k, slant) in out.iter_mut().enumerate() {
            // Walk away from the front's end along the ring.
            let (o, s) = if k == 0 {
                (0, 0.0)
            } else {
                (self.m, self.length())
            };
            let from = self.shape.ring[o];
            let mut i = o;
            let mut to = from;
            for _ in 0..n - self.m {
                i = if k == 0 { (i + n - 1) % n } else { (i + 1) % n };
                let next = self.shape.ring[i];
                let d = dist(from, next);
                if d >= reach {
                    let here = dist(from, to);
                    to = to + (next - to) * ((reach - here) / (d - here).max(1e-9)).clamp(0.0, 1.0);
                    break;
                }
                to = next;
            }
            let a = angle(self.normal(s), to - from);
            *slant = if a.abs() < 55f64.to_radians() { a } else { 0.0 };
        }
        out
    }

    fn mean_depth(&self) -> f64 {
        let l = self.length();
        let (mut sum, mut count) = (0.0, 0.0);
        for k in 0..5 {
            let s = l * (f64::from(k) + 0.5) / 5.0;
            if let Some(r) = self.rung(s, self.normal(s)) {
                sum += dist(r.pf, r.pb);
                count += 1.0;
            }
        }
        if count > 0.0 {
            sum / count
        } else {
            0.0
        }
    }

    /// The rung from arc length `s` of the front along `dir`.
    pub(super) fn rung(&self, s: f64, dir: P) -> Option<Rung> {
        let (k, mut pf) = self.arc.at(s);
        let (a, b) = (self.arc.s[k], self.arc.s[k + 1]);
        let mut uf = k as f64 + ((s - a) / (b - a).max(1e-12)).clamp(0.0, 1.0);
        if s - a <= self.snap && s - a <= b - s {
            (uf, pf) = (k as f64, self.arc.p[k]);
        } else if b - s <= self.snap {
            (uf, pf) = ((k + 1) as f64, self.arc.p[k + 1]);
        }
        if uf <= 0.0 || uf >= self.m as f64 {
            return None;
        }
        // It must leave into the shape.
        let e = self.arc.p[k + 1] - self.arc.p[k];
        if dot(left(e), dir) < 0.25 * dist(self.arc.p[k], self.arc.p[k + 1]) {
            return None;
        }
        let (ub, pb) = self.hit(uf, pf, dir)?;
        Some(Rung { uf, pf, ub, pb })
    }

    /// The first place of the ring that the ray from the front place meets.
    fn hit(&self, uf: f64, pf: P, dir: P) -> Option<(f64, P)> {
        let n = self.shape.len();
        let k = uf.floor() as usize;
        let whole = uf == k as f64;
        let mut best: Option<(f64, usize, f64)> = None;
        for e in 0..n {
            if e == k || (whole && (e + 1) % n == k) {
                continue;
            }
            let (a, b) = self.shape.edge(e);
            if let Some((t, r)) = ray_hit(pf, dir, a, b) {
                if best.is_none_or(|v| t < v.0) {
                    best = Some((t, e, r));
                }
            }
        }
        let (t, e, _) = best?;
        if e < self.m {
            return None; // it sees the front itself
        }
        let mark = self.shape.mark(e, pf + dir * t, self.snap);
        let mut ub = mark.edge as f64;
        if mark.vertex {
            if mark.edge == 0 {
                return None; // the front's own start
            }
            let near = |i: usize| i == k || (whole && (i + 1) % n == k);
            // A snapped chord is no longer the ray: look again.
            let clear = (0..n)
                .filter(|&i| !near(i) && i != mark.edge && (i + 1) % n != mark.edge)
                .all(|i| {
                    let (a, b) = self.shape.edge(i);
                    !super::geom::meet(pf, mark.at, a, b)
                });
            if !clear || mark.edge <= self.m {
                return None;
            }
        } else {
            let (a, b) = self.shape.edge(e);
            ub += (dist(a, mark.at) / dist(a, b)).clamp(1e-9, 1.0 - 1e-9);
        }
        Some((ub, mark.at))
    }

    /// The rung before the first parcel: the front's start.
    pub(super) fn first(&self) -> Rung {
        let p = self.shape.ring[0];
        Rung {
            uf: 0.0,
            pf: p,
            ub: self.shape.len() as f64,
            pb: p,
        }
    }

    /// The rung after the last parcel: the front's end.
    pub(super) fn last(&self) -> Rung {
        let p = self.shape.ring[self.m];
        Rung {
            uf: self.m as f64,
            pf: p,
            ub: self.m as f64,
            pb: p,
        }
    }

    /// Whether rung `b` may follow rung `a`.
    pub(super) fn ordered(a: &Rung, b: &Rung) -> bool {
        a.uf < b.uf && (a.ub > b.ub || (a.ub == b.ub && a.pf != a.pb && b.pf != b.pb))
    }

    /// Writes the parcel between two rungs into the bench.
    pub(super) fn parcel(&self, a: &Rung, b: &Rung, bench: &mut Bench) {
        bench.ring.clear();
        bench.front.clear();
        self.walk(a.uf, a.pf, b.uf, b.pf, bench);
        if b.pb == b.pf {
            bench.ring.pop();
            bench.front.pop();
        }
        if a.ub > b.ub {
            self.walk(b.ub, b.pb, a.ub, a.pb, bench);
        } else {
            bench.ring.push(b.pb);
            bench.front.push(false);
        }
        if a.pb == a.pf {
            bench.ring.pop();
            bench.front.pop();
        }
    }

    /// Appends the ring from `u0` to `u1`, with the points at both ends; the
    /// edge after the last point is the caller's rung.
    fn walk(&self, u0: f64, p0: P, u1: f64, p1: P, bench: &mut Bench) {
        let n = self.shape.len();
        let mut edge = u0.floor() as usize;
        bench.ring.push(p0);
        bench.front.push(self.shape.front[edge % n]);
        loop {
            edge += 1;
            if edge as f64 >= u1 {
                break;
            }
            bench.ring.push(self.shape.ring[edge % n]);
            bench.front.push(self.shape.front[edge % n]);
        }
        bench.ring.push(p1);
        bench.front.push(false);
    }

    /// Measures the parcel between two rungs.
    pub(super) fn assess(
        &self,
        a: &Rung,
        b: &Rung,
        options: &ParcelOptions,
        bench: &mut Bench,
    ) -> (f64, Quality) {
        self.parcel(a, b, bench);
        bench.work += 1 + bench.ring.len() / 8;
        let q = measure(&bench.ring, &bench.front, &mut bench.scratch);
        (cost(&q, options), q)
    }

    /// Cost of the whole row under these inner rungs, or `None` if they are
    /// out of order.
    pub(super) fn total(
        &self,
        rungs: &[Rung],
        options: &ParcelOptions,
        bench: &mut Bench,
        limit: f64,
    ) -> Option<f64> {
        let mut last = self.first();
        let mut sum = 0.0;
        for r in rungs.iter().copied().chain(std::iter::once(self.last())) {
            if !Self::ordered(&last, &r) {
                return None;
            }
            sum += self.assess(&last, &r, options, bench).0;
            if sum > limit {
                return None;
            }
            last = r;
        }
        Some(sum)
    }

    /// The parcels between these inner rungs.
    pub(super) fn shapes(&self, rungs: &[Rung], bench: &mut Bench) -> Vec<Shape> {
        let mut last = self.first();
        let mut out = Vec::with_capacity(rungs.len() + 1);
        for r in rungs.iter().copied().chain(std::iter::once(self.last())) {
            self.parcel(&last, &r, bench);
            out.push(Shape {
                ring: bench.ring.clone(),
                front: bench.front.clone(),
            });
            last = r;
        }
        out
    }

    /// The best of a few regular ways to slice the row: equal widths, the
    /// lean of the ends spread in a fan, or kept to the end parcels.
    pub(super) fn regular(
        &self,
        options: &ParcelOptions,
        bench: &mut Bench,
    ) -> Option<(f64, Vec<Rung>)> {
        let l = self.length();
        let depth = self.depth.max(1e-6);
        // Deep land takes narrower parcels, shallow land wider ones.
        let w = options.width * (options.depth / depth).powf(0.6).clamp(0.75, 1.35);
        let n0 = count(l, w);
        let mut best: Option<(f64, Vec<Rung>)> = None;
        let leaning = self.slant[0].abs() + self.slant[1].abs() > 0.05;
        let mut tries = vec![(n0, false, 0.0)];
        if leaning {
            tries.extend([(n0, true, f64::INFINITY), (n0, true, 2.5)]);
        }
        for (n, middle, fan) in tries {
            let Some(rungs) = self.spread(n, middle, fan, w) else {
                continue;
            };
            let limit = best.as_ref().map_or(f64::INFINITY, |b| b.0);
            if let Some(c) = self.total(&rungs, options, bench, limit) {
                let clean = c < 0.04 * (n as f64);
                best = Some((c, rungs));
                if clean {
                    break;
                }
            }
        }
        best
    }

    /// `n - 1` rungs at equal widths, measured at the front or at mid-depth.
    /// The ends' slants die out over `fan` parcels (infinite: over the row).
    fn spread(&self, n: usize, middle: bool, fan: f64, w: f64) -> Option<Vec<Rung>> {
        let l = self.length();
        let [a, b] = self.slant;
        let h = if middle { 0.5 * self.depth } else { 0.0 };
        // Counter-clockwise lean moves the back end towards the front's start.
        let (lo, hi) = (-h * a.tan(), l - h * b.tan());
        let mut rungs = Vec::with_capacity(n.saturating_sub(1));
        for k in 1..n {
            let t = k as f64 / n as f64;
            let mid = lo + (hi - lo) * t;
            let lean = if fan == 0.0 {
                0.0
            } else if fan.is_infinite() {
                a * (1.0 - t) + b * t
            } else {
                let f = |d: f64| (1.0 - d / (fan * w)).max(0.0);
                a * f(mid - lo) + b * f(hi - mid)
            };
            let s = (mid + h * lean.tan()).clamp(0.0, l);
            rungs.push(self.rung(s, turned(self.normal(s), lean))?);
        }
        Some(rungs)
    }
}

/// The count that divides a length best into widths near `w` (NUMERICS law 5
/// for repeats): the n with the least max(l / (n w), n w / l), more on ties.
pub(super) fn count(l: f64, w: f64) -> usize {
    let x = (l / w).clamp(0.0, 1e4);
    let n = x.floor().max(1.0);
    let f = |n: f64| (x / n).max(n / x);
    if f(n + 1.0) <= f(n) {
        n as usize + 1
    } else {
        n as usize
    }
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::*;

    fn strip(l: f64, d: f64) -> Shape {
        Shape {
            ring: vec![pt(0., 0.), pt(l, 0.), pt(l, d), pt(0., d)],
            front: vec![true, false, false, false],
        }
    }

    #[test]
    fn counts_follow_the_ratio_rule() {
        assert_eq!(count(90.0, 18.0), 5);
        assert_eq!(count(98.0, 18.0), 5);
        assert_eq!(count(100.0, 18.0), 6);
        assert_eq!(count(3.0, 18.0), 1);
    }

    #[test]
    fn a_strip_becomes_equal_lots() {
        let options = ParcelOptions::default();
        let s = strip(90.0, 30.0);
        let chain = s.chains(&options)[0];
        let row = Row::new(&s, &chain, &options).expect("a row");
        let mut bench = Bench::default();
        let (c, rungs) = row.regular(&options, &mut bench).expect("slices");
        assert!(c < 1e-9 && rungs.len() == 4);
        let lots = row.shapes(&rungs, &mut bench);
        assert_eq!(lots.len(), 5);
        for lot in &lots {
            assert!((lot.area() - 540.0).abs() < 1e-9);
            assert!((lot.frontage() - 18.0).abs() < 1e-9);
            assert_eq!(lot.len(), 4);
        }
    }
}
