//! Connectivity and travel by distances of vertices: for one sink or few
//! (**T**).
//!
//! Each active vertex that is no sink has one parent, over an active edge, and a
//! distance d_v in [lo_v, hi_v] that is larger than its parent's:
//!
//! sum of p_vw = y_v,  p_vw + p_wv <= x_e,
//! d_v >= d_w + l_e - (hi_w + l_e - lo_v) (1 - p_vw).   (9a)
//!
//! An edge is charged at one of its ends, with q_v + q_w = x_e and q_w >= p_vw,
//! what it is away there:
//!
//! c_e >= d_v - hi_v (1 - x_e) - (hi_v - lo_w) q_w,  c_e >= lo_v q_v + lo_w q_w.   (9b)
//!
//! A sink that is placed has no parent: the sum of its p is y_v - s_v.
//!
//! The least c is the way from the nearer end, as in
//! [`cost`](crate::design::cost). lo_v is the way to a sink over all edges that
//! may be active, hi_v what [`longest_ways`] says: (9) is the better the less
//! that is.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::draft::{Draft, Fill, Known, Term};
use super::prepare::{prepare, Fate};
use super::reach::useful;
use crate::design::{distances, Problem};

/// For each vertex, a way than which it has no longer one to its sink in any
/// valid network that costs no more than `cost`; minus infinity if it is active
/// in no such network.
///
/// *Why.* On the way of a vertex v let w be the last vertex before which all
/// edges were given ones that lead to a sink (or the sink itself): from there
/// the way is over edges that are paid for, and no longer than g_w, w's way over
/// given edges. The i-th of k paid edges from w on costs at least lambda_L l_i +
/// lambda_D (a_w + l_1 + ... + l_i-1), with a_w the way of w over all edges
/// that may be active. For a length n in all this is least with the longest
/// edges last and few of them, and it must not be over `cost`: so n is bounded
/// by some N_w, and the way of v by g_w + N_w, for the w from which v can be
/// reached over N_w. Given edges that lead to no sink by themselves are counted
/// as if they lay on every way. Ways are of what travel costs, so an edge with
/// a way of c_i over it costs at least r c_i of length, with r the least of l /
/// c over all edges: that takes the place of lambda_L's l_i.
///
/// With one-way streets the bounds are what all edges cost together, because no
/// way passes an edge twice in one direction; and minus infinity where no sink
/// can be reached, or none reaches.
#[must_use]
pub fn longest_ways(problem: &Problem, cost: f64) -> Vec<f64> {
    let fates = prepare(problem);
    let possible: Vec<bool> = fates.iter().map(|&fate| fate != Fate::Off).collect();
    if problem.has_one_way() {
        let edges = (0..problem.edges()).filter(|&e| possible[e]);
        let all = edges.map(|e| problem.travel_cost(e)).sum::<f64>();
        let useful = useful(problem, &|e| possible[e]);
        let bound = |u: bool| if u { all } else { f64::NEG_INFINITY };
        return useful.into_iter().map(bound).collect();
    }
    let given: Vec<bool> = (0..problem.edges()).map(|e| problem.is_given(e)).collect();
    let least = distances(&problem.eased(), &possible);
    let mut over_given = distances(problem, &given);
    let sum =
        |edges: &mut dyn Iterator<Item = usize>| edges.map(|e| problem.travel_cost(e)).sum::<f64>();
    let mut apart =
        (0..problem.edges()).filter(|&e| given[e] && over_given[problem.ends[e][0]].is_infinite());
    let extra = sum(&mut apart);
    // Where a sink may be placed a way may end.
    for &v in problem.placed.iter().flat_map(|placed| &placed.candidates) {
        over_given[v] = if over_given[v].is_finite() {
            over_given[v]
        } else {
            0.0
        };
    }
    let longest = (0..problem.edges())
        .filter(|&e| possible[e])
        .map(|e| problem.travel_cost(e))
        .fold(0.0, f64::max);
    let all = sum(&mut (0..problem.edges()).filter(|&e| possible[e]));
    let rate = (0..problem.edges())
        .filter(|&e| possible[e])
        .map(|e| problem.lengths[e] / problem.travel_cost(e))
        .fold(f64::INFINITY, f64::min);
    let around = problem.around();
    let mut ways = vec![f64::NEG_INFINITY; problem.vertices];
    for w in (0..problem.vertices).filter(|&w| over_given[w].is_finite()) {
        let paid = paid_length(problem, rate, cost, least[w], longest).min(all);
        // All vertices within `paid` of w.
        let mut within = vec![f64::INFINITY; problem.vertices];
        let mut queue = BinaryHeap::from([(Reverse(0_u64), w)]);
        within[w] = 0.0;
        // Lengths are positive, and so ordered as their bits are.
        while let Some((Reverse(bits), v)) = queue.pop() {
            let gone = f64::from_bits(bits);
            if gone > within[v] {
                continue;
            }
            ways[v] = ways[v].max(over_given[w] + paid + extra);
            for &(e, u) in &around[v] {
                // Orphans' edges are no matter of cost.
                let there = gone
                    + if given[e] {
                        0.0
                    } else {
                        problem.travel_cost(e)
                    };
                if possible[e] && there < within[u] && there <= paid + 1e-9 {
                    within[u] = there;
                    queue.push((Reverse(there.to_bits()), u));
                }
            }
        }
    }
    // Rounding must not cut off the longest of them.
    ways.iter_mut()
        .for_each(|way| *way = way.min(all + extra) + 1e-6);
    // No vertex is nearer than it can be.
    for (way, &least) in ways.iter_mut().zip(&least) {
        if *way < least {
            *way = f64::NEG_INFINITY;
        }
    }
    ways
}

/// How long a path of paid edges may be that begins `away` from a sink and
/// costs at most `cost`; `rate` is the least length of an edge for what travel
/// over it costs.
fn paid_length(problem: &Problem, rate: f64, cost: f64, away: f64, longest: f64) -> f64 {
    // Without any edge there is no rate.
    let rate = if rate.is_finite() { rate } else { 1.0 };
    let (length, travel) = (problem.length_weight * rate, problem.travel_weight);
    // The edge of which k others of the path come after it is travelled on by
    // all of them, and each pays the way before the path.
    let (mut left, mut gone) = (cost.max(0.0), 0.0);
    for k in 0_u32.. {
        let edge = longest * (length + travel * f64::from(k)) + travel * away;
        if edge <= 0.0 && k > 0 || !edge.is_finite() {
            return f64::INFINITY;
        }
        if edge > left {
            // A shorter edge may do, but pays the way before the path in full.
            let rest = length + travel * f64::from(k);
            let part = (left - travel * away).max(0.0) / rest.max(f64::MIN_POSITIVE);
            return gone + part.min(longest);
        }
        left -= edge;
        gone += longest;
        if k > 1_000_000 {
            return f64::INFINITY;
        }
    }
    gone
}

/// The columns of rows (9).
#[derive(Debug)]
pub(super) struct Distances {
    /// Each edge: whether its first (second) end has the other for its parent.
    parent: Vec<[Option<usize>; 2]>,
    /// Each edge: whether it is charged at its first (second) end.
    charged: Vec<[Option<usize>; 2]>,
    /// Each edge: what it is charged.
    cost: Vec<Option<usize>>,
    /// Each vertex: its distance, and the least of it.
    distance: Vec<Option<(usize, f64)>>,
}

/// Adds columns and rows (9); `longest` has a bound for each vertex, else the
/// sum of what travel over all edges costs is taken.
pub(super) fn add(draft: &mut Draft<'_>, longest: Option<&[f64]>) -> Distances {
    let problem = draft.problem;
    let edges = problem.edges();
    let possible: Vec<bool> = (0..edges).map(|e| draft.possible(e)).collect();
    let least = distances(&problem.eased(), &possible);
    let all: f64 = (0..edges).map(|e| problem.travel_cost(e)).sum();
    let mut columns = Distances {
        parent: vec![[None; 2]; edges],
        charged: vec![[None; 2]; edges],
        cost: vec![None; edges],
        distance: vec![None; problem.vertices],
    };
    let mut d = vec![Term::Off; problem.vertices];
    let mut high = vec![0.0; problem.vertices];
    for v in 0..problem.vertices {
        if problem.sinks[v] || draft.y[v] == Term::Off {
            continue;
        }
        let bound = longest.map_or(all, |ways| ways[v]);
        if bound < least[v] {
            // Active in no network that is good enough.
            let y = draft.y[v];
            draft.row(f64::NEG_INFINITY, 0.0, [(y, 1.0)]);
        }
        high[v] = bound.max(least[v]);
        let column = draft.program.real(0.0, high[v]);
        draft.program.bound(column, least[v], high[v]);
        columns.distance[v] = Some((column, least[v]));
        d[v] = Term::Column(column);
    }
    let low = |v: usize| if problem.sinks[v] { 0.0 } else { least[v] };
    let mut parents: Vec<Vec<(Term, f64)>> = vec![Vec::new(); problem.vertices];
    for e in (0..edges).filter(|&e| possible[e]) {
        let x = draft.x[e];
        let length = problem.travel_cost(e);
        let mut once = vec![(x, -1.0)];
        for k in 0..2 {
            let (v, w) = (problem.ends[e][k], problem.ends[e][1 - k]);
            if problem.sinks[v] {
                continue;
            }
            let column = draft.program.binary(0.0);
            columns.parent[e][k] = Some(column);
            let p = Term::Column(column);
            once.push((p, 1.0));
            parents[v].push((p, 1.0));
            let slack = (high[w] + length - low(v)).max(0.0);
            let terms = [(d[v], 1.0), (d[w], -1.0), (p, -slack)];
            draft.row(length - slack, f64::INFINITY, terms);
        }
        draft.row(f64::NEG_INFINITY, 0.0, once);
        let ends = problem.ends[e];
        if problem.is_given(e) || ends.iter().any(|&v| problem.sinks[v]) {
            continue;
        }
        let q = [0; 2].map(|_| draft.program.binary(0.0));
        columns.charged[e] = q.map(Some);
        let q = q.map(Term::Column);
        draft.row(0.0, 0.0, [(q[0], 1.0), (q[1], 1.0), (x, -1.0)]);
        let column = draft
            .program
            .real(problem.travel_weight, high[ends[0]].max(high[ends[1]]));
        columns.cost[e] = Some(column);
        let c = Term::Column(column);
        let floor = [(c, 1.0), (q[0], -low(ends[0])), (q[1], -low(ends[1]))];
        draft.row(0.0, f64::INFINITY, floor);
        for k in 0..2 {
            let (v, w) = (ends[k], ends[1 - k]);
            if let Some(p) = columns.parent[e][k] {
                draft.row(
                    0.0,
                    f64::INFINITY,
                    [(q[1 - k], 1.0), (Term::Column(p), -1.0)],
                );
            }
            // The factor of q_w must not be negative: where w is always farther
            // than v, being charged there is no reason to pay less.
            let less = (high[v] - low(w)).max(0.0);
            let terms = [(c, 1.0), (d[v], -1.0), (x, -high[v]), (q[1 - k], less)];
            draft.row(-high[v], f64::INFINITY, terms);
        }
    }
    for (v, mut terms) in parents.into_iter().enumerate() {
        if !problem.sinks[v] {
            terms.extend([(draft.y[v], -1.0), (draft.s[v], 1.0)]);
            draft.row(0.0, 0.0, terms);
        }
    }
    columns
}

impl Distances {
    /// The column of what each edge is charged.
    pub(super) fn ways(&self) -> Vec<Option<usize>> {
        self.cost.clone()
    }
}

impl Fill for Distances {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for (v, distance) in self.distance.iter().enumerate() {
            if let Some((column, least)) = *distance {
                let active = known.degree[v] > 0 && known.away[v].is_finite();
                values[column] = if active { known.away[v] } else { least };
            }
            if let (Some((e, _)), true) = (known.next[v], known.degree[v] > 0) {
                let side = usize::from(known.problem.ends[e][1] == v);
                if let Some(column) = self.parent[e][side] {
                    values[column] = 1.0;
                }
            }
        }
        for (e, ends) in known.problem.ends.iter().enumerate() {
            if !known.active[e] {
                continue;
            }
            let at = known.nearer(e);
            if let Some(column) = self.charged[e][usize::from(ends[1] == at)] {
                values[column] = 1.0;
            }
            if let Some(column) = self.cost[e] {
                values[column] = known.away[at];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::EdgeState;

    /// A path of ten edges from the sink at 0.
    fn path(given: usize) -> Problem {
        Problem {
            vertices: 11,
            ends: (0..10).map(|k| [k, k + 1]).collect(),
            lengths: vec![1.0; 10],
            states: (0..10)
                .map(|k| {
                    if k < given {
                        EdgeState::Given
                    } else {
                        EdgeState::Open
                    }
                })
                .collect(),
            sinks: (0..11).map(|v| v == 0).collect(),
            dead_ends: true,
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn what_a_way_costs_bounds_it() {
        // Three edges cost 1 + 2 + 3, and one more 4.
        let ways = longest_ways(&path(0), 9.0);
        assert!((ways[3] - 3.75).abs() < 1e-5, "{ways:?}");
        assert_eq!(ways[4], f64::NEG_INFINITY);
        // From the end of four given edges on the first costs 5, the second 6.
        let ways = longest_ways(&path(4), 11.0);
        assert!((ways[6] - 6.0).abs() < 1e-5, "{ways:?}");
        assert_eq!(ways[7], f64::NEG_INFINITY);
    }
}
