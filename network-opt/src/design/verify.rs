//! Is a network valid? Knows nothing of solvers.

use super::cost::{occurs, placed};
use super::problem::{EdgeState, Network, Problem};
use super::violation::Violation;
use super::ways::{distances, distances_from, ways_to, Heading, Streets, Way};

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
pub(super) mod tests {
    use super::*;
    use crate::design::{Pattern, PatternKind, Placement, Rooms};

    /// A ladder of two squares: vertices 0 1 2 below, 3 4 5 above; edges 0-1,
    /// 1-2, 3-4, 4-5, 0-3, 1-4, 2-5. The sink is vertex 0.
    pub(in crate::design) fn ladder() -> Problem {
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

    pub(in crate::design) fn network(edges: &[usize]) -> Network {
        let mut active = vec![false; 7];
        edges.iter().for_each(|&e| active[e] = true);
        Network {
            active,
            ..Network::default()
        }
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
}
