//! No dead ends.
//!
//! For each vertex v that is no sink
//!
//! sum of x_e at v >= 2 y_v.   (2)
//!
//! With s_v more on the left where v may become a sink.
//!
//! The paper's equation 10 speaks of half-edges, of which only the one towards
//! the sink need be active: it leaves dead ends at the far end.

use super::draft::{Draft, Term};

/// Adds rows (2) where the problem forbids dead ends.
pub(super) fn add(draft: &mut Draft<'_>) {
    if draft.problem.dead_ends {
        return;
    }
    for v in 0..draft.problem.vertices {
        let s = draft.s[v];
        if s == Term::On {
            continue;
        }
        let edges: Vec<_> = draft.around[v].iter().map(|&(e, _)| draft.x[e]).collect();
        let y = draft.y[v];
        let sum = edges.into_iter().map(|x| (x, 1.0));
        draft.row(0.0, f64::INFINITY, sum.chain([(y, -2.0), (s, 1.0)]));
    }
}
