//! Anderson acceleration of the fixed-point iteration x -> g(x) (Anderson 1965;
//! its use on local/global geometry solvers: Peng et al. 2018). Proposals only:
//! the caller keeps the energy from rising.

use crate::geometry::{dot, exceeds, P};

/// History of the last few steps.
#[derive(Clone, Debug)]
pub(crate) struct Anderson {
    depth: usize,
    /// Differences of successive residuals f = g(x) - x, newest last.
    df: Vec<Vec<P>>,
    /// Differences of successive g(x).
    dg: Vec<Vec<P>>,
    last: Option<(Vec<P>, Vec<P>)>,
    proposed: bool,
}

fn product(a: &[P], b: &[P]) -> f64 {
    a.iter().zip(b).map(|(&u, &v)| dot(u, v)).sum()
}

impl Anderson {
    /// A depth of 0 switches it off.
    pub(crate) fn new(depth: usize) -> Self {
        Self {
            depth,
            df: Vec::new(),
            dg: Vec::new(),
            last: None,
            proposed: false,
        }
    }

    /// Takes note of a plain step from `x` to `g` and proposes a longer one, or
    /// nothing while there is no history.
    pub(crate) fn propose(&mut self, x: &[P], g: &[P]) -> Option<Vec<P>> {
        self.proposed = false;
        if self.depth == 0 {
            return None;
        }
        let f: Vec<P> = g.iter().zip(x).map(|(&a, &b)| a - b).collect();
        if let Some((f0, g0)) = self.last.take() {
            self.df
                .push(f.iter().zip(&f0).map(|(&a, &b)| a - b).collect());
            self.dg
                .push(g.iter().zip(&g0).map(|(&a, &b)| a - b).collect());
            if self.df.len() > self.depth {
                self.df.remove(0);
                self.dg.remove(0);
            }
        }
        let gamma = self.combine(&f);
        self.last = Some((f, g.to_vec()));
        let gamma = gamma?;
        let mut y = g.to_vec();
        for (c, d) in gamma.iter().zip(&self.dg) {
            for (q, &v) in y.iter_mut().zip(d) {
                *q = *q - v * *c;
            }
        }
        self.proposed = true;
        y.iter()
            .all(|q| q.x.is_finite() && q.y.is_finite())
            .then_some(y)
    }

    /// Forgets the history after a refused proposal: it described another
    /// regime (a clamp set in, a projection changed).
    pub(crate) fn reset_if_proposed(&mut self) {
        if self.proposed {
            self.df.clear();
            self.dg.clear();
        }
    }

    /// Least-squares coefficients of f in the residual differences, by
    /// regularised normal equations (at most `depth` unknowns).
    fn combine(&self, f: &[P]) -> Option<Vec<f64>> {
        let m = self.df.len();
        if m == 0 {
            return None;
        }
        // The normal equations, right-hand side last in each row.
        let mut a: Vec<Vec<f64>> = self
            .df
            .iter()
            .map(|u| {
                self.df
                    .iter()
                    .map(|v| product(u, v))
                    .chain([product(u, f)])
                    .collect()
            })
            .collect();
        let trace: f64 = (0..m).map(|i| a[i][i]).sum();
        for (i, row) in a.iter_mut().enumerate() {
            row[i] += 1e-12 * trace;
        }
        for i in 0..m {
            let upper = a[i].clone();
            if !exceeds(upper[i], 0.0) {
                return None;
            }
            for row in &mut a[i + 1..] {
                let k = row[i] / upper[i];
                for (v, u) in row.iter_mut().zip(&upper).skip(i) {
                    *v -= k * u;
                }
            }
        }
        let mut gamma = vec![0.0; m];
        for i in (0..m).rev() {
            let mut v = a[i][m];
            for c in i + 1..m {
                v -= a[i][c] * gamma[c];
            }
            gamma[i] = v / a[i][i];
        }
        Some(gamma)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::p;

    #[test]
    fn a_linear_map_is_solved_in_a_few_steps() {
        // g(x) = A x + b with slow eigenvalues; two unknowns per point.
        let g = |x: &[P]| vec![p(0.99 * x[0].x + 0.005 * x[0].y + 1.0, 0.9 * x[0].y + 2.0)];
        let mut x = vec![p(0.0, 0.0)];
        let mut anderson = Anderson::new(5);
        for _ in 0..6 {
            let plain = g(&x);
            x = anderson.propose(&x, &plain).unwrap_or(plain);
        }
        let r = g(&x)[0] - x[0];
        assert!(r.x.hypot(r.y) < 1e-6, "{r:?}");
    }
}
