//! A program in the making: what all families of constraints share.

use crate::design::{distances, Network, Problem, Streets};
use crate::mip::Program;

use super::prepare::{prepare, Fate};

/// What stands for an edge or vertex in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    /// 0: known to be inactive.
    Off,
    /// 1: known to be active.
    On,
    /// A column.
    Column(usize),
}

/// A program in the making.
pub(super) struct Draft<'p> {
    pub(super) problem: &'p Problem,
    pub(super) around: Vec<Vec<(usize, usize)>>,
    pub(super) program: Program,
    /// Each edge.
    pub(super) x: Vec<Term>,
    /// Each vertex; set by [`activity`](super::activity).
    pub(super) y: Vec<Term>,
    /// Whether each vertex is a sink; candidates are columns, set by
    /// [`sinks`](super::sinks).
    pub(super) s: Vec<Term>,
    /// Whether a row cannot hold, whatever the columns are.
    pub(super) contradicts: bool,
}

impl<'p> Draft<'p> {
    /// Only the edges' columns, with what their length costs.
    pub(super) fn new(problem: &'p Problem) -> Self {
        let mut program = Program::default();
        let fates = prepare(problem);
        let mut constant = 0.0;
        let mut x = Vec::with_capacity(fates.len());
        for (e, fate) in fates.into_iter().enumerate() {
            let cost = problem.length_weight * problem.lengths[e];
            x.push(match fate {
                Fate::Off => Term::Off,
                Fate::On => {
                    constant += if problem.is_given(e) { 0.0 } else { cost };
                    Term::On
                }
                Fate::Open => Term::Column(program.binary(cost)),
            });
        }
        let mut draft = Self {
            problem,
            around: problem.around(),
            program,
            x,
            y: Vec::new(),
            s: (problem.sinks.iter())
                .map(|&sink| if sink { Term::On } else { Term::Off })
                .collect(),
            contradicts: false,
        };
        if constant != 0.0 {
            draft.constant(constant);
        }
        draft
    }

    /// A cost that is paid in any case: programs have no constant, so a column
    /// that is always 1.
    pub(super) fn constant(&mut self, cost: f64) {
        let column = self.program.real(cost, 1.0);
        self.program.bound(column, 1.0, 1.0);
    }

    /// Adds a row unless it holds in any case.
    pub(super) fn row(
        &mut self,
        low: f64,
        high: f64,
        terms: impl IntoIterator<Item = (Term, f64)>,
    ) {
        let mut known = 0.0;
        let mut columns = Vec::new();
        for (term, factor) in terms {
            match term {
                Term::Off => {}
                Term::On => known += factor,
                Term::Column(column) => columns.push((column, factor)),
            }
        }
        // Whether bounds of the columns suffice.
        let (mut least, mut most) = (known, known);
        for &(column, factor) in &columns {
            let c = self.program.columns()[column];
            least += (factor * c.low).min(factor * c.high);
            most += (factor * c.low).max(factor * c.high);
        }
        if least >= low && most <= high {
            return;
        }
        self.contradicts |= most < low - 1e-9 || least > high + 1e-9;
        self.program.row(low - known, high - known, columns);
    }

    /// Whether an edge may be active.
    pub(super) fn possible(&self, edge: usize) -> bool {
        self.x[edge] != Term::Off
    }
}

/// A network and what follows from it: what families compute their own columns
/// from.
pub(super) struct Known<'p> {
    pub(super) problem: &'p Problem,
    pub(super) active: &'p [bool],
    pub(super) rooms: &'p [usize],
    /// Whether each vertex is a sink, those chosen included.
    pub(super) sinks: Vec<bool>,
    /// The active edges with their directions.
    pub(super) streets: Streets<'p>,
    pub(super) degree: Vec<usize>,
    /// The way of each vertex to a sink.
    pub(super) away: Vec<f64>,
    /// The edge and vertex next on it; none at sinks and where there is no way.
    pub(super) next: Vec<Option<(usize, usize)>>,
    /// All vertices with a way, the nearest first.
    pub(super) order: Vec<usize>,
}

impl<'p> Known<'p> {
    pub(super) fn new(problem: &'p Problem, network: &'p Network) -> Self {
        let active = network.active.as_slice();
        let settled = problem.settled(&network.sinks);
        let away = distances(&settled, network);
        let mut degree = vec![0; problem.vertices];
        let mut next = vec![None; problem.vertices];
        for (e, &[a, b]) in problem.ends.iter().enumerate() {
            if !active[e] {
                continue;
            }
            degree[a] += 1;
            degree[b] += 1;
            for (v, w) in [(a, b), (b, a)] {
                // Lengths are positive, so the next vertex is nearer: no cycles.
                // The way was computed as this very sum.
                if away[v] == away[w] + problem.travel_cost(e) && next[v].is_none() {
                    next[v] = Some((e, w));
                }
            }
        }
        let mut order: Vec<usize> = (0..problem.vertices)
            .filter(|&v| away[v].is_finite())
            .collect();
        order.sort_by(|&a, &b| away[a].total_cmp(&away[b]));
        Self {
            problem,
            active,
            rooms: &network.rooms,
            sinks: settled.sinks.clone(),
            streets: network.into(),
            degree,
            away,
            next,
            order,
        }
    }

    /// The end of an edge that is nearer to a sink; the first of equal ones.
    pub(super) fn nearer(&self, edge: usize) -> usize {
        let [a, b] = self.problem.ends[edge];
        if self.away[b] < self.away[a] {
            b
        } else {
            a
        }
    }
}

/// What computes the columns of a family from a network, so that any network
/// can be the start of a solver and the test of a program.
pub(super) trait Fill: std::fmt::Debug + Send + Sync {
    /// Sets them.
    fn fill(&self, known: &Known<'_>, values: &mut [f64]);
}
