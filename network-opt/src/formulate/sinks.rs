//! Sinks whose places the program chooses.
//!
//! With a column s_v for each candidate v, k of which become sinks, each of
//! them active
//!
//! sum of s_v = k,  s_v <= y_v.   (28)
//!
//! What other families say of sinks holds of a candidate if s_v is 1. It may be
//! a dead end, and needs no edge or half-edge that goes on,
//!
//! sum of x_e at v >= 2 y_v - s_v;   (2')
//!
//! ball cuts say nothing where a ball B holds one,
//!
//! x(delta(B)) + x(K) + 2 sum of s_v over B >= 2;   (6')
//!
//! and flows may leave the network there, by a column a of its own in the
//! balance of v, of which n may be all that is sent:
//!
//! outflow + a_v - inflow = what v sends,  a_v <= n s_v.   (7')

use super::draft::{Draft, Fill, Known, Term};

/// The columns of rows (28).
#[derive(Debug)]
pub(super) struct Placed {
    /// Vertex and column.
    s: Vec<(usize, usize)>,
}

/// Adds columns and rows (28), if there are sinks to be placed.
pub(super) fn add(draft: &mut Draft<'_>) -> Placed {
    let mut s = Vec::new();
    let Some(placed) = &draft.problem.placed else {
        return Placed { s };
    };
    let mut sum = Vec::new();
    for &v in &placed.candidates {
        let y = draft.y[v];
        if y == Term::Off {
            continue;
        }
        let column = draft.program.binary(0.0);
        s.push((v, column));
        draft.s[v] = Term::Column(column);
        sum.push((draft.s[v], 1.0));
        draft.row(
            f64::NEG_INFINITY,
            0.0,
            [(Term::Column(column), 1.0), (y, -1.0)],
        );
    }
    let count = placed.count as f64;
    draft.row(count, count, sum);
    Placed { s }
}

impl Placed {
    /// The sinks of a solution, ascending.
    pub(super) fn chosen(&self, values: &[f64]) -> Vec<usize> {
        let chosen = self.s.iter().filter(|&&(_, column)| values[column] > 0.5);
        let mut sinks: Vec<usize> = chosen.map(|&(v, _)| v).collect();
        sinks.sort_unstable();
        sinks
    }
}

impl Fill for Placed {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(v, column) in &self.s {
            values[column] = f64::from(u8::from(known.sinks[v]));
        }
    }
}

/// Where flows may leave the network if sinks are chosen there (7').
#[derive(Debug)]
pub(super) struct Outlets {
    /// The column of each vertex.
    a: Vec<Option<usize>>,
}

impl Outlets {
    /// One for each candidate for which `wanted` says true, of capacity `most`.
    pub(super) fn new(draft: &mut Draft<'_>, most: f64, wanted: impl Fn(usize) -> bool) -> Self {
        let mut a = vec![None; draft.problem.vertices];
        for (v, a) in a.iter_mut().enumerate() {
            let s = draft.s[v];
            if matches!(s, Term::Column(_)) && wanted(v) {
                let column = draft.program.real(0.0, most);
                *a = Some(column);
                draft.row(
                    f64::NEG_INFINITY,
                    0.0,
                    [(Term::Column(column), 1.0), (s, -most)],
                );
            }
        }
        Self { a }
    }

    /// The outlet of a vertex.
    pub(super) fn at(&self, v: usize) -> Option<usize> {
        self.a[v]
    }
}
