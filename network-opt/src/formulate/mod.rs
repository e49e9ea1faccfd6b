//! From a [`Problem`] to an integer program and back.
//!
//! One module for each family of constraints, each with its equation:
//! `activity` (1), `dead_ends` (2), `coverage` (3), `patterns` (4, 5), `balls`
//! (6), `flow` (7), `travel` (8), `single_sink` (9), `routes`, `rooms` (15 to
//! 17, 20 and 21), `parents` and `room_balls` (22 to 25), `detours` (26, 27), `sinks`
//! (28), `connections` (29), `symmetry` (30), and `paper`, the formulation of Peng et al. 2016 as they wrote it. With
//! one-way streets `arcs` (10 to 12) and `one_way` (13, 14) take the place of
//! `flow` and `travel`; these two have numbers of their own.

mod activity;
mod arcs;
mod balls;
mod connections;
mod coverage;
mod cycles;
mod dead_ends;
mod detours;
mod draft;
mod flow;
mod one_way;
mod paper;
mod parents;
mod patterns;
mod prepare;
mod price;
mod reach;
mod room_balls;
mod rooms;
mod routes;
mod single_sink;
mod sinks;
mod symmetry;
mod travel;

use crate::design::{Heading, Network, Problem, Streets};
use crate::error::DesignError;
use crate::mip::{Program, Row};

use connections::Connections;
use detours::Detours;
use draft::{Draft, Fill, Known, Term};
use room_balls::RoomBalls;

pub use prepare::{prepare, Fate};
pub(crate) use price::step;
pub use single_sink::longest_ways;

/// Which integer program a problem becomes.
///
/// All have the same valid networks and the same optimum, but that
/// [`Formulation::Flow`] does not price travel and [`Formulation::Paper`]
/// prices it by the paper's recursion, which is the true distance where all
/// edges are of length 1. One-way streets are known to [`Formulation::Flow`] and
/// [`Formulation::TravelFlow`] alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Formulation {
    /// What is best for the weights and sinks of the problem, see
    /// [`Formulation::for_problem`].
    #[default]
    Recommended,
    /// **F**: a flow from vertices; exact if travel costs nothing, else a lower
    /// bound.
    Flow,
    /// **Fe**: a flow from edges that prices travel.
    TravelFlow,
    /// **T**: distances of vertices along a tree, for one sink or few.
    SingleSink,
    /// The paper's own, equations 1 to 17: distances of half-edges.
    Paper,
}

impl Formulation {
    /// The one that measured best: [`Formulation::Flow`] where travel costs
    /// nothing, [`Formulation::SingleSink`] with one sink and travel that counts
    /// most, and no street one-way, [`Formulation::TravelFlow`] else. Where travel only breaks ties
    /// between networks of one length, [`Exact`](crate::solve::Exact) solves the
    /// flow before it.
    #[must_use]
    pub fn for_problem(problem: &Problem) -> Self {
        let sinks = problem.sinks.iter().filter(|&&sink| sink).count();
        if problem.travel_weight == 0.0 {
            Self::Flow
        } else if problem.has_one_way() {
            Self::TravelFlow
        } else if sinks == 1
            && problem.placed.is_none()
            && problem.travel_weight >= problem.length_weight
        {
            Self::SingleSink
        } else {
            Self::TravelFlow
        }
    }
}

/// Families of cuts: rows that every valid network meets and that fractions do
/// not. Without them programs have the same solutions, and worse bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cuts {
    /// Ball cuts (6): what coverage and connectivity say together.
    ///
    /// Default value: `true`.
    pub balls: bool,
    /// Room cuts (24) and (25): what rooms and connectivity say together.
    ///
    /// Default value: `true`.
    pub rooms: bool,
    /// Detour cuts (26): what travel and streets that are missing say together.
    /// Of [`Formulation::TravelFlow`] and [`Formulation::SingleSink`].
    ///
    /// Default value: `true`.
    pub detours: bool,
    /// Connection cuts (29): what has to be active is joined to a sink by a whole
    /// street. Of all formulations but [`Formulation::Paper`].
    ///
    /// Default value: `true`.
    pub connections: bool,
}

impl Default for Cuts {
    fn default() -> Self {
        Self::all()
    }
}

impl Cuts {
    /// All of them.
    #[must_use]
    pub const fn all() -> Self {
        Self {
            balls: true,
            rooms: true,
            detours: true,
            connections: true,
        }
    }

    /// None of them.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            balls: false,
            rooms: false,
            detours: false,
            connections: false,
        }
    }
}

/// A problem as an integer program.
#[derive(Debug)]
pub struct Formulated<'p> {
    problem: &'p Problem,
    formulation: Formulation,
    program: Program,
    x: Vec<Term>,
    arcs: Option<arcs::Arcs>,
    rooms: Option<usize>,
    placed: sinks::Placed,
    room_balls: Option<RoomBalls>,
    detours: Option<Detours>,
    connections: Option<Connections>,
    families: Vec<Family>,
    symmetries: Option<symmetry::Symmetries>,
    /// Rows before those that were added by [`Formulated::cut`].
    own_rows: usize,
    contradicts: bool,
    longest: Option<Vec<f64>>,
    /// Columns before those of connectivity, travel and rooms, and the first of
    /// rooms: what these but for those between cost is length, patterns and
    /// wishes.
    plain: [usize; 2],
    /// What a network costs beside what the program prices, and how much one of
    /// the program's units is; none if it prices all in units of the problem.
    priced: Option<[f64; 2]>,
}

/// Families with columns of their own.
#[derive(Debug)]
enum Family {
    Plain(Box<dyn Fill>),
    Rooms(rooms::Rooms),
}

impl<'p> Formulated<'p> {
    /// Writes a problem down as an integer program. `longest` bounds the way of
    /// each vertex to its sink; only [`Formulation::SingleSink`] uses it, and
    /// is the better the less it is: see [`longest_ways`].
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`] if the problem does not fit together;
    /// [`DesignError::BadOption`] for a formulation that does not know one-way
    /// streets, if there are any.
    ///
    /// # Examples
    ///
    /// ```
    /// use network_opt::design::{Network, Problem};
    /// use network_opt::formulate::{Formulated, Formulation};
    /// use network_opt::mip::{Microlp, MipReply, MipSolver};
    ///
    /// // A square with the sink at vertex 0; vertex 2 has to be reached.
    /// let problem = Problem {
    ///     vertices: 4,
    ///     ends: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
    ///     lengths: vec![1.0, 1.0, 1.0, 2.0],
    ///     states: vec![Default::default(); 4],
    ///     sinks: vec![true, false, false, false],
    ///     required_vertices: vec![2],
    ///     dead_ends: true,
    ///     length_weight: 1.0,
    ///     ..Problem::default()
    /// };
    /// let formulated = Formulated::new(&problem, Formulation::Recommended, None)?;
    /// let (program, limits) = (formulated.program(), Default::default());
    /// let found = Microlp.solve(program, None, &limits, &mut |_| MipReply::GoOn)?;
    /// let network = formulated.network(&found.solution.unwrap());
    /// assert_eq!(network.active, [true, true, false, false]);
    /// # Ok::<(), network_opt::DesignError>(())
    /// ```
    pub fn new(
        problem: &'p Problem,
        formulation: Formulation,
        longest: Option<Vec<f64>>,
    ) -> Result<Self, DesignError> {
        Self::with_cuts(problem, formulation, longest, Cuts::default())
    }

    /// As [`Formulated::new`], with some families of cuts only.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`] if the problem does not fit together.
    pub fn with_cuts(
        problem: &'p Problem,
        formulation: Formulation,
        longest: Option<Vec<f64>>,
        cuts: Cuts,
    ) -> Result<Self, DesignError> {
        problem.check()?;
        let formulation = match formulation {
            Formulation::Recommended => Formulation::for_problem(problem),
            other => other,
        };
        knows_ways(problem, formulation)?;
        let mut draft = Draft::new(problem);
        let tight = formulation != Formulation::Paper;
        let mut families: Vec<Family> = Vec::new();
        let mut plain = |family: Box<dyn Fill>| families.push(Family::Plain(family));
        plain(Box::new(activity::add(&mut draft, tight)));
        let placed = sinks::add(&mut draft);
        dead_ends::add(&mut draft);
        coverage::add(&mut draft);
        plain(Box::new(routes::add(&mut draft, tight)));
        if tight {
            plain(Box::new(patterns::add(&mut draft)));
            if cuts.balls {
                plain(Box::new(balls::add(&mut draft)));
            }
        }
        let mut detours = None;
        // What follows is proven for sinks that are known and streets that run
        // both ways.
        let plainly = problem.placed.is_none() && !problem.has_one_way();
        let plain_columns = draft.program.columns().len();
        let arcs = problem.has_one_way().then(|| arcs::add(&mut draft));
        if let Some(arcs) = &arcs {
            plain(Box::new(arcs.clone()));
            let travels = formulation == Formulation::TravelFlow;
            for heading in Heading::BOTH {
                if travels {
                    plain(Box::new(one_way::add_edges(&mut draft, arcs, heading)));
                }
                if !travels || one_way::has_orphans(problem, heading) {
                    plain(Box::new(one_way::add_vertices(&mut draft, arcs, heading)));
                }
            }
        }
        match formulation {
            // Done.
            _ if arcs.is_some() => {}
            Formulation::Recommended | Formulation::Flow => {
                plain(Box::new(flow::add(&mut draft)));
            }
            Formulation::TravelFlow => {
                let travel = travel::add(&mut draft);
                if cuts.detours && plainly {
                    detours = detours::add(&mut draft, &travel);
                    if let Some(detours) = &detours {
                        plain(Box::new(detours.clone()));
                    }
                }
                plain(Box::new(travel));
                if flow::has_orphans(&draft) {
                    plain(Box::new(flow::add(&mut draft)));
                }
            }
            Formulation::SingleSink => {
                let ways = single_sink::add(&mut draft, longest.as_deref());
                if cuts.detours && plainly {
                    detours = detours::of(&draft, ways.ways());
                }
                plain(Box::new(ways));
            }
            Formulation::Paper => plain(Box::new(paper::add(&mut draft))),
        }
        let connections = cuts
            .connections
            .then(|| Connections::of(&draft, formulation));
        let room_columns = draft.program.columns().len();
        let mut room_balls = None;
        let rooms = rooms::add(&mut draft, tight).map(|rooms| {
            if tight && cuts.rooms && plainly {
                let parents = parents::add(&mut draft);
                families.push(Family::Plain(Box::new(parents.clone())));
                let (r, holding) = (&rooms.r, &rooms.holding);
                room_balls = Some(RoomBalls::add(&mut draft, r, holding, parents));
            }
            families.push(Family::Rooms(rooms));
            families.len() - 1
        });
        let mut program = draft.program;
        program.promise_step(price::step(problem, formulation));
        let own_rows = program.rows().len();
        Ok(Self {
            problem,
            formulation,
            program,
            x: draft.x,
            arcs,
            rooms,
            placed,
            room_balls,
            detours,
            connections: connections.flatten(),
            families,
            symmetries: None,
            own_rows,
            contradicts: draft.contradicts,
            longest,
            plain: [plain_columns, room_columns],
            priced: None,
        })
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Which it is; never [`Formulation::Recommended`].
    #[must_use]
    pub fn formulation(&self) -> Formulation {
        self.formulation
    }

    /// The bounds on the ways of vertices that the program relies on: it knows of
    /// no network with a longer one.
    #[must_use]
    pub fn longest(&self) -> Option<&[f64]> {
        let relies = self.formulation == Formulation::SingleSink;
        self.longest.as_deref().filter(|_| relies)
    }

    /// Whether some row cannot hold, so that there is no valid network.
    #[must_use]
    pub fn contradicts(&self) -> bool {
        self.contradicts
    }

    /// The network of a solution.
    ///
    /// # Panics
    ///
    /// If there is not one value a column.
    #[must_use]
    pub fn network(&self, values: &[f64]) -> Network {
        assert_eq!(
            values.len(),
            self.program.columns().len(),
            "one value a column"
        );
        let active = self.x.iter().map(|x| match x {
            Term::Off => false,
            Term::On => true,
            Term::Column(column) => values[*column] > 0.5,
        });
        let active: Vec<bool> = active.collect();
        let arcs = self.arcs.as_ref();
        let backward = |e: usize| arcs.is_some_and(|arcs| arcs.is_backward(e, values));
        Network {
            ways: self.problem.decided_ways(&active, backward),
            active,
            rooms: (self.room_family()).map_or_else(Vec::new, |rooms| rooms.placed(values)),
            sinks: self.placed.chosen(values),
        }
    }

    /// The solution of a network. If the network is valid, and no way in it
    /// longer than [`Formulated::longest`], it meets all rows.
    ///
    /// # Panics
    ///
    /// If the network has not one entry an edge.
    #[must_use]
    pub fn solution(&self, network: &Network) -> Vec<f64> {
        assert_eq!(
            network.active.len(),
            self.problem.edges(),
            "one entry an edge"
        );
        let known = Known::new(self.problem, network);
        // Fixed columns hold constants.
        let columns = self.program.columns().iter();
        let mut values: Vec<f64> = columns
            .map(|c| if c.low == c.high { c.low } else { 0.0 })
            .collect();
        self.placed.fill(&known, &mut values);
        for family in &self.families {
            match family {
                Family::Plain(family) => family.fill(&known, &mut values),
                Family::Rooms(rooms) => rooms.fill(&known, &mut values),
            }
        }
        values
    }

    /// Valid rows that a solution of the relaxation violates by over
    /// `tolerance`: room cuts, detour cuts and connection cuts, which are too many
    /// to write all of them down.
    #[must_use]
    pub fn separate(&self, values: &[f64], tolerance: f64) -> Vec<Row> {
        let rooms = self.room_balls.iter();
        let mut rows: Vec<Row> = rooms
            .flat_map(|balls| balls.separate(values, tolerance))
            .collect();
        let detours = self.detours.iter();
        rows.extend(detours.flat_map(|detours| detours.separate(values, tolerance)));
        let connections = self.connections.iter();
        rows.extend(connections.flat_map(|all| all.separate(values, tolerance)));
        rows
    }

    /// The program with all edges and their directions as in `network` but those
    /// of which `free` says true, and rooms as there but those with all their edges free.
    ///
    /// # Panics
    ///
    /// If `network` or `free` has not one entry an edge.
    #[must_use]
    pub fn window(&self, network: &Network, free: &[bool]) -> Program {
        assert_eq!(network.active.len(), self.x.len(), "one entry an edge");
        assert_eq!(free.len(), self.x.len(), "one entry an edge");
        let mut program = self.program.clone();
        for (e, x) in self.x.iter().enumerate() {
            if let (Term::Column(column), false) = (*x, free[e]) {
                let value = f64::from(u8::from(network.active[e]));
                program.bound(column, value, value);
            }
        }
        let streets = Streets::from(network);
        for &(e, columns) in self.arcs.iter().flat_map(|arcs| arcs.free()) {
            let way = streets.way(self.problem, e);
            for (end, column) in columns.into_iter().enumerate().filter(|_| !free[e]) {
                let runs = network.active[e] && way.runs_from(end);
                let value = f64::from(u8::from(runs));
                program.bound(column, value, value);
            }
        }
        if let (Some(rooms), Some(placed)) = (self.room_family(), &self.problem.rooms) {
            let is_free = placed.placements.iter().map(|placement| {
                let mut edges = placement.inner.iter().chain(&placement.border);
                edges.all(|&e| free[e])
            });
            for (k, is_free) in is_free.enumerate() {
                if let (Some(column), false) = (rooms.column(k), is_free) {
                    let value = f64::from(u8::from(network.rooms.contains(&k)));
                    program.bound(column, value, value);
                }
            }
        }
        program
    }

    /// Whether there are any such rows.
    #[must_use]
    pub fn separates(&self) -> bool {
        self.room_balls.is_some() || self.detours.is_some() || self.connections.is_some()
    }

    /// Adds a row that all valid networks meet.
    pub fn cut(&mut self, row: Row) {
        self.program.row(row.low, row.high, row.terms);
    }

    /// Adds those of the rows of another formulation of the same problem, with the
    /// same families of cuts, that are of streets, patterns and routes alone, which
    /// come first in all of them.
    pub(crate) fn adopt(&mut self, rows: &[Row]) {
        let shared = self.plain[0];
        let is_shared = |row: &&Row| row.terms.iter().all(|&(column, _)| column < shared);
        rows.iter()
            .filter(is_shared)
            .for_each(|row| self.cut(row.clone()));
    }

    /// The rows that were added.
    pub(crate) fn added(&self) -> &[Row] {
        &self.program.rows()[self.own_rows..]
    }

    /// Drops added rows that a solution does not need, of connection cuts.
    pub(crate) fn drop_idle_cuts(&mut self, values: &[f64]) {
        if self.connections.is_some() && self.room_balls.is_none() {
            self.program.drop_idle_rows(self.own_rows, values);
        }
    }

    fn room_family(&self) -> Option<&rooms::Rooms> {
        match self.families.get(self.rooms?)? {
            Family::Rooms(rooms) => Some(rooms),
            Family::Plain(_) => None,
        }
    }
}

/// Whether a formulation knows the one-way streets of a problem, if it has any.
fn knows_ways(problem: &Problem, formulation: Formulation) -> Result<(), DesignError> {
    if !problem.has_one_way() {
        return Ok(());
    }
    let name = match formulation {
        Formulation::SingleSink => "SingleSink",
        Formulation::Paper => "Paper",
        Formulation::Recommended | Formulation::Flow | Formulation::TravelFlow => return Ok(()),
    };
    Err(DesignError::BadOption {
        what: format!(
            "the formulation {name} does not know one-way streets; take Flow, TravelFlow (where \
             travel costs something) or Recommended"
        ),
    })
}

/// A number of edges than which no cycle has fewer that may be active throughout
/// in a valid network; `None` if there is no cycle at all.
pub(crate) fn least_cycle(problem: &Problem) -> Option<usize> {
    cycles::least_cycle(&Draft::new(problem))
}
