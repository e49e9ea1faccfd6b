//! Directions of streets: arcs.
//!
//! Each edge with ends i and j has a_ij and a_ji, whether traffic runs over it
//! from i to j, and from j to i. They are x_e and x_e of a two-way street, x_e
//! and 0 of a one-way street of known direction, and columns of one that may
//! run either way:
//!
//! a_ij + a_ji = x_e.   (10)
//!
//! At each v that is no sink traffic comes in and goes on:
//!
//! sum of a_vw >= y_v,  sum of a_wv >= y_v.   (11)
//!
//! **Ball cuts.** Those of [`balls`](super::balls) hold as they are: their proof
//! needs that an active vertex is joined to a sink by active edges and, for
//! (6b), that it has two of them, whatever their directions. Room cuts and the
//! rows of [`Search`](crate::solve::Search)'s bound argue the same way. Besides,
//! for a set U without a sink that holds a set B of coverage, with delta+ the
//! arcs that leave U and delta- those that enter it,
//!
//! a(delta+(U)) >= 1,  a(delta-(U)) >= 1.   (12)
//!
//! *Proof.* Some v of B is active. A way from it, along active edges in their
//! direction, ends at a sink, which is outside U; the first of its arcs with its
//! head outside has its tail in U. The way to v from a sink enters U likewise. []
//!
//! With only two-way streets both are (6a); their sum over a U whose boundary is
//! all of one-way streets is x(delta(U)) >= 2, with dead ends allowed or not. U
//! is B, and B with its neighbours, ring after ring up to the nearest sink.

use std::collections::BTreeSet;

use super::coverage::least_sets;
use super::draft::{Draft, Fill, Known, Term};
use super::reach::useful;
use crate::design::{Problem, Way};

/// Each edge: whether traffic runs over it from its first end, and from its
/// second.
#[derive(Clone, Debug)]
pub(super) struct Arcs {
    pub(super) run: Vec<[Term; 2]>,
    /// Edges with columns of their own, by number.
    free: Vec<(usize, [usize; 2])>,
}

/// Adds columns and rows (10) to (12).
pub(super) fn add(draft: &mut Draft<'_>) -> Arcs {
    let problem = draft.problem;
    let useful = useful(problem, &|e| draft.possible(e));
    let mut arcs = Arcs {
        run: Vec::with_capacity(problem.edges()),
        free: Vec::new(),
    };
    for e in 0..problem.edges() {
        let x = draft.x[e];
        let run = match problem.way(e) {
            _ if x == Term::Off => [Term::Off; 2],
            Way::Both => [x, x],
            Way::Forward => [x, Term::Off],
            Way::Backward => [Term::Off, x],
            Way::Either => {
                let columns = [0; 2].map(|_| draft.program.binary(0.0));
                arcs.free.push((e, columns));
                let [a, b] = columns.map(Term::Column);
                draft.row(0.0, 0.0, [(a, 1.0), (b, 1.0), (x, -1.0)]);
                [a, b]
            }
        };
        arcs.run.push(run);
    }
    for v in (0..problem.vertices).filter(|&v| !problem.sinks[v]) {
        for out in [true, false] {
            let all = draft.around[v].iter();
            let mut terms: Vec<_> = all
                .map(|&(e, _)| (arcs.at(problem, e, v, out), 1.0))
                .collect();
            terms.push((draft.y[v], -1.0));
            draft.row(0.0, f64::INFINITY, terms);
        }
        if !useful[v] {
            // Off already, unless the problem demands it: then nothing is valid.
            let y = draft.y[v];
            draft.row(f64::NEG_INFINITY, 0.0, [(y, 1.0)]);
        }
    }
    let mut cuts = BTreeSet::new();
    for set in least_sets(draft) {
        let mut ball: BTreeSet<usize> = set.into_iter().collect();
        for _ in 0..RINGS {
            if ball.iter().any(|&v| problem.sinks[v]) {
                break;
            }
            let ring = leaving(draft, &ball);
            if ring.len() > WIDEST {
                break;
            }
            cuts.insert(ball.iter().copied().collect::<Vec<usize>>());
            // Over an edge that is active anyway a way leads out.
            if ring.is_empty() || ring.iter().any(|&(e, _)| draft.x[e] == Term::On) {
                break;
            }
            let far = ring.iter().flat_map(|&(e, _)| problem.ends[e]);
            ball.extend(far.collect::<Vec<usize>>());
        }
    }
    for set in cuts {
        let ball: BTreeSet<usize> = set.into_iter().collect();
        for out in [true, false] {
            let ring = leaving(draft, &ball).into_iter();
            let terms: Vec<_> = ring
                .map(|(e, v)| (arcs.at(problem, e, v, out), 1.0))
                .collect();
            draft.row(1.0, f64::INFINITY, terms);
        }
    }
    arcs
}

/// Rings of neighbours that are put around a set at most.
const RINGS: usize = 24;
/// Edges of a cut at most: one of many says little of each, and rows of many
/// columns cost time.
const WIDEST: usize = 32;

/// The edges that may be active with one end among some vertices, with that end.
fn leaving(draft: &Draft<'_>, ball: &BTreeSet<usize>) -> Vec<(usize, usize)> {
    let from = ball.iter().flat_map(|&v| {
        let around = draft.around[v].iter();
        around.map(move |&(e, w)| (e, v, w))
    });
    from.filter(|&(e, _, w)| draft.possible(e) && !ball.contains(&w))
        .map(|(e, v, _)| (e, v))
        .collect()
}

impl Arcs {
    /// Whether traffic runs over an edge at `v`: away from it if `out`, else to
    /// it.
    fn at(&self, problem: &Problem, e: usize, v: usize, out: bool) -> Term {
        let end = usize::from(problem.ends[e][1] == v);
        self.run[e][if out { end } else { 1 - end }]
    }

    /// Whether an edge runs from its second end to its first.
    pub(super) fn is_backward(&self, e: usize, values: &[f64]) -> bool {
        match self.run[e] {
            [Term::Column(there), Term::Column(back)] => values[back] > values[there],
            _ => false,
        }
    }

    /// The columns of edges that may run either way.
    pub(super) fn free(&self) -> &[(usize, [usize; 2])] {
        &self.free
    }
}

impl Fill for Arcs {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &(e, columns) in &self.free {
            let way = known.streets.way(known.problem, e);
            for (end, column) in columns.into_iter().enumerate() {
                let runs = known.active[e] && way.runs_from(end);
                values[column] = f64::from(u8::from(runs));
            }
        }
    }
}
