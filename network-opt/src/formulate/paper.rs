//! The formulation of Peng et al. 2016 as they wrote it (**A**), to compare
//! with.
//!
//! Half-edges E_ij with distances D_ij in [0, Delta], Delta the length of all
//! half-edges, and, where v_j is no sink, an L for each half-edge that follows:
//!
//! L <= E_jk,   (1)
//! D_jk - D_ij + Delta L <= Delta - l_ij,   (2)
//! E_ij <= sum of L,   (3)
//! -1 <= E_ij + E_ji - 2 E_x <= 0,   (4)
//! 1 - n <= sum of E_x at v - n V <= 0,   (5)
//!
//! and for patterns of n edges, active or inactive ones, with Z true or false
//!
//! 0 <= sum over the active + sum of 1 - x over the inactive - n Z <= n - 1   (12, 13);
//!
//! equation 11, branches, comes to the same as patterns of three edges at a
//! vertex. Dead ends (9, 10): a variable for each half-edge, true if an edge
//! follows. Equation 10 as written asks for an edge after every active
//! half-edge, those into a sink included; here sinks are left out, as the
//! instances' values were measured. It forbids no dead end at the start of a
//! half-edge, so row (2) of [`dead_ends`](super::dead_ends) is kept beside it:
//! else the program would answer another question than all others.
//!
//! Where v_j may become a sink (which the paper has in its figure 8e, but not in
//! its equations), that stands on the right of (3) and (10) as well.
//!
//! The recursion (2) adds the first edge of a way and not the last, so D is the
//! way of v_j to its sink only if all edges are of length 1. (l is what travel
//! costs, see [`travel_cost`](crate::design::Problem::travel_cost).) One-way
//! streets it does not know. Given edges have
//! half-edges, but their D is free of charge, as is their length; those between
//! two sinks have none. So the program of the paper's figure 2a has its 2241
//! variables, those of equations 9 and 12 not counted.

use super::draft::{Draft, Fill, Known, Term};
use super::patterns::never;

/// The columns of equations 1 to 13.
#[derive(Debug)]
pub(super) struct HalfEdges {
    /// Each edge: the half-edge that leaves its first (second) end.
    active: Vec<[Option<usize>; 2]>,
    /// Its distance.
    distance: Vec<[Option<usize>; 2]>,
    /// The half-edges that follow each, by their edges.
    follows: Vec<[Vec<(usize, usize)>; 2]>,
    /// Whether an edge follows each half-edge.
    nonempty: Vec<[Option<usize>; 2]>,
    /// Patterns.
    z: Vec<(usize, usize)>,
}

/// Adds equations 1 to 5 and 9 to 13.
pub(super) fn add(draft: &mut Draft<'_>) -> HalfEdges {
    let problem = draft.problem;
    let edges = problem.edges();
    let possible: Vec<usize> = (0..edges).filter(|&e| draft.possible(e)).collect();
    let all = 2.0
        * possible
            .iter()
            .map(|&e| problem.travel_cost(e))
            .sum::<f64>();
    let mut columns = HalfEdges {
        active: vec![[None; 2]; edges],
        distance: vec![[None; 2]; edges],
        follows: vec![[Vec::new(), Vec::new()]; edges],
        nonempty: vec![[None; 2]; edges],
        z: Vec::new(),
    };
    for &e in &possible {
        // A given edge from sink to sink needs nothing and leads nowhere.
        if problem.is_given(e) && problem.ends[e].iter().all(|&v| problem.sinks[v]) {
            continue;
        }
        let cost = if problem.is_given(e) {
            0.0
        } else {
            problem.travel_weight
        };
        for k in 0..2 {
            columns.active[e][k] = Some(draft.program.binary(0.0));
            columns.distance[e][k] = Some(draft.program.real(cost, all));
        }
        let [i, j] = columns.active[e].map(|c| c.map_or(Term::Off, Term::Column));
        let x = draft.x[e];
        draft.row(-1.0, 0.0, [(i, 1.0), (j, 1.0), (x, -2.0)]);
    }
    for &e in &possible {
        for k in 0..2 {
            if columns.active[e][k].is_none() {
                continue;
            }
            follow(draft, &mut columns, e, k, all);
        }
    }
    for v in 0..problem.vertices {
        let (y, edges) = (draft.y[v], &draft.around[v]);
        let mut terms: Vec<_> = edges.iter().map(|&(e, _)| (draft.x[e], 1.0)).collect();
        let n = terms.iter().filter(|(x, _)| *x != Term::Off).count() as f64;
        terms.push((y, -n));
        // Nothing is asked of a vertex without edges.
        if n > 0.0 {
            draft.row(1.0 - n, 0.0, terms);
        }
    }
    patterns(draft, &mut columns);
    columns
}

/// Equations 1 to 3, 9 and 10 of one half-edge.
fn follow(draft: &mut Draft<'_>, columns: &mut HalfEdges, e: usize, k: usize, all: f64) {
    let problem = draft.problem;
    let j = problem.ends[e][1 - k];
    let term = |column: Option<usize>| column.map_or(Term::Off, Term::Column);
    let (active, distance) = (term(columns.active[e][k]), term(columns.distance[e][k]));
    if problem.sinks[j] {
        return;
    }
    let next: Vec<usize> = (draft.around[j].iter().map(|&(f, _)| f))
        .filter(|&f| f != e && draft.possible(f))
        .collect();
    let mut any = vec![(active, 1.0)];
    for &f in &next {
        let side = usize::from(problem.ends[f][1] == j);
        let column = draft.program.binary(0.0);
        columns.follows[e][k].push((f, column));
        let l = Term::Column(column);
        let (next, there) = (
            term(columns.active[f][side]),
            term(columns.distance[f][side]),
        );
        draft.row(f64::NEG_INFINITY, 0.0, [(l, 1.0), (next, -1.0)]);
        let step = [(there, 1.0), (distance, -1.0), (l, all)];
        draft.row(f64::NEG_INFINITY, all - problem.travel_cost(e), step);
        any.push((l, -1.0));
    }
    any.push((draft.s[j], -1.0));
    draft.row(f64::NEG_INFINITY, 0.0, any);
    if !problem.dead_ends {
        let column = draft.program.binary(0.0);
        columns.nonempty[e][k] = Some(column);
        let nu = Term::Column(column);
        let n = next.len() as f64;
        let mut terms: Vec<_> = next.iter().map(|&f| (draft.x[f], 1.0)).collect();
        terms.push((nu, -n));
        let low = if next.is_empty() { 0.0 } else { 1.0 - n };
        draft.row(low, 0.0, terms);
        let s = draft.s[j];
        draft.row(
            f64::NEG_INFINITY,
            0.0,
            [(active, 1.0), (nu, -1.0), (s, -1.0)],
        );
    }
}

/// Equations 12 and 13, and 11.
fn patterns(draft: &mut Draft<'_>, columns: &mut HalfEdges) {
    let problem = draft.problem;
    for (k, pattern) in problem.patterns.iter().enumerate() {
        if never(draft, pattern) {
            continue;
        }
        let n = (pattern.active.len() + pattern.inactive.len()) as f64;
        let inactive = pattern.inactive.len() as f64;
        let mut terms = super::patterns::terms(draft, pattern);
        if let Some(cost) = pattern.cost {
            let column = draft.program.binary(cost);
            columns.z.push((k, column));
            terms.push((Term::Column(column), -n));
        }
        draft.row(-inactive, n - 1.0 - inactive, terms);
    }
}

impl Fill for HalfEdges {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        let problem = known.problem;
        // The paper's distance of the half-edge that leaves each vertex on its way.
        let mut gone = vec![0.0; problem.vertices];
        for &v in &known.order {
            if let Some((e, w)) = known.next[v] {
                let at_sink = known.sinks[w];
                gone[v] = if at_sink {
                    0.0
                } else {
                    problem.travel_cost(e) + gone[w]
                };
            }
        }
        for (e, ends) in problem.ends.iter().enumerate() {
            if !known.active[e] {
                continue;
            }
            let to = known.nearer(e);
            let k = usize::from(ends[0] == to);
            let mut set = |column: Option<usize>, value: f64| {
                if let Some(column) = column {
                    values[column] = value;
                }
            };
            set(self.active[e][k], 1.0);
            if known.sinks[to] {
                continue;
            }
            set(self.distance[e][k], problem.travel_cost(e) + gone[to]);
            for &(f, column) in &self.follows[e][k] {
                if known.next[to].is_some_and(|(next, _)| next == f) {
                    values[column] = 1.0;
                }
            }
        }
        for (e, columns) in self.nonempty.iter().enumerate() {
            for (k, column) in columns.iter().enumerate() {
                let to = problem.ends[e][1 - k];
                if let Some(column) = *column {
                    let others = known.degree[to] - usize::from(known.active[e]);
                    values[column] = f64::from(u8::from(others > 0));
                }
            }
        }
        for &(k, column) in &self.z {
            let pattern = &problem.patterns[k];
            let occurs = pattern.active.iter().all(|&e| known.active[e])
                && !pattern.inactive.iter().any(|&e| known.active[e]);
            values[column] = f64::from(u8::from(occurs));
        }
    }
}
