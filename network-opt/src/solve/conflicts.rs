//! Why there is no network: which families of constraints are in each other's
//! way.

use super::{Ended, Exact, Limits, NetworkSolver};
use crate::design::{EdgeState, PatternKind, Problem, RouteKind};
use crate::error::DesignError;
use crate::mip::MipSolver;

/// A family of constraints that can be left out of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Constraints {
    /// That places are covered.
    Coverage,
    /// That vertices are active.
    RequiredVertices,
    /// That edges are active.
    RequiredEdges,
    /// That edges are not.
    ClosedEdges,
    /// That there are no dead ends.
    DeadEnds,
    /// That a pattern does not occur.
    Pattern(PatternKind),
    /// That routes are there that were asked for.
    Routes,
    /// That places inside are joined: the point-to-point constraint.
    Inside,
    /// That places on the boundary are joined.
    Across,
    /// That rooms tile the floor, on corridors.
    Rooms,
    /// That there are so many rooms of a kind.
    RoomCounts,
    /// What rooms are demanded to be beside.
    RoomWishes,
    /// That all is within reach of a sink: without it every vertex is one, and
    /// none is to be placed.
    Connectivity,
    /// That so many sinks are placed, each on a street: without it all the
    /// candidates are sinks.
    PlacedSinks,
    /// That streets are one-way: without it traffic runs both ways everywhere.
    Directions,
}

impl Constraints {
    /// The family in words.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Coverage => "that places are covered",
            Self::RequiredVertices => "places that must be passed",
            Self::RequiredEdges => "edges that must be active",
            Self::ClosedEdges => "edges that must not be",
            Self::DeadEnds => "no dead ends",
            Self::Pattern(PatternKind::TooClose) => "none too close",
            Self::Pattern(PatternKind::ZigZag) => "no zig-zags",
            Self::Pattern(PatternKind::TJunction) => "no T-junctions",
            Self::Pattern(PatternKind::Branch) => "no branches",
            Self::Pattern(PatternKind::DeadEnd) => "no dead ends, one by one",
            Self::Pattern(PatternKind::Facade) => "no corridor along the facade",
            Self::Routes => "routes",
            Self::Inside => "places inside that must be joined",
            Self::Across => "places on the boundary that must be joined",
            Self::PlacedSinks => "how many sinks are placed, each on a street",
            Self::Directions => "one-way streets",
            Self::Rooms => "rooms that tile the floor, each on a corridor",
            Self::RoomCounts => "how many rooms of a kind there are",
            Self::RoomWishes => "what rooms must be beside",
            Self::Connectivity => "that all is within reach of a sink",
        }
    }
}

/// What makes a problem infeasible.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Conflict {
    /// Families each of which, left out alone, makes the rest possible.
    pub each: Vec<Constraints>,
    /// Families that cannot all be met, but could without any one of them, as
    /// far as that could be found out in time. Those of `each` are all in it.
    pub together: Vec<Constraints>,
    /// Whether every question was answered in time.
    pub complete: bool,
}

/// Finds out which families of constraints conflict, by leaving out one after
/// the other; `None` if the problem has a network.
///
/// Each question has the time of `limits` to be answered. What is not answered
/// counts as if it had no network; [`Conflict::complete`] says so.
///
/// # Errors
///
/// As [`NetworkSolver::solve`].
///
/// # Examples
///
/// ```
/// use network_opt::design::{EdgeState, Problem};
/// use network_opt::mip::Microlp;
/// use network_opt::solve::{conflicts, Constraints, Limits};
///
/// // Vertex 1 can only be reached by a dead end.
/// let problem = Problem {
///     vertices: 2,
///     ends: vec![[0, 1]],
///     lengths: vec![1.0],
///     states: vec![EdgeState::Open],
///     sinks: vec![true, false],
///     required_vertices: vec![1],
///     length_weight: 1.0,
///     ..Problem::default()
/// };
/// let conflict = conflicts(&problem, &Microlp, &Limits::default())?.unwrap();
/// assert!(conflict.each.contains(&Constraints::DeadEnds));
/// assert!(conflict.each.contains(&Constraints::RequiredVertices));
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn conflicts<M: MipSolver>(
    problem: &Problem,
    solver: &M,
    limits: &Limits,
) -> Result<Option<Conflict>, DesignError> {
    conflicts_by(problem, &Exact::new(solver), limits)
}

/// As [`conflicts`], by any solver: one that finds networks but proves little,
/// such as [`Search`](super::Search), answers by what it finds.
///
/// # Errors
///
/// As [`NetworkSolver::solve`].
pub fn conflicts_by(
    problem: &Problem,
    solver: &dyn NetworkSolver,
    limits: &Limits,
) -> Result<Option<Conflict>, DesignError> {
    problem.check()?;
    let mut complete = true;
    let mut possible = |problem: &Problem| -> Result<bool, DesignError> {
        // Any network will do, and the shortest is the easiest to look for.
        let mut asked = Problem {
            length_weight: 1.0,
            travel_weight: 0.0,
            patterns: (problem.patterns.iter())
                .filter(|p| p.cost.is_none())
                .cloned()
                .collect(),
            routes: (problem.routes.iter())
                .filter(|r| r.cost.is_none())
                .cloned()
                .collect(),
            ..problem.clone()
        };
        if let Some(rooms) = &mut asked.rooms {
            rooms.wishes.retain(|wish| wish.cost.is_none());
        }
        let mut found = false;
        let outcome = solver.solve(&asked, None, limits, &mut |progress| {
            found = progress.best.is_some();
            !found
        })?;
        complete &= found || outcome.network.is_some() || outcome.ended == Ended::Infeasible;
        Ok(found || outcome.network.is_some())
    };
    if possible(problem)? {
        return Ok(None);
    }
    let families = families(problem);
    let mut each = Vec::new();
    for &family in &families {
        if possible(&without(problem, &[family]))? {
            each.push(family);
        }
    }
    // Leave out what is not needed for the conflict, one family after the other.
    let mut left_out: Vec<Constraints> = Vec::new();
    for &family in families.iter().filter(|family| !each.contains(family)) {
        left_out.push(family);
        if possible(&without(problem, &left_out))? {
            left_out.pop();
        }
    }
    let together = families.into_iter().filter(|f| !left_out.contains(f));
    Ok(Some(Conflict {
        together: together.collect(),
        each,
        complete,
    }))
}

/// The families that a problem has.
fn families(problem: &Problem) -> Vec<Constraints> {
    let has = |state| problem.states.contains(&state);
    let mut kinds: Vec<PatternKind> = (problem.patterns.iter())
        .filter(|p| p.cost.is_none())
        .map(|p| p.kind)
        .collect();
    kinds.sort_unstable();
    kinds.dedup();
    let needs = |kind| {
        let mut routes = problem.routes.iter();
        routes.any(|r| r.kind == kind && r.cost.is_none())
    };
    let plain = [
        (!problem.coverage.is_empty(), Constraints::Coverage),
        (
            !problem.required_vertices.is_empty(),
            Constraints::RequiredVertices,
        ),
        (
            has(EdgeState::Required) || has(EdgeState::Given),
            Constraints::RequiredEdges,
        ),
        (has(EdgeState::Closed), Constraints::ClosedEdges),
        (!problem.dead_ends, Constraints::DeadEnds),
        (needs(RouteKind::Asked), Constraints::Routes),
        (needs(RouteKind::Inside), Constraints::Inside),
        (needs(RouteKind::Across), Constraints::Across),
        (problem.placed.is_some(), Constraints::PlacedSinks),
        (problem.rooms.is_some(), Constraints::Rooms),
        (
            (problem.rooms.iter()).any(|r| !r.counts.is_empty()),
            Constraints::RoomCounts,
        ),
        (
            (problem.rooms.iter()).any(|r| r.wishes.iter().any(|w| w.cost.is_none())),
            Constraints::RoomWishes,
        ),
        (true, Constraints::Connectivity),
        (problem.has_one_way(), Constraints::Directions),
    ];
    let plain = plain
        .into_iter()
        .filter(|(there, _)| *there)
        .map(|(_, f)| f);
    let mut families: Vec<Constraints> = plain
        .chain(kinds.into_iter().map(Constraints::Pattern))
        .collect();
    families.sort_unstable();
    families
}

/// Leaves out the routes of a kind that have to be there.
fn drop_routes(problem: &mut Problem, kind: RouteKind) {
    let routes = &mut problem.routes;
    routes.retain(|route| route.kind != kind || route.cost.is_some());
}

/// The problem without some families.
fn without(problem: &Problem, families: &[Constraints]) -> Problem {
    let mut rest = problem.clone();
    for &family in families {
        match family {
            Constraints::Coverage => rest.coverage.clear(),
            Constraints::RequiredVertices => rest.required_vertices.clear(),
            Constraints::RequiredEdges | Constraints::ClosedEdges => {
                let closed = family == Constraints::ClosedEdges;
                for state in &mut rest.states {
                    if *state != EdgeState::Open && (*state == EdgeState::Closed) == closed {
                        *state = EdgeState::Open;
                    }
                }
            }
            Constraints::DeadEnds => rest.dead_ends = true,
            Constraints::Pattern(kind) => {
                rest.patterns.retain(|p| p.kind != kind || p.cost.is_some());
            }
            Constraints::Routes => drop_routes(&mut rest, RouteKind::Asked),
            Constraints::Inside => drop_routes(&mut rest, RouteKind::Inside),
            Constraints::Across => drop_routes(&mut rest, RouteKind::Across),
            Constraints::PlacedSinks => rest = rest.eased().into_owned(),
            Constraints::Rooms => rest.rooms = None,
            Constraints::Directions => rest.ways.clear(),
            Constraints::RoomCounts => rest.rooms.iter_mut().for_each(|r| r.counts.clear()),
            Constraints::RoomWishes => rest.rooms.iter_mut().for_each(|r| {
                r.wishes.retain(|wish| wish.cost.is_some());
            }),
            Constraints::Connectivity => {
                rest.sinks.iter_mut().for_each(|sink| *sink = true);
                rest.placed = None;
            }
        }
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Pattern, Way};
    use crate::mip::Microlp;

    /// A square with the sink at 0; 2 has to be reached, and the two edges at 0
    /// are too close.
    fn square() -> Problem {
        Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
            lengths: vec![1.0; 4],
            states: vec![EdgeState::Open; 4],
            sinks: vec![true, false, false, false],
            coverage: vec![vec![2]],
            patterns: vec![Pattern {
                kind: PatternKind::TooClose,
                active: vec![0, 3],
                inactive: vec![],
                cost: None,
            }],
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    /// A street that leads to a place, and none that leads out of it.
    #[test]
    fn directions_are_a_family() {
        use Constraints::{Connectivity, Coverage, Directions};
        let mut problem = square();
        problem.patterns.clear();
        problem.dead_ends = true;
        problem.states[2] = EdgeState::Closed;
        problem.ways = vec![Way::Forward, Way::Either, Way::Both, Way::Both];
        let found = conflicts(&problem, &Microlp, &Limits::default());
        let found = found.expect("solved").expect("a conflict");
        let closed = Constraints::ClosedEdges;
        assert_eq!(found.each, [Coverage, closed, Connectivity, Directions]);
        assert!(found.complete);
        problem.states[2] = EdgeState::Open;
        let found = conflicts(&problem, &Microlp, &Limits::default());
        assert_eq!(found.expect("solved"), None);
    }

    #[test]
    fn families_in_conflict_are_named() {
        use Constraints::{Connectivity, Coverage, DeadEnds, Pattern};
        let limits = Limits::default();
        let found = conflicts(&square(), &Microlp, &limits).expect("solved");
        let close = Pattern(PatternKind::TooClose);
        let expected = vec![Coverage, DeadEnds, close, Connectivity];
        let found = found.expect("a conflict");
        assert_eq!((&found.each, &found.together), (&expected, &expected));
        assert!(found.complete);
        // Closed edges are in a conflict of their own then, and no family alone
        // is to blame but coverage and connectivity.
        let mut two = square();
        two.states[0] = EdgeState::Closed;
        two.states[3] = EdgeState::Closed;
        let found = conflicts(&two, &Microlp, &limits)
            .expect("solved")
            .expect("a conflict");
        assert_eq!(found.each, [Coverage, Connectivity]);
        assert!(found.together.contains(&Coverage) && found.together.len() >= 3);
        let mut fine = square();
        fine.patterns.clear();
        assert_eq!(conflicts(&fine, &Microlp, &limits).expect("solved"), None);
    }
}
