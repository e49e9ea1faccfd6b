//! The energy of a network as a sparse quadratic form, and its minimisation
//! under the bounds of the sliding junctions.
//!
//! Unknowns are displacements from where the optimisation began: two for a
//! free vertex, one (along its rail) for a sliding one. So the numbers are
//! small wherever the site lies.

use super::factor::{Factor, Matrix};
use crate::mesh::predicates::{dot, P};

/// How a vertex may move, and at which unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Var {
    /// Not at all.
    Fixed,
    /// Freely: unknowns `k` (x) and `k + 1` (y).
    Free(usize),
    /// Along a unit direction: unknown `k` (metres).
    Slide(usize, P),
}

impl Var {
    /// The displacement that unknowns `q` stand for.
    pub(crate) fn displacement(&self, q: &[f64]) -> P {
        match *self {
            Self::Fixed => P { x: 0.0, y: 0.0 },
            Self::Free(k) => P {
                x: q[k],
                y: q[k + 1],
            },
            Self::Slide(k, d) => P {
                x: q[k] * d.x,
                y: q[k] * d.y,
            },
        }
    }

    /// The unknowns, each with the displacement of one unit of it.
    fn basis(&self) -> impl Iterator<Item = (usize, P)> {
        let both = match *self {
            Self::Fixed => [None, None],
            Self::Free(k) => [
                Some((k, P { x: 1.0, y: 0.0 })),
                Some((k + 1, P { x: 0.0, y: 1.0 })),
            ],
            Self::Slide(k, d) => [Some((k, d)), None],
        };
        both.into_iter().flatten()
    }
}

/// `weight * |sum c_k v_k - aim|^2` over up to three vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) weight: f64,
    /// (vertex, coefficient); unused ones have coefficient 0.
    pub(crate) parts: [(usize, f64); 3],
}

impl Term {
    pub(crate) fn one(weight: f64, v: usize) -> Self {
        Self {
            weight,
            parts: [(v, 1.0), (v, 0.0), (v, 0.0)],
        }
    }

    /// `sum c_k v_k - aim`, from differences, so that large coordinates lose
    /// nothing. The coefficients sum to 1, or to 0 up to rounding.
    pub(crate) fn residual(&self, points: &[P], aim: P) -> P {
        let o = points[self.parts[0].0];
        let sum: f64 = self.parts.iter().map(|p| p.1).sum();
        let whole = if sum.abs() < 1e-6 { 0.0 } else { 1.0 };
        let mut r = P {
            x: whole * o.x - aim.x,
            y: whole * o.y - aim.y,
        };
        for (v, c) in self.parts {
            r.x += c * (points[v].x - o.x);
            r.y += c * (points[v].y - o.y);
        }
        r
    }

    /// The term's share of the energy.
    pub(crate) fn value(&self, points: &[P], aim: P) -> f64 {
        let r = self.residual(points, aim);
        self.weight * dot(r, r)
    }
}

/// The quadratic form, with its factorisation.
#[derive(Debug)]
pub(crate) struct System {
    matrix: Matrix,
    /// `matrix` with the rows and columns of held unknowns cleared.
    reduced: Matrix,
    factor: Factor,
    /// Which unknowns the factor holds at a bound; `None` before the first.
    held: Option<Vec<bool>>,
    /// How often the numbers were factored.
    pub(crate) factorizations: usize,
}

/// Bounds of the unknowns: infinite for free ones.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    pub(crate) low: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

impl System {
    /// Assembles and analyses the matrix of the terms. `None` if there is not
    /// enough memory.
    pub(crate) fn new(size: usize, vars: &[Var], terms: &[Term]) -> Option<Self> {
        let mut triplets = Vec::with_capacity(terms.len() * 8 + size);
        for term in terms {
            for (v, cv) in term.parts {
                for (w, cw) in term.parts {
                    let c = term.weight * cv * cw;
                    if c == 0.0 {
                        continue;
                    }
                    for (i, di) in vars[v].basis() {
                        for (j, dj) in vars[w].basis() {
                            triplets.push((i, j, c * dot(di, dj)));
                        }
                    }
                }
            }
        }
        // Held unknowns need their diagonal, whatever the weights.
        triplets.extend((0..size).map(|i| (i, i, 0.0)));
        let matrix = Matrix::assemble(size, &triplets);
        Some(Self {
            factor: Factor::analyse(&matrix)?,
            reduced: matrix.clone(),
            matrix,
            held: None,
            factorizations: 0,
        })
    }

    /// The right-hand side for terms that aim at the given points.
    pub(crate) fn rhs(&self, vars: &[Var], begin: &[P], terms: &[(Term, P)]) -> Vec<f64> {
        let mut rhs = vec![0.0; self.matrix.size];
        for (term, aim) in terms {
            let r = term.residual(begin, *aim);
            for (v, c) in term.parts {
                for (i, d) in vars[v].basis() {
                    rhs[i] -= term.weight * c * dot(d, r);
                }
            }
        }
        rhs
    }

    /// Minimises `q H q / 2 - rhs q` within the bounds, from a `q` within
    /// them; the value never rises. Returns the number of unknowns held at a
    /// bound, or `None` if the matrix is not positive definite.
    ///
    /// Primal-dual active sets: solve with the held unknowns at their bounds,
    /// hold those that overstep, release those that are pulled inwards, until
    /// nothing changes (two or three rounds in practice). Should that cycle,
    /// a step along the projected direction to the exact minimum on that line
    /// is taken instead.
    pub(crate) fn minimise(&mut self, q: &mut [f64], rhs: &[f64], b: &Bounds) -> Option<usize> {
        const ROUNDS: usize = 12;
        let n = q.len();
        // -1 held at the low bound, 1 at the high one.
        let mut side: Vec<i8> = vec![0; n];
        let mut x = q.to_vec();
        let mut settled = false;
        for _ in 0..ROUNDS {
            let held: Vec<bool> = side.iter().map(|&s| s != 0).collect();
            let at: Vec<f64> = (0..n)
                .map(|i| match side[i] {
                    0 => 0.0,
                    s if s < 0 => b.low[i],
                    _ => b.high[i],
                })
                .collect();
            x = self.solve_held(&held, &at, rhs)?;
            let pull = self.pull(&x, rhs);
            let next: Vec<i8> = (0..n)
                .map(|i| match side[i] {
                    0 if x[i] < b.low[i] => -1,
                    0 if x[i] > b.high[i] => 1,
                    s if s < 0 && pull[i] > 0.0 => 0,
                    s if s > 0 && pull[i] < 0.0 => 0,
                    s => s,
                })
                .collect();
            if next == side {
                settled = true;
                break;
            }
            side = next;
        }
        if !settled {
            let p: Vec<f64> = (0..n)
                .map(|i| x[i].clamp(b.low[i], b.high[i]) - q[i])
                .collect();
            let down: f64 = self.pull(q, rhs).iter().zip(&p).map(|(g, p)| g * p).sum();
            let curve: f64 = self
                .matrix
                .times(&p)
                .iter()
                .zip(&p)
                .map(|(h, p)| h * p)
                .sum();
            let step = if down > 0.0 && curve > 0.0 {
                (down / curve).min(1.0)
            } else {
                0.0
            };
            x = (0..n).map(|i| q[i] + step * p[i]).collect();
        }
        for i in 0..n {
            q[i] = x[i].clamp(b.low[i], b.high[i]);
        }
        Some(side.iter().filter(|&&s| s != 0).count())
    }

    /// Minus the gradient.
    fn pull(&self, x: &[f64], rhs: &[f64]) -> Vec<f64> {
        let hx = self.matrix.times(x);
        rhs.iter().zip(hx).map(|(r, h)| r - h).collect()
    }

    /// Solves with some unknowns held at given values. Factors again only if
    /// the held set is another than last time.
    fn solve_held(&mut self, held: &[bool], at: &[f64], rhs: &[f64]) -> Option<Vec<f64>> {
        let m = &self.matrix;
        if self.held.as_deref() != Some(held) {
            for j in 0..m.size {
                for k in m.starts[j]..m.starts[j + 1] {
                    let i = m.rows[k];
                    self.reduced.values[k] = match (held[i] || held[j], i == j) {
                        (false, _) => m.values[k],
                        (true, true) => 1.0,
                        (true, false) => 0.0,
                    };
                }
            }
            self.factorizations += 1;
            if !self.factor.refactor(&self.reduced) {
                self.held = None;
                return None;
            }
            self.held = Some(held.to_vec());
        }
        let mut x = rhs.to_vec();
        for j in (0..m.size).filter(|&j| held[j]) {
            for (i, v) in m.column(j) {
                x[i] -= v * at[j];
            }
        }
        for j in (0..m.size).filter(|&j| held[j]) {
            x[j] = at[j];
        }
        self.factor.solve(&mut x);
        // A factor of a nearly singular matrix may pass; its answer shows.
        x.iter().all(|v| v.is_finite()).then_some(x)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    /// Two sliders on the x axis, each drawn to an aim, tied to each other.
    fn tied(aims: [f64; 2], low: f64, high: f64) -> (Vec<f64>, usize) {
        let east = P { x: 1.0, y: 0.0 };
        let vars = [Var::Slide(0, east), Var::Slide(1, east)];
        let begin = [P { x: 0.0, y: 0.0 }; 2];
        let tie = Term {
            weight: 1.0,
            parts: [(0, 1.0), (1, -1.0), (1, 0.0)],
        };
        let terms = [
            (Term::one(1.0, 0), P { x: aims[0], y: 7.0 }),
            (Term::one(1.0, 1), P { x: aims[1], y: 7.0 }),
            (tie, P { x: 0.0, y: 0.0 }),
        ];
        let plain: Vec<Term> = terms.iter().map(|t| t.0).collect();
        let mut system = System::new(2, &vars, &plain).unwrap();
        let rhs = system.rhs(&vars, &begin, &terms);
        let bounds = Bounds {
            low: vec![low; 2],
            high: vec![high; 2],
        };
        let mut q = vec![0.0; 2];
        let held = system.minimise(&mut q, &rhs, &bounds).unwrap();
        (q, held)
    }

    #[test]
    fn bounds_hold_and_release() {
        let (q, held) = tied([3.0, 0.0], -9.0, 9.0);
        assert!((q[0] - 2.0).abs() < 1e-12 && (q[1] - 1.0).abs() < 1e-12 && held == 0);
        // The first stops at its bound, the second settles for half of it.
        let (q, held) = tied([30.0, 0.0], -9.0, 9.0);
        assert!((q[0] - 9.0).abs() < 1e-12 && (q[1] - 4.5).abs() < 1e-12 && held == 1);
        // Unbounded both would overstep; with the first held the second would
        // not: it must be released again.
        let (q, held) = tied([30.0, 5.0], -9.0, 9.0);
        assert!((q[0] - 9.0).abs() < 1e-12 && (q[1] - 7.0).abs() < 1e-12 && held == 1);
    }
}
