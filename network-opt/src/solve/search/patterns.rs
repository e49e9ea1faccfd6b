//! Patterns made ready for the search, and what follows from forbidden ones.

use super::lists::Lists;
use super::model::{Fate, Hopeless};
use crate::design::Problem;

/// A pattern of at most three active edges, seen from one of them: it costs so
/// much if the others are active too, those to be inactive left aside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triple {
    /// The other edges; twice the same if there is only one, and the edge itself
    /// if there is none.
    pub(super) others: [usize; 2],
    /// Infinite if it is forbidden.
    pub(super) cost: f64,
    pub(super) pattern: usize,
}

/// The literals of each pattern that can occur.
pub(super) fn literals(problem: &Problem) -> (Lists<(usize, bool)>, Vec<Option<f64>>) {
    let mut lists = Vec::with_capacity(problem.patterns.len());
    let mut costs = Vec::with_capacity(problem.patterns.len());
    for pattern in &problem.patterns {
        if pattern.cost == Some(0.0) || pattern.active.iter().any(|e| pattern.inactive.contains(e))
        {
            continue;
        }
        let on = pattern.active.iter().map(|&e| (e, true));
        let mut list: Vec<_> = on
            .chain(pattern.inactive.iter().map(|&e| (e, false)))
            .collect();
        list.sort_unstable();
        list.dedup();
        lists.push(list);
        costs.push(pattern.cost);
    }
    (Lists::new(lists), costs)
}

/// The short patterns by edge, but those that cannot occur.
pub(super) fn triples(
    patterns: &Lists<(usize, bool)>,
    costs: &[Option<f64>],
    fates: &[Fate],
) -> Lists<Triple> {
    let mut found = vec![Vec::new(); fates.len()];
    for (pattern, cost) in costs.iter().enumerate() {
        let list = patterns.of(pattern);
        let never = |&(e, on): &(usize, bool)| fates[e] == if on { Fate::Off } else { Fate::On };
        let active: Vec<usize> = list.iter().filter(|l| l.1).map(|l| l.0).collect();
        // An edge alone that is dear, or two or three; a dead end is none of them,
        // since a path goes on.
        let alone = active.len() == 1 && list.len() == 1;
        if !(alone || (2..=3).contains(&active.len())) || list.iter().any(never) {
            continue;
        }
        for &e in &active {
            let mut others = active.iter().copied().filter(|&k| k != e);
            let first = others.next().unwrap_or(e);
            found[e].push(Triple {
                others: [first, others.next().unwrap_or(first)],
                cost: cost.unwrap_or(f64::INFINITY),
                pattern,
            });
        }
    }
    Lists::new(found)
}

/// Draws conclusions from forbidden patterns of which one literal is left, and
/// from vertices where an edge alone would be a dead end.
pub(super) fn decide(
    problem: &Problem,
    around: &Lists<(usize, usize)>,
    (patterns, costs): (&Lists<(usize, bool)>, &[Option<f64>]),
    may_sink: &[bool],
    fates: &mut [Fate],
) -> Result<(), Hopeless> {
    loop {
        let mut changed = false;
        for (p, _) in costs.iter().enumerate().filter(|(_, cost)| cost.is_none()) {
            let holds = |(e, wanted): (usize, bool)| match fates[e] {
                Fate::Open => None,
                Fate::On => Some(wanted),
                Fate::Off => Some(!wanted),
            };
            let list = patterns.of(p);
            if list.iter().any(|&l| holds(l) == Some(false)) {
                continue;
            }
            let mut open = list.iter().filter(|&&l| holds(l).is_none());
            match (open.next(), open.next()) {
                (None, _) => return Err(Hopeless),
                (Some(&(e, wanted)), None) => {
                    fates[e] = if wanted { Fate::Off } else { Fate::On };
                    changed = true;
                }
                _ => {}
            }
        }
        for v in (0..problem.vertices).filter(|&v| !problem.dead_ends && !may_sink[v]) {
            let mut usable = around.of(v).iter().filter(|&&(e, _)| fates[e] != Fate::Off);
            if let (Some(&(e, _)), None) = (usable.next(), usable.next()) {
                if fates[e] == Fate::On {
                    return Err(Hopeless);
                }
                fates[e] = Fate::Off;
                changed = true;
            }
        }
        if !changed {
            return Ok(());
        }
    }
}
