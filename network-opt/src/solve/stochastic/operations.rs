//! The four kinds of operations.

use super::draft::Draft;
use crate::design::{EdgeState, Problem};

/// All operations on a network, as the edges that they toggle, ascending: one
/// edge, two that share a vertex or three in a row deleted, or one added.
pub(super) fn operations(problem: &Problem, draft: &Draft<'_>) -> Vec<Vec<usize>> {
    let is_free = |e: usize| problem.states[e] == EdgeState::Open;
    let gone = |e: usize| is_free(e) && draft.active()[e];
    let mut all = Vec::new();
    for (e, &ends) in problem.ends.iter().enumerate() {
        if is_free(e) {
            all.push(vec![e]);
        }
        if !gone(e) {
            continue;
        }
        let [left, right] = ends.map(|v| {
            let others = draft.around(v).iter().map(|&(other, _)| other);
            others
                .filter(move |&o| o != e && gone(o))
                .collect::<Vec<_>>()
        });
        // Two edges with both ends in common are one pair.
        let pairs = left
            .iter()
            .chain(right.iter().filter(|o| !left.contains(o)));
        all.extend(pairs.filter(|&&o| o > e).map(|&o| vec![e, o]));
        for &a in &left {
            for &b in right.iter().filter(|&&b| b != a) {
                let mut three = vec![a, e, b];
                three.sort_unstable();
                all.push(three);
            }
        }
    }
    all.sort_unstable();
    // Three edges in a ring are in a row three times.
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of four edges: 4 singles, 3 pairs, 2 triples, all to delete.
    #[test]
    fn a_path_has_nine() {
        let problem = Problem {
            vertices: 5,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 4]],
            lengths: vec![1.0; 4],
            states: vec![EdgeState::Open; 4],
            sinks: vec![true; 5],
            ..Problem::default()
        };
        let mut draft = Draft::new(&problem, None);
        assert_eq!(operations(&problem, &draft).len(), 9);
        // Without the second edge: it can be added, three deleted, and a pair.
        draft.toggle(&[1]);
        let all = operations(&problem, &draft);
        assert_eq!(all, [vec![0], vec![1], vec![2], vec![2, 3], vec![3]]);
    }

    /// A triangle is one triple.
    #[test]
    fn a_triangle_has_seven() {
        let problem = Problem {
            vertices: 3,
            ends: vec![[0, 1], [1, 2], [2, 0]],
            lengths: vec![1.0; 3],
            states: vec![EdgeState::Open; 3],
            sinks: vec![true; 3],
            ..Problem::default()
        };
        assert_eq!(operations(&problem, &Draft::new(&problem, None)).len(), 7);
    }
}
