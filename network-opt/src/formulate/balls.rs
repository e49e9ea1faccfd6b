//! Ball cuts: what coverage and connectivity say together.
//!
//! Let B be vertices of which one at least is active, by coverage, none of them
//! a sink; delta(B) the edges with one end in B. Then
//!
//! x(delta(B)) >= 1,   (6a)
//!
//! and, where dead ends are forbidden, for every set K of edges within B that
//! meets each cycle within B that may be active throughout,
//!
//! x(delta(B)) + x(K) >= 2.   (6b)
//!
//! *Proof.* Let v be active in B, and C the component of v in the graph of the
//! active edges within B. C reaches a sink, which is outside B, over an active
//! edge that leaves C; it is not within B, else it were in C; so it is in
//! delta(B). That is (6a). For (6b), if C contains a cycle, the cycle is active
//! throughout, K meets it, and K and delta(B) have no edge in common: 1 + 1. If
//! C is a single vertex, its edges, of which there are two at least, are all in
//! delta(B). Else C is a tree with two leaves at least; each leaf has two active
//! edges at least, one of them within B, so one in delta(B); and these are two
//! edges, because an edge of delta(B) has one end in B. []
//!
//! If v may become a sink, that is added to the left as often as stands on the
//! right: for all v of B where s_v is 0 the proof is the same.
//!
//! A cycle that contains all edges of a forbidden pattern (without inactive
//! edges) is never active throughout: with too close edges forbidden and a range
//! of two edges on a grid, only the cycle of eight edges around the middle is
//! left, and K may be any one edge of it.
//!
//! The flows of [`flow`](super::flow) and [`travel`](super::travel) follow from
//! none of this: a fractional flow may run through edges of capacity 1/n. On
//! 312 edges these cuts raise the bound at the root from 5.7 to 16 of 19.

use std::collections::BTreeSet;

use super::coverage::least_sets;
use super::cycles::meeting_sets;
use super::draft::{Draft, Term};

/// Adds cuts (6a) or (6b) for each set of coverage.
pub(super) fn add(draft: &mut Draft<'_>) {
    let sets = least_sets(draft);
    let patterns = never(draft);
    for set in sets {
        if set.iter().any(|&v| draft.s[v] == Term::On) {
            continue;
        }
        for (edges, least) in cuts(draft, &set, &patterns) {
            // Where a sink is placed within, the cut says nothing.
            let placed = set.iter().map(|&v| (draft.s[v], least));
            let terms = edges.iter().map(|&e| (draft.x[e], 1.0)).chain(placed);
            let terms: Vec<_> = terms.collect();
            draft.row(least, f64::INFINITY, terms);
        }
    }
}

/// Sets of edges with the number of them that is active at least, if one of the
/// vertices of `set`, none a sink, is active.
fn cuts(draft: &Draft<'_>, set: &[usize], never: &[Vec<usize>]) -> Vec<(Vec<usize>, f64)> {
    let ball: BTreeSet<usize> = set.iter().copied().collect();
    let mut within = BTreeSet::new();
    let mut leaving = BTreeSet::new();
    for &v in set {
        for &(e, w) in &draft.around[v] {
            if !draft.possible(e) {
                continue;
            }
            if ball.contains(&w) {
                within.insert(e);
            } else {
                leaving.insert(e);
            }
        }
    }
    let leaving: Vec<usize> = leaving.into_iter().collect();
    if draft.problem.dead_ends {
        return vec![(leaving, 1.0)];
    }
    let edges: Vec<(usize, [usize; 2])> = (within.iter())
        .map(|&e| (e, draft.problem.ends[e]))
        .collect();
    // The patterns of each edge, by their first.
    let mut forbidden: Vec<Vec<usize>> = Vec::new();
    for &e in &within {
        let patterns = never[e].iter().map(|&p| &draft.problem.patterns[p].active);
        let inside = patterns.filter(|active| active.iter().all(|k| within.contains(k)));
        forbidden.extend(inside.cloned());
    }
    let sets = meeting_sets(&edges, &forbidden);
    let cuts = sets.into_iter().map(|k| {
        let mut cut = leaving.clone();
        cut.extend(k);
        (cut, 2.0)
    });
    cuts.collect()
}

/// For each edge, the patterns whose edges are never all active, listed at the
/// first of them.
fn never(draft: &Draft<'_>) -> Vec<Vec<usize>> {
    let mut never = vec![Vec::new(); draft.problem.edges()];
    for (k, pattern) in draft.problem.patterns.iter().enumerate() {
        let plain = pattern.inactive.iter().all(|&e| draft.x[e] == Term::Off);
        if let (None, true, Some(&first)) = (pattern.cost, plain, pattern.active.first()) {
            never[first].push(k);
        }
    }
    never
}
