//! What is known of each edge before any program is solved.

use super::reach::useful;
use crate::design::{EdgeState, Problem};

/// Whether an edge is active in every valid network, in none, or in some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// In none.
    Off,
    /// In all.
    On,
    /// Not known.
    Open,
}

/// Decides edges by what a problem forbids, until nothing more follows:
///
/// - given and required edges are on, closed ones off;
/// - the last edge that is not decided of a forbidden [pattern](crate::design::Pattern)
///   is decided so that the pattern does not occur: where one edge of a quad is
///   given, and too close edges are forbidden, the edge across it is off;
/// - where dead ends are forbidden, the last edge at a vertex that is no sink is
///   off, and the last beside an edge that is on is on;
/// - edges that no sink can be reached from are off, and with one-way streets
///   those that cannot be reached from a sink.
///
/// Edges that the problem demands stay on, whatever follows: the program says
/// then that there is no network. No valid network is lost (a law of
/// `tests/design_props.rs`).
#[must_use]
pub fn prepare(problem: &Problem) -> Vec<Fate> {
    let mut fates: Vec<Fate> = (problem.states.iter())
        .map(|state| match state {
            EdgeState::Open => Fate::Open,
            EdgeState::Given | EdgeState::Required => Fate::On,
            EdgeState::Closed => Fate::Off,
        })
        .collect();
    let around = problem.around();
    // What may become a sink may be a dead end, or what others lead to.
    let sinks = problem.possible_sinks();
    loop {
        let before = fates.clone();
        patterns(problem, &mut fates);
        if !problem.dead_ends {
            dead_ends(&sinks, &around, &mut fates);
        }
        islands(problem, &sinks, &around, &mut fates);
        if fates == before {
            return fates;
        }
    }
}

fn patterns(problem: &Problem, fates: &mut [Fate]) {
    for pattern in problem.patterns.iter().filter(|p| p.cost.is_none()) {
        let wanted = pattern.active.iter().map(|&e| (e, Fate::On, Fate::Off));
        let unwanted = pattern.inactive.iter().map(|&e| (e, Fate::Off, Fate::On));
        let mut last = None;
        let mut open = 0;
        let mut happens = true;
        for (edge, occurs, avoids) in wanted.chain(unwanted) {
            if fates[edge] == Fate::Open {
                // An edge may be named twice.
                open += usize::from(last != Some((edge, avoids)));
                last = Some((edge, avoids));
            } else {
                happens &= fates[edge] == occurs;
            }
        }
        if let (true, 1, Some((edge, avoids))) = (happens, open, last) {
            fates[edge] = avoids;
        }
    }
}

fn dead_ends(sinks: &[bool], around: &[Vec<(usize, usize)>], fates: &mut [Fate]) {
    // Vertices whose edges have changed, so that a chain of dead ends is
    // removed in one go.
    let mut queue: Vec<usize> = (0..sinks.len()).collect();
    while let Some(v) = queue.pop() {
        if sinks[v] {
            continue;
        }
        let count = |fate| around[v].iter().filter(|&&(e, _)| fates[e] == fate).count();
        let decided = match (count(Fate::On), count(Fate::Open)) {
            (0, 1) => Fate::Off,
            (1, 1) => Fate::On,
            _ => continue,
        };
        for &(e, w) in &around[v] {
            if fates[e] == Fate::Open {
                fates[e] = decided;
                queue.push(w);
            }
        }
    }
}

fn islands(problem: &Problem, sinks: &[bool], around: &[Vec<(usize, usize)>], fates: &mut [Fate]) {
    if problem.has_one_way() {
        let useful = useful(problem, &|e| fates[e] != Fate::Off);
        for (e, ends) in problem.ends.iter().enumerate() {
            if fates[e] == Fate::Open && ends.iter().any(|&v| !useful[v]) {
                fates[e] = Fate::Off;
            }
        }
        return;
    }
    let mut reached = sinks.to_vec();
    let mut queue: Vec<usize> = (0..problem.vertices).filter(|&v| reached[v]).collect();
    while let Some(v) = queue.pop() {
        for &(e, w) in &around[v] {
            if fates[e] != Fate::Off && !reached[w] {
                reached[w] = true;
                queue.push(w);
            }
        }
    }
    for (e, &[a, _]) in problem.ends.iter().enumerate() {
        if fates[e] == Fate::Open && !reached[a] {
            fates[e] = Fate::Off;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Pattern, PatternKind};

    /// A path 0-1-2-3 with the sink at 0, and an edge 4-5 apart.
    fn path() -> Problem {
        Problem {
            vertices: 6,
            ends: vec![[0, 1], [1, 2], [2, 3], [4, 5]],
            lengths: vec![1.0; 4],
            states: vec![EdgeState::Open; 4],
            sinks: vec![true, false, false, false, false, false],
            length_weight: 1.0,
            dead_ends: true,
            ..Problem::default()
        }
    }

    #[test]
    fn what_leads_nowhere_is_off() {
        use Fate::{Off, On, Open};
        let mut problem = path();
        assert_eq!(prepare(&problem), [Open, Open, Open, Off]);
        problem.dead_ends = false;
        assert_eq!(prepare(&problem), [Off; 4]);
        // With a second sink the path may stay, all of it or nothing.
        problem.sinks[3] = true;
        assert_eq!(prepare(&problem), [Open, Open, Open, Off]);
        problem.states[1] = EdgeState::Given;
        assert_eq!(prepare(&problem), [On, On, On, Off]);
    }

    #[test]
    fn the_last_edge_of_a_pattern_is_decided() {
        use Fate::{Off, On, Open};
        let mut problem = path();
        let pattern = |active: &[usize], inactive: &[usize]| Pattern {
            kind: PatternKind::TooClose,
            active: active.to_vec(),
            inactive: inactive.to_vec(),
            cost: None,
        };
        problem.states[0] = EdgeState::Given;
        problem.patterns = vec![pattern(&[0, 2], &[])];
        assert_eq!(prepare(&problem), [On, Open, Off, Off]);
        problem.patterns = vec![pattern(&[0], &[2])];
        assert_eq!(prepare(&problem), [On, Open, On, Off]);
        // A contradiction is left for the program to see.
        problem.states[2] = EdgeState::Required;
        problem.patterns = vec![pattern(&[0, 2], &[])];
        assert_eq!(prepare(&problem), [On, Open, On, Off]);
    }
}
