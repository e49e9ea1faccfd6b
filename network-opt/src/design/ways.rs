//! One-way streets, and what travel costs: which way traffic may run over each
//! edge, and how far it is to the sinks and from them.
//!
//! The paper's network is of streets that traffic runs over both ways; its
//! conclusion names one-way streets as what is missing. Here an edge may be
//! one-way, in a direction that is given or to be chosen. Traffic goes from
//! every street to a sink and comes from a sink to every street, each along
//! streets in their direction, so a network is valid if every active vertex can
//! do both: with all sinks taken for one, the network is strongly connected.
//!
//! Travel over an edge is the mean of the way out and the way in: from the end
//! that its traffic may leave by to the nearest sink, and from the nearest sink
//! to the end that it may enter by. Over two-way streets both are the way from
//! the nearer end, so nothing changes where there are no one-way streets. A
//! street that becomes one-way never makes a network better: ways become no
//! shorter, and there are fewer ends to choose from.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::problem::{Network, Problem};
use crate::error::DesignError;

/// Which way traffic may run over an edge.
///
/// # Examples
///
/// A block at the end of a street: one way around it, and it does not matter
/// which.
///
/// ```
/// use network_opt::design::{Problem, Way};
/// use network_opt::mip::Microlp;
/// use network_opt::solve::{Ended, Exact, Limits, NetworkSolver};
///
/// let problem = Problem {
///     vertices: 4,
///     ends: vec![[0, 1], [1, 2], [2, 3], [1, 3]],
///     lengths: vec![1.0; 4],
///     states: vec![Default::default(); 4],
///     sinks: vec![true, false, false, false],
///     required_vertices: vec![2],
///     ways: vec![Way::Both, Way::Either, Way::Either, Way::Either],
///     length_weight: 1.0,
///     travel_weight: 1.0,
///     ..Problem::default()
/// };
/// let found = Exact::new(Microlp).solve(&problem, None, &Limits::default(), &mut |_| true)?;
/// assert_eq!(found.ended, Ended::Proven);
/// // From the heads of the three it is 3, 2 and 1 to the sink, and from there 1,
/// // 2 and 3 to their tails.
/// assert_eq!((found.cost.length, found.cost.travel), (4.0, 6.0));
/// let ways = found.network.unwrap().ways;
/// assert_eq!(ways[1], ways[2]);
/// assert_eq!(ways[3], ways[1].reversed());
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Way {
    /// Both ways.
    #[default]
    Both,
    /// From the first of its [ends](Problem::ends) to the second.
    Forward,
    /// From the second of its ends to the first.
    Backward,
    /// One way, and it is to be decided which. In a [`Network`] that of an
    /// edge that is not active; traffic never runs over it.
    Either,
}

impl Way {
    /// Whether traffic runs over the edge from one of its ends (0 the first, 1
    /// the second) to the other; not while that is undecided.
    #[must_use]
    pub const fn runs_from(self, end: usize) -> bool {
        match self {
            Self::Both => true,
            Self::Forward => end == 0,
            Self::Backward => end == 1,
            Self::Either => false,
        }
    }

    /// Whether it may turn out to do so.
    #[must_use]
    pub const fn may_run_from(self, end: usize) -> bool {
        matches!(self, Self::Either) || self.runs_from(end)
    }

    /// The other way round.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Forward => Self::Backward,
            Self::Backward => Self::Forward,
            other => other,
        }
    }
}

/// Active edges with their directions, as a [`Network`] has them; or a list of
/// active edges alone, which is enough where the problem leaves no direction
/// open.
#[derive(Clone, Copy, Debug)]
pub struct Streets<'n> {
    active: &'n [bool],
    ways: &'n [Way],
}

impl<'n> From<&'n Network> for Streets<'n> {
    fn from(network: &'n Network) -> Self {
        Self {
            active: &network.active,
            ways: &network.ways,
        }
    }
}

impl<'n> From<&'n [bool]> for Streets<'n> {
    fn from(active: &'n [bool]) -> Self {
        Self { active, ways: &[] }
    }
}

impl<'n> From<&'n Vec<bool>> for Streets<'n> {
    fn from(active: &'n Vec<bool>) -> Self {
        Self::from(active.as_slice())
    }
}

impl<'n, const N: usize> From<&'n [bool; N]> for Streets<'n> {
    fn from(active: &'n [bool; N]) -> Self {
        Self::from(active.as_slice())
    }
}

impl<'n> Streets<'n> {
    /// Whether each edge is active.
    #[must_use]
    pub const fn active(&self) -> &'n [bool] {
        self.active
    }

    /// Which way traffic runs over an edge: what the problem says, and where it
    /// leaves that open what the network says.
    #[must_use]
    pub fn way(&self, problem: &Problem, edge: usize) -> Way {
        match problem.way(edge) {
            Way::Either => match self.ways.get(edge) {
                Some(&way @ (Way::Forward | Way::Backward)) => way,
                _ => Way::Either,
            },
            decided => decided,
        }
    }
}

impl Problem {
    /// Which way traffic may run over an edge.
    #[must_use]
    pub fn way(&self, edge: usize) -> Way {
        self.ways.get(edge).copied().unwrap_or_default()
    }

    /// Whether any edge is one-way.
    #[must_use]
    pub fn has_one_way(&self) -> bool {
        self.ways.iter().any(|&way| way != Way::Both)
    }

    /// Whether the direction of any edge is to be decided.
    #[must_use]
    pub fn has_choice_of_ways(&self) -> bool {
        self.ways.contains(&Way::Either)
    }

    /// What travel over an edge costs: its length, unless
    /// [`Problem::travel_costs`] says something else.
    #[must_use]
    pub fn travel_cost(&self, edge: usize) -> f64 {
        match self.travel_costs.get(edge) {
            Some(&cost) => cost,
            None => self.lengths[edge],
        }
    }

    /// The entries of [`Network::ways`] for a network with these active edges,
    /// of which `backward` says whether those to be decided run from their
    /// second end to their first.
    pub(crate) fn decided_ways(
        &self,
        active: &[bool],
        backward: impl Fn(usize) -> bool,
    ) -> Vec<Way> {
        if !self.has_choice_of_ways() {
            return Vec::new();
        }
        let decide = |e: usize| match self.way(e) {
            Way::Either if active[e] && backward(e) => Way::Backward,
            Way::Either if active[e] => Way::Forward,
            other => other,
        };
        (0..self.edges()).map(decide).collect()
    }

    /// Checks the lists of ways and of costs of travel.
    pub(super) fn check_ways(&self) -> Result<(), DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        for (name, len) in [
            ("ways", self.ways.len()),
            ("travel_costs", self.travel_costs.len()),
        ] {
            if len != 0 && len != self.edges() {
                return bad(format!(
                    "{name} has {len} entries, of {}; give one an edge, or none",
                    self.edges()
                ));
            }
        }
        let mut costs = self.travel_costs.iter();
        if let Some(e) = costs.position(|c| !(*c > 0.0 && c.is_finite())) {
            return bad(format!(
                "travel over edge {e} costs {}; costs are positive",
                self.travel_costs[e]
            ));
        }
        Ok(())
    }
}

/// To the sinks, or from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    /// From every street to a sink.
    Out,
    /// From a sink to every street.
    In,
}

impl Heading {
    pub(crate) const BOTH: [Self; 2] = [Self::Out, Self::In];

    /// The end of an edge that traffic comes from if its way to the stop, or
    /// from it, leads on from the end `near` to the other.
    pub(crate) const fn tail(self, near: usize) -> usize {
        match self {
            Self::Out => near,
            Self::In => 1 - near,
        }
    }

    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Out => Self::In,
            Self::In => Self::Out,
        }
    }
}

/// How far it is from each vertex to the nearest of the `stops`, or from that
/// to the vertex, over edges that `runs` says traffic runs over from the end
/// 0 or 1; infinite where there is no way.
pub(crate) fn ways_to(
    problem: &Problem,
    around: &[Vec<(usize, usize)>],
    stops: &[bool],
    heading: Heading,
    runs: impl Fn(usize, usize) -> bool,
) -> Vec<f64> {
    let mut away = vec![f64::INFINITY; problem.vertices];
    let mut queue = BinaryHeap::new();
    for (v, _) in stops.iter().enumerate().filter(|(_, &stop)| stop) {
        away[v] = 0.0;
        // Of numbers that are not negative the bits are in order.
        queue.push(Reverse((0.0_f64.to_bits(), v)));
    }
    while let Some(Reverse((bits, v))) = queue.pop() {
        let gone = f64::from_bits(bits);
        if gone > away[v] {
            continue;
        }
        for &(e, w) in &around[v] {
            let there = gone + problem.travel_cost(e);
            if there < away[w] && runs(e, heading.tail(usize::from(problem.ends[e][1] == w))) {
                away[w] = there;
                queue.push(Reverse((there.to_bits(), w)));
            }
        }
    }
    away
}

/// The way from each vertex to its nearest sink over active edges, by what
/// travel over them costs; infinite where there is none.
///
/// # Panics
///
/// If there is not one entry an edge.
#[must_use]
pub fn distances<'n>(problem: &Problem, streets: impl Into<Streets<'n>>) -> Vec<f64> {
    heading(problem, streets.into(), Heading::Out)
}

/// The way to each vertex from its nearest sink over active edges: the same as
/// [`distances`] where all streets are two-way.
///
/// # Panics
///
/// If there is not one entry an edge.
///
/// # Examples
///
/// ```
/// use network_opt::design::{distances, distances_from, Problem, Way};
///
/// // One way around a block: 0, 1, 2, 3 and back to the sink at 0.
/// let problem = Problem {
///     vertices: 4,
///     ends: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
///     lengths: vec![1.0; 4],
///     states: vec![Default::default(); 4],
///     sinks: vec![true, false, false, false],
///     ways: vec![Way::Forward; 4],
///     length_weight: 1.0,
///     ..Problem::default()
/// };
/// assert_eq!(distances(&problem, &[true; 4]), [0.0, 3.0, 2.0, 1.0]);
/// assert_eq!(distances_from(&problem, &[true; 4]), [0.0, 1.0, 2.0, 3.0]);
/// ```
#[must_use]
pub fn distances_from<'n>(problem: &Problem, streets: impl Into<Streets<'n>>) -> Vec<f64> {
    heading(problem, streets.into(), Heading::In)
}

fn heading(problem: &Problem, streets: Streets<'_>, heading: Heading) -> Vec<f64> {
    let runs = |e: usize, from: usize| streets.active[e] && streets.way(problem, e).runs_from(from);
    ways_to(problem, &problem.around(), &problem.sinks, heading, runs)
}

/// What travel of an edge counts: the mean of the way from it to a sink and of
/// the way to it from one, by the ways of its ends, the edge itself left out;
/// infinite while its direction is undecided.
pub(crate) fn mean_way([a, b]: [usize; 2], way: Way, to: &[f64], from: &[f64]) -> f64 {
    let (out, back) = match way {
        Way::Both => (to[a].min(to[b]), from[a].min(from[b])),
        Way::Forward => (to[b], from[a]),
        Way::Backward => (to[a], from[b]),
        Way::Either => (f64::INFINITY, f64::INFINITY),
    };
    0.5 * (out + back)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{cost, verify, EdgeState, Violation};

    /// A block around which one can drive, with a street to it: sink 0, edges
    /// 0-1, 1-2, 2-3, 3-1.
    fn lollipop(ways: [Way; 4]) -> Problem {
        Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 1]],
            lengths: vec![1.0; 4],
            states: vec![EdgeState::Open; 4],
            sinks: vec![true, false, false, false],
            ways: ways.to_vec(),
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    const ALL: [bool; 4] = [true; 4];

    fn faults(ways: [Way; 4], decided: &[Way]) -> Vec<Violation> {
        let network = Network {
            active: ALL.to_vec(),
            ways: decided.to_vec(),
            ..Network::default()
        };
        verify(&lollipop(ways), &network)
    }

    #[test]
    fn ways_out_and_in_are_counted() {
        use Way::{Both, Forward};
        // Two-way: 0-1 at the sink, 1-2 and 3-1 one away, 2-3 two.
        let two_way = cost(&lollipop([Both; 4]), &ALL);
        assert_eq!(two_way.travel, 0.0 + 1.0 + 2.0 + 1.0);
        // Around: out 3, 2, 1 from the heads and in 1, 2, 3 to the tails.
        let around = lollipop([Both, Forward, Forward, Forward]);
        assert_eq!(distances(&around, &ALL), [0.0, 1.0, 3.0, 2.0]);
        assert_eq!(distances_from(&around, &ALL), [0.0, 1.0, 2.0, 3.0]);
        let travel = cost(&around, &ALL).travel;
        assert_eq!(travel, 0.5 * ((3.0 + 1.0) + (2.0 + 2.0) + (1.0 + 3.0)));
        // On a street of twice the speed ways are half as long.
        let mut fast = around;
        fast.travel_costs = vec![0.5; 4];
        let found = cost(&fast, &ALL);
        assert_eq!((found.length, found.travel), (4.0, 0.5 * travel));
    }

    #[test]
    fn each_fault_of_directions_has_its_name() {
        use Way::{Backward, Both, Either, Forward};
        assert_eq!(faults([Both, Forward, Forward, Forward], &[]), []);
        // 1 -> 3 -> 2 <- 1: nothing leads on from 2, and from 3 only to it.
        assert_eq!(
            faults([Both, Forward, Backward, Backward], &[]),
            [
                Violation::OnlyIn { vertex: 2 },
                Violation::NoWayOut { vertex: 3 }
            ]
        );
        assert_eq!(
            faults([Both, Backward, Forward, Forward], &[]),
            [
                Violation::OnlyOut { vertex: 2 },
                Violation::NoWayIn { vertex: 3 }
            ]
        );
        // The street to the block leads in only; nothing comes out of it.
        let shut = faults([Forward, Forward, Forward, Forward], &[]);
        let expected = [1, 2, 3].map(|vertex| Violation::NoWayOut { vertex });
        assert_eq!(shut, expected);
        let shut = faults([Backward, Forward, Forward, Forward], &[]);
        let expected = [1, 2, 3].map(|vertex| Violation::NoWayIn { vertex });
        assert_eq!(shut, expected);
        // Directions that were to be chosen.
        let open = [Both, Either, Either, Either];
        assert_eq!(faults(open, &[Both, Backward, Backward, Backward]), []);
        assert_eq!(
            faults(open, &[Both, Backward, Either, Backward])[0],
            Violation::NoDirection { edge: 2 }
        );
        let undecided = [1, 2, 3].map(|edge| Violation::NoDirection { edge });
        assert_eq!(faults(open, &[])[..3], undecided);
        assert_eq!(
            faults(
                [Both, Forward, Forward, Forward],
                &[Both, Forward, Backward, Forward]
            ),
            [Violation::WrongWay { edge: 2 }]
        );
        assert_eq!(faults(open, &[Both]), [Violation::WrongSize]);
    }

    #[test]
    fn lists_of_ways_have_to_fit() {
        let mut problem = lollipop([Way::Both; 4]);
        assert!(problem.check().is_ok() && !problem.has_one_way());
        problem.ways.pop();
        assert!(problem.check().is_err());
        problem.ways.clear();
        problem.travel_costs = vec![1.0, 1.0, 0.0, 1.0];
        let error = problem.check().expect_err("free travel").to_string();
        assert!(error.contains("edge 2"), "{error}");
        problem.travel_costs = vec![1.0];
        assert!(problem.check().is_err());
    }
}
