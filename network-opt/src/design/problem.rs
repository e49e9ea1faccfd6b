//! What is to be solved: a specification spelled out on one mesh.

use super::placed::PlacedSinks;
use super::route::Route;
use super::ways::Way;
use crate::error::DesignError;

/// What is known of an edge beforehand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EdgeState {
    /// The program decides.
    #[default]
    Open,
    /// Active already, such as an existing street: costs no length, and its
    /// own way to a sink is not counted, but others travel over it.
    Given,
    /// Must become active, and costs what others cost.
    Required,
    /// Must not become active.
    Closed,
}

/// A combination of active and inactive edges that is unwelcome.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pattern {
    /// What it is called in messages: "zig-zag", "too close".
    pub kind: PatternKind,
    /// Edges that are active in it.
    pub active: Vec<usize>,
    /// Edges that are not.
    pub inactive: Vec<usize>,
    /// What each occurrence costs; `None` forbids it.
    pub cost: Option<f64>,
}

/// The local features of the paper's section 4.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PatternKind {
    /// Opposite edges of a quad.
    TooClose,
    /// Three edges that turn one way and then the other.
    ZigZag,
    /// Three of four edges at a crossing.
    TJunction,
    /// Three edges or more at a vertex.
    Branch,
    /// One edge alone at a vertex that is no sink.
    DeadEnd,
    /// A corridor along the facade.
    Facade,
}

impl PatternKind {
    /// The feature in words.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::TooClose => "too close",
            Self::ZigZag => "zig-zag",
            Self::TJunction => "T-junction",
            Self::Branch => "branch",
            Self::DeadEnd => "dead end",
            Self::Facade => "corridor along the facade",
        }
    }
}

/// A room that may be placed: a set of faces.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Placement {
    /// Which template it is of.
    pub template: String,
    /// The faces it takes.
    pub faces: Vec<usize>,
    /// Edges within it, none of which may be a corridor.
    pub inner: Vec<usize>,
    /// Edges around it, one of which at least must be a corridor.
    pub border: Vec<usize>,
}

/// How many of some rooms there may be: the paper's "linear constraints" on the
/// occurrences of room types (section 5.2).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RoomCount {
    /// What is counted, in messages.
    pub name: String,
    /// The placements that count, each once.
    pub rooms: Vec<usize>,
    /// So many of them at least.
    pub least: usize,
    /// So many of them at most; `None` for any number.
    pub most: Option<usize>,
}

/// A wish about rooms: if all of `when` are placed, one of `then` is wanted
/// too.
///
/// With one room in `when` and those that share a wall with it in `then` this
/// is "next to"; with `then` empty it is a room that is unwelcome where it is;
/// with two in `when` and `then` empty, two that are unwelcome together.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RoomWish {
    /// Placements.
    pub when: Vec<usize>,
    /// Placements.
    pub then: Vec<usize>,
    /// What it costs if it is not granted; `None` demands it.
    pub cost: Option<f64>,
}

impl RoomWish {
    /// Whether it is not granted by these rooms.
    #[must_use]
    pub fn is_denied(&self, is_placed: impl Fn(usize) -> bool) -> bool {
        self.when.iter().all(|&r| is_placed(r)) && !self.then.iter().any(|&r| is_placed(r))
    }
}

/// Rooms, which take the place of coverage (the paper's section 5.2).
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct Rooms {
    /// All that may be placed.
    pub placements: Vec<Placement>,
    /// Whether each face is to be covered by exactly one room; the others are
    /// obstacles, covered by none.
    pub covered: Vec<bool>,
    /// How many there may be.
    pub counts: Vec<RoomCount>,
    /// Which are wanted where, and beside which.
    pub wishes: Vec<RoomWish>,
}

/// An integer program in the making: which edges of a mesh are active?
///
/// Made from a [`Specification`](super::Specification), or by hand. Every
/// number of an edge, vertex or face is a position in the lists of the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Problem {
    /// Number of vertices.
    pub vertices: usize,
    /// The two ends of each edge.
    pub ends: Vec<[usize; 2]>,
    /// Delta, the length of each edge: what it costs, and what travel over it
    /// costs unless [`Problem::travel_costs`] says otherwise. Positive.
    pub lengths: Vec<f64>,
    /// What travel over each edge costs: its time, say, in the unit of lengths
    /// at the speed of new streets, so that faster streets attract. Positive;
    /// empty if it is the length.
    #[cfg_attr(feature = "serde", serde(default))]
    pub travel_costs: Vec<f64>,
    /// Which way traffic may run over each edge, given ones too; empty if both
    /// ways everywhere. From every active vertex a sink must be within reach
    /// along streets in their direction, and it from a sink.
    #[cfg_attr(feature = "serde", serde(default))]
    pub ways: Vec<Way>,
    /// What is known of each edge.
    pub states: Vec<EdgeState>,
    /// Whether each vertex is a sink: where traffic goes.
    pub sinks: Vec<bool>,
    /// Sets of vertices of which one at least must be active: the balls of the
    /// coverage constraint (equation 6).
    pub coverage: Vec<Vec<usize>>,
    /// Vertices that must be active.
    pub required_vertices: Vec<usize>,
    /// Whether a vertex that is no sink may have a single active edge.
    pub dead_ends: bool,
    /// Unwelcome combinations of edges; each at most once.
    pub patterns: Vec<Pattern>,
    /// Routes between two places that have to be there, or cost something if
    /// they are not (equations 7 and 8).
    pub routes: Vec<Route>,
    /// Sinks that are to be placed, besides those of `sinks`.
    #[cfg_attr(feature = "serde", serde(default))]
    pub placed: Option<PlacedSinks>,
    /// Rooms, if this is a floorplan.
    pub rooms: Option<Rooms>,
    /// lambda_L, the weight of length.
    pub length_weight: f64,
    /// lambda_D, the weight of travel.
    pub travel_weight: f64,
}

impl Problem {
    /// Number of edges.
    #[must_use]
    pub fn edges(&self) -> usize {
        self.ends.len()
    }

    /// Whether an edge counts as active without being chosen.
    #[must_use]
    pub fn is_given(&self, edge: usize) -> bool {
        self.states[edge] == EdgeState::Given
    }

    /// The edges at each vertex with their other ends.
    #[must_use]
    pub fn around(&self) -> Vec<Vec<(usize, usize)>> {
        let mut around = vec![Vec::new(); self.vertices];
        for (e, &[a, b]) in self.ends.iter().enumerate() {
            around[a].push((e, b));
            around[b].push((e, a));
        }
        around
    }

    /// Checks that the lists fit together.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`], which says what does not.
    pub fn check(&self) -> Result<(), DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let (edges, vertices) = (self.edges(), self.vertices);
        for (name, len, wanted) in [
            ("lengths", self.lengths.len(), edges),
            ("states", self.states.len(), edges),
            ("sinks", self.sinks.len(), vertices),
        ] {
            if len != wanted {
                return bad(format!("{name} has {len} entries, of {wanted}"));
            }
        }
        if let Some(e) = self
            .ends
            .iter()
            .position(|[a, b]| a == b || *a.max(b) >= vertices)
        {
            return bad(format!("edge {e} does not join two of {vertices} vertices"));
        }
        if let Some(e) = self
            .lengths
            .iter()
            .position(|l| !(*l > 0.0 && l.is_finite()))
        {
            return bad(format!(
                "edge {e} is {} long; lengths are positive",
                self.lengths[e]
            ));
        }
        self.check_ways()?;
        for (name, weight) in [
            ("length", self.length_weight),
            ("travel", self.travel_weight),
        ] {
            if !(weight >= 0.0 && weight.is_finite()) {
                return bad(format!("the weight of {name} is {weight}; give 0 or more"));
            }
        }
        if let Some(what) = self.placed.as_ref().and_then(|p| p.fault(&self.sinks)) {
            return bad(what);
        }
        if self.placed.is_some() && self.has_one_way() {
            return bad(
                "sinks are to be placed where streets are one-way; place them first, on two-way streets"
                    .to_owned(),
            );
        }
        if !self.sinks.contains(&true) && self.placed.is_none() {
            return bad("there is no sink, so nothing can be reached".to_owned());
        }
        let edge_lists = self.patterns.iter().flat_map(|p| [&p.active, &p.inactive]);
        let rooms = self.rooms.iter().flat_map(|r| &r.placements);
        let edge_lists = edge_lists
            .chain(self.routes.iter().flat_map(|route| &route.paths))
            .chain(rooms.clone().flat_map(|r| [&r.inner, &r.border]));
        if let Some(e) = edge_lists.flatten().find(|&&e| e >= edges) {
            return bad(format!("edge {e} is named, of {edges}"));
        }
        let named = self
            .coverage
            .iter()
            .flatten()
            .chain(&self.required_vertices);
        if let Some(v) = named.into_iter().find(|&&v| v >= vertices) {
            return bad(format!("vertex {v} is named, of {vertices}"));
        }
        if let Some(rooms) = &self.rooms {
            let faces = rooms.covered.len();
            if let Some(f) = rooms
                .placements
                .iter()
                .flat_map(|r| &r.faces)
                .find(|&&f| f >= faces)
            {
                return bad(format!("face {f} is named, of {faces}"));
            }
            let placements = rooms.placements.len();
            let named = (rooms.wishes.iter())
                .flat_map(|w| w.when.iter().chain(&w.then))
                .chain(rooms.counts.iter().flat_map(|c| &c.rooms));
            if let Some(r) = named.into_iter().find(|&&r| r >= placements) {
                return bad(format!("placement {r} is named, of {placements}"));
            }
            for count in &rooms.counts {
                let (name, least) = (&count.name, count.least);
                if let Some(most) = count.most.filter(|&most| most < least) {
                    return bad(format!("of {name:?} there are to be {least} to {most}"));
                }
                let mut once = count.rooms.clone();
                once.sort_unstable();
                once.dedup();
                if once.len() < count.rooms.len() {
                    return bad(format!("the count of {name:?} names a placement twice"));
                }
            }
            let mut costs = rooms.wishes.iter().filter_map(|w| w.cost);
            if let Some(cost) = costs.find(|c| !(*c >= 0.0 && c.is_finite())) {
                return bad(format!("a wish costs {cost}; give 0 or more, or demand it"));
            }
        }
        let mut costs = self.routes.iter().filter_map(|r| r.cost);
        if let Some(cost) = costs.find(|c| !(*c >= 0.0 && c.is_finite())) {
            return bad(format!(
                "a route that is not there costs {cost}; give 0 or more, or demand it"
            ));
        }
        let mut costs = self.patterns.iter().filter_map(|p| p.cost);
        if let Some(cost) = costs.find(|c| !(*c >= 0.0 && c.is_finite())) {
            return bad(format!(
                "a pattern costs {cost}; give 0 or more, or forbid it"
            ));
        }
        Ok(())
    }
}

/// An answer: which edges are active, and which rooms and sinks are placed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Network {
    /// Whether each edge is active, given ones included.
    pub active: Vec<bool>,
    /// Positions of the placed rooms, ascending.
    pub rooms: Vec<usize>,
    /// The sinks that were placed, ascending; empty if the problem knows all.
    #[cfg_attr(feature = "serde", serde(default))]
    pub sinks: Vec<usize>,
    /// Which way traffic runs over each edge. Empty if the problem leaves no
    /// direction open; else with [`Way::Forward`] or [`Way::Backward`] for each
    /// active edge of which it does, and what the problem says for all others.
    #[cfg_attr(feature = "serde", serde(default))]
    pub ways: Vec<Way>,
}
