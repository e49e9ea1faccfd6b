//! Whom a vertex sends its traffic to: a forest that leads to the sinks.
//!
//! Each active vertex that is no sink has one parent, over an active edge:
//!
//! sum of p_vw over the edges vw at v = y_v,  p_vw + p_wv <= x_e.   (22)
//!
//! *Why it holds.* In a valid network every active vertex has a way to a sink;
//! its next vertex on a shortest one is its parent, and no two vertices are each
//! other's, because lengths are positive.
//!
//! A set B of vertices of which one is active and none is a sink is left by the
//! way from that vertex, so
//!
//! sum of p_vw over v in B, w outside >= 1.   (23)
//!
//! That says more than x(delta(B)) >= 1: an edge that joins two such sets
//! serves as the way out of one of them only. Where networks are trees, as where
//! dead ends are allowed, (23) is what makes a relaxation good: of the floor of
//! 10 x 10 squares with dead ends the bound at the root goes from 13.7 to 19.7
//! of 20. Where the cuts of [`balls`](super::balls) ask for two edges anyway, as
//! for streets that cover a mesh, it says nothing new (measured: equal bounds to
//! three digits), so only rooms have it.

use super::draft::{Draft, Fill, Known, Term};

/// The columns of rows (22).
#[derive(Clone, Debug)]
pub(super) struct Parents {
    /// Each edge: whether its first (second) end has the other for its parent.
    parent: Vec<[Option<usize>; 2]>,
}

/// Adds columns and rows (22).
pub(super) fn add(draft: &mut Draft<'_>) -> Parents {
    let problem = draft.problem;
    let mut parent = vec![[None; 2]; problem.edges()];
    let mut sums: Vec<Vec<(Term, f64)>> = vec![Vec::new(); problem.vertices];
    for (e, columns) in parent.iter_mut().enumerate() {
        if !draft.possible(e) {
            continue;
        }
        let mut once = vec![(draft.x[e], -1.0)];
        for (k, column) in columns.iter_mut().enumerate() {
            let v = problem.ends[e][k];
            if problem.sinks[v] {
                continue;
            }
            let p = draft.program.real(0.0, 1.0);
            *column = Some(p);
            once.push((Term::Column(p), 1.0));
            sums[v].push((Term::Column(p), 1.0));
        }
        draft.row(f64::NEG_INFINITY, 0.0, once);
    }
    for (v, mut sum) in sums.into_iter().enumerate() {
        if !problem.sinks[v] {
            sum.push((draft.y[v], -1.0));
            draft.row(0.0, 0.0, sum);
        }
    }
    Parents { parent }
}

impl Parents {
    /// The column that says whether an end of an edge, its first or second, has
    /// the other for its parent.
    pub(super) fn column(&self, edge: usize, end: usize) -> Option<usize> {
        self.parent[edge][end]
    }
}

impl Fill for Parents {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for v in (0..known.problem.vertices).filter(|&v| known.degree[v] > 0) {
            if let Some((e, _)) = known.next[v] {
                let side = usize::from(known.problem.ends[e][1] == v);
                if let Some(column) = self.parent[e][side] {
                    values[column] = 1.0;
                }
            }
        }
    }
}
