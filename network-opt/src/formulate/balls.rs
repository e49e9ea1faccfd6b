//! Ball cuts: what coverage and connectivity say together.
//!
//! Let B be vertices of which one at least is active, by coverage, none of them
//! a sink; delta(B) the edges with one end in B. Then
//!
//! x(delta(B)) >= 1,   (6a)
//!
//! and, where dead ends are forbidden, with a column r_B that is 1 if delta(B)
//! has a single active edge,
//!
//! x(delta(B)) + r_B >= 2,   (6b)
//! r_B <= x(K)   (6c)
//!
//! for every set K of edges within B that meets each cycle within B that may be
//! active throughout; without such a cycle r_B is 0.
//!
//! *Proof.* Let v be active in B, and C the component of v in the graph of the
//! active edges within B. C reaches a sink, which is outside B, over an active
//! edge that leaves C; it is not within B, else it were in C; so it is in
//! delta(B). That is (6a), and (6b). For (6c), let that be the only active edge
//! of delta(B). C is no single vertex, because that has two edges at least, all
//! of them in delta(B). It is no tree with two leaves or more either: each leaf
//! has two active edges at least, one of them within B, so one in delta(B); and
//! these are two edges, because an edge of delta(B) has one end in B. So C
//! contains a cycle, which is active throughout, and K meets it. []
//!
//! If v may become a sink, that is added to the left of (6a) and (6b) as often
//! as stands on the right, and r_B is 0 where one is placed in B: for all v of B
//! where s_v is 0 the proof is the same.
//!
//! A cycle that contains all edges of a forbidden pattern (without inactive
//! edges) is never active throughout: with too close edges forbidden and a range
//! of two edges on a grid, only the cycle of eight edges around the middle is
//! left, and K may be any one edge of it.
//!
//! Let K be one edge e for all sets B of a family, and let no two of them have
//! such a cycle in common. Then
//!
//! sum of r_B over the family <= x_e.   (6d)
//!
//! *Proof.* Let r_B and r_B' be 1, and C and C' the cycles of the proof above:
//! both pass e. C' is not within B, else it were a cycle of both; so it has
//! vertices in B, the ends of e, and others, and passes delta(B) twice at least,
//! where only one edge is active. So one of all r_B is 1 at most, and then x_e
//! is 1 by (6c). []
//!
//! On a grid every edge is in the cycles around four vertices. Without (6d) a
//! relaxation holds small parts of all four.
//!
//! The flows of [`flow`](super::flow) and [`travel`](super::travel) follow from
//! none of this: a fractional flow may run through edges of capacity 1/n. On
//! 312 edges these cuts raise the bound at the root from 5.7 to 16 of 19.

use std::collections::{BTreeMap, BTreeSet};

use super::coverage::least_sets;
use super::cycles::{cycles_within, Cycles};
use super::draft::{Draft, Fill, Known, Term};

/// The columns r_B.
#[derive(Debug, Default)]
pub(super) struct Rings {
    rings: Vec<Ring>,
}

/// A set B in which a cycle may be active.
#[derive(Debug)]
struct Ring {
    /// r_B.
    column: usize,
    set: Vec<usize>,
    leaving: Vec<usize>,
    /// Its cycles, unless they are too many.
    cycles: Option<Vec<Vec<usize>>>,
}

/// Adds cuts (6a), or (6b) to (6d), for each set of coverage.
pub(super) fn add(draft: &mut Draft<'_>) -> Rings {
    let patterns = never(draft);
    let mut rings = Rings::default();
    // The rings of each set K.
    let mut met: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for set in least_sets(draft) {
        if set.iter().any(|&v| draft.s[v] == Term::On) {
            continue;
        }
        let (leaving, within) = edges_of(draft, &set);
        let least = if draft.problem.dead_ends { 1.0 } else { 2.0 };
        // Where a sink is placed within, the cut says nothing.
        let placed = set.iter().map(|&v| (draft.s[v], least));
        let terms = leaving.iter().map(|&e| (draft.x[e], 1.0)).chain(placed);
        let mut terms: Vec<_> = terms.collect();
        if !draft.problem.dead_ends {
            let Cycles { all, sets } = cycles_of(draft, &within, &patterns);
            if !sets.iter().any(Vec::is_empty) {
                let column = draft.program.real(0.0, 1.0);
                terms.push((Term::Column(column), 1.0));
                for k in sets {
                    met.entry(k).or_default().push(rings.rings.len());
                }
                rings.rings.push(Ring {
                    column,
                    set,
                    leaving,
                    cycles: all,
                });
            }
        }
        draft.row(least, f64::INFINITY, terms);
    }
    for (k, members) in met {
        for family in rings.families(&k, &members) {
            let edges = k.iter().map(|&e| (draft.x[e], 1.0));
            let rings = family.iter().map(|&r| &rings.rings[r]);
            let terms = edges.chain(rings.map(|r| (Term::Column(r.column), -1.0)));
            let terms: Vec<_> = terms.collect();
            draft.row(0.0, f64::INFINITY, terms);
        }
    }
    rings
}

/// The edges that leave a set and those within that may be active, ascending.
fn edges_of(draft: &Draft<'_>, set: &[usize]) -> (Vec<usize>, Vec<usize>) {
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
    (leaving.into_iter().collect(), within.into_iter().collect())
}

/// The cycles of some edges that may be active throughout.
fn cycles_of(draft: &Draft<'_>, within: &[usize], never: &[Vec<usize>]) -> Cycles {
    let edges: Vec<(usize, [usize; 2])> = (within.iter())
        .map(|&e| (e, draft.problem.ends[e]))
        .collect();
    // The patterns of each edge, by their first.
    let mut forbidden: Vec<Vec<usize>> = Vec::new();
    for &e in within {
        let patterns = never[e].iter().map(|&p| &draft.problem.patterns[p].active);
        let inside = patterns.filter(|active| {
            let mut active = active.iter();
            active.all(|k| within.binary_search(k).is_ok())
        });
        forbidden.extend(inside.cloned());
    }
    cycles_within(&edges, &forbidden)
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

impl Rings {
    /// The rings whose cycles K meets, in families of (6d).
    fn families(&self, k: &[usize], members: &[usize]) -> Vec<Vec<usize>> {
        let mut families: Vec<Vec<usize>> = Vec::new();
        for &ring in members {
            let fits = |family: &&mut Vec<usize>| {
                k.len() == 1 && family.iter().all(|&other| self.are_apart(ring, other))
            };
            match families.iter_mut().find(fits) {
                Some(family) => family.push(ring),
                None => families.push(vec![ring]),
            }
        }
        families
    }

    /// Whether two rings have no cycle in common, as far as is known.
    fn are_apart(&self, a: usize, b: usize) -> bool {
        match (&self.rings[a].cycles, &self.rings[b].cycles) {
            (Some(a), Some(b)) => !a.iter().any(|cycle| b.contains(cycle)),
            _ => false,
        }
    }
}

impl Fill for Rings {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for ring in &self.rings {
            let leaving = ring.leaving.iter().filter(|&&e| known.active[e]).count();
            let placed = ring.set.iter().any(|&v| known.sinks[v]);
            values[ring.column] = f64::from(u8::from(leaving == 1 && !placed));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::design::{EdgeState, Pattern, PatternKind, Problem};
    use crate::formulate::{Formulated, Formulation};

    /// Squares, six by six, whose boundary is given and sink.
    fn squares() -> Problem {
        let (n, at) = (7, |x: usize, y: usize| 7 * y + x);
        let mut ends = Vec::new();
        let mut patterns = Vec::new();
        for k in 0..n {
            for j in 0..n - 1 {
                ends.push([at(j, k), at(j + 1, k)]);
                ends.push([at(k, j), at(k, j + 1)]);
            }
        }
        let edge = |a, b| ends.iter().position(|&e| e == [a, b]).expect("an edge");
        for x in 0..n - 1 {
            for y in 0..n - 1 {
                let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
                for active in [vec![edge(a, b), edge(c, d)], vec![edge(a, c), edge(b, d)]] {
                    patterns.push(Pattern {
                        kind: PatternKind::TooClose,
                        active,
                        inactive: vec![],
                        cost: None,
                    });
                }
            }
        }
        let outer = |k: usize| k == 0 || k == n - 1;
        let rim = |v: usize| outer(v % n) || outer(v / n);
        let given = |&[a, b]: &[usize; 2]| {
            let (column, row) = (a % n == b % n, a / n == b / n);
            (column && outer(a % n)) || (row && outer(a / n))
        };
        let states = ends.iter().map(|e| match given(e) {
            true => EdgeState::Given,
            false => EdgeState::Open,
        });
        let ball = |v: usize| {
            let near = move |w: &usize| (w % n).abs_diff(v % n) + (w / n).abs_diff(v / n) <= 2;
            (0..n * n).filter(near).collect()
        };
        Problem {
            vertices: n * n,
            lengths: vec![1.0; ends.len()],
            states: states.collect(),
            sinks: (0..n * n).map(rim).collect(),
            coverage: (0..n * n).map(ball).collect(),
            patterns,
            length_weight: 1.0,
            ends,
            ..Problem::default()
        }
    }

    #[test]
    fn a_ring_with_one_street_to_it_is_allowed() {
        let problem = squares();
        let formulated = Formulated::new(&problem, Formulation::Flow, None).expect("fits");
        let at = |x: usize, y: usize| 7 * y + x;
        // Around the middle, and from there to the boundary.
        let mut active: Vec<bool> = (0..problem.edges()).map(|e| problem.is_given(e)).collect();
        let ring = [
            (2, 2),
            (3, 2),
            (4, 2),
            (4, 3),
            (4, 4),
            (3, 4),
            (2, 4),
            (2, 3),
            (2, 2),
        ];
        let street = [(3, 4), (3, 5), (3, 6)];
        for way in [&ring[..], &street[..]] {
            for step in way.windows(2) {
                let (a, b) = (at(step[0].0, step[0].1), at(step[1].0, step[1].1));
                let e = problem
                    .ends
                    .iter()
                    .position(|&e| e == [a, b] || e == [b, a]);
                active[e.expect("an edge")] = true;
            }
        }
        let network = crate::design::Network {
            active,
            ..Default::default()
        };
        assert_eq!(crate::design::verify(&problem, &network), []);
        let solution = formulated.solution(&network);
        assert!(formulated.program().violation(&solution) < 1e-9);
    }
}
