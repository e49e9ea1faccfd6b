//! Is a network valid, and what does it cost? Knows nothing of solvers.

use std::fmt;

use super::problem::{EdgeState, Network, PatternKind, Problem};
use super::ways::{distances, distances_from, mean_way, ways_to, Heading, Streets, Way};

/// What is wrong with a network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Violation {
    /// The network has another number of edges than the problem.
    WrongSize,
    /// A given or required edge is not active.
    Missing {
        /// The edge.
        edge: usize,
    },
    /// A closed edge is active.
    Forbidden {
        /// The edge.
        edge: usize,
    },
    /// From an active edge no sink can be reached: an island (C1).
    Island {
        /// The edge.
        edge: usize,
    },
    /// None of the vertices that cover a place is active (C2).
    Uncovered {
        /// The position in [`Problem::coverage`].
        row: usize,
    },
    /// A vertex that must be active is not.
    Inactive {
        /// The vertex.
        vertex: usize,
    },
    /// A vertex that is no sink has a single active edge.
    DeadEnd {
        /// The vertex.
        vertex: usize,
    },
    /// A forbidden combination of edges.
    Pattern {
        /// The position in [`Problem::patterns`].
        pattern: usize,
        /// What it is.
        kind: PatternKind,
    },
    /// None of the paths between two places is active throughout.
    NoRoute {
        /// The position in [`Problem::routes`].
        route: usize,
    },
    /// A face is not covered by exactly one room, or an obstacle is covered.
    Tiling {
        /// The face.
        face: usize,
        /// How many rooms cover it.
        rooms: usize,
    },
    /// A room without a corridor on its border.
    NoDoor {
        /// The position in the list of placements.
        room: usize,
    },
    /// A corridor runs through a room.
    Crossed {
        /// The position in the list of placements.
        room: usize,
        /// The edge.
        edge: usize,
    },
    /// Another number of sinks is placed than there are to be.
    SinkCount {
        /// How many are, those of [`Violation::NoPlace`] not counted.
        sinks: usize,
    },
    /// A sink is placed where none may be, or twice at one vertex.
    NoPlace {
        /// The vertex.
        vertex: usize,
    },
    /// A room that does not exist.
    NoRoom {
        /// Its number.
        room: usize,
    },
    /// An edge that is to be one-way has no direction.
    NoDirection {
        /// The edge.
        edge: usize,
    },
    /// An edge has another direction than the problem says.
    WrongWay {
        /// The edge.
        edge: usize,
    },
    /// A vertex that is no sink, whose streets all lead to it: one can get
    /// there, but not on.
    OnlyIn {
        /// The vertex.
        vertex: usize,
    },
    /// A vertex that is no sink, whose streets all lead away from it.
    OnlyOut {
        /// The vertex.
        vertex: usize,
    },
    /// Streets lead on from a vertex, but none of them in its direction to a
    /// sink, though one is joined to it.
    NoWayOut {
        /// The vertex.
        vertex: usize,
    },
    /// Streets lead to a vertex, but none of them in its direction from a sink,
    /// though one is joined to it.
    NoWayIn {
        /// The vertex.
        vertex: usize,
    },
    /// Too few rooms of a kind, or too many.
    Count {
        /// The position in [`Rooms::counts`](super::Rooms::counts).
        count: usize,
        /// How many there are.
        rooms: usize,
    },
    /// A demand on rooms that is not met.
    Wish {
        /// The position in [`Rooms::wishes`](super::Rooms::wishes).
        wish: usize,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::WrongSize => write!(f, "the network has not one entry an edge"),
            Self::Missing { edge } => write!(f, "edge {edge} has to be active"),
            Self::Forbidden { edge } => write!(f, "edge {edge} must not be active"),
            Self::Island { edge } => write!(f, "edge {edge} reaches no sink"),
            Self::Uncovered { row } => write!(f, "nothing covers place {row}"),
            Self::Inactive { vertex } => write!(f, "vertex {vertex} has to be active"),
            Self::DeadEnd { vertex } => write!(f, "there is a dead end at vertex {vertex}"),
            Self::Pattern { pattern, kind } => {
                write!(f, "pattern {pattern} ({}) is forbidden", kind.as_str())
            }
            Self::NoRoute { route } => write!(f, "no path of route {route} is active"),
            Self::Tiling { face, rooms } => write!(f, "face {face} is covered by {rooms} rooms"),
            Self::NoDoor { room } => write!(f, "room {room} is on no corridor"),
            Self::Crossed { room, edge } => write!(f, "corridor {edge} runs through room {room}"),
            Self::SinkCount { sinks } => {
                write!(f, "{sinks} sinks are placed, not as many as asked")
            }
            Self::NoPlace { vertex } => {
                write!(f, "no sink may be placed at vertex {vertex}, or not twice")
            }
            Self::NoRoom { room } => write!(f, "there is no room {room}"),
            Self::NoDirection { edge } => {
                write!(f, "edge {edge} has to be one-way, and has no direction")
            }
            Self::WrongWay { edge } => write!(f, "edge {edge} has to run another way"),
            Self::OnlyIn { vertex } => {
                write!(
                    f,
                    "all streets at vertex {vertex} lead to it, none leads on"
                )
            }
            Self::OnlyOut { vertex } => {
                write!(
                    f,
                    "all streets at vertex {vertex} lead away, none leads to it"
                )
            }
            Self::NoWayOut { vertex } => write!(
                f,
                "no sink can be reached from vertex {vertex} along streets in their direction"
            ),
            Self::NoWayIn { vertex } => write!(
                f,
                "vertex {vertex} cannot be reached from a sink along streets in their direction"
            ),
            Self::Count { count, rooms } => {
                write!(f, "{rooms} rooms are not what count {count} asks for")
            }
            Self::Wish { wish } => write!(f, "demand {wish} on rooms is not met"),
        }
    }
}

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
fn placed(rooms: &super::Rooms, network: &Network) -> Vec<bool> {
    let mut placed = vec![false; rooms.placements.len()];
    for &room in &network.rooms {
        if let Some(placed) = placed.get_mut(room) {
            *placed = true;
        }
    }
    placed
}

pub(super) fn occurs(pattern: &super::Pattern, active: &[bool]) -> bool {
    pattern.active.iter().all(|&e| active[e]) && !pattern.inactive.iter().any(|&e| active[e])
}

/// All that is wrong with a network; empty if it is valid.
///
/// # Examples
///
/// ```
/// use network_opt::design::{verify, Network, Problem, Violation};
///
/// // Two edges in a row, the sink at one end: without dead ends there is no way.
/// let problem = Problem {
///     vertices: 3,
///     ends: vec![[0, 1], [1, 2]],
///     lengths: vec![1.0; 2],
///     states: vec![Default::default(); 2],
///     sinks: vec![true, false, false],
///     length_weight: 1.0,
///     ..Problem::default()
/// };
/// let both = Network { active: vec![true, true], ..Network::default() };
/// assert_eq!(verify(&problem, &both), [Violation::DeadEnd { vertex: 2 }]);
/// ```
#[must_use]
pub fn verify(problem: &Problem, network: &Network) -> Vec<Violation> {
    let active = &network.active;
    let ways = network.ways.len();
    if active.len() != problem.edges() || ways != 0 && ways != problem.edges() {
        return vec![Violation::WrongSize];
    }
    if problem.placed.is_some() || !network.sinks.is_empty() {
        return super::placed::verify_placed(problem, network);
    }
    let mut found = Vec::new();
    for (edge, state) in problem.states.iter().enumerate() {
        match (state, active[edge]) {
            (EdgeState::Given | EdgeState::Required, false) => {
                found.push(Violation::Missing { edge })
            }
            (EdgeState::Closed, true) => found.push(Violation::Forbidden { edge }),
            _ => {}
        }
    }
    // Whatever the directions.
    let on = |e: usize, _| active[e];
    let away = ways_to(problem, &problem.around(), &problem.sinks, Heading::Out, on);
    let mut degree = vec![0_usize; problem.vertices];
    for (edge, &[a, b]) in problem.ends.iter().enumerate() {
        if active[edge] {
            degree[a] += 1;
            degree[b] += 1;
            // Both ends are of one component.
            if away[a].is_infinite() {
                found.push(Violation::Island { edge });
            }
        }
    }
    if problem.has_one_way() {
        directions(problem, network, &away, &mut found);
    }
    for (row, ball) in problem.coverage.iter().enumerate() {
        if ball.iter().all(|&v| degree[v] == 0) {
            found.push(Violation::Uncovered { row });
        }
    }
    for &vertex in &problem.required_vertices {
        if degree[vertex] == 0 {
            found.push(Violation::Inactive { vertex });
        }
    }
    if !problem.dead_ends {
        let ends = (0..problem.vertices).filter(|&v| degree[v] == 1 && !problem.sinks[v]);
        found.extend(ends.map(|vertex| Violation::DeadEnd { vertex }));
    }
    for (pattern, p) in problem.patterns.iter().enumerate() {
        if p.cost.is_none() && occurs(p, active) {
            let kind = p.kind;
            found.push(Violation::Pattern { pattern, kind });
        }
    }
    for (route, r) in problem.routes.iter().enumerate() {
        if r.cost.is_none() && !r.is_there(active) {
            found.push(Violation::NoRoute { route });
        }
    }
    rooms(problem, network, &mut found);
    found
}

/// What is wrong with directions, islands left aside: they are named already.
fn directions(problem: &Problem, network: &Network, away: &[f64], found: &mut Vec<Violation>) {
    let streets = Streets::from(network);
    let mut leads = vec![[false; 2]; problem.vertices];
    let mut active = vec![false; problem.vertices];
    for (edge, ends) in problem.ends.iter().enumerate() {
        if !network.active[edge] {
            continue;
        }
        let (asked, way) = (problem.way(edge), streets.way(problem, edge));
        if way == Way::Either {
            found.push(Violation::NoDirection { edge });
        } else if asked != Way::Either && network.ways.get(edge).is_some_and(|&w| w != asked) {
            found.push(Violation::WrongWay { edge });
        }
        for (k, &v) in ends.iter().enumerate() {
            active[v] = true;
            leads[v][0] |= way.runs_from(k);
            leads[v][1] |= way.runs_from(1 - k);
        }
    }
    let (to, from) = (
        distances(problem, streets),
        distances_from(problem, streets),
    );
    let there = (0..problem.vertices).filter(|&v| active[v] && away[v].is_finite());
    for vertex in there {
        match (leads[vertex][0], to[vertex].is_finite()) {
            (_, true) => {}
            (false, false) => found.push(Violation::OnlyIn { vertex }),
            (true, false) => found.push(Violation::NoWayOut { vertex }),
        }
        match (leads[vertex][1], from[vertex].is_finite()) {
            (_, true) => {}
            (false, false) => found.push(Violation::OnlyOut { vertex }),
            (true, false) => found.push(Violation::NoWayIn { vertex }),
        }
    }
}

fn rooms(problem: &Problem, network: &Network, found: &mut Vec<Violation>) {
    let Some(rooms) = &problem.rooms else {
        found.extend(
            network
                .rooms
                .first()
                .map(|&room| Violation::NoRoom { room }),
        );
        return;
    };
    let mut covers = vec![0_usize; rooms.covered.len()];
    for &room in &network.rooms {
        let Some(placement) = rooms.placements.get(room) else {
            found.push(Violation::NoRoom { room });
            continue;
        };
        placement.faces.iter().for_each(|&f| covers[f] += 1);
        for &edge in &placement.inner {
            if network.active[edge] {
                found.push(Violation::Crossed { room, edge });
            }
        }
        if !placement.border.iter().any(|&e| network.active[e]) {
            found.push(Violation::NoDoor { room });
        }
    }
    for (face, (&count, &wanted)) in covers.iter().zip(&rooms.covered).enumerate() {
        if count != usize::from(wanted) {
            found.push(Violation::Tiling { face, rooms: count });
        }
    }
    let placed = placed(rooms, network);
    let is_placed = |r: usize| placed[r];
    for (count, wanted) in rooms.counts.iter().enumerate() {
        let rooms = wanted.rooms.iter().filter(|&&r| is_placed(r)).count();
        if rooms < wanted.least || wanted.most.is_some_and(|most| rooms > most) {
            found.push(Violation::Count { count, rooms });
        }
    }
    for (wish, wanted) in rooms.wishes.iter().enumerate() {
        if wanted.cost.is_none() && wanted.is_denied(is_placed) {
            found.push(Violation::Wish { wish });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Pattern, Placement, Rooms};

    /// A ladder of two squares: vertices 0 1 2 below, 3 4 5 above; edges 0-1,
    /// 1-2, 3-4, 4-5, 0-3, 1-4, 2-5. The sink is vertex 0.
    fn ladder() -> Problem {
        Problem {
            vertices: 6,
            ends: vec![[0, 1], [1, 2], [3, 4], [4, 5], [0, 3], [1, 4], [2, 5]],
            lengths: vec![1.0, 2.0, 1.0, 2.0, 1.0, 1.0, 1.0],
            states: vec![EdgeState::Open; 7],
            sinks: vec![true, false, false, false, false, false],
            length_weight: 10.0,
            travel_weight: 1.0,
            ..Problem::default()
        }
    }

    fn network(edges: &[usize]) -> Network {
        let mut active = vec![false; 7];
        edges.iter().for_each(|&e| active[e] = true);
        Network {
            active,
            ..Network::default()
        }
    }

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
    fn each_violation_is_found() {
        let with = |change: fn(&mut Problem), edges: &[usize]| {
            let mut problem = ladder();
            change(&mut problem);
            problem.check().expect("fits together");
            verify(&problem, &network(edges))
        };
        let ring = [0, 1, 6, 3, 2, 4];
        assert_eq!(
            with(|p| p.states[5] = EdgeState::Required, &ring),
            [Violation::Missing { edge: 5 }]
        );
        assert_eq!(
            with(|p| p.states[4] = EdgeState::Closed, &ring),
            [Violation::Forbidden { edge: 4 }]
        );
        // The right square alone is an island.
        let island = with(|_| {}, &[1, 6, 3, 5]);
        assert_eq!(island.len(), 4);
        assert!(matches!(island[0], Violation::Island { edge: 1 }));
        assert_eq!(
            with(|p| p.coverage = vec![vec![0], vec![2, 5]], &[0, 5, 2, 4]),
            [Violation::Uncovered { row: 1 }]
        );
        assert_eq!(
            with(|p| p.required_vertices = vec![5], &[0, 5, 2, 4]),
            [Violation::Inactive { vertex: 5 }]
        );
        assert_eq!(with(|_| {}, &[0, 1]), [Violation::DeadEnd { vertex: 2 }]);
        assert_eq!(with(|p| p.dead_ends = true, &[0, 1]), []);
        let close = |p: &mut Problem| {
            p.patterns = vec![Pattern {
                kind: PatternKind::TooClose,
                active: vec![0, 2],
                inactive: vec![],
                cost: None,
            }];
        };
        assert_eq!(with(close, &[0, 5, 2, 4]).len(), 1);
        assert_eq!(
            with(
                |p| p.routes = vec![vec![vec![1, 6], vec![5, 3]].into()],
                &[0, 5, 2, 4]
            ),
            [Violation::NoRoute { route: 0 }]
        );
        assert_eq!(
            with(
                |p| p.routes = vec![vec![vec![1, 6], vec![5, 3]].into()],
                &ring
            ),
            []
        );
        assert_eq!(
            verify(&ladder(), &Network::default()),
            [Violation::WrongSize]
        );
    }

    #[test]
    fn rooms_tile_have_doors_and_are_not_crossed() {
        let mut problem = ladder();
        let room = |faces: &[usize], inner: &[usize], border: &[usize]| Placement {
            template: "room".into(),
            faces: faces.to_vec(),
            inner: inner.to_vec(),
            border: border.to_vec(),
        };
        problem.rooms = Some(Rooms {
            placements: vec![
                room(&[0, 1], &[5], &[0, 1, 2, 3, 4, 6]),
                room(&[0], &[], &[0, 2, 4, 5]),
                room(&[1], &[], &[1, 3, 5, 6]),
            ],
            covered: vec![true, true],
            ..Rooms::default()
        });
        problem.check().expect("fits together");
        let with = |rooms: &[usize], edges: &[usize]| {
            verify(
                &problem,
                &Network {
                    rooms: rooms.to_vec(),
                    ..network(edges)
                },
            )
        };
        let ring = [0, 1, 6, 3, 2, 4];
        assert_eq!(with(&[0], &ring), []);
        assert_eq!(with(&[1, 2], &ring), []);
        assert_eq!(
            with(&[0, 1], &ring),
            [Violation::Tiling { face: 0, rooms: 2 }]
        );
        assert_eq!(with(&[1], &ring), [Violation::Tiling { face: 1, rooms: 0 }]);
        assert_eq!(
            with(&[0], &[0, 5, 2, 4]),
            [Violation::Crossed { room: 0, edge: 5 }]
        );
        assert_eq!(
            with(&[1, 2], &[]),
            [Violation::NoDoor { room: 1 }, Violation::NoDoor { room: 2 }]
        );
        assert_eq!(with(&[0, 9], &ring), [Violation::NoRoom { room: 9 }]);
        // With all faces obstacles nothing may be placed.
        problem.rooms.as_mut().expect("rooms").covered = vec![false; 2];
        assert_eq!(
            verify(
                &problem,
                &Network {
                    rooms: vec![2],
                    ..network(&ring)
                }
            ),
            [Violation::Tiling { face: 1, rooms: 1 }]
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
