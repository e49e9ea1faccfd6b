//! The cycles within a few edges, and the sets of edges that meet all of them.

use std::collections::BTreeSet;

use super::draft::{Draft, Term};

/// Steps of the search for cycles before it is given up.
const STEPS: usize = 20_000;
/// Sets of edges that are kept.
const SETS: usize = 24;

/// The cycles of a small graph, and what meets them.
#[derive(Debug)]
pub(super) struct Cycles {
    /// All of them, each with its edges ascending; `None` if they are too many.
    pub(super) all: Option<Vec<Vec<usize>>>,
    /// Sets of edges, each of which meets every cycle; one empty set if there
    /// is no cycle. At least one, none twice, in a fixed order, edges ascending.
    ///
    /// That the least ones or all are found is not promised: where cycles are
    /// too many to be listed, the one set is of the edges outside a spanning
    /// forest, which every cycle meets.
    pub(super) sets: Vec<Vec<usize>>,
}

/// The cycles that do not contain one of the `forbidden` sets; `edges` are
/// numbers with their two ends.
pub(super) fn cycles_within(edges: &[(usize, [usize; 2])], forbidden: &[Vec<usize>]) -> Cycles {
    let all = cycles(edges, forbidden);
    let sets = match &all {
        Some(cycles) => transversals(cycles),
        None => vec![outside_forest(edges)],
    };
    Cycles { all, sets }
}

/// All simple cycles without a forbidden set, each once, its edges ascending;
/// `None` if the search takes too long.
fn cycles(edges: &[(usize, [usize; 2])], forbidden: &[Vec<usize>]) -> Option<Vec<Vec<usize>>> {
    let mut vertices: Vec<usize> = edges.iter().flat_map(|&(_, ends)| ends).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut search = Search {
        around: vec![Vec::new(); vertices.len()],
        forbidden,
        path: Vec::new(),
        on_path: vec![false; vertices.len()],
        found: BTreeSet::new(),
        steps: 0,
    };
    for &(e, ends) in edges {
        let [a, b] = ends.map(|v| vertices.partition_point(|&w| w < v));
        search.around[a].push((e, b));
        search.around[b].push((e, a));
    }
    for root in 0..vertices.len() {
        search.on_path[root] = true;
        search.extend(root, root)?;
        search.on_path[root] = false;
    }
    Some(search.found.into_iter().collect())
}

struct Search<'a> {
    around: Vec<Vec<(usize, usize)>>,
    forbidden: &'a [Vec<usize>],
    path: Vec<usize>,
    on_path: Vec<bool>,
    found: BTreeSet<Vec<usize>>,
    steps: usize,
}

impl Search<'_> {
    /// Extends a path that began at `root` over vertices after it.
    fn extend(&mut self, root: usize, at: usize) -> Option<()> {
        self.steps += 1;
        if self.steps > STEPS {
            return None;
        }
        for k in 0..self.around[at].len() {
            let (e, to) = self.around[at][k];
            if to < root || self.path.last() == Some(&e) || (self.on_path[to] && to != root) {
                continue;
            }
            self.path.push(e);
            if self.is_allowed(e) {
                if to == root {
                    if self.path.len() > 1 {
                        let mut cycle = self.path.clone();
                        cycle.sort_unstable();
                        self.found.insert(cycle);
                    }
                } else {
                    self.on_path[to] = true;
                    self.extend(root, to)?;
                    self.on_path[to] = false;
                }
            }
            self.path.pop();
        }
        Some(())
    }

    /// Whether the path holds no forbidden set with its last edge in it.
    fn is_allowed(&self, last: usize) -> bool {
        !self
            .forbidden
            .iter()
            .any(|set| set.contains(&last) && set.iter().all(|e| self.path.contains(e)))
    }
}

/// Edges of a cycle from which on its length is not told any more.
const LONGEST: usize = 12;
/// Steps of the search for the least cycle before it is given up.
const LEAST_STEPS: usize = 2_000_000;

/// A number of edges than which no cycle has fewer that may be active
/// throughout; `None` if there is no cycle at all.
pub(super) fn least_cycle(draft: &Draft<'_>) -> Option<usize> {
    let possible: Vec<usize> = (0..draft.problem.edges())
        .filter(|&e| draft.possible(e))
        .collect();
    let ends: Vec<(usize, [usize; 2])> = (possible.iter())
        .map(|&e| (e, draft.problem.ends[e]))
        .collect();
    if outside_forest(&ends).is_empty() {
        return None;
    }
    let mut forbidden: Vec<Vec<&[usize]>> = vec![Vec::new(); draft.problem.edges()];
    for pattern in draft.problem.patterns.iter().filter(|p| p.cost.is_none()) {
        if pattern.inactive.iter().all(|&e| draft.x[e] == Term::Off) {
            for &e in &pattern.active {
                forbidden[e].push(&pattern.active);
            }
        }
    }
    let mut steps = 0;
    // Two edges with the same ends are a cycle.
    for length in 2..LONGEST {
        let mut path = Vec::new();
        for root in 0..draft.problem.vertices {
            let mut on_path = vec![root];
            let found = closes(
                draft,
                &forbidden,
                length,
                &mut path,
                &mut on_path,
                &mut steps,
            );
            if found || steps > LEAST_STEPS {
                return Some(length);
            }
        }
    }
    Some(LONGEST)
}

/// Whether a path from its first vertex can be closed to a cycle of `length`
/// edges over vertices after that.
fn closes(
    draft: &Draft<'_>,
    forbidden: &[Vec<&[usize]>],
    length: usize,
    path: &mut Vec<usize>,
    on_path: &mut Vec<usize>,
    steps: &mut usize,
) -> bool {
    *steps += 1;
    let (root, at) = (on_path[0], on_path[on_path.len() - 1]);
    let last = path.len() + 1 == length;
    for &(e, to) in &draft.around[at] {
        let goes = if last {
            to == root
        } else {
            to > root && !on_path.contains(&to)
        };
        if !goes || !draft.possible(e) || path.contains(&e) || *steps > LEAST_STEPS {
            continue;
        }
        path.push(e);
        on_path.push(to);
        let allowed = !forbidden[e]
            .iter()
            .any(|set| set.iter().all(|k| path.contains(k)));
        let found = allowed && (last || closes(draft, forbidden, length, path, on_path, steps));
        path.pop();
        on_path.pop();
        if found {
            return true;
        }
    }
    false
}

/// Sets with an edge of each cycle: an edge of the shortest cycle that is not
/// met, each in turn.
fn transversals(cycles: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut found: BTreeSet<Vec<usize>> = BTreeSet::new();
    let mut open: Vec<Vec<usize>> = vec![Vec::new()];
    while let Some(set) = open.pop() {
        if found.len() >= SETS {
            break;
        }
        let missed = cycles.iter().filter(|c| !c.iter().any(|e| set.contains(e)));
        match missed.min_by_key(|c| c.len()) {
            None => {
                let mut set = set;
                set.sort_unstable();
                found.insert(set);
            }
            Some(cycle) => open.extend(cycle.iter().rev().map(|&e| {
                let mut larger = set.clone();
                larger.push(e);
                larger
            })),
        }
    }
    // Of two sets, one within the other, the smaller says more.
    let all: Vec<Vec<usize>> = found.into_iter().collect();
    let least = all.iter().filter(|set| {
        !all.iter()
            .any(|other| other.len() < set.len() && other.iter().all(|e| set.contains(e)))
    });
    least.cloned().collect()
}

fn outside_forest(edges: &[(usize, [usize; 2])]) -> Vec<usize> {
    let most = edges.iter().flat_map(|(_, ends)| ends).max();
    let mut group: Vec<usize> = (0..=most.copied().unwrap_or(0)).collect();
    let mut outside = Vec::new();
    for &(e, [a, b]) in edges {
        let (from, to) = (group[a], group[b]);
        if from == to {
            outside.push(e);
        } else {
            group
                .iter_mut()
                .filter(|g| **g == from)
                .for_each(|g| *g = to);
        }
    }
    outside
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A window of two by two panes; edges by rows, then by columns.
    fn window() -> Vec<(usize, [usize; 2])> {
        let across = (0..9).filter(|v| v % 3 < 2).map(|v| [v, v + 1]);
        let up = (0..6).map(|v| [v, v + 3]);
        across.chain(up).enumerate().collect()
    }

    /// What forbids two opposite edges of a pane.
    fn too_close() -> Vec<Vec<usize>> {
        let pairs = [
            (0, 2),
            (1, 3),
            (2, 4),
            (3, 5),
            (6, 7),
            (7, 8),
            (9, 10),
            (10, 11),
        ];
        pairs.map(|(a, b)| vec![a, b]).to_vec()
    }

    #[test]
    fn the_cycles_of_a_window_are_counted() {
        // 4 panes, 4 pairs, 4 corners of three, all four, and around the middle
        // none but that: 4 + 4 + 4 + 1.
        assert_eq!(cycles(&window(), &[]).expect("few").len(), 13);
        // Without too close edges only the frame.
        let frame = cycles(&window(), &too_close()).expect("few");
        assert_eq!(frame, [vec![0, 1, 4, 5, 6, 8, 9, 11]]);
        let sets = cycles_within(&window(), &too_close()).sets;
        assert_eq!(sets.len(), 8);
        assert!(sets.iter().all(|set| set.len() == 1));
    }

    #[test]
    fn every_set_meets_every_cycle() {
        let sets = cycles_within(&window(), &[]).sets;
        let all = cycles(&window(), &[]).expect("few");
        let forest = outside_forest(&window());
        // 12 edges, 9 vertices, 4 independent cycles.
        assert_eq!(forest.len(), 4);
        for set in sets.iter().chain([&forest]) {
            assert!(
                all.iter().all(|c| c.iter().any(|e| set.contains(e))),
                "{set:?}"
            );
        }
        // A tree has no cycle.
        let tree = cycles_within(&window()[..4], &[]);
        assert_eq!(tree.sets, [Vec::<usize>::new()]);
        assert_eq!(tree.all, Some(vec![]));
    }

    #[test]
    fn the_least_cycle_has_no_forbidden_pattern() {
        let ends: Vec<[usize; 2]> = window().into_iter().map(|(_, ends)| ends).collect();
        let pattern = |active| crate::design::Pattern {
            kind: crate::design::PatternKind::TooClose,
            active,
            inactive: vec![],
            cost: None,
        };
        let mut problem = crate::design::Problem {
            vertices: 9,
            lengths: vec![1.0; ends.len()],
            states: vec![Default::default(); ends.len()],
            sinks: (0..9).map(|v| v == 4).collect(),
            ends,
            length_weight: 1.0,
            dead_ends: true,
            ..Default::default()
        };
        // A pane; without too close edges only the frame.
        assert_eq!(least_cycle(&Draft::new(&problem)), Some(4));
        problem.patterns = too_close().into_iter().map(pattern).collect();
        assert_eq!(least_cycle(&Draft::new(&problem)), Some(8));
        // Without one of its edges none, which is not noticed; but all that is
        // looked for are cycles of less than twelve.
        problem.states[0] = crate::design::EdgeState::Closed;
        assert_eq!(least_cycle(&Draft::new(&problem)), Some(LONGEST));
        // A tree has none.
        problem.states[1..6].fill(crate::design::EdgeState::Closed);
        assert_eq!(least_cycle(&Draft::new(&problem)), None);
    }

    #[test]
    fn too_many_cycles_are_not_listed() {
        let n = 12;
        let complete: Vec<[usize; 2]> = (0..n).flat_map(|a| (0..a).map(move |b| [b, a])).collect();
        let edges: Vec<_> = complete.into_iter().enumerate().collect();
        assert_eq!(cycles(&edges, &[]), None);
        let Cycles { all, sets } = cycles_within(&edges, &[]);
        assert_eq!((all, sets.len()), (None, 1));
        assert_eq!(sets[0].len(), n * (n - 1) / 2 - (n - 1));
    }
}
