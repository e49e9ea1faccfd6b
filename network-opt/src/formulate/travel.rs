//! Connectivity and travel by a flow from edges: the travel objective (**Fe**).
//!
//! Each active edge that was not given sends one unit from one of its ends to a
//! sink:
//!
//! h_ij + h_ji = x_e,  h >= 0,
//! outflow - inflow = sum of the h at v, at each v that is no sink,
//! f_ij + f_ji <= n x_e,   (8)
//!
//! and the flow costs lambda_D c_e f, with c_e what travel over e costs, its
//! length or its time. The least flow takes the shortest ways
//! from the nearer ends, so it costs what [`cost`](crate::design::cost) calls
//! travel: with edges of length 1 the paper's sum of D. (With other lengths the
//! paper's recursion, equation 2, counts the first edge of a way and not the
//! last; here the distance is the true one.)
//!
//! n is the number of edges that may send; fewer, say the number of vertices,
//! would cut off solutions. An edge at a sink has nothing to pay and sends
//! nothing. Given edges carry what they are asked to. What may become a sink has
//! an outlet, as [`sinks`](super::sinks) says; an edge there sends its unit.

use super::draft::{Draft, Fill, Known, Term};
use super::sinks::Outlets;

/// The columns of rows (8).
#[derive(Debug)]
pub(super) struct Travel {
    /// Each edge: the share that it sends from its first and second end.
    sent: Vec<[Option<usize>; 2]>,
    /// Each edge: the flow from its first and from its second end.
    along: Vec<[Option<usize>; 2]>,
    outlets: Outlets,
}

/// Adds columns and rows (8).
pub(super) fn add(draft: &mut Draft<'_>) -> Travel {
    let problem = draft.problem;
    let edges = problem.edges();
    let sinks = |e: usize| problem.ends[e].map(|v| problem.sinks[v]);
    let sends = |draft: &Draft<'_>, e: usize| {
        draft.possible(e) && !problem.is_given(e) && sinks(e) == [false; 2]
    };
    let most = (0..edges).filter(|&e| sends(draft, e)).count() as f64;
    let mut balance: Vec<Vec<(Term, f64)>> = vec![Vec::new(); problem.vertices];
    let mut travel = Travel {
        sent: vec![[None; 2]; edges],
        along: vec![[None; 2]; edges],
        outlets: Outlets::new(draft, most, |_| true),
    };
    for e in 0..edges {
        if !draft.possible(e) || sinks(e) == [true; 2] {
            continue;
        }
        let [a, b] = problem.ends[e];
        if sends(draft, e) {
            let mut share = vec![(draft.x[e], -1.0)];
            for (k, v) in [a, b].into_iter().enumerate() {
                let column = draft.program.real(0.0, 1.0);
                travel.sent[e][k] = Some(column);
                let h = Term::Column(column);
                share.push((h, 1.0));
                balance[v].push((h, -1.0));
            }
            draft.row(0.0, 0.0, share);
        }
        let mut capacity = vec![(draft.x[e], -most)];
        let cost = problem.travel_weight * problem.travel_cost(e);
        for (k, (from, to)) in [(a, b), (b, a)].into_iter().enumerate() {
            if problem.sinks[from] {
                continue;
            }
            let column = draft.program.real(cost, most);
            travel.along[e][k] = Some(column);
            let f = Term::Column(column);
            capacity.push((f, 1.0));
            balance[from].push((f, 1.0));
            balance[to].push((f, -1.0));
        }
        draft.row(f64::NEG_INFINITY, 0.0, capacity);
    }
    for (v, terms) in balance.into_iter().enumerate() {
        if !problem.sinks[v] {
            let outlet = travel.outlets.at(v).map(|a| (Term::Column(a), 1.0));
            let terms: Vec<_> = terms.into_iter().chain(outlet).collect();
            draft.row(0.0, 0.0, terms);
        }
    }
    travel
}

impl Travel {
    /// Whether an edge sends traffic if it is active.
    pub(super) fn sends(&self, edge: usize) -> bool {
        self.sent[edge][0].is_some()
    }

    /// The columns of the flow over an edge, one for each direction in which
    /// there may be some.
    pub(super) fn flows(&self, edge: usize) -> impl Iterator<Item = usize> + '_ {
        self.along[edge].iter().flatten().copied()
    }
}

impl Fill for Travel {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        let mut carried = vec![0.0; known.problem.vertices];
        for (e, ends) in known.problem.ends.iter().enumerate() {
            if !known.active[e] {
                continue;
            }
            let from = known.nearer(e);
            if let Some(column) = self.sent[e][usize::from(ends[1] == from)] {
                values[column] = 1.0;
                carried[from] += 1.0;
            }
        }
        for &v in known.order.iter().rev() {
            let Some((e, to)) = known.next[v] else {
                if let Some(a) = self.outlets.at(v) {
                    values[a] = carried[v];
                }
                continue;
            };
            carried[to] += carried[v];
            let side = usize::from(known.problem.ends[e][1] == v);
            if let Some(column) = self.along[e][side] {
                values[column] = carried[v];
            }
        }
    }
}
