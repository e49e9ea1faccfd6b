//! The local features of a specification as patterns of edges.

use super::{Feature, Specification};
use crate::design::problem::{EdgeState, Pattern, PatternKind};
use crate::design::tessellation::Tessellation;

impl Specification {
    /// All patterns that can occur and are not free.
    pub(super) fn patterns(&self, mesh: &Tessellation, states: &[EdgeState]) -> Vec<Pattern> {
        let mut patterns = Vec::new();
        let mut add = |kind, active: Vec<usize>, inactive: Vec<usize>, feature: Feature| {
            // What a closed edge is part of cannot occur.
            let closed = |&e: &usize| states[e] == EdgeState::Closed;
            let given = |&e: &usize| states[e] == EdgeState::Given;
            if active.iter().any(closed) || inactive.iter().any(given) || active.iter().all(given) {
                return;
            }
            if let Some(cost) = feature.cost() {
                patterns.push(Pattern {
                    kind,
                    active,
                    inactive,
                    cost,
                });
            }
        };
        for pair in mesh.opposite_edges() {
            add(PatternKind::TooClose, pair.to_vec(), vec![], self.too_close);
        }
        for path in mesh.zig_zags() {
            add(PatternKind::ZigZag, path.to_vec(), vec![], self.zig_zags);
        }
        for v in 0..mesh.points().len() {
            let around: Vec<usize> = mesh.around(v).iter().map(|&(e, _)| e).collect();
            let others = |e: usize| {
                around
                    .iter()
                    .copied()
                    .filter(move |&o| o != e)
                    .collect::<Vec<_>>()
            };
            if around.len() == 4 {
                for &e in &around {
                    add(PatternKind::TJunction, others(e), vec![e], self.t_junctions);
                }
            }
            // Three of them at once: all that more than two comes to.
            for (i, &a) in around.iter().enumerate() {
                for (j, &b) in around.iter().enumerate().skip(i + 1) {
                    for &c in &around[j + 1..] {
                        add(PatternKind::Branch, vec![a, b, c], vec![], self.branches);
                    }
                }
            }
            if let Feature::Weighted(_) = self.dead_ends {
                for &e in &around {
                    add(PatternKind::DeadEnd, vec![e], others(e), self.dead_ends);
                }
            }
        }
        patterns
    }
}
