//! Unwelcome combinations of edges: too close, zig-zags, T-junctions, branches.
//!
//! A pattern of n active edges and some inactive ones, if forbidden:
//!
//! sum of x over the active - sum of x over the inactive <= n - 1,   (4)
//!
//! else with a column z in [0, 1] that costs what an occurrence costs:
//!
//! z >= sum over the active - sum over the inactive - (n - 1).   (5)
//!
//! z may be real, since the least that it can be is 0 or 1. Rows (4) and (5) say
//! the same of whole numbers as the paper's equations 11 (a branch is three
//! edges at a vertex, all active), 12 and 13, and are tighter for fractions:
//! with four edges, equation 13 lets every T be 0 until all of its row is used.

use super::draft::{Draft, Fill, Known, Term};
use crate::design::Pattern;

#[derive(Debug)]
pub(super) struct Costs {
    /// Pattern and column.
    z: Vec<(usize, usize)>,
}

/// Adds rows (4) and (5).
pub(super) fn add(draft: &mut Draft<'_>) -> Costs {
    let mut z = Vec::new();
    let problem = draft.problem;
    for (k, pattern) in problem.patterns.iter().enumerate() {
        let mut terms = terms(draft, pattern);
        let most = pattern.active.len() as f64 - 1.0;
        if let Some(cost) = pattern.cost {
            if cost == 0.0 || never(draft, pattern) {
                continue;
            }
            let column = draft.program.real(cost, 1.0);
            z.push((k, column));
            terms.push((Term::Column(column), -1.0));
        }
        draft.row(f64::NEG_INFINITY, most, terms);
    }
    Costs { z }
}

pub(super) fn terms(draft: &Draft<'_>, pattern: &Pattern) -> Vec<(Term, f64)> {
    let active = pattern.active.iter().map(|&e| (draft.x[e], 1.0));
    let inactive = pattern.inactive.iter().map(|&e| (draft.x[e], -1.0));
    active.chain(inactive).collect()
}

/// Whether it is known not to occur.
pub(super) fn never(draft: &Draft<'_>, pattern: &Pattern) -> bool {
    pattern.active.iter().any(|&e| draft.x[e] == Term::Off)
        || pattern.inactive.iter().any(|&e| draft.x[e] == Term::On)
}

impl Fill for Costs {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(k, column) in &self.z {
            let pattern = &known.problem.patterns[k];
            let occurs = pattern.active.iter().all(|&e| known.active[e])
                && !pattern.inactive.iter().any(|&e| known.active[e]);
            values[column] = f64::from(u8::from(occurs));
        }
    }
}
