//! Lines through a block that follow its fronts: spines and offsets.
//!
//! A spine is where two fronts are equally far, an offset where one front is
//! a given distance away. Both are level lines of a difference of distances,
//! found on the block's boundary by bisection and followed inside by
//! predictor and corrector; a straight skeleton would give the same lines for
//! straight fronts, but follows every small edge of a curved one.

use super::geom::{cross, dist, dot, inside, left, lerp, norm, ray_hit, unit, P};
use super::shape::{Mark, Shape};

/// A line to measure distances from. Its ends run on straight, so that level
/// lines do not curl round them.
#[derive(Clone, Debug)]
pub(super) struct Base {
    points: Vec<P>,
    extend: bool,
}

impl Base {
    pub(super) fn new(points: Vec<P>, extend: bool) -> Self {
        Self { points, extend }
    }

    /// Distance and the unit vector away from the line.
    fn distance(&self, q: P) -> (f64, P) {
        let n = self.points.len();
        let mut best = (f64::INFINITY, q);
        for i in 0..n - 1 {
            let (a, b) = (self.points[i], self.points[i + 1]);
            let d = b - a;
            let l = dot(d, d);
            if l <= 0.0 {
                continue;
            }
            let mut t = dot(q - a, d) / l;
            if !(self.extend && i == 0) {
                t = t.max(0.0);
            }
            if !(self.extend && i == n - 2) {
                t = t.min(1.0);
            }
            let f = a + d * t;
            let r = dist(f, q);
            if r < best.0 {
                best = (r, f);
            }
        }
        let away = unit(q - best.1).unwrap_or(P { x: 0.0, y: 0.0 });
        (best.0, away)
    }
}

/// What is zero along the line.
#[derive(Clone, Debug)]
pub(super) enum Level {
    /// Distance from the first equals distance from the second.
    Between(Base, Base),
    /// Distance from the line equals this.
    At(Base, f64),
}

impl Level {
    fn value(&self, q: P) -> (f64, P) {
        match self {
            Self::Between(a, b) => {
                let ((da, ga), (db, gb)) = (a.distance(q), b.distance(q));
                (da - db, ga - gb)
            }
            Self::At(a, d) => {
                let (da, ga) = a.distance(q);
                (da - d, ga)
            }
        }
    }
}

/// A path across a shape.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Path {
    pub(super) from: Mark,
    pub(super) inner: Vec<P>,
    pub(super) to: Mark,
}

/// All level lines across the shape, each once.
pub(super) fn level_lines(shape: &Shape, level: &Level, step: f64, snap: f64) -> Vec<Path> {
    let roots = roots(shape, level, step);
    let mut out: Vec<Path> = Vec::new();
    for &(edge, q) in &roots {
        if out
            .iter()
            .any(|p| dist(p.to.at, q) < 0.5 * step || dist(p.from.at, q) < 0.5 * step)
        {
            continue;
        }
        let from = shape.mark(edge, q, snap);
        if let Some((inner, edge, at)) = follow(shape, level, from, step) {
            let to = shape.mark(edge, at, snap);
            let inner = simplify(from.at, &inner, to.at, 0.12 * step);
            if from != to {
                out.push(Path { from, inner, to });
            }
        }
        if out.len() >= 6 {
            break;
        }
    }
    out
}

/// Where the level changes sign along the boundary.
fn roots(shape: &Shape, level: &Level, step: f64) -> Vec<(usize, P)> {
    let mut out = Vec::new();
    for i in 0..shape.len() {
        let (a, b) = shape.edge(i);
        let parts = (dist(a, b) / step).ceil().clamp(1.0, 200.0) as usize;
        let mut v0 = level.value(a).0;
        for k in 0..parts {
            let (t0, t1) = (k as f64 / parts as f64, (k + 1) as f64 / parts as f64);
            let v1 = level.value(lerp(a, b, t1)).0;
            if (v0 < 0.0) != (v1 < 0.0) {
                let (mut lo, mut hi) = (t0, t1);
                for _ in 0..30 {
                    let mid = 0.5 * (lo + hi);
                    if (level.value(lerp(a, b, mid)).0 < 0.0) == (v0 < 0.0) {
                        lo = mid;
                    } else {
                        hi = mid;
                    }
                }
                out.push((i, lerp(a, b, 0.5 * (lo + hi))));
            }
            v0 = v1;
        }
    }
    out
}

/// Follows the level line from a boundary mark to where it leaves the shape.
fn follow(shape: &Shape, level: &Level, from: Mark, step: f64) -> Option<(Vec<P>, usize, P)> {
    let mut q = from.at;
    let mut heading = start_heading(shape, level, from, step)?;
    let mut inner = Vec::new();
    for k in 0..400 {
        let mut next = q + heading * step;
        for _ in 0..3 {
            let (v, g) = level.value(next);
            let l = dot(g, g);
            if l < 0.02 {
                return None;
            }
            let move_by = g * (v / l);
            if norm(move_by) > step {
                return None;
            }
            next = next - move_by;
        }
        let d = next - q;
        if dot(d, heading) <= 0.2 * step {
            return None;
        }
        // Does this step leave the shape?
        let mut exit: Option<(f64, usize)> = None;
        for e in 0..shape.len() {
            let own =
                k == 0 && (e == from.edge || (from.vertex && (e + 1) % shape.len() == from.edge));
            if own {
                continue;
            }
            let (a, b) = shape.edge(e);
            if let Some((t, _)) = ray_hit(q, d, a, b) {
                if t <= 1.0 && exit.is_none_or(|x| t < x.0) {
                    exit = Some((t, e));
                }
            }
        }
        if let Some((t, e)) = exit {
            return Some((inner, e, q + d * t));
        }
        inner.push(next);
        heading = unit(d)?;
        q = next;
    }
    None
}

fn start_heading(shape: &Shape, level: &Level, from: Mark, step: f64) -> Option<P> {
    // At a shared corner of two fronts the gradient has no meaning: look
    // around on a small circle for the level line instead.
    let probe = 0.4 * step;
    let mut best: Option<(f64, P)> = None;
    // Counted from the boundary's direction, so that a turned block is traced
    // like the block.
    let (a, b) = shape.edge(from.edge);
    let along = unit(b - a)?;
    for k in 0..48 {
        let d = super::geom::turned(along, f64::from(k) * std::f64::consts::TAU / 48.0);
        let q = from.at + d * probe;
        if inside(&shape.ring, q) {
            let v = level.value(q).0.abs();
            if best.is_none_or(|b| v < b.0) {
                best = Some((v, d));
            }
        }
    }
    let d = best?.1;
    let (_, g) = level.value(from.at + d * probe);
    let t = unit(left(g))?;
    let t = if dot(t, d) < 0.0 { t * -1.0 } else { t };
    // The tangent where it agrees with the probe, the probe elsewhere.
    Some(if dot(t, d) > 0.8 { t } else { d })
}

/// Douglas and Peucker's rule; the ends stay.
pub(super) fn simplify(from: P, inner: &[P], to: P, tolerance: f64) -> Vec<P> {
    let mut all = Vec::with_capacity(inner.len() + 2);
    all.push(from);
    all.extend_from_slice(inner);
    all.push(to);
    let mut keep = vec![false; all.len()];
    let mut stack = vec![(0, all.len() - 1)];
    while let Some((i, j)) = stack.pop() {
        let d = all[j] - all[i];
        let l = norm(d);
        let mut worst = (tolerance, 0);
        for k in i + 1..j {
            let h = if l > 0.0 {
                cross(d, all[k] - all[i]).abs() / l
            } else {
                dist(all[i], all[k])
            };
            if h > worst.0 {
                worst = (h, k);
            }
        }
        if worst.1 > 0 {
            keep[worst.1] = true;
            stack.push((i, worst.1));
            stack.push((worst.1, j));
        }
    }
    (1..all.len() - 1)
        .filter(|&k| keep[k])
        .map(|k| all[k])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::*;

    #[test]
    fn the_spine_of_a_rectangle_is_its_axis() {
        let s = Shape {
            ring: vec![pt(0., 0.), pt(100., 0.), pt(100., 60.), pt(0., 60.)],
            front: vec![true; 4],
        };
        let a = Base::new(vec![pt(0., 0.), pt(100., 0.)], true);
        let b = Base::new(vec![pt(100., 60.), pt(0., 60.)], true);
        let lines = level_lines(&s, &Level::Between(a.clone(), b), 3.0, 0.3);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].inner.is_empty());
        assert!((lines[0].from.at.y - 30.0).abs() < 1e-6 && (lines[0].to.at.y - 30.0).abs() < 1e-6);
        let lines = level_lines(&s, &Level::At(a, 22.0), 3.0, 0.3);
        assert_eq!(lines.len(), 1);
        assert!((lines[0].from.at.y - 22.0).abs() < 1e-6);
    }

    #[test]
    fn the_spine_of_a_wedge_starts_at_its_corner() {
        let s = Shape {
            ring: vec![pt(0., 0.), pt(100., 0.), pt(100., 40.)],
            front: vec![true; 3],
        };
        let a = Base::new(vec![pt(0., 0.), pt(100., 0.)], true);
        let b = Base::new(vec![pt(100., 40.), pt(0., 0.)], true);
        let lines = level_lines(&s, &Level::Between(a, b), 3.0, 0.3);
        assert!(!lines.is_empty());
        let corner = pt(0., 0.);
        assert!(
            lines
                .iter()
                .any(|l| l.from.at == corner || l.to.at == corner),
            "{lines:?}"
        );
    }
}
