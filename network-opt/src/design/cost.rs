//! What does a network cost? Knows nothing of solvers.

use super::problem::{Network, Problem};
use super::ways::{distances, distances_from, mean_way, Streets};

/// What a network costs (equation 14).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cost {
    /// The sum that is to be small.
    pub objective: f64,
    /// Length of the active edges that were not given.
    pub length: f64,
    /// Sum over those edges of the way to the nearest sink from the nearer of
    /// their two ends, over active edges, by what travel over them costs. With
    /// one-way streets the mean of that and of the way from the nearest sink,
    /// each by the end that traffic of the edge may leave or enter by. Infinite
    /// on an island.
    pub travel: f64,
    /// What patterns cost that are not forbidden.
    pub patterns: f64,
    /// What routes cost that are not there and need not be.
    #[cfg_attr(feature = "serde", serde(default))]
    pub routes: f64,
    /// What wishes about rooms cost that are not granted.
    #[cfg_attr(feature = "serde", serde(default))]
    pub wishes: f64,
}

impl Cost {
    /// What of it is not travel: length, patterns, routes and wishes, by their
    /// weights.
    pub(crate) fn without_travel(&self, problem: &Problem) -> f64 {
        self.objective - problem.travel_weight * self.travel
    }
}

/// What a network costs, valid or not. Patterns that are forbidden cost
/// nothing here, nor do routes that have to be there. Where sinks are to be
/// placed, see [`cost_of`](super::cost_of).
///
/// # Panics
///
/// If there is not one entry an edge.
#[must_use]
pub fn cost<'n>(problem: &Problem, streets: impl Into<Streets<'n>>) -> Cost {
    let streets: Streets<'_> = streets.into();
    let active = streets.active();
    let away = distances(problem, streets);
    let from = problem
        .has_one_way()
        .then(|| distances_from(problem, streets));
    let (mut length, mut travel) = (0.0, 0.0);
    for (e, &[a, b]) in problem.ends.iter().enumerate() {
        if active[e] && !problem.is_given(e) {
            length += problem.lengths[e];
            travel += match &from {
                Some(from) => mean_way([a, b], streets.way(problem, e), &away, from),
                None => away[a].min(away[b]),
            };
        }
    }
    let patterns = problem
        .patterns
        .iter()
        .filter(|p| occurs(p, active))
        .filter_map(|p| p.cost)
        .sum();
    let missing = problem.routes.iter().filter(|r| !r.is_there(active));
    let routes = missing.filter_map(|r| r.cost).sum();
    // An island's way is infinite; 0 times that is not a number.
    let travelled = if problem.travel_weight > 0.0 {
        problem.travel_weight * travel
    } else {
        0.0
    };
    Cost {
        objective: problem.length_weight * length + travelled + patterns + routes,
        length,
        travel,
        patterns,
        routes,
        wishes: 0.0,
    }
}

/// What a network costs in all, valid or not: [`cost`] with the sinks that it
/// chooses, and the wishes about rooms that are not granted. Demands that are
/// not met cost nothing here.
///
/// # Panics
///
/// If the network has not one entry an edge.
#[must_use]
pub fn cost_of(problem: &Problem, network: &Network) -> Cost {
    let mut found = cost(&problem.settled(&network.sinks), network);
    if let Some(rooms) = &problem.rooms {
        let placed = placed(rooms, network);
        let denied = rooms.wishes.iter().filter(|w| w.is_denied(|r| placed[r]));
        found.wishes = denied.filter_map(|w| w.cost).sum();
        found.objective += found.wishes;
    }
    found
}

/// Whether each room that may be placed is.
pub(super) fn placed(rooms: &super::Rooms, network: &Network) -> Vec<bool> {
    let mut placed = vec![false; rooms.placements.len()];
    for &room in &network.rooms {
        if let Some(placed) = placed.get_mut(room) {
            *placed = true;
        }
    }
    placed
}

/// Whether a pattern is there: all of one list active, none of the other.
pub(super) fn occurs(pattern: &super::Pattern, active: &[bool]) -> bool {
    pattern.active.iter().all(|&e| active[e]) && !pattern.inactive.iter().any(|&e| active[e])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::verify::tests::{ladder, network};
    use crate::design::{verify, EdgeState, Pattern, PatternKind};

    #[test]
    fn costs_are_lengths_and_ways() {
        // All around: 0-1 and 0-3 start at the sink; 1-2 and 3-4 from a way of
        // 1, 2-5 from 3, 4-5 from 2.
        let ring = network(&[0, 1, 6, 3, 2, 4]);
        let found = cost(&ladder(), &ring.active);
        assert_eq!((found.length, found.travel), (8.0, 1.0 + 1.0 + 3.0 + 2.0));
        assert_eq!(found.objective, 87.0);
        assert_eq!(verify(&ladder(), &ring), []);
        // Given edges cost nothing, but are travelled on.
        let mut given = ladder();
        given.states[0] = EdgeState::Given;
        given.states[1] = EdgeState::Given;
        let found = cost(&given, &ring.active);
        assert_eq!((found.length, found.travel), (5.0, 1.0 + 3.0 + 2.0));
        assert_eq!(
            distances(&given, &ring.active),
            [0.0, 1.0, 3.0, 1.0, 2.0, 4.0]
        );
    }

    #[test]
    fn costs_of_patterns_are_added_and_forbidden_ones_are_not() {
        let mut problem = ladder();
        let pattern = |cost| Pattern {
            kind: PatternKind::TJunction,
            active: vec![0, 1],
            inactive: vec![5],
            cost,
        };
        problem.patterns = vec![pattern(Some(3.0)), pattern(None)];
        let ring = network(&[0, 1, 6, 3, 2, 4]);
        assert_eq!(cost(&problem, &ring.active).patterns, 3.0);
        assert_eq!(verify(&problem, &ring).len(), 1);
        problem.patterns[1].cost = Some(f64::NAN);
        assert!(problem.check().is_err());
    }
}
