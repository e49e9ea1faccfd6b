//! Routes between two places: the paper's point-to-point constraint.
//!
//! For each pair of places, with a column P of each path that would do and N
//! the number of its edges (equations 7 and 8 of the paper)
//!
//! sum of P >= 1,  P <= x_e for each edge e of the path.
//!
//! The rows for single edges are tighter than the paper's
//! N P - sum of x_e <= 0 in one. Its other side, P >= sum of x_e - N + 1, which
//! makes P true where the path happens to be active, asks for nothing.

use super::draft::{Draft, Fill, Known, Term};

#[derive(Debug)]
pub(super) struct Routes {
    /// Route, path and column.
    paths: Vec<(usize, usize, usize)>,
}

/// Adds columns and rows; those of the paper as written unless `tight`.
pub(super) fn add(draft: &mut Draft<'_>, tight: bool) -> Routes {
    let mut paths = Vec::new();
    for (r, route) in draft.problem.routes.iter().enumerate() {
        let mut any = Vec::new();
        for (k, path) in route.iter().enumerate() {
            if path.iter().any(|&e| !draft.possible(e)) {
                continue;
            }
            let column = draft.program.binary(0.0);
            paths.push((r, k, column));
            let chosen = Term::Column(column);
            any.push((chosen, 1.0));
            if tight || path.is_empty() {
                for &e in path {
                    let x = draft.x[e];
                    draft.row(f64::NEG_INFINITY, 0.0, [(chosen, 1.0), (x, -1.0)]);
                }
            } else {
                let n = path.len() as f64;
                let sum: Vec<_> = path.iter().map(|&e| (draft.x[e], -1.0)).collect();
                draft.row(1.0 - n, 0.0, sum.into_iter().chain([(chosen, n)]));
            }
        }
        draft.row(1.0, f64::INFINITY, any);
    }
    Routes { paths }
}

impl Fill for Routes {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(r, k, column) in &self.paths {
            let path = &known.problem.routes[r][k];
            let all = path.iter().all(|&e| known.active[e]);
            values[column] = f64::from(u8::from(all));
        }
    }
}
