//! A building: storeys around the same shafts.

use std::time::Duration;

use geo_types::Coord;

use super::measure::{area, middle};
use super::on::Floor;
use super::spec::{FloorSpecification, Place, Shaft, ShaftRole};
use super::template::Shape;
use crate::design::{verify, Tessellation};
use crate::error::DesignError;
use crate::solve::{Limits, NetworkSolver, Outcome, Progress, Watch};

/// One storey of a building.
#[derive(Clone, Debug, PartialEq)]
pub struct Storey {
    /// What was asked.
    pub specification: FloorSpecification,
    /// What that means on the mesh.
    pub floor: Floor,
    /// What was found.
    pub outcome: Outcome,
}

impl Storey {
    /// Whether there is a plan, and the checker, which knows nothing of solvers,
    /// finds nothing wrong with it.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let network = self.outcome.network.as_ref();
        network.is_some_and(|network| verify(&self.floor.problem, network).is_empty())
    }
}

/// Plans the storeys of a building, the ground floor first, all on the same mesh
/// and with the same shafts. Only the ground floor has an entrance without being
/// told so; on the others corridors lead to the shafts.
///
/// The time is divided among the storeys; what one leaves goes to the next ones.
/// A storey without a plan has none in its outcome, and the others are planned
/// all the same; a watch that says no ends the work, and the storeys after it
/// are missing.
///
/// # Errors
///
/// Those of [`FloorSpecification::on`], with the storey, and of the solver.
///
/// # Examples
///
/// ```
/// use network_opt::floor::{design_storeys, spread_shafts, FloorSpecification};
/// use network_opt::geo_types::polygon;
/// use network_opt::quad::{quads, QuadOptions};
/// use network_opt::solve::{Limits, Search};
///
/// let block = polygon![(x: 0., y: 0.), (x: 24., y: 0.), (x: 24., y: 15.), (x: 0., y: 15.)];
/// let mesh = quads(&block, &QuadOptions { edge_length: 3.0, ..QuadOptions::default() })?;
/// let shafts = spread_shafts(&mesh, 1);
/// let two = vec![FloorSpecification::default(); 2];
/// let limits = Limits { deadline: None, ..Limits::default() };
/// let search = Search { moves: Some(3000) };
/// let storeys = design_storeys(&mesh, &shafts, &two, &search, &limits, &mut |_| true)?;
/// assert!(storeys.iter().all(|storey| storey.is_valid()));
/// // The same shaft, which is where corridors of the upper storey lead.
/// assert_eq!(storeys[0].floor.shafts, storeys[1].floor.shafts);
/// assert!(storeys[1].floor.entrances.is_empty());
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn design_storeys(
    mesh: &Tessellation,
    shafts: &[Shaft],
    specifications: &[FloorSpecification],
    solver: &dyn NetworkSolver,
    limits: &Limits,
    watch: &mut Watch<'_>,
) -> Result<Vec<Storey>, DesignError> {
    let mut floors = Vec::new();
    for (k, specification) in specifications.iter().enumerate() {
        let mut specification = specification.clone();
        if k == 0 && specification.entrances.is_empty() && specification.shafts != ShaftRole::Sinks
        {
            // As if there were no shafts: one in the longest facade.
            let alone = specification.on(mesh, &[])?;
            let entrances = alone.entrances.iter().map(|&v| Place::Vertex(v));
            specification.entrances = entrances.collect();
        }
        let floor = specification.on(mesh, shafts).map_err(|e| match e {
            DesignError::BadFloor { what } if specifications.len() > 1 => DesignError::BadFloor {
                what: format!("storey {k}: {what}"),
            },
            other => other,
        })?;
        floors.push((specification, floor));
    }
    let mut storeys = Vec::new();
    let mut spent = Duration::ZERO;
    let mut going = true;
    let count = floors.len();
    for (k, (specification, floor)) in floors.into_iter().enumerate() {
        if !going {
            break;
        }
        let left = u32::try_from(count - k).unwrap_or(u32::MAX);
        let limits = Limits {
            deadline: (limits.deadline).map(|deadline| deadline.saturating_sub(spent) / left),
            ..limits.clone()
        };
        let mut told = |progress: &Progress<'_>| {
            going = watch(&Progress {
                elapsed: progress.elapsed + spent,
                ..*progress
            });
            going
        };
        let outcome = solver.solve(&floor.problem, None, &limits, &mut told)?;
        spent += outcome.elapsed;
        storeys.push(Storey {
            specification,
            floor,
            outcome,
        });
    }
    Ok(storeys)
}

/// Places for so many shafts of one face each, spread so that all of the floor
/// is near to one: the means of Lloyd's clusters of faces by area, beginning
/// with faces far from each other.
///
/// Where there are fewer faces with a corner inside, there are fewer shafts.
#[must_use]
pub fn spread_shafts(mesh: &Tessellation, count: usize) -> Vec<Shaft> {
    let faces = mesh.faces().len();
    let middles: Vec<Coord<f64>> = (0..faces).map(|f| middle(mesh, f)).collect();
    let weights: Vec<f64> = (0..faces).map(|f| area(mesh, f)).collect();
    let square = |a: Coord<f64>, b: Coord<f64>| (a.x - b.x).powi(2) + (a.y - b.y).powi(2);
    let mut on_rim = vec![false; mesh.points().len()];
    for (ends, _) in mesh.edges().iter().zip(mesh.rim()).filter(|(_, rim)| *rim) {
        ends.iter().for_each(|&v| on_rim[v] = true);
    }
    // A shaft in the facade takes a window.
    let mut may: Vec<usize> = (0..faces)
        .filter(|&f| mesh.faces()[f].iter().all(|&v| !on_rim[v]))
        .collect();
    if may.len() < count {
        may = (0..faces)
            .filter(|&f| mesh.faces()[f].iter().any(|&v| !on_rim[v]))
            .collect();
    }
    let mean = |of: &[usize]| {
        let sum: f64 = of.iter().map(|&f| weights[f]).sum();
        let at = of.iter().fold(Coord { x: 0.0, y: 0.0 }, |at, &f| {
            at + middles[f] * weights[f]
        });
        at / sum
    };
    let all: Vec<usize> = (0..faces).collect();
    let mut seeds: Vec<Coord<f64>> = Vec::new();
    for _ in 0..count.min(may.len()) {
        let away = |f: usize| {
            let ways = seeds.iter().map(|&s| square(s, middles[f]));
            ways.fold(f64::INFINITY, f64::min)
        };
        if seeds.is_empty() {
            seeds.push(mean(&all));
        } else if let Some(far) = (0..faces).max_by(|&a, &b| away(a).total_cmp(&away(b))) {
            seeds.push(middles[far]);
        }
    }
    for _ in 0..20 {
        let mut clusters = vec![Vec::new(); seeds.len()];
        for (f, &at) in middles.iter().enumerate() {
            let near = (0..seeds.len())
                .min_by(|&a, &b| square(seeds[a], at).total_cmp(&square(seeds[b], at)));
            if let Some(k) = near {
                clusters[k].push(f);
            }
        }
        for (seed, cluster) in seeds.iter_mut().zip(&clusters) {
            if !cluster.is_empty() {
                *seed = mean(cluster);
            }
        }
    }
    let mut taken: Vec<usize> = Vec::new();
    for seed in seeds {
        let free = may.iter().filter(|f| !taken.contains(f));
        let near =
            free.min_by(|&&a, &&b| square(middles[a], seed).total_cmp(&square(middles[b], seed)));
        taken.extend(near);
    }
    let one = Shape::new(&[(0, 0)]).ok();
    taken
        .into_iter()
        .map(|f| Shaft {
            name: "lift".to_owned(),
            at: Place::Point([middles[f].x, middles[f].y]),
            shape: one.clone(),
        })
        .collect()
}
