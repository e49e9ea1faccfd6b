//! Streets in levels: collectors first, then local streets on a finer mesh, and
//! so on, each level with those above it as they are.
//!
//! Peng et al. 2016, section 5.1: the network of each level is found on the
//! mesh of the one before it, refined once.
//!
//! Each level has a class with the speed that one drives at on its streets.
//! Travel of a level counts the length of a way over its own streets, and over
//! streets of another speed the length that its own would have for the same
//! time: so the faster streets of the level above attract. With one speed for
//! all that is the length.

mod streets;
#[cfg(test)]
mod tests;

use std::time::Duration;

use crate::design::{Problem, Specification, Streets, Tessellation, Way};
use crate::error::DesignError;
use crate::solve::{Limits, NetworkSolver, Outcome, Progress, Watch};

pub use streets::{streets, Street};

/// The network of one level.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Its mesh: that of the level before, refined.
    pub mesh: Tessellation,
    /// What was asked of it, the streets of the levels before given.
    pub problem: Problem,
    /// What was found.
    pub outcome: Outcome,
    /// Class, width and speed of the streets that it adds.
    pub class: StreetClass,
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

/// What the streets of a level are.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StreetClass {
    /// What they are called.
    pub name: String,
    /// How wide they are, metres.
    pub width: f64,
    /// How fast one drives there, km/h.
    pub speed: f64,
}

impl Default for StreetClass {
    /// Collectors, 12 m wide.
    fn default() -> Self {
        Self::new("collector", 12.0)
    }
}

impl StreetClass {
    /// A class with the [usual speed](usual_speed) of its name.
    #[must_use]
    pub fn new(name: &str, width: f64) -> Self {
        Self {
            name: name.to_owned(),
            width,
            speed: usual_speed(name),
        }
    }
}

/// The speed of streets by what they are called, km/h: the paper's 40, 30, 20
/// and 20 miles an hour for "major", "collector", "local" and "cul-de-sac"
/// (section 5.1); 30 for what is called otherwise.
#[must_use]
pub fn usual_speed(name: &str) -> f64 {
    const MILE: f64 = 1.609_344;
    MILE * match name {
        "major" => 40.0,
        "local" | "cul-de-sac" => 20.0,
        _ => 30.0,
    }
}

/// What is asked of one level.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LevelPlan {
    /// What the streets are that it adds.
    pub class: StreetClass,
    /// What they are for.
    pub specification: Specification,
}

/// Finds the networks of all levels, each specification on the mesh of its
/// level: the first on `mesh`, the next on [`Tessellation::refined`] of it. The
/// streets of the levels before are given, in their directions, and obstacles
/// grow with the mesh. The time is divided among the levels.
///
/// All streets are as fast as each other; see [`design_plans`] for classes.
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
    let plan = |specification: &Specification| LevelPlan {
        specification: specification.clone(),
        ..LevelPlan::default()
    };
    let plans: Vec<LevelPlan> = specifications.iter().map(plan).collect();
    design_plans(mesh, &plans, None, solver, limits, watch)
}

/// [`design_levels`] with a class for each level. `existing` says how fast one
/// drives on streets that exist from the start, km/h: the boundary, if that is
/// given, and what specifications give; `None` as on those of the first level.
///
/// # Errors
///
/// Those of [`design_levels`]; [`DesignError::BadOption`] for a speed or width
/// that is not positive.
///
/// # Examples
///
/// Local streets between collectors on which one drives half as fast again.
///
/// ```
/// use network_opt::design::{OneWay, Sinks, Specification, Tessellation};
/// use network_opt::geo_types::coord;
/// use network_opt::levels::{design_plans, LevelPlan, StreetClass};
/// use network_opt::solve::{Limits, Search};
///
/// let points = (0..49).map(|k| coord! { x: 90.0 * f64::from(k % 7), y: 90.0 * f64::from(k / 7) });
/// let faces = (0..36).map(|k| k / 6 * 7 + k % 6).map(|a| vec![a, a + 1, a + 8, a + 7]);
/// let mesh = Tessellation::new(points.collect(), faces.collect())?;
/// let plans = [
///     LevelPlan { class: StreetClass::new("collector", 14.0), ..LevelPlan::default() },
///     LevelPlan {
///         class: StreetClass::new("local", 6.0),
///         specification: Specification { one_way: OneWay::New, travel: 0.2, ..Specification::default() },
///     },
/// ];
/// let limits = Limits { deadline: None, ..Limits::default() };
/// let search = Search { moves: Some(3000) };
/// let levels = design_plans(mesh, &plans, None, &search, &limits, &mut |_| true)?;
/// let local = &levels[1].problem;
/// let given = (0..local.edges()).find(|&e| local.is_given(e)).unwrap();
/// assert!((local.travel_costs[given] / local.lengths[given] - 2.0 / 3.0).abs() < 1e-12);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn design_plans(
    mesh: Tessellation,
    plans: &[LevelPlan],
    existing: Option<f64>,
    solver: &dyn NetworkSolver,
    limits: &Limits,
    watch: &mut Watch<'_>,
) -> Result<Vec<Level>, DesignError> {
    let existing = existing.or_else(|| plans.first().map(|plan| plan.class.speed));
    let existing = existing.unwrap_or_default();
    check(plans, existing)?;
    let share = u32::try_from(plans.len().max(1)).unwrap_or(u32::MAX);
    let limits = Limits {
        deadline: limits.deadline.map(|deadline| deadline / share),
        ..limits.clone()
    };
    let mut levels: Vec<Level> = Vec::new();
    let mut mesh = mesh;
    let mut obstacles: Vec<usize> = Vec::new();
    let mut spent = Duration::ZERO;
    // What streets there are on the mesh, by its edges.
    let mut known: Vec<Option<Known>> = Vec::new();
    for plan in plans {
        let mut specification = plan.specification.clone();
        if let Some(before) = levels.last() {
            let Some(network) = &before.outcome.network else {
                break;
            };
            specification.given.extend(halves(&network.active));
            known = found(before, &known, existing);
            obstacles = finer(&mesh, &obstacles);
            mesh = mesh.refined();
        }
        obstacles.extend(&specification.obstacles);
        obstacles.sort_unstable();
        obstacles.dedup();
        specification.obstacles.clone_from(&obstacles);
        let mut problem = specification.on(&mesh)?;
        known.resize(problem.edges(), None);
        travel_by_time(&mut problem, &known, plan.class.speed, existing);
        keep_directions(&mut problem, &known);
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
            class: plan.class.clone(),
        });
    }
    Ok(levels)
}

fn check(plans: &[LevelPlan], existing: f64) -> Result<(), DesignError> {
    let positive = |value: f64| value > 0.0 && value.is_finite();
    for LevelPlan { class, .. } in plans {
        for (name, value, unit) in [
            ("speed", class.speed, "km/h"),
            ("width", class.width, "metres"),
        ] {
            if !positive(value) {
                let what = format!("the {name} of {:?} is {value}; give {unit}", class.name);
                return Err(DesignError::BadOption { what });
            }
        }
    }
    if !plans.is_empty() && !positive(existing) {
        let what = format!("the speed of existing streets is {existing}; give km/h");
        return Err(DesignError::BadOption { what });
    }
    Ok(())
}

/// What is known of a street of a level above.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    speed: f64,
    way: Way,
}

/// The streets of a level and of those above it, by the edges of the refined
/// mesh, as far as these are halves of edges.
fn found(level: &Level, known: &[Option<Known>], existing: f64) -> Vec<Option<Known>> {
    let Some(network) = &level.outcome.network else {
        return Vec::new();
    };
    let streets = Streets::from(network);
    let street = |e: usize| {
        network.active[e].then(|| Known {
            speed: match known[e] {
                Some(above) => above.speed,
                None if level.problem.is_given(e) => existing,
                None => level.class.speed,
            },
            // The halves of an edge run as it does: a to m, m to b.
            way: streets.way(&level.problem, e),
        })
    };
    (0..level.problem.edges())
        .flat_map(|e| [street(e); 2])
        .collect()
}

/// Makes travel cost its time, in the length of a street of this level that
/// takes as long.
fn travel_by_time(problem: &mut Problem, known: &[Option<Known>], own: f64, existing: f64) {
    let speed = |e: usize| match known[e] {
        Some(above) => above.speed,
        None if problem.is_given(e) => existing,
        None => own,
    };
    let speeds: Vec<f64> = (0..problem.edges()).map(speed).collect();
    if speeds.iter().any(|&speed| speed != own) {
        let lengths = problem.lengths.iter().zip(&speeds);
        problem.travel_costs = lengths.map(|(l, speed)| l * own / speed).collect();
    }
}

/// Gives streets of the levels above the directions that they have.
fn keep_directions(problem: &mut Problem, known: &[Option<Known>]) {
    let one_way = known.iter().flatten().any(|k| k.way != Way::Both);
    if one_way && problem.ways.is_empty() {
        problem.ways = vec![Way::Both; problem.edges()];
    }
    for (way, known) in problem.ways.iter_mut().zip(known) {
        if let Some(known) = known {
            *way = known.way;
        }
    }
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
