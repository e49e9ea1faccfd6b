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

use std::time::Duration;

use crate::design::{
    distances, distances_from, mean_way, Network, Problem, Specification, Streets, Tessellation,
    Way,
};
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

/// A street of a finished network.
#[derive(Clone, Debug, PartialEq)]
pub struct Street {
    /// The level that it belongs to, from 0.
    pub level: usize,
    /// Where it runs; a one-way street in its direction.
    pub line: LineString<f64>,
    /// For each piece between two points of the line the way from there to a
    /// sink of its level, in metres along edges of the mesh; over streets of
    /// another speed in metres of its own that take as long. With one-way streets
    /// the mean of that and of the way from a sink.
    pub away: Vec<f64>,
    /// Whether traffic runs over it one way only.
    pub one_way: bool,
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

/// The streets of all levels, smoothed together on the finest mesh, so that
/// they meet where they met; no street runs on into one of another level, nor
/// one-way streets into others or against each other. Sinks that lie alone are
/// pinned, for a street is to end there; where a whole street is sink its ends
/// may slide.
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
    let mut ways = vec![Way::Both; last.mesh.edges().len()];
    for (index, level) in found.iter().enumerate() {
        let mut own = level.own();
        let mut way = nearer(level);
        let mut runs = directions(level);
        for _ in index + 1..found.len() {
            (own, way, runs) = (halved(&own), halved(&way), halved(&runs));
        }
        own.resize(last.mesh.edges().len(), false);
        for (e, &on) in own.iter().enumerate() {
            if on {
                away[e] = way[e];
                ways[e] = runs[e];
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
        given = halved(&given);
    }
    given.resize(last.mesh.edges().len(), false);
    let (of, snakes): (Vec<usize>, Vec<Snake>) = all.into_iter().unzip();
    let mut options = options.clone();
    options
        .pinned
        .extend(found.iter().flat_map(|l| lone_sinks(l)));
    let smooth = smooth_snakes(&last.mesh, snakes, &given, &options)?;
    let streets = smooth.streets.into_iter().zip(of);
    Ok(streets
        .flat_map(|((snake, line), level)| {
            let runs: Vec<Way> = (snake.edges.iter().zip(&snake.vertices))
                .map(|(&e, &v)| {
                    if last.mesh.edges()[e][0] == v {
                        ways[e]
                    } else {
                        ways[e].reversed()
                    }
                })
                .collect();
            let away: Vec<f64> = snake.edges.iter().map(|&e| away[e]).collect();
            cut(&line, &runs, &away, options.pieces, level)
        })
        .collect())
}

/// Sinks of a level without a sink beside them, those placed included; vertices
/// keep their numbers on finer meshes.
fn lone_sinks(level: &Level) -> Vec<usize> {
    let mut sinks = level.problem.sinks.clone();
    let placed = level.outcome.network.iter().flat_map(|n| &n.sinks);
    placed.for_each(|&v| sinks[v] = true);
    let lone = |&v: &usize| !level.mesh.around(v).iter().any(|&(_, w)| sinks[w]);
    (0..sinks.len())
        .filter(|&v| sinks[v])
        .filter(lone)
        .collect()
}

/// A snake's line as streets, cut where traffic begins to run another way: `runs`
/// and `away` are of its edges, of so many pieces each.
fn cut(
    line: &LineString<f64>,
    runs: &[Way],
    away: &[f64],
    pieces: usize,
    level: usize,
) -> Vec<Street> {
    let mut streets = Vec::new();
    let mut from = 0;
    while from < runs.len() {
        let way = runs[from];
        let same = runs[from..].iter().take_while(|&&w| w == way).count();
        let to = from + same;
        let mut points = line.0[from * pieces..=to * pieces].to_vec();
        let mut away: Vec<f64> = away[from..to]
            .iter()
            .flat_map(|&metres| std::iter::repeat_n(metres, pieces))
            .collect();
        if way == Way::Backward {
            points.reverse();
            away.reverse();
        }
        streets.push(Street {
            level,
            line: points.into(),
            away,
            one_way: way != Way::Both,
        });
        from = to;
    }
    streets
}

/// A list by edge, for the halves of edges on the refined mesh; its edges within
/// faces are not in it.
fn halved<T: Copy>(list: &[T]) -> Vec<T> {
    list.iter().flat_map(|&value| [value, value]).collect()
}

/// Which way traffic runs over each edge.
fn directions(level: &Level) -> Vec<Way> {
    let empty = Network::default();
    let streets = Streets::from(level.outcome.network.as_ref().unwrap_or(&empty));
    (0..level.problem.edges())
        .map(|e| streets.way(&level.problem, e))
        .collect()
}

/// The travel of each edge of a level, metres: its way to a sink of the level,
/// with one-way streets the mean of that and the way from one.
fn nearer(level: &Level) -> Vec<f64> {
    let Some(network) = &level.outcome.network else {
        return vec![f64::INFINITY; level.problem.edges()];
    };
    let unit = level.metres();
    let settled = level.problem.settled(&network.sinks);
    let to = distances(&settled, network);
    let from = distances_from(&settled, network);
    let ends = level.problem.ends.iter().zip(directions(level));
    ends.map(|(&ends, way)| unit * mean_way(ends, way, &to, &from))
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
    use crate::design::{verify, Among, EdgeState, OneWay, Rim, Sinks};
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

    /// A street that leads to a single place ends there, on the boundary and
    /// inside it.
    #[test]
    fn streets_end_at_lone_sinks() {
        for sink in [3, 24] {
            let spec = Specification {
                sinks: Sinks::At(vec![sink]),
                rim: Rim::Closed,
                ..Specification::default()
            };
            let limits = Limits {
                deadline: None,
                ..Limits::default()
            };
            let search = Search { moves: Some(2000) };
            let mesh = Tessellation::grid(6, 6);
            let at = mesh.points()[sink];
            let levels =
                design_levels(mesh, &[spec], &search, &limits, &mut |_| true).expect("fits");
            let streets = streets(&levels, &SnakeOptions::default()).expect("smooth");
            let meets = |street: &Street| street.line.0.contains(&at);
            assert!(streets.iter().any(meets), "a street at vertex {sink}");
        }
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

    fn plans(one_way: [OneWay; 2]) -> Vec<LevelPlan> {
        let plan = |(name, one_way)| LevelPlan {
            class: StreetClass::new(name, 10.0),
            specification: Specification {
                one_way,
                travel: 0.2,
                ..Specification::default()
            },
        };
        ["collector", "local"]
            .into_iter()
            .zip(one_way)
            .map(plan)
            .collect()
    }

    fn designed(plans: &[LevelPlan], existing: Option<f64>) -> Vec<Level> {
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let search = Search { moves: Some(3000) };
        let mesh = Tessellation::grid(6, 6);
        design_plans(mesh, plans, existing, &search, &limits, &mut |_| true).expect("fits")
    }

    /// Streets of the level above are faster, the boundary fastest.
    #[test]
    fn travel_counts_time() {
        let levels = designed(&plans([OneWay::None; 2]), Some(usual_speed("major")));
        for (level, own) in levels.iter().zip([30.0, 20.0]) {
            let problem = &level.problem;
            for e in 0..problem.edges() {
                let rim = problem.ends[e].iter().all(|&v| {
                    let point = level.mesh.points()[v];
                    [point.x, point.y].iter().any(|&c| c == 0.0 || c == 6.0)
                });
                let mph = match problem.is_given(e) {
                    true if rim => 40.0,
                    true => 30.0,
                    false => own,
                };
                let share = problem.travel_cost(e) / problem.lengths[e];
                assert!(
                    (share - own / mph).abs() < 1e-12,
                    "{share} for {own} / {mph}"
                );
            }
        }
        // One speed for all is none, and what design_levels does.
        let mut same = plans([OneWay::None; 2]);
        same[1].class.speed = same[0].class.speed;
        let levels = designed(&same, None);
        assert!(levels
            .iter()
            .all(|level| level.problem.travel_costs.is_empty()));
        let specifications: Vec<Specification> =
            same.into_iter().map(|plan| plan.specification).collect();
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let search = Search { moves: Some(3000) };
        let mesh = Tessellation::grid(6, 6);
        let plain = design_levels(mesh, &specifications, &search, &limits, &mut |_| true);
        for (a, b) in plain.expect("fits").iter().zip(&levels) {
            assert_eq!(
                (&a.problem, &a.outcome.network),
                (&b.problem, &b.outcome.network)
            );
        }
    }

    /// The next level has to do with the directions that there are, and streets
    /// are drawn in theirs.
    #[test]
    fn directions_go_down() {
        let levels = designed(&plans([OneWay::All, OneWay::None]), None);
        assert_eq!(levels.len(), 2);
        for level in &levels {
            let network = level.outcome.network.as_ref().expect("found");
            assert_eq!(verify(&level.problem, network), []);
        }
        let above = levels[0].outcome.network.as_ref().expect("found");
        for (e, &on) in above.active.iter().enumerate() {
            for half in [2 * e, 2 * e + 1].into_iter().filter(|_| on) {
                assert_eq!(levels[1].problem.way(half), above.ways[e]);
                assert_ne!(above.ways[e], Way::Both);
            }
        }
        let options = SnakeOptions {
            // No snake moves, so that its points are the mesh's.
            closeness: 1e9,
            ..SnakeOptions::default()
        };
        let found = streets(&levels, &options).expect("smooth");
        assert!(found
            .iter()
            .all(|street| street.one_way == (street.level == 0)));
        let mesh = &levels[1].mesh;
        for street in &found {
            assert_eq!(street.away.len() + 1, street.line.0.len());
            assert!(street.away.iter().all(|metres| metres.is_finite()));
            let at = |p: geo_types::Coord<f64>| {
                let near = |q: &geo_types::Coord<f64>| (q.x - p.x).hypot(q.y - p.y) < 1e-3;
                mesh.points().iter().position(near)
            };
            let stops: Vec<usize> = street.line.0.iter().filter_map(|&p| at(p)).collect();
            for pair in stops.windows(2).filter(|_| street.one_way) {
                let e = mesh.edge_between(pair[0], pair[1]).expect("an edge");
                let end = usize::from(mesh.edges()[e][0] != pair[0]);
                assert!(levels[1].problem.way(e).runs_from(end));
            }
        }
    }

    #[test]
    fn speeds_have_to_be_positive() {
        let mut bad = plans([OneWay::None; 2]);
        bad[1].class.speed = 0.0;
        let run = |plans: &[LevelPlan], existing| {
            let mesh = Tessellation::grid(2, 2);
            let search = Search { moves: Some(1) };
            design_plans(
                mesh,
                plans,
                existing,
                &search,
                &Limits::default(),
                &mut |_| true,
            )
        };
        assert!(run(&bad, None).is_err());
        bad[1].class.speed = 30.0;
        assert!(run(&bad, Some(f64::NAN)).is_err());
        bad[0].class.width = -1.0;
        assert!(run(&bad, None).is_err());
        assert_eq!(run(&[], None).expect("nothing to do"), vec![]);
    }
}
