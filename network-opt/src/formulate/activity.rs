//! Which vertices are active.
//!
//! A vertex is active if an edge at it is (definition 4.1). With x of edges and
//! y of vertices
//!
//! x_e <= y_v for both ends v of e,  y_v <= sum of x_e at v.   (1)
//!
//! That is tighter than the paper's equation 5, 1 - n <= sum x - n y <= 0 with
//! all n edges at v in one row. y follows from x and may be real; it is whole
//! in the program, because a branch on a vertex decides more than one on an
//! edge.

use super::draft::{Draft, Fill, Known, Term};

#[derive(Debug)]
pub(super) struct Activity {
    /// The columns of edges and of vertices.
    x: Vec<(usize, usize)>,
    y: Vec<(usize, usize)>,
}

/// Adds the vertices' columns; rows (1) if `tight`.
pub(super) fn add(draft: &mut Draft<'_>, tight: bool) -> Activity {
    let vertices = draft.problem.vertices;
    let mut columns = Vec::new();
    for v in 0..vertices {
        let edges: Vec<Term> = draft.around[v].iter().map(|&(e, _)| draft.x[e]).collect();
        draft.y.push(if edges.contains(&Term::On) {
            Term::On
        } else if edges.iter().all(|&x| x == Term::Off) {
            Term::Off
        } else {
            let column = draft.program.binary(0.0);
            columns.push((v, column));
            Term::Column(column)
        });
        if tight {
            let y = draft.y[v];
            for &x in &edges {
                draft.row(f64::NEG_INFINITY, 0.0, [(x, 1.0), (y, -1.0)]);
            }
            let sum = edges.iter().map(|&x| (x, 1.0));
            draft.row(0.0, f64::INFINITY, sum.chain([(y, -1.0)]));
        }
    }
    for &v in &draft.problem.required_vertices {
        let y = draft.y[v];
        draft.row(1.0, f64::INFINITY, [(y, 1.0)]);
    }
    let x = draft.x.iter().enumerate().filter_map(|(e, x)| match x {
        Term::Column(column) => Some((e, *column)),
        _ => None,
    });
    Activity {
        x: x.collect(),
        y: columns,
    }
}

impl Fill for Activity {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(e, column) in &self.x {
            values[column] = f64::from(u8::from(known.active[e]));
        }
        for &(v, column) in &self.y {
            values[column] = f64::from(u8::from(known.degree[v] > 0));
        }
    }
}
