//! Streets in levels: collectors first, then local streets on a finer mesh, and
//! so on, each level with those above it as they are.
//!
//! Peng et al. 2016, section 5.1: the network of each level is found on the
//! mesh of the one before it, refined once.

use std::time::Duration;

use crate::design::{distances, Network, Problem, Specification, Tessellation};
use crate::error::DesignError;
use crate::snake::{smooth_snakes, snakes, Snake, SnakeOptions};
use crate::solve::{Limits, NetworkSolver, Outcome, Progress, Watch};
use geo_types::LineString;

/// The network of one level.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Its mesh: that of the level before, refined.
    pub mesh: Tessellation,
    /// What was asked of it, the streets of the levels before given.
    pub problem: Problem,
    /// What was found.
    pub outcome: Outcome,
}

impl Level {
    /// The edges that this level adds to the network.
    fn own(&self) -> Vec<bool> {
        let active = self.outcome.network.as_ref().map(|n| n.active.as_slice());
        let active = active.unwrap_or(&[]).iter().enumerate();
        active
            .map(|(e, &on)| on && !self.problem.is_given(e))
            .collect()
    }
}

/// A street of a finished network.
#[derive(Clone, Debug, PartialEq)]
pub struct Street {
    /// The level that it belongs to, from 0.
    pub level: usize,
    /// Where it runs.
    pub line: LineString<f64>,
    /// For each piece between two points of the line the way from there to a
    /// sink of its level, in metres along edges of the mesh.
    pub away: Vec<f64>,
}

/// Finds the networks of all levels, each specification on the mesh of its
/// level: the first on `mesh`, the next on [`Tessellation::refined`] of it. The
/// streets of the levels before are given, and obstacles grow with the mesh.
/// The time is divided among the levels.
///
/// Ends early after a level without a network; look at the last outcome.
///
/// # Errors
///
/// Those of [`Specification::on`] and of the solver.
///
/// # Examples
///
/// ```
/// use network_opt::design::{Sinks, Specification};
/// use network_opt::geo_types::polygon;
/// use network_opt::levels::{design_levels, streets};
/// use network_opt::quad::{quads, QuadOptions};
/// use network_opt::snake::SnakeOptions;
/// use network_opt::solve::{Limits, Search};
/// use std::time::Duration;
///
/// let site = polygon![(x: 0., y: 0.), (x: 600., y: 0.), (x: 600., y: 600.), (x: 0., y: 600.)];
/// let mesh = quads(&site, &QuadOptions { edge_length: 75.0, ..QuadOptions::default() })?;
/// let collectors = Specification::default();
/// let local = Specification { sinks: Sinks::Streets, ..Specification::default() };
/// let limits = Limits { deadline: Some(Duration::from_millis(300)), ..Limits::default() };
/// let levels = design_levels(mesh, &[collectors, local], &Search::default(), &limits, &mut |_| true)?;
/// assert_eq!(levels.len(), 2);
/// let found = streets(&levels, &SnakeOptions::default())?;
/// assert!(found.iter().any(|street| street.level == 0) && found.iter().any(|street| street.level == 1));
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn design_levels(
    mesh: Tessellation,
    specifications: &[Specification],
    solver: &dyn NetworkSolver,
    limits: &Limits,
    watch: &mut Watch<'_>,
) -> Result<Vec<Level>, DesignError> {
    let share = u32::try_from(specifications.len().max(1)).unwrap_or(u32::MAX);
    let limits = Limits {
        deadline: limits.deadline.map(|deadline| deadline / share),
        ..limits.clone()
    };
    let mut levels: Vec<Level> = Vec::new();
    let mut mesh = mesh;
    let mut obstacles: Vec<usize> = Vec::new();
    let mut spent = Duration::ZERO;
    for specification in specifications {
        let mut specification = specification.clone();
        if let Some(before) = levels.last() {
            let Some(network) = &before.outcome.network else {
                break;
            };
            specification.given.extend(halves(&network.active));
            obstacles = finer(&mesh, &obstacles);
            mesh = mesh.refined();
        }
        obstacles.extend(&specification.obstacles);
        obstacles.sort_unstable();
        obstacles.dedup();
        specification.obstacles.clone_from(&obstacles);
        let problem = specification.on(&mesh)?;
        let mut told = |progress: &Progress<'_>| {
            watch(&Progress {
                elapsed: progress.elapsed + spent,
                ..*progress
            })
        };
        let outcome = solver.solve(&problem, None, &limits, &mut told)?;
        spent += outcome.elapsed;
        levels.push(Level {
            mesh: mesh.clone(),
            problem,
            outcome,
        });
    }
    Ok(levels)
}

/// The active edges of a mesh, as edges of the refined one.
fn halves(active: &[bool]) -> impl Iterator<Item = usize> + '_ {
    let edges = active.iter().enumerate().filter(|(_, &on)| on);
    edges.flat_map(|(e, _)| [2 * e, 2 * e + 1])
}

/// Obstacles on the refined mesh: what lies between obstacles is one.
fn finer(mesh: &Tessellation, obstacles: &[usize]) -> Vec<usize> {
    let is = |v: &usize| obstacles.binary_search(v).is_ok();
    let (vertices, edges) = (mesh.points().len(), mesh.edges().len());
    let between = mesh.edges().iter().enumerate();
    let between = between.filter(|(_, ends)| ends.iter().all(is));
    let inside = mesh.faces().iter().enumerate();
    let inside = inside.filter(|(_, face)| face.iter().all(is));
    obstacles
        .iter()
        .copied()
        .chain(between.map(|(e, _)| vertices + e))
        .chain(inside.map(|(f, _)| vertices + edges + f))
        .collect()
}

/// The streets of all levels, smoothed together on the finest mesh, so that
/// they meet where they met; no street runs on into one of another level.
///
/// # Errors
///
/// Those of [`smooth_snakes`].
pub fn streets(levels: &[Level], options: &SnakeOptions) -> Result<Vec<Street>, DesignError> {
    let found: Vec<&Level> = levels
        .iter()
        .filter(|level| level.outcome.network.is_some())
        .collect();
    let Some(last) = found.last() else {
        return Ok(Vec::new());
    };
    let mut all: Vec<(usize, Snake)> = Vec::new();
    let mut away = vec![0.0; last.mesh.edges().len()];
    for (index, level) in found.iter().enumerate() {
        let mut own = level.own();
        let mut way = nearer(level);
        for _ in index + 1..found.len() {
            (own, way) = refined(&own, &way);
        }
        own.resize(last.mesh.edges().len(), false);
        for (e, &on) in own.iter().enumerate() {
            if on {
                away[e] = way[e];
            }
        }
        let snakes = snakes(&last.mesh, &own, options.through_deg.to_radians());
        all.extend(snakes.into_iter().map(|snake| (index, snake)));
    }
    // What was given from the start stays; on a finer mesh its halves.
    let mut given: Vec<bool> = (0..found[0].problem.edges())
        .map(|e| found[0].problem.is_given(e))
        .collect();
    for _ in 1..found.len() {
        given = given.iter().flat_map(|&on| [on, on]).collect();
    }
    given.resize(last.mesh.edges().len(), false);
    let (of, snakes): (Vec<usize>, Vec<Snake>) = all.into_iter().unzip();
    let smooth = smooth_snakes(&last.mesh, snakes, &given, options)?;
    let streets = smooth.streets.into_iter().zip(of);
    Ok(streets
        .map(|((snake, line), level)| Street {
            level,
            away: snake
                .edges
                .iter()
                .flat_map(|&e| std::iter::repeat_n(away[e], options.pieces))
                .collect(),
            line,
        })
        .collect())
}

/// Lists by edge on the refined mesh; its edges within faces are not in them.
fn refined(own: &[bool], way: &[f64]) -> (Vec<bool>, Vec<f64>) {
    (
        own.iter().flat_map(|&on| [on, on]).collect(),
        way.iter().flat_map(|&metres| [metres, metres]).collect(),
    )
}

/// The way from the nearer end of each edge to a sink of its level, metres.
fn nearer(level: &Level) -> Vec<f64> {
    let empty = Network::default();
    let network = level.outcome.network.as_ref().unwrap_or(&empty);
    let unit = level.metres();
    let settled = level.problem.settled(&network.sinks);
    let away = distances(&settled, &network.active);
    let ends = level.problem.ends.iter();
    ends.map(|ends| {
        unit * ends
            .map(|v| away[v])
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    })
    .collect()
}

impl Level {
    /// Metres in a unit of the problem's lengths.
    #[must_use]
    pub fn metres(&self) -> f64 {
        match self.problem.lengths.first() {
            Some(&length) if length > 0.0 => self.mesh.length(0) / length,
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{verify, Among, EdgeState, Rim, Sinks};
    use crate::solve::Search;

    fn two_levels(obstacles: Vec<usize>) -> Vec<Level> {
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let search = Search { moves: Some(3000) };
        let first = Specification {
            obstacles,
            ..Specification::default()
        };
        let second = Specification {
            sinks: Sinks::Streets,
            ..Specification::default()
        };
        let mesh = Tessellation::grid(6, 6);
        design_levels(mesh, &[first, second], &search, &limits, &mut |_| true).expect("fits")
    }

    /// The second level has the first one's streets twice as finely, and both
    /// are valid.
    #[test]
    fn lower_levels_build_on_higher_ones() {
        let levels = two_levels(vec![]);
        assert_eq!(levels.len(), 2);
        assert_eq!(levels[1].mesh.faces().len(), 4 * 36);
        for level in &levels {
            let network = level.outcome.network.as_ref().expect("found");
            assert_eq!(verify(&level.problem, network), []);
        }
        let above = levels[0].outcome.network.as_ref().expect("found");
        for (e, &on) in above.active.iter().enumerate() {
            for half in [2 * e, 2 * e + 1] {
                assert_eq!(levels[1].problem.is_given(half), on);
            }
        }
        let streets = streets(&levels, &SnakeOptions::default()).expect("smooth");
        for street in &streets {
            assert_eq!(street.away.len() + 1, street.line.0.len());
            assert!(street.away.iter().all(|metres| metres.is_finite()));
        }
        assert!(streets.iter().any(|s| s.level == 0) && streets.iter().any(|s| s.level == 1));
    }

    /// Sinks that the first level places are what its ways lead to.
    #[test]
    fn ways_lead_to_placed_sinks() {
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let search = Search { moves: Some(3000) };
        let first = Specification {
            rim: Rim::Open,
            sinks: Sinks::Placed {
                count: 2,
                among: Among::Interior,
            },
            ..Specification::default()
        };
        let second = Specification {
            rim: Rim::Open,
            sinks: Sinks::Streets,
            ..Specification::default()
        };
        let mesh = Tessellation::grid(6, 6);
        let levels = design_levels(mesh, &[first, second], &search, &limits, &mut |_| true);
        let levels = levels.expect("fits");
        let sinks = |level: &Level| level.outcome.network.as_ref().map(|n| n.sinks.len());
        assert_eq!([sinks(&levels[0]), sinks(&levels[1])], [Some(2), Some(0)]);
        for street in streets(&levels, &SnakeOptions::default()).expect("smooth") {
            assert!(street.away.iter().all(|metres| metres.is_finite()));
        }
    }

    /// A square of obstacles stays empty on the finer mesh too.
    #[test]
    fn obstacles_grow_with_the_mesh() {
        // Vertices 16, 17, 23, 24: a face in the middle of the grid.
        let levels = two_levels(vec![16, 17, 23, 24]);
        let fine = &levels[1];
        let face = (0..36).find(|&f| levels[0].mesh.faces()[f] == [16, 17, 24, 23]);
        let centre = 49 + levels[0].mesh.edges().len() + face.expect("a face");
        for &(e, _) in fine.mesh.around(centre) {
            assert_eq!(fine.problem.states[e], EdgeState::Closed);
        }
    }
}
