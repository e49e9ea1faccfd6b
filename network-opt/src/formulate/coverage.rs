//! Coverage.
//!
//! For each place, with B the vertices that cover it (equation 6)
//!
//! sum of y_u over u in B >= 1.   (3)
//!
//! A row whose set holds another's follows from that and is left out.

use std::collections::BTreeSet;

use super::draft::{Draft, Term};

/// Adds rows (3) but dominated ones.
pub(super) fn add(draft: &mut Draft<'_>) {
    let sets = least_sets(draft);
    for set in sets {
        let terms = set.into_iter().map(|v| (draft.y[v], 1.0));
        let terms: Vec<_> = terms.collect();
        draft.row(1.0, f64::INFINITY, terms);
    }
}

/// The sets of vertices of which one has to be active, without vertices that
/// cannot be, without sets that hold one that is, and without sets that hold
/// another; shortest first.
pub(super) fn least_sets(draft: &Draft<'_>) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = (draft.problem.coverage.iter())
        .filter(|ball| ball.iter().all(|&v| draft.y[v] != Term::On))
        .map(|ball| {
            let mut set: Vec<usize> = ball.clone();
            set.retain(|&v| draft.y[v] != Term::Off);
            set.sort_unstable();
            set.dedup();
            set
        })
        .collect();
    sets.sort_by(|a, b| a.len().cmp(&b.len()).then_with(|| a.cmp(b)));
    // By their first vertex, which is in every set that holds them.
    let mut kept: Vec<Vec<BTreeSet<usize>>> = vec![Vec::new(); draft.problem.vertices];
    let mut empty = false;
    sets.retain(|set| {
        let own: BTreeSet<usize> = set.iter().copied().collect();
        let mut smaller = own.iter().flat_map(|&v| &kept[v]);
        let free = !empty && !smaller.any(|smaller| smaller.is_subset(&own));
        if free {
            match set.first() {
                Some(&first) => kept[first].push(own),
                None => empty = true,
            }
        }
        free
    });
    sets
}
