//! What a network is for, in the designer's words, and what that means for
//! each edge of a mesh.

mod patterns;
mod places;
mod states;
mod traffic;

pub use places::{Among, Place};
pub use traffic::{Across, Inside, Pairs, Parts, Traffic};

use super::one_way::{ways, OneWay};
use super::placed::PlacedSinks;
use super::problem::{EdgeState, Problem};
use super::tessellation::Tessellation;
use crate::error::DesignError;

/// How a local feature is treated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Feature {
    /// Neither sought nor avoided.
    #[default]
    Free,
    /// Each occurrence costs so much.
    Weighted(f64),
    /// Must not occur.
    Forbidden,
}

impl Feature {
    /// What an occurrence costs: nothing to say if it is free, `Some(None)` if
    /// it is forbidden.
    fn cost(self) -> Option<Option<f64>> {
        match self {
            Self::Free => None,
            Self::Weighted(cost) => Some(Some(cost)),
            Self::Forbidden => Some(None),
        }
    }
}

/// How near a street must be to every vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Coverage {
    /// Within so many edges.
    Hops(usize),
    /// Within so many metres along edges.
    Metres(f64),
}

/// Where traffic goes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Sinks {
    /// All vertices on the boundary.
    #[default]
    Boundary,
    /// All vertices on streets that exist: what the streets of a lower level
    /// lead to.
    Streets,
    /// These vertices.
    At(Vec<usize>),
    /// Somewhere: the program chooses where they serve best, each on a street,
    /// as in the paper's figure 8e.
    Placed {
        /// How many.
        count: usize,
        /// Where; by default on the boundary.
        #[cfg_attr(feature = "serde", serde(default))]
        among: Among,
    },
}

/// What becomes of the edges on the boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Rim {
    /// Streets that exist: active, and free.
    #[default]
    Given,
    /// Edges like others.
    Open,
    /// No street may run along the boundary.
    Closed,
}

/// A specification (section 3 of the paper): independent of any mesh but for
/// the vertices and edges that it names.
///
/// ```
/// use network_opt::design::{Feature, Specification, Tessellation};
/// use network_opt::geo_types::polygon;
/// use network_opt::quad::{quads, QuadOptions};
///
/// let site = polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 120., y: 120.), (x: 0., y: 120.)];
/// let mesh = quads(&site, &QuadOptions { edge_length: 10.0, ..QuadOptions::default() })?;
/// // The paper's figure 2a, but for its exact mesh: 312 edges.
/// let problem = Specification::default().on(&mesh)?;
/// assert_eq!(problem.edges(), 312);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Specification {
    /// (i) Density: how near a street must be.
    ///
    /// Default value: two edges.
    pub coverage: Coverage,
    /// (ii) lambda_L, the weight of length.
    ///
    /// Default value: 1.
    pub length: f64,
    /// (ii) lambda_D, the weight of travel.
    ///
    /// Default value: 1e-4: short networks, and of those the quick ones.
    pub travel: f64,
    /// (iii) What traffic the network is for.
    ///
    /// Default value: to sinks alone.
    pub traffic: Traffic,
    /// (iv) Where traffic goes.
    ///
    /// Default value: the boundary.
    pub sinks: Sinks,
    /// What becomes of the edges on the boundary.
    ///
    /// Default value: given.
    pub rim: Rim,
    /// (v) Vertices with a single street, but for sinks.
    ///
    /// Default value: forbidden.
    pub dead_ends: Feature,
    /// (v) Vertices with three streets or more.
    ///
    /// Default value: free.
    pub branches: Feature,
    /// (v) Three edges that turn one way and then the other, on either side.
    ///
    /// Default value: 5 each.
    pub zig_zags: Feature,
    /// (v) Opposite edges of a quad.
    ///
    /// Default value: forbidden.
    pub too_close: Feature,
    /// (v) Three streets at a vertex of four edges.
    ///
    /// Default value: free.
    pub t_junctions: Feature,
    /// Edges that are streets already, besides those of the boundary: active,
    /// and free.
    pub given: Vec<usize>,
    /// (vi) Vertices that no street may touch: obstacles.
    pub obstacles: Vec<usize>,
    /// (vi) Routes that must be there: runs of vertices, each joined to the
    /// next by an edge.
    pub routes: Vec<Vec<usize>>,
    /// Whether routes are free of branches: nothing else touches their inner
    /// vertices, as in the paper's figure 6d.
    pub through: bool,
    /// Which streets are one-way.
    ///
    /// Default value: none.
    pub one_way: OneWay,
    /// Streets over which traffic may only run one way, where they are part of
    /// the network: runs of vertices in the order in which traffic passes them,
    /// each joined to the next by an edge.
    pub one_way_runs: Vec<Vec<usize>>,
}

impl Default for Specification {
    fn default() -> Self {
        Self {
            coverage: Coverage::Hops(2),
            length: 1.0,
            travel: 1e-4,
            traffic: Traffic::default(),
            sinks: Sinks::Boundary,
            rim: Rim::Given,
            dead_ends: Feature::Forbidden,
            branches: Feature::Free,
            zig_zags: Feature::Weighted(5.0),
            too_close: Feature::Forbidden,
            t_junctions: Feature::Free,
            given: Vec::new(),
            obstacles: Vec::new(),
            routes: Vec::new(),
            through: false,
            one_way: OneWay::None,
            one_way_runs: Vec::new(),
        }
    }
}

impl Specification {
    /// What the specification means on a mesh. Lengths are counted in mean
    /// edges, so that weights mean the same on meshes of any size.
    ///
    /// Where streets are given and opposite edges must not both be streets,
    /// the edge opposite a given one is closed.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`] for a vertex that is not in the mesh, a
    /// route or one-way run that does not follow edges, a route into an obstacle,
    /// one-way runs against each other, a number out of its range, no sink, or
    /// places that have to be joined and cannot be; [`DesignError::BadOption`] for
    /// parts that are not.
    pub fn on(&self, mesh: &Tessellation) -> Result<Problem, DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let (vertices, edges) = (mesh.points().len(), mesh.edges().len());
        let runs = self.routes.iter().chain(&self.one_way_runs);
        let named = self.obstacles.iter().chain(runs.flatten());
        let sinks = match &self.sinks {
            Sinks::At(list) => list.as_slice(),
            Sinks::Boundary | Sinks::Streets | Sinks::Placed { .. } => &[],
        };
        if let Some(v) = named.chain(sinks).find(|&&v| v >= vertices) {
            return bad(format!("vertex {v} is named, of {vertices}"));
        }
        if let Some(e) = self.given.iter().find(|&&e| e >= edges) {
            return bad(format!("edge {e} is given, of {edges}"));
        }
        let rim: Vec<bool> = mesh.rim().collect();
        let states = self.states(mesh, &rim)?;
        let mut is_sink = vec![false; vertices];
        match &self.sinks {
            Sinks::At(list) => list.iter().for_each(|&v| is_sink[v] = true),
            Sinks::Boundary => {
                let outer = mesh.edges().iter().zip(&rim).filter(|(_, &rim)| rim);
                outer.for_each(|(ends, _)| ends.iter().for_each(|&v| is_sink[v] = true));
            }
            Sinks::Streets => {
                let streets = mesh.edges().iter().zip(&states);
                let streets = streets.filter(|(_, &state)| state == EdgeState::Given);
                streets.for_each(|(ends, _)| ends.iter().for_each(|&v| is_sink[v] = true));
            }
            Sinks::Placed { .. } => {}
        }
        let placed = match &self.sinks {
            Sinks::Placed { count, among } => {
                let open = |&(e, _): &(usize, usize)| states[e] != EdgeState::Closed;
                let may = |v: usize| mesh.around(v).iter().any(open);
                Some(PlacedSinks {
                    candidates: among.candidates(mesh, &may)?,
                    count: *count,
                })
            }
            _ => None,
        };
        let to_sinks = self.traffic.to_sinks;
        if !(to_sinks >= 0.0 && to_sinks.is_finite()) {
            return bad(format!(
                "the weight of traffic to sinks is {to_sinks}; give 0 or more"
            ));
        }
        let mean = (0..edges).map(|e| mesh.length(e)).sum::<f64>() / edges.max(1) as f64;
        let mut problem = Problem {
            vertices,
            ends: mesh.edges().to_vec(),
            lengths: (0..edges).map(|e| mesh.length(e) / mean).collect(),
            coverage: self.balls(mesh)?,
            patterns: self.patterns(mesh, &states),
            dead_ends: self.dead_ends != Feature::Forbidden,
            ways: ways(self.one_way, &self.one_way_runs, mesh, &states)?,
            states,
            sinks: is_sink,
            placed,
            length_weight: self.length,
            travel_weight: self.travel * to_sinks,
            ..Problem::default()
        };
        problem.check()?;
        problem.routes = self.spans(mesh, &problem)?;
        problem.check()?;
        Ok(problem)
    }

    /// The balls of the coverage constraint (equation 6).
    fn balls(&self, mesh: &Tessellation) -> Result<Vec<Vec<usize>>, DesignError> {
        let of = |v: usize| match self.coverage {
            Coverage::Hops(hops) => mesh.ball(v, hops),
            Coverage::Metres(metres) => mesh.within(v, metres),
        };
        if let Coverage::Metres(metres) = self.coverage {
            if !(metres >= 0.0 && metres.is_finite()) {
                return Err(DesignError::BadProblem {
                    what: format!("the coverage range is {metres}; give metres, 0 or more"),
                });
            }
        }
        // What lies within an obstacle needs no street.
        let all = (0..mesh.points().len()).filter(|v| !self.obstacles.contains(v));
        Ok(all.map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{verify, Network, PatternKind, Violation};

    /// The paper's figure 2: 312 edges of which 48 are the boundary's, 48 more
    /// are parallel to one, and 192 pairs are too close.
    #[test]
    fn the_grid_of_figure_two() {
        let problem = Specification::default()
            .on(&Tessellation::grid(12, 12))
            .expect("fits");
        let count = |state| problem.states.iter().filter(|&&s| s == state).count();
        assert_eq!(problem.edges(), 312);
        assert_eq!(
            (count(EdgeState::Given), count(EdgeState::Closed)),
            (48, 48)
        );
        let of = |kind| problem.patterns.iter().filter(|p| p.kind == kind).count();
        assert_eq!(of(PatternKind::TooClose), 192);
        // S and Z where the instances have one of the two.
        assert_eq!(of(PatternKind::ZigZag), 288);
        assert_eq!(problem.coverage.len(), 169);
        assert_eq!(problem.sinks.iter().filter(|&&s| s).count(), 48);
    }

    #[test]
    fn routes_and_obstacles_fix_edges() {
        let mesh = Tessellation::grid(4, 4);
        let spec = Specification {
            rim: Rim::Open,
            too_close: Feature::Free,
            routes: vec![vec![2, 7, 12, 17, 22]],
            through: true,
            obstacles: vec![8],
            ..Specification::default()
        };
        let problem = spec.on(&mesh).expect("fits");
        let count = |state| problem.states.iter().filter(|&&s| s == state).count();
        // Four edges of the route; beside its inner vertices six edges, and at
        // the obstacle three more.
        assert_eq!(
            (count(EdgeState::Required), count(EdgeState::Closed)),
            (4, 9)
        );
        let network = Network {
            active: problem
                .states
                .iter()
                .map(|&s| s == EdgeState::Required)
                .collect(),
            ..Network::default()
        };
        assert!(verify(&problem, &network)
            .iter()
            .all(|v| !matches!(v, Violation::Missing { .. } | Violation::Forbidden { .. })));
        for (routes, obstacles, word) in [
            (vec![vec![0, 2]], vec![], "jumps"),
            (vec![vec![0, 99]], vec![], "named"),
            (vec![vec![6, 7, 8]], vec![8], "obstacle"),
        ] {
            let bad = Specification {
                rim: Rim::Open,
                routes,
                obstacles,
                ..Specification::default()
            };
            let error = bad.on(&mesh).expect_err("bad").to_string();
            assert!(error.contains(word), "{error}");
        }
    }

    /// On a single crossing: each feature is what its name says.
    #[test]
    fn features_are_what_they_are_called() {
        let mesh = Tessellation::grid(2, 2);
        let spec = Specification {
            rim: Rim::Open,
            zig_zags: Feature::Free,
            too_close: Feature::Free,
            dead_ends: Feature::Weighted(1.0),
            branches: Feature::Weighted(10.0),
            t_junctions: Feature::Weighted(100.0),
            length: 0.0,
            travel: 0.0,
            ..Specification::default()
        };
        let problem = spec.on(&mesh).expect("fits");
        let spokes: Vec<usize> = mesh.around(4).iter().map(|&(e, _)| e).collect();
        let cost = |count: usize| {
            let mut active = vec![false; mesh.edges().len()];
            spokes[..count].iter().for_each(|&e| active[e] = true);
            crate::design::cost(&problem, &active).objective
        };
        // Each spoke ends dead on the rim, and one alone in the middle too; three
        // are a branch and a T; of four there are four choices of three.
        assert_eq!(
            [cost(1), cost(2), cost(3), cost(4)],
            [2.0, 2.0, 113.0, 44.0]
        );
    }
}
