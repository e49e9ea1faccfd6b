//! Routes between two places: the paper's point-to-point constraint.
//!
//! For each pair of places, with a column P of each path that would do and N
//! the number of its edges (equations 7 and 8 of the paper)
//!
//! sum of P >= 1,  P <= x_e for each edge e of the path.
//!
//! The rows for single edges are tighter than the paper's
//! N P - sum of x_e <= 0 in one. Of a route that need not be there, but costs
//! c if it is not, the first is
//!
//! sum of P + u >= 1,  0 <= u <= 1,
//!
//! and u costs c: where all x are whole, the least u is 0 or 1.
//!
//! The other side of the paper's rows, P >= sum of x_e - N + 1, which
//! makes P true where the path happens to be active, asks for nothing.

use super::draft::{Draft, Fill, Known, Term};

#[derive(Debug)]
pub(super) struct Routes {
    /// Route, path and column.
    paths: Vec<(usize, usize, usize)>,
    /// Route and the column that says that it is not there.
    missing: Vec<(usize, usize)>,
}

/// Adds columns and rows; those of the paper as written unless `tight`.
pub(super) fn add(draft: &mut Draft<'_>, tight: bool) -> Routes {
    let (mut paths, mut missing) = (Vec::new(), Vec::new());
    for (r, route) in draft.problem.routes.iter().enumerate() {
        let mut any = Vec::new();
        if let Some(cost) = route.cost {
            if cost == 0.0 {
                continue;
            }
            let column = draft.program.real(cost, 1.0);
            missing.push((r, column));
            any.push((Term::Column(column), 1.0));
        }
        for (k, path) in route.paths.iter().enumerate() {
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
    Routes { paths, missing }
}

impl Fill for Routes {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(r, k, column) in &self.paths {
            let path = &known.problem.routes[r].paths[k];
            let all = path.iter().all(|&e| known.active[e]);
            values[column] = f64::from(u8::from(all));
        }
        for &(r, column) in &self.missing {
            let there = known.problem.routes[r].is_there(known.active);
            values[column] = f64::from(u8::from(!there));
        }
    }
}
