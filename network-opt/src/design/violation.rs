//! What can be wrong with a network.

use std::fmt;

use super::problem::PatternKind;
#[cfg(doc)]
use super::problem::Problem;

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
