//! Connection cuts: what has to be active is joined to a sink.
//!
//! Let B be vertices of which one at least is active, by coverage or because it
//! has to be, and S vertices that hold all of B, none of them a sink. Then
//!
//! x(delta(S)) >= 1,   (29)
//!
//! with delta(S) the edges with one end in S.
//!
//! *Proof.* A vertex of B is active, so there is a way from it to a sink over
//! active edges. It begins in S and ends outside. []
//!
//! For S = B that is (6a). The flow of (7) says the same of every S, but with
//! capacities: of n units that may run over an edge a vertex sends one, so an
//! n-th of an edge is enough for it. A relaxation builds what covers most in the
//! middle, and hardly a street that leads there; with (29) there is a whole one.
//!
//! There are too many sets S to write all of them down; [`Connections::separate`]
//! finds for each B one that is violated most, a least cut between B and the
//! sinks. What may become a sink counts as one.
//!
//! Where travel is paid for, a relaxation joins what is active anyway, to keep
//! ways short: on meshes whose boundary is sink none of these cuts is violated
//! then. So they are looked for where travel is not priced, and where detour
//! cuts are.

use std::collections::{BTreeSet, VecDeque};

use super::coverage::least_sets;
use super::detours::are_worth_it;
use super::draft::{Draft, Term};
use super::Formulation;
use crate::mip::Row;

/// Edges of a problem from which on there are too many cuts to look at.
const LARGE: usize = 1_500;

/// What connection cuts are made of.
#[derive(Clone, Debug)]
pub(super) struct Connections {
    /// The sets B.
    sets: Vec<Vec<usize>>,
    /// Whether each vertex is a sink, or may become one.
    sinks: Vec<bool>,
    x: Vec<Term>,
    ends: Vec<[usize; 2]>,
    around: Vec<Vec<(usize, usize)>>,
}

impl Connections {
    /// The cuts of a program; none where the problem is too large, nothing has to
    /// be active or they would hardly be violated.
    pub(super) fn of(draft: &Draft<'_>, formulation: Formulation) -> Option<Self> {
        let problem = draft.problem;
        let of_use = match formulation {
            Formulation::Flow => true,
            Formulation::TravelFlow | Formulation::SingleSink => are_worth_it(draft),
            Formulation::Recommended | Formulation::Paper => false,
        };
        let sinks = problem.possible_sinks();
        let mut sets = least_sets(draft);
        sets.extend(problem.required_vertices.iter().map(|&v| vec![v]));
        sets.retain(|set| set.iter().all(|&v| !sinks[v]));
        (of_use && !sets.is_empty() && problem.edges() <= LARGE).then(|| Self {
            sets,
            sinks,
            x: draft.x.clone(),
            ends: problem.ends.clone(),
            around: draft.around.clone(),
        })
    }

    /// Cuts (29) that a fractional solution violates by over `tolerance`, at
    /// most one for each set that has to be joined, none twice.
    pub(super) fn separate(&self, values: &[f64], tolerance: f64) -> Vec<Row> {
        let part = |x: &Term| match *x {
            Term::Off => 0.0,
            Term::On => 1.0,
            Term::Column(column) => values[column],
        };
        let parts: Vec<f64> = self.x.iter().map(part).collect();
        let cuts: BTreeSet<Vec<usize>> = (self.sets.iter())
            .filter_map(|set| self.least_cut(set, &parts, 1.0 - tolerance))
            .collect();
        cuts.into_iter().map(|cut| self.row(&cut)).collect()
    }

    /// The edges of a least cut between a set and the sinks, ascending, if it is
    /// less than `most`; of least cuts that with the fewest vertices on the side of
    /// the set.
    ///
    /// By shortest augmenting paths: cuts are of a few edges, and the search
    /// ends once the flow is `most`.
    fn least_cut(&self, set: &[usize], parts: &[f64], most: f64) -> Option<Vec<usize>> {
        // What may still flow over each edge from its first and from its second end.
        let mut left: Vec<[f64; 2]> = parts.iter().map(|&part| [part; 2]).collect();
        let mut flow = 0.0;
        loop {
            let (end, before) = self.search(set, &left);
            let Some(end) = end else {
                let inside = |v: usize| before[v].is_some() || set.contains(&v);
                let crosses = |&e: &usize| {
                    let [a, b] = self.ends[e];
                    self.x[e] != Term::Off && inside(a) != inside(b)
                };
                return Some((0..self.ends.len()).filter(crosses).collect());
            };
            let mut path = Vec::new();
            let mut at = end;
            while let Some(e) = before[at] {
                let [a, b] = self.ends[e];
                let (from, side) = if a == at { (b, 1) } else { (a, 0) };
                path.push((e, side));
                at = from;
            }
            let more = (path.iter()).fold(most, |more, &(e, side)| more.min(left[e][side]));
            flow += more;
            if flow >= most {
                return None;
            }
            for (e, side) in path {
                left[e][side] -= more;
                left[e][1 - side] += more;
            }
        }
    }

    /// A sink that can be reached from a set over what is left of edges, and for
    /// each vertex that was reached the edge that led there; none for those of
    /// the set.
    fn search(&self, set: &[usize], left: &[[f64; 2]]) -> (Option<usize>, Vec<Option<usize>>) {
        let mut before = vec![None; self.around.len()];
        let mut reached = vec![false; self.around.len()];
        set.iter().for_each(|&v| reached[v] = true);
        let mut queue: VecDeque<usize> = set.iter().copied().collect();
        while let Some(v) = queue.pop_front() {
            if self.sinks[v] {
                return (Some(v), before);
            }
            for &(e, w) in &self.around[v] {
                let side = usize::from(self.ends[e][1] == v);
                if !reached[w] && left[e][side] > 1e-9 {
                    reached[w] = true;
                    before[w] = Some(e);
                    queue.push_back(w);
                }
            }
        }
        (None, before)
    }

    fn row(&self, cut: &[usize]) -> Row {
        let mut terms = Vec::new();
        let mut low = 1.0;
        for &e in cut {
            match self.x[e] {
                Term::Off => {}
                Term::On => low -= 1.0,
                Term::Column(column) => terms.push((column, 1.0)),
            }
        }
        terms.sort_unstable_by_key(|&(column, _)| column);
        Row {
            terms,
            low,
            high: f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::design::{EdgeState, Network, Problem};
    use crate::formulate::{Cuts, Formulated, Formulation};

    /// A street of six vertices between sinks at both ends; 2 or 3 has to be
    /// active.
    fn street() -> Problem {
        Problem {
            vertices: 6,
            ends: (0..5).map(|k| [k, k + 1]).collect(),
            lengths: vec![1.0; 5],
            states: vec![EdgeState::Open; 5],
            sinks: (0..6).map(|v| v == 0 || v == 5).collect(),
            coverage: vec![vec![2, 3]],
            dead_ends: true,
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn what_has_to_be_active_is_joined_by_a_whole_street() {
        let problem = street();
        let formulated = Formulated::new(&problem, Formulation::Flow, None).expect("fits");
        let columns = formulated.program().columns().len();
        // The first columns are those of the edges: a fifth of each but the
        // fourth, of which a tenth.
        let mut values = vec![0.0; columns];
        values[..5].copy_from_slice(&[0.2, 0.2, 0.2, 0.1, 0.2]);
        let rows = formulated.separate(&values, 0.01);
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0].terms, [(1, 1.0), (3, 1.0)]);
        assert_eq!(rows[0].low, 1.0);
        // One end is enough.
        values[..5].copy_from_slice(&[1.0, 1.0, 0.0, 0.0, 0.0]);
        assert!(formulated.separate(&values, 0.01).is_empty());
        // What is farther away may be what is missing.
        values[..5].copy_from_slice(&[0.5, 1.0, 0.0, 0.3, 0.3]);
        let rows = formulated.separate(&values, 0.01);
        assert_eq!(rows[0].terms, [(0, 1.0), (3, 1.0)]);
        let cuts = Cuts {
            connections: false,
            ..Cuts::all()
        };
        let without = Formulated::with_cuts(&problem, Formulation::Flow, None, cuts);
        assert!(!without.expect("fits").separates());
    }

    #[test]
    fn other_formulations_adopt_what_is_of_streets_alone() {
        let problem = Problem {
            travel_weight: 0.001,
            ..street()
        };
        let flow = Formulated::new(&problem, Formulation::Flow, None).expect("fits");
        let mut travel = Formulated::new(&problem, Formulation::TravelFlow, None).expect("fits");
        let columns = flow.program().columns().len();
        let mut values = vec![0.0; columns];
        values[..5].copy_from_slice(&[0.2, 0.2, 0.2, 0.1, 0.2]);
        let mut rows = flow.separate(&values, 0.01);
        let streets = rows.clone();
        let mut of_flow = rows[0].clone();
        of_flow.terms.push((columns - 1, 1.0));
        rows.push(of_flow);
        travel.adopt(&rows);
        assert_eq!(travel.added(), streets);
        // Their columns are the same ones: two edges from a sink to vertex 2.
        let network = Network {
            active: vec![true, true, false, false, false],
            ..Network::default()
        };
        let solution = travel.solution(&network);
        assert!(travel.program().violation(&solution) < 1e-9);
        assert_eq!(solution[..5], flow.solution(&network)[..5]);
    }
}
