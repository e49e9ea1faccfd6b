//! Sinks whose places the program chooses.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::problem::{Network, Problem};
use super::verify::verify;
use super::violation::Violation;

/// Sinks that are to be placed: so many of the candidates become sinks, each
/// of them on a street.
///
/// A sink that no street touches serves nobody; were it allowed, "three sinks"
/// would be met by one in use and two anywhere. So the best network is the best
/// of those for any choice of `count` candidates as sinks that have to be
/// active.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlacedSinks {
    /// Vertices that may become sinks, none twice, none a sink already.
    pub candidates: Vec<usize>,
    /// How many of them do.
    pub count: usize,
}

impl PlacedSinks {
    /// What is wrong with it in a problem of these sinks, in words.
    pub(super) fn fault(&self, sinks: &[bool]) -> Option<String> {
        let mut seen = BTreeSet::new();
        for &v in &self.candidates {
            match sinks.get(v) {
                None => {
                    let of = sinks.len();
                    return Some(format!("vertex {v} may become a sink, of {of} vertices"));
                }
                Some(true) => {
                    return Some(format!("vertex {v} may become a sink, but is one already"))
                }
                Some(false) if !seen.insert(v) => {
                    return Some(format!("vertex {v} is named twice among those for sinks"))
                }
                Some(false) => {}
            }
        }
        let (count, places) = (self.count, self.candidates.len());
        if count == 0 || count > places {
            return Some(format!(
                "{count} sinks are to be placed on {places} vertices; ask for 1 to {places}"
            ));
        }
        None
    }
}

impl Problem {
    /// The problem with its open sinks placed: these vertices are sinks, and
    /// have to be active. Itself, if none is to be placed.
    ///
    /// What [`distances`](super::distances) and [`cost`](super::cost) say of a network of
    /// such a problem holds for what is settled.
    ///
    /// ```
    /// use network_opt::design::{cost, cost_of, Network, PlacedSinks, Problem};
    ///
    /// // A path of two edges, with a sink at one of its ends.
    /// let problem = Problem {
    ///     vertices: 3,
    ///     ends: vec![[0, 1], [1, 2]],
    ///     lengths: vec![1.0, 3.0],
    ///     states: vec![Default::default(); 2],
    ///     sinks: vec![false; 3],
    ///     placed: Some(PlacedSinks { candidates: vec![0, 2], count: 1 }),
    ///     dead_ends: true,
    ///     travel_weight: 1.0,
    ///     ..Problem::default()
    /// };
    /// let network = |sink| Network { active: vec![true; 2], sinks: vec![sink], ..Network::default() };
    /// assert_eq!(cost_of(&problem, &network(0)).travel, 1.0);
    /// assert_eq!(cost_of(&problem, &network(2)).travel, 3.0);
    /// assert_eq!(cost(&problem.settled(&[2]), &[true; 2]).travel, 3.0);
    /// ```
    #[must_use]
    pub fn settled(&self, sinks: &[usize]) -> Cow<'_, Self> {
        if self.placed.is_none() {
            return Cow::Borrowed(self);
        }
        let mut settled = self.clone();
        settled.placed = None;
        for &v in sinks.iter().filter(|&&v| v < self.vertices) {
            settled.sinks[v] = true;
            settled.required_vertices.push(v);
        }
        Cow::Owned(settled)
    }

    /// The problem with every candidate a sink, active or not: what it takes to
    /// reach a sink in it is no more than whatever is chosen.
    pub(crate) fn eased(&self) -> Cow<'_, Self> {
        if self.placed.is_none() {
            return Cow::Borrowed(self);
        }
        let sinks = self.possible_sinks();
        Cow::Owned(Self {
            sinks,
            placed: None,
            ..self.clone()
        })
    }

    /// Whether each vertex is a sink or may become one.
    #[must_use]
    pub fn possible_sinks(&self) -> Vec<bool> {
        let mut possible = self.sinks.clone();
        for &v in self.placed.iter().flat_map(|placed| &placed.candidates) {
            possible[v] = true;
        }
        possible
    }
}

/// What is wrong with the sinks that a network chooses, and with the network
/// if they are its sinks.
pub(super) fn verify_placed(problem: &Problem, network: &Network) -> Vec<Violation> {
    let none = PlacedSinks::default();
    let placed = problem.placed.as_ref().unwrap_or(&none);
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    for &vertex in &network.sinks {
        if !placed.candidates.contains(&vertex) || !seen.insert(vertex) {
            found.push(Violation::NoPlace { vertex });
        }
    }
    if seen.len() != placed.count {
        let sinks = seen.len();
        found.push(Violation::SinkCount { sinks });
    }
    let chosen: Vec<usize> = seen.into_iter().collect();
    let settled = problem.settled(&chosen);
    let rest = Network {
        sinks: Vec::new(),
        ..network.clone()
    };
    found.extend(verify(&settled, &rest));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::EdgeState;

    /// A ring of four, sinks to be placed on all but vertex 3.
    fn ring(count: usize) -> Problem {
        Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
            lengths: vec![1.0, 1.0, 1.0, 2.0],
            states: vec![EdgeState::Open; 4],
            sinks: vec![false; 4],
            placed: Some(PlacedSinks {
                candidates: vec![0, 1, 2],
                count,
            }),
            length_weight: 1.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    fn network(active: [bool; 4], sinks: &[usize]) -> Network {
        Network {
            active: active.to_vec(),
            sinks: sinks.to_vec(),
            ..Network::default()
        }
    }

    #[test]
    fn chosen_sinks_are_judged() {
        let with = |active, sinks: &[usize]| verify(&ring(2), &network(active, sinks));
        let path = [true, true, false, false];
        assert_eq!(with(path, &[0, 2]), []);
        // The end of a street at a sink is no dead end, at others it is.
        assert_eq!(with(path, &[0, 1]), [Violation::DeadEnd { vertex: 2 }]);
        assert_eq!(with([true; 4], &[0]), [Violation::SinkCount { sinks: 1 }]);
        assert_eq!(
            with([true; 4], &[0, 0]),
            [
                Violation::NoPlace { vertex: 0 },
                Violation::SinkCount { sinks: 1 }
            ]
        );
        assert!(with([true; 4], &[0, 3]).contains(&Violation::NoPlace { vertex: 3 }));
        assert!(with([true; 4], &[0, 9]).contains(&Violation::NoPlace { vertex: 9 }));
        // A sink that no street touches.
        assert_eq!(
            with([true, false, false, false], &[0, 2]),
            [
                Violation::Inactive { vertex: 2 },
                Violation::DeadEnd { vertex: 1 }
            ]
        );
        // None to be placed.
        let mut known = ring(2);
        known.placed = None;
        known.sinks[0] = true;
        assert_eq!(verify(&known, &network([true; 4], &[])), []);
        assert_eq!(
            verify(&known, &network([true; 4], &[1]))[0],
            Violation::NoPlace { vertex: 1 }
        );
    }

    #[test]
    fn counts_and_places_have_to_fit() {
        for count in [0, 4] {
            assert!(ring(count).check().is_err());
        }
        let mut problem = ring(3);
        assert_eq!(problem.check(), Ok(()));
        problem.sinks[2] = true;
        assert!(problem.check().is_err());
        let with = |candidates: Vec<usize>| {
            let mut problem = ring(1);
            problem.placed = Some(PlacedSinks {
                candidates,
                count: 1,
            });
            problem.check().is_err()
        };
        assert!(with(vec![0, 0]) && with(vec![4]) && with(vec![]) && !with(vec![3]));
    }
}
