//! Connectivity and travel with one-way streets: two flows, one to the sinks and
//! one from them.
//!
//! The flow to the sinks is that of [`flow`](super::flow) or of
//! [`travel`](super::travel), over arcs in their direction:
//!
//! outflow - inflow = y_v, or the sum of the h at v,  f_ij <= n a_ij.   (13)
//!
//! The flow from the sinks is the same with all arcs reversed: what a sink sends
//! to v over i, j runs in the program from v over j, i, and f_ji <= n a_ij.
//!
//! **Length.** Each active vertex sends one unit to the sinks and receives one
//! from them. Vertices from which a sink can be reached over given edges of known
//! direction take up the flow to the sinks, and likewise those that are reached
//! over such edges send the flow from them: nothing has to be shown of those.
//!
//! **Travel.** Each active edge e that was not given sends one unit, from one of
//! the ends that its traffic may leave by, and receives one, at one of the ends
//! that it may enter by:
//!
//! h_i + h_j = x_e,  h_j <= a_ij,  h_i <= a_ji,   (14)
//!
//! and so with the flow from the sinks. With c_e what travel over an edge costs
//! each of the two flows costs lambda_D c_e / 2 f; the least flows take least
//! ways, so that is what [`cost`](crate::design::cost) calls travel. An edge that
//! sends leads to a sink from the end that it sends from, and so from its other
//! end too, over itself: that shows the connectivity of every vertex with an edge
//! that was not given. Where given edges are not joined to sinks by themselves
//! the flow from vertices is there as well.

use super::arcs::Arcs;
use super::draft::{Draft, Fill, Known, Term};
use crate::design::{ways_to, Heading, Problem};

/// A flow to the sinks, or from them.
#[derive(Debug)]
pub(super) struct OneWay {
    heading: Heading,
    /// Vertices that take up any flow.
    stops: Vec<bool>,
    /// Whether each vertex sends a unit if it is active.
    senders: Vec<bool>,
    /// Each edge: the share that it sends from its first and second end.
    sent: Vec<[Option<usize>; 2]>,
    /// Each edge: the flow from its first and from its second end.
    along: Vec<[Option<usize>; 2]>,
}

/// Vertices from which given edges lead to a sink (for [`Heading::In`] to which
/// they lead from one), whatever else is active.
fn settled(problem: &Problem, heading: Heading) -> Vec<bool> {
    let runs = |e: usize, from: usize| problem.is_given(e) && problem.way(e).runs_from(from);
    let away = ways_to(problem, &problem.around(), &problem.sinks, heading, runs);
    away.into_iter().map(f64::is_finite).collect()
}

/// Whether given edges need a flow from vertices besides that from edges.
pub(super) fn has_orphans(problem: &Problem, heading: Heading) -> bool {
    let settled = settled(problem, heading);
    let mut ends = problem.ends.iter().enumerate();
    ends.any(|(e, ends)| problem.is_given(e) && ends.iter().any(|&v| !settled[v]))
}

/// Adds a flow from active vertices: rows (13).
pub(super) fn add_vertices(draft: &mut Draft<'_>, arcs: &Arcs, heading: Heading) -> OneWay {
    let problem = draft.problem;
    let stops = settled(problem, heading);
    let senders: Vec<bool> = (0..problem.vertices)
        .map(|v| !stops[v] && draft.y[v] != Term::Off)
        .collect();
    let most = senders.iter().filter(|&&sends| sends).count() as f64;
    let mut balance: Vec<Vec<(Term, f64)>> = (0..problem.vertices)
        .map(|v| {
            if senders[v] {
                vec![(draft.y[v], -1.0)]
            } else {
                Vec::new()
            }
        })
        .collect();
    let along = flow(draft, arcs, heading, &stops, most, 0.0, &mut balance);
    OneWay {
        heading,
        senders,
        sent: vec![[None; 2]; problem.edges()],
        along,
        stops,
    }
}

/// Adds a flow from active edges that were not given, which prices travel: rows
/// (13) and (14).
pub(super) fn add_edges(draft: &mut Draft<'_>, arcs: &Arcs, heading: Heading) -> OneWay {
    let problem = draft.problem;
    let mut balance: Vec<Vec<(Term, f64)>> = vec![Vec::new(); problem.vertices];
    let mut sent = vec![[None; 2]; problem.edges()];
    let mut most = 0.0;
    for (e, sent) in sent.iter_mut().enumerate() {
        if !draft.possible(e) || problem.is_given(e) {
            continue;
        }
        let ends = problem.ends[e];
        // By the end k the edge is left from if traffic runs over it to k.
        let to = |k: usize| arcs.run[e][heading.tail(1 - k)];
        let both_ways = to(0) == to(1);
        let leaves = [0, 1].map(|k| to(k) != Term::Off);
        let pays = |k: usize| !problem.sinks[ends[k]];
        if both_ways && !(pays(0) && pays(1)) || (0..2).all(|k| !(leaves[k] && pays(k))) {
            continue;
        }
        most += 1.0;
        let mut share = vec![(draft.x[e], -1.0)];
        for k in (0..2).filter(|&k| leaves[k]) {
            let column = draft.program.real(0.0, 1.0);
            sent[k] = Some(column);
            let h = Term::Column(column);
            share.push((h, 1.0));
            balance[ends[k]].push((h, -1.0));
            if !both_ways {
                draft.row(f64::NEG_INFINITY, 0.0, [(h, 1.0), (to(k), -1.0)]);
            }
        }
        draft.row(0.0, 0.0, share);
    }
    let weight = 0.5 * problem.travel_weight;
    let along = flow(
        draft,
        arcs,
        heading,
        &problem.sinks,
        most,
        weight,
        &mut balance,
    );
    OneWay {
        heading,
        stops: problem.sinks.clone(),
        senders: vec![false; problem.vertices],
        sent,
        along,
    }
}

/// The flow's columns, each edge's from its first and from its second end, and
/// its rows: `balance` holds what vertices send.
fn flow(
    draft: &mut Draft<'_>,
    arcs: &Arcs,
    heading: Heading,
    stops: &[bool],
    most: f64,
    weight: f64,
    balance: &mut [Vec<(Term, f64)>],
) -> Vec<[Option<usize>; 2]> {
    let problem = draft.problem;
    let mut along = vec![[None; 2]; problem.edges()];
    for (e, columns) in along.iter_mut().enumerate() {
        let ends = problem.ends[e];
        let run = |k: usize| arcs.run[e][heading.tail(k)];
        let mut flows = [None; 2];
        for k in 0..2 {
            let (from, to) = (ends[k], ends[1 - k]);
            if run(k) == Term::Off || stops[from] {
                continue;
            }
            let column = draft.program.real(weight * problem.travel_cost(e), most);
            columns[k] = Some(column);
            let f = Term::Column(column);
            flows[k] = Some(f);
            balance[from].push((f, 1.0));
            balance[to].push((f, -1.0));
        }
        match flows {
            // Traffic of one vertex takes one way or the other.
            [Some(there), Some(back)] if run(0) == run(1) => {
                let terms = [(there, 1.0), (back, 1.0), (run(0), -most)];
                draft.row(f64::NEG_INFINITY, 0.0, terms);
            }
            flows => {
                for (k, f) in flows.into_iter().enumerate() {
                    if let Some(f) = f {
                        draft.row(f64::NEG_INFINITY, 0.0, [(f, 1.0), (run(k), -most)]);
                    }
                }
            }
        }
    }
    for (v, terms) in balance.iter_mut().enumerate() {
        if !stops[v] {
            draft.row(0.0, 0.0, std::mem::take(terms));
        }
    }
    along
}

impl Fill for OneWay {
    /// Every unit along a least way.
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        let problem = known.problem;
        let way = |e: usize| known.streets.way(problem, e);
        let runs = |e: usize, from: usize| known.active[e] && way(e).runs_from(from);
        let around = problem.around();
        let away = ways_to(problem, &around, &self.stops, self.heading, runs);
        let mut carried = vec![0.0; problem.vertices];
        for (e, sent) in self.sent.iter().enumerate() {
            if !known.active[e] {
                continue;
            }
            let leaves = (0..2).filter(|&k| sent[k].is_some());
            let by = leaves
                .filter(|&k| runs(e, self.heading.tail(1 - k)))
                .min_by(|&a, &b| {
                    let [a, b] = [a, b].map(|k| away[problem.ends[e][k]]);
                    a.total_cmp(&b)
                });
            if let Some((k, column)) = by.and_then(|k| Some((k, sent[k]?))) {
                values[column] = 1.0;
                carried[problem.ends[e][k]] += 1.0;
            }
        }
        let mut order: Vec<usize> = (0..problem.vertices)
            .filter(|&v| away[v].is_finite() && !self.stops[v])
            .collect();
        order.sort_by(|&a, &b| away[b].total_cmp(&away[a]));
        for v in order {
            carried[v] += f64::from(u8::from(self.senders[v] && known.degree[v] > 0));
            // The way was computed as this very sum.
            let next = around[v].iter().find(|&&(e, w)| {
                let end = usize::from(problem.ends[e][1] == v);
                away[v] == away[w] + problem.travel_cost(e) && runs(e, self.heading.tail(end))
            });
            let Some(&(e, w)) = next else { continue };
            carried[w] += carried[v];
            if let Some(column) = self.along[e][usize::from(problem.ends[e][1] == v)] {
                values[column] = carried[v];
            }
        }
    }
}
