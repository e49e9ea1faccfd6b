//! Connectivity by a flow: the length objective (**F**).
//!
//! Each active vertex sends one unit to a sink over active edges:
//!
//! outflow - inflow = y_v at each v that is no sink,
//! f_ij + f_ji <= n x_e.   (7)
//!
//! n is the number of vertices that send. There are no distances and so no
//! large constants but n; of a solution only its length, patterns and rooms are
//! priced, travel is not.
//!
//! Given edges carry any flow and cost nothing, so vertices that they join are
//! one here: with a sink among them they are a sink; else they send one unit,
//! because a given street without a way to a sink is an island. What may become
//! a sink has an outlet, as [`sinks`](super::sinks) says.

use super::draft::{Draft, Fill, Known, Term};
use super::sinks::Outlets;

/// A flow between groups of vertices that given edges join.
#[derive(Debug)]
pub(super) struct Flow {
    /// The group of each vertex.
    group: Vec<usize>,
    /// Whether each group holds a sink.
    sink: Vec<bool>,
    /// Whether each group is of given edges, without a sink.
    orphan: Vec<bool>,
    /// The columns of each edge's flow from its first end and from its second.
    along: Vec<[Option<usize>; 2]>,
    outlets: Outlets,
}

/// Whether given edges are apart from every sink, so that more than the flow of
/// travel is needed to join them.
pub(super) fn has_orphans(draft: &Draft<'_>) -> bool {
    let (group, sink) = groups(draft);
    given(draft).any(|e| !sink[group[draft.problem.ends[e][0]]])
}

fn given<'d>(draft: &'d Draft<'_>) -> impl Iterator<Item = usize> + 'd {
    (0..draft.problem.edges()).filter(|&e| draft.problem.is_given(e))
}

fn groups(draft: &Draft<'_>) -> (Vec<usize>, Vec<bool>) {
    let mut group: Vec<usize> = (0..draft.problem.vertices).collect();
    fn root(group: &mut [usize], mut v: usize) -> usize {
        while group[v] != v {
            group[v] = group[group[v]];
            v = group[v];
        }
        v
    }
    for e in given(draft) {
        let [a, b] = draft.problem.ends[e].map(|v| root(&mut group, v));
        group[a.max(b)] = a.min(b);
    }
    let mut sink = vec![false; draft.problem.vertices];
    for v in 0..draft.problem.vertices {
        group[v] = root(&mut group, v);
        sink[group[v]] |= draft.problem.sinks[v];
    }
    (group, sink)
}

/// Adds columns and rows (7).
pub(super) fn add(draft: &mut Draft<'_>) -> Flow {
    let (group, sink) = groups(draft);
    let mut orphan = vec![false; sink.len()];
    for e in given(draft) {
        let g = group[draft.problem.ends[e][0]];
        orphan[g] = !sink[g];
    }
    let senders = (0..group.len()).filter(|&v| {
        let alone = group[v] == v && !sink[v];
        alone && (orphan[v] || draft.y[v] != Term::Off)
    });
    let senders: Vec<usize> = senders.collect();
    let most = senders.len() as f64;
    let mut balance: Vec<Vec<(Term, f64)>> = vec![Vec::new(); group.len()];
    let mut along = vec![[None; 2]; draft.problem.edges()];
    for (e, columns) in along.iter_mut().enumerate() {
        let [a, b] = draft.problem.ends[e].map(|v| group[v]);
        if a == b || !draft.possible(e) {
            continue;
        }
        let mut capacity = vec![(draft.x[e], -most)];
        for (k, (from, to)) in [(a, b), (b, a)].into_iter().enumerate() {
            if sink[from] {
                continue;
            }
            let column = draft.program.real(0.0, most);
            columns[k] = Some(column);
            let f = Term::Column(column);
            capacity.push((f, 1.0));
            balance[from].push((f, 1.0));
            balance[to].push((f, -1.0));
        }
        draft.row(f64::NEG_INFINITY, 0.0, capacity);
    }
    let outlets = Outlets::new(draft, most, |v| !sink[group[v]]);
    for v in 0..group.len() {
        if let Some(a) = outlets.at(v) {
            balance[group[v]].push((Term::Column(a), 1.0));
        }
    }
    for &v in &senders {
        let sends = if orphan[v] { Term::On } else { draft.y[v] };
        let mut terms = std::mem::take(&mut balance[v]);
        terms.push((sends, -1.0));
        draft.row(0.0, 0.0, terms);
    }
    Flow {
        group,
        sink,
        orphan,
        along,
        outlets,
    }
}

impl Fill for Flow {
    /// Every group's unit along a tree of fewest edges.
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        let count = self.group.len();
        let mut around = vec![Vec::new(); count];
        for (e, ends) in known.problem.ends.iter().enumerate() {
            let [a, b] = ends.map(|v| self.group[v]);
            if known.active[e] && a != b {
                around[a].push((e, b, 1));
                around[b].push((e, a, 0));
            }
        }
        // One of the chosen sinks of each group, where all of it leaves.
        let mut outlet = vec![None; count];
        let mut seen = self.sink.clone();
        for v in (0..count).filter(|&v| known.sinks[v]) {
            seen[self.group[v]] = true;
            if let Some(a) = self.outlets.at(v) {
                outlet[self.group[v]] = Some(a);
            }
        }
        let mut order: Vec<usize> = (0..count)
            .filter(|&v| self.group[v] == v && seen[v])
            .collect();
        let mut next = vec![None; count];
        let mut at = 0;
        while at < order.len() {
            let to = order[at];
            at += 1;
            // `side` is the end of the edge that the flow leaves from.
            for &(e, from, side) in &around[to] {
                if !seen[from] {
                    seen[from] = true;
                    next[from] = Some((e, to, side));
                    order.push(from);
                }
            }
        }
        let mut carried = vec![0.0; count];
        for &v in order.iter().rev() {
            let sends = self.orphan[v] || known.degree[v] > 0;
            carried[v] += f64::from(u8::from(sends));
            if let Some(a) = outlet[v] {
                values[a] = carried[v];
            }
            let Some((e, to, side)) = next[v] else {
                continue;
            };
            carried[to] += carried[v];
            if let Some(column) = self.along[e][side] {
                values[column] = carried[v];
            }
        }
    }
}
