//! Detour cuts: what a street travels if short ways are closed to it.
//!
//! Let D_g be the way of an active edge g that sends traffic, from the nearer of
//! its ends to a sink, k the least that it can be over all edges that may be
//! active, and A a set of edges that every way from an end of g to a sink
//! crosses that is shorter than k + m. Then with c_g a column for the way of g,
//! 0 where g is not active,
//!
//! c_g >= (k + m) x_g - m x(A),   (26)
//! sum of l_e f_e >= sum of c_g,   (27)
//!
//! with l_e what travel over e costs.
//!
//! *Proof.* Where g is active and no edge of A is, D_g is k + m at least; where
//! one of A is, D_g is k at least, and the right hand side is k at most; where g
//! is not active that is 0 at most. So c_g = D_g meets (26), and the flow of
//! (8), which takes the shortest ways, travels the sum of all D_g. []
//!
//! A flow alone takes the shortest ways over all edges, each of which need be
//! active to a small part only. For A edges serve that are part of a way shorter
//! than k + m (with the nearest sink behind them and the nearest end of g before)
//! and pass a given distance from the sinks, or from g: each such way begins k
//! from the sinks at least, and ends at them.
//!
//! These cuts are of use where length counts as well as travel, since then a
//! relaxation saves streets by long detours: with 5 for length and 1 for travel
//! they raise the bound at the root of 12 x 12 squares from 136.2 to 145.3 of
//! 160, and that of 18 x 17 from 380.2 to 400.7 of 447. With travel alone and
//! sinks inside it goes from 250.4 to 255.3 of 278, with one sink from 102.5 to
//! 108.0 of 110; where all of the boundary is sink they are hardly ever violated.
//! Ways longer by more than four edges were of no use. There are too many cuts to
//! be written down: [`Detours::separate`] finds those that are violated.

use super::draft::{Draft, Fill, Known, Term};
use super::travel::Travel;
use crate::design::distances;
use crate::mip::Row;

/// Edges of a problem from which on there are too many cuts to look at.
const LARGE: usize = 1_500;
/// Weight of length, as a share of that of travel, from which on long ways save
/// streets that are worth something.
const SAVED: f64 = 0.1;
/// Sinks up to which ways are long.
const FEW: usize = 8;
/// How much longer ways are looked at, in the least length of an edge.
const LONGER: usize = 4;

/// The columns of (27), and all cuts (26).
#[derive(Clone, Debug)]
pub(super) struct Detours {
    /// The way of each edge that sends.
    way: Vec<Option<usize>>,
    /// Each edge.
    x: Vec<Term>,
    cuts: Vec<Cut>,
}

/// A cut (26).
#[derive(Clone, Debug)]
struct Cut {
    edge: usize,
    /// k and m.
    least: f64,
    more: f64,
    /// A.
    crossed: Vec<usize>,
}

/// Adds the columns of ways and row (27) to a flow; nothing where the problem is
/// too large or travel costs nothing.
pub(super) fn add(draft: &mut Draft<'_>, travel: &Travel) -> Option<Detours> {
    let problem = draft.problem;
    if !are_worth_it(draft) {
        return None;
    }
    let mut way = vec![None; problem.edges()];
    let mut sum = Vec::new();
    // No way is longer than all edges together.
    let all: f64 = (0..problem.edges()).map(|e| problem.travel_cost(e)).sum();
    for (e, way) in way.iter_mut().enumerate() {
        for column in travel.flows(e) {
            sum.push((Term::Column(column), problem.travel_cost(e)));
        }
        if travel.sends(e) {
            let column = draft.program.real(0.0, all);
            *way = Some(column);
            sum.push((Term::Column(column), -1.0));
        }
    }
    draft.row(0.0, f64::INFINITY, sum);
    Some(Detours::of(draft, way))
}

/// The cuts of a program that has a column for the way of each edge already.
pub(super) fn of(draft: &Draft<'_>, way: Vec<Option<usize>>) -> Option<Detours> {
    are_worth_it(draft).then(|| Detours::of(draft, way))
}

/// Where travel alone counts and sinks are many hardly any cut is violated, and
/// columns for ways only slow the program down: of 12 x 12 squares whose boundary
/// is sink the proof took 11 s without them, and was not there after 30 s with.
pub(super) fn are_worth_it(draft: &Draft<'_>) -> bool {
    let problem = draft.problem;
    let sinks = problem.sinks.iter().filter(|&&sink| sink).count();
    let saves = problem.length_weight > SAVED * problem.travel_weight || sinks <= FEW;
    problem.travel_weight > 0.0 && saves && problem.edges() <= LARGE
}

/// All cuts of one edge.
fn cuts_of(draft: &Draft<'_>, edge: usize, away: &[f64], cuts: &mut Vec<Cut>) {
    let problem = draft.problem;
    let ends = problem.ends[edge];
    let least = away[ends[0]].min(away[ends[1]]);
    if !least.is_finite() {
        return;
    }
    cuts.push(Cut {
        edge,
        least,
        more: 0.0,
        crossed: Vec::new(),
    });
    // The way from the nearer end of the edge, as if that were the sink.
    let mut sinks = vec![false; problem.vertices];
    ends.iter().for_each(|&v| sinks[v] = true);
    let gone = ways_from(draft, &sinks);
    let unit = (0..problem.edges())
        .map(|e| problem.travel_cost(e))
        .fold(f64::INFINITY, f64::min);
    for longer in 1..=LONGER {
        let more = longer as f64 * unit;
        let mut short = Vec::new();
        for (e, &[a, b]) in problem.ends.iter().enumerate() {
            for (p, q) in [(a, b), (b, a)] {
                let through = gone[p] + problem.travel_cost(e) + away[q];
                if e != edge && draft.possible(e) && through < least + more - 1e-9 {
                    short.push((e, p, q));
                }
            }
        }
        let mut distance = 0.0;
        while distance < least - 1e-9 {
            // Past a distance by more than rounding errors.
            let near = distance + 1e-9;
            let to_sinks = |&&(_, p, q): &&(usize, usize, usize)| away[p] > near && away[q] <= near;
            let from_edge =
                |&&(_, p, q): &&(usize, usize, usize)| gone[p] <= near && gone[q] > near;
            let crossing: [Vec<usize>; 2] = [
                short.iter().filter(to_sinks).map(|s| s.0).collect(),
                short.iter().filter(from_edge).map(|s| s.0).collect(),
            ];
            for mut crossed in crossing {
                crossed.sort_unstable();
                crossed.dedup();
                if crossed.iter().all(|&e| draft.x[e] != Term::On) {
                    cuts.push(Cut {
                        edge,
                        least,
                        more,
                        crossed,
                    });
                }
            }
            distance += unit;
        }
    }
}

/// The least way to each vertex from a set of them, over edges that may be
/// active.
fn ways_from(draft: &Draft<'_>, from: &[bool]) -> Vec<f64> {
    let mut ways: Vec<f64> = from
        .iter()
        .map(|&from| if from { 0.0 } else { f64::INFINITY })
        .collect();
    let mut queue: std::collections::VecDeque<usize> =
        (0..from.len()).filter(|&v| from[v]).collect();
    while let Some(v) = queue.pop_front() {
        for &(e, w) in &draft.around[v] {
            let way = ways[v] + draft.problem.travel_cost(e);
            if draft.possible(e) && way < ways[w] - 1e-12 {
                ways[w] = way;
                queue.push_back(w);
            }
        }
    }
    ways
}

impl Detours {
    fn of(draft: &Draft<'_>, way: Vec<Option<usize>>) -> Self {
        let possible: Vec<bool> = (0..way.len()).map(|e| draft.possible(e)).collect();
        let away = distances(draft.problem, &possible);
        let mut cuts = Vec::new();
        for e in (0..way.len()).filter(|&e| way[e].is_some()) {
            cuts_of(draft, e, &away, &mut cuts);
        }
        Self {
            way,
            x: draft.x.clone(),
            cuts,
        }
    }

    /// Cuts (26) that a fractional solution violates by over `tolerance` of the
    /// least length, the most violated for each edge and m.
    pub(super) fn separate(&self, values: &[f64], tolerance: f64) -> Vec<Row> {
        let value = |e: usize| match self.x[e] {
            Term::Off => 0.0,
            Term::On => 1.0,
            Term::Column(column) => values[column],
        };
        let mut best: Vec<(f64, &Cut)> = Vec::new();
        for cut in &self.cuts {
            let Some(way) = self.way[cut.edge] else {
                continue;
            };
            let crossed: f64 = cut.crossed.iter().map(|&e| value(e)).sum();
            let wanted = (cut.least + cut.more) * value(cut.edge) - cut.more * crossed;
            let lacks = wanted - values[way];
            if lacks <= tolerance {
                continue;
            }
            // Cuts of one edge and m follow each other.
            match best.last_mut() {
                Some(last) if last.1.edge == cut.edge && last.1.more == cut.more => {
                    if lacks > last.0 {
                        *last = (lacks, cut);
                    }
                }
                _ => best.push((lacks, cut)),
            }
        }
        best.into_iter().map(|(_, cut)| self.row(cut)).collect()
    }

    fn row(&self, cut: &Cut) -> Row {
        let mut terms: Vec<(usize, f64)> =
            self.way[cut.edge].map(|c| (c, 1.0)).into_iter().collect();
        let mut low = 0.0;
        match self.x[cut.edge] {
            Term::Off => {}
            Term::On => low += cut.least + cut.more,
            Term::Column(column) => terms.push((column, -cut.least - cut.more)),
        }
        for &e in &cut.crossed {
            if let Term::Column(column) = self.x[e] {
                terms.push((column, cut.more));
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

impl Fill for Detours {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for (e, way) in self.way.iter().enumerate() {
            if let (Some(column), true) = (*way, known.active[e]) {
                values[column] = known.away[known.nearer(e)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::design::{EdgeState, Network, Problem};
    use crate::formulate::{Formulated, Formulation};

    /// A ring of six with the sink at 0, every vertex active.
    fn ring() -> Problem {
        Problem {
            vertices: 6,
            ends: (0..6).map(|k| [k, (k + 1) % 6]).collect(),
            lengths: vec![1.0; 6],
            states: vec![EdgeState::Open; 6],
            sinks: (0..6).map(|v| v == 0).collect(),
            required_vertices: (1..6).collect(),
            dead_ends: true,
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    #[test]
    fn an_edge_pays_for_the_long_way_where_the_short_one_is_not_active() {
        let problem = ring();
        let formulated = Formulated::new(&problem, Formulation::TravelFlow, None).expect("fits");
        // Of edge 2 from 2 to 3 the nearer end is 2 from the sink over 1, and the
        // other 3 over 4 and 5.
        let mut active = vec![true; 6];
        active[1] = false;
        let network = Network {
            active,
            ..Network::default()
        };
        let solution = formulated.solution(&network);
        assert!(formulated.program().violation(&solution) < 1e-9);
        assert!(formulated.separate(&solution, 1e-6).is_empty());
        // Edges 1 to 4 send, from 1, 2, 2 and 1 away; of edge 2 it is 3 now. The
        // columns of ways are the last four.
        let ways = solution.len() - 4..solution.len();
        assert_eq!(solution[ways.clone()], [0.0, 3.0, 2.0, 1.0]);
        let mut cheaper = solution.clone();
        cheaper[ways.start + 1] = 2.0;
        let rows = formulated.separate(&cheaper, 1e-6);
        // m = 1, by edge 0 or edge 1; with more the other way is as short.
        assert!(!rows.is_empty());
        for row in rows {
            let sum: f64 = row.terms.iter().map(|&(c, f)| f * cheaper[c]).sum();
            assert!((row.low - sum - 1.0).abs() < 1e-9, "{row:?}");
        }
    }
}
