//! Floorplans of a building from a specification: what `urban-layout floorplan`
//! plans.
//!
//! The building's outline is cut into quads, [`network_opt::floor`] places rooms
//! and corridors on them, storey by storey, and [`mod@draw`] makes polygons with
//! walls and doors of that.

pub mod draw;
mod spec;

use std::time::{Duration, Instant};

use network_opt::design::Tessellation;
use network_opt::floor::{design_storeys, spread_shafts, FloorSpecification, Obstacle, Storey};
use network_opt::quad::{quads, QuadOptions};
use network_opt::solve::{conflicts_by, Conflict, Ended, Limits, Progress, Search};
use serde_json::{json, Map, Value};

use crate::error::{Error, Result};
use crate::site::{ElementKind, Site};

use draw::{draw, Drawing};
pub use spec::FloorplanSpec;

/// Squares of a floor whose cell size is chosen by the program, about; and the
/// least cell, metres: two by two of them are an office for two.
const SQUARES: f64 = 400.0;
const LEAST_CELL: f64 = 2.7;
/// Time at most to find out why there is no plan, for each question.
const WHY: Duration = Duration::from_millis(1500);

/// The plans of a building.
#[derive(Debug)]
pub struct FloorplanStudy {
    /// The mesh that all storeys share.
    pub mesh: Tessellation,
    /// The storeys, the ground floor first, each with its plan.
    pub storeys: Vec<Storey>,
    /// What is drawn of each.
    pub drawings: Vec<Drawing>,
    /// What was asked for, in local metres.
    pub spec: FloorplanSpec,
    /// Seconds in all.
    pub seconds: f64,
}

impl FloorplanStudy {
    /// Plans the storeys of a building; the time that `limits` give is divided
    /// among them. Key elements of the file are obstacles on all storeys: parks
    /// and water are courts, which give windows.
    ///
    /// `told` hears of progress, and stops the work by false.
    ///
    /// # Errors
    ///
    /// Of input, if there is not one outline, it cannot be cut into quads, or the
    /// specification does not fit it; [`Error::is_unsatisfied`] if there is no
    /// plan in time, with the constraints that are in each other's way as far as
    /// that could be found out; [`Error::is_cancelled`] if `told` said no before
    /// there was a plan of each storey.
    ///
    /// # Examples
    ///
    /// ```
    /// use network_opt::solve::Limits;
    /// use urban_layout::floorplan::{FloorplanSpec, FloorplanStudy};
    /// use urban_layout::geo_types::polygon;
    /// use urban_layout::site::Site;
    ///
    /// let outline = polygon![(x: 0., y: 0.), (x: 27., y: 0.), (x: 27., y: 16.), (x: 0., y: 16.)];
    /// let site = Site::from_polygon(&outline)?;
    /// let limits = Limits { deadline: Some(std::time::Duration::from_millis(400)), ..Limits::default() };
    /// let study = FloorplanStudy::new(&site, &FloorplanSpec::default(), &limits, &mut |_| true)?;
    /// let drawing = &study.drawings[0];
    /// // Rooms and corridors tile the floor.
    /// assert!((drawing.area() - 27.0 * 16.0).abs() < 1e-3);
    /// assert!(drawing.rooms.iter().all(|room| room.door.is_some()));
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn new(
        site: &Site,
        spec: &FloorplanSpec,
        limits: &Limits,
        told: &mut dyn FnMut(&Progress<'_>) -> bool,
    ) -> Result<Self> {
        let began = Instant::now();
        let fault = |e: network_opt::DesignError| Error::input(e.to_string());
        let [outline] = site.parts.as_slice() else {
            return Err(Error::input(format!(
                "the building has {} outlines; give one at a time",
                site.parts.len()
            )));
        };
        spec.check()?;
        let mut spec = spec.in_metres(&site.frame);
        let cell = if spec.cell == 0.0 {
            (site.area() / SQUARES).sqrt().max(LEAST_CELL)
        } else {
            spec.cell
        };
        let options = QuadOptions {
            edge_length: cell,
            ..QuadOptions::default()
        };
        let mesh = quads(outline, &options).map_err(fault)?;
        let courts = courts(site);
        for storey in &mut spec.storey {
            storey.obstacles.extend(courts.iter().cloned());
        }
        spec.shaft.extend(spread_shafts(&mesh, spec.spread_shafts));
        spec.spread_shafts = 0;
        let mut going = true;
        let mut watch = |progress: &Progress<'_>| {
            going = told(progress);
            going
        };
        let storeys = design_storeys(
            &mesh,
            &spec.shaft,
            &spec.storey,
            &Search::default(),
            limits,
            &mut watch,
        )
        .map_err(fault)?;
        let unplanned = storeys.iter().position(|storey| !storey.is_valid());
        if !going && (unplanned.is_some() || storeys.len() < spec.storey.len()) {
            return Err(Error::cancelled());
        }
        if let Some(k) = unplanned {
            return Err(why(&storeys[k], k, storeys.len(), limits));
        }
        let drawings = storeys
            .iter()
            .map(|storey| draw(&mesh, storey, outline, &spec))
            .collect();
        Ok(Self {
            mesh,
            storeys,
            drawings,
            spec,
            seconds: began.elapsed().as_secs_f64(),
        })
    }

    /// Metres of an edge of length 1 in the objective.
    fn metres(&self) -> f64 {
        let edges = self.mesh.edges().len();
        let sum: f64 = (0..edges).map(|e| self.mesh.length(e)).sum();
        sum / edges.max(1) as f64
    }

    /// The figures of `floorplan.json`: sums over storeys, and each storey.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let metres = self.metres();
        let seconds = |time: Duration| time.as_secs_f64();
        let bound = |storey: &Storey| {
            let bound = storey.outcome.bound;
            if bound.is_finite() {
                bound
            } else {
                0.0
            }
        };
        let sum = |of: &dyn Fn(&Storey) -> f64| self.storeys.iter().map(of).sum::<f64>();
        let gap = |objective: f64, bound: f64| {
            if objective > 0.0 {
                ((objective - bound) / objective).max(0.0)
            } else {
                0.0
            }
        };
        // One storey after the other: the first plan of all is complete when each
        // first one is there.
        let mut first = Some(0.0);
        for storey in &self.storeys {
            first = first
                .zip(storey.outcome.first_feasible)
                .map(|(sum, time)| sum + seconds(time));
        }
        let each = self.storeys.iter().zip(&self.drawings).enumerate();
        let storeys: Vec<Value> = each
            .map(|(k, (storey, drawing))| {
                let cost = storey.outcome.cost;
                let mut kinds = Map::new();
                for room in &drawing.rooms {
                    let count = kinds.get(&room.name).and_then(Value::as_u64).unwrap_or(0);
                    kinds.insert(room.name.clone(), json!(count + 1));
                }
                let placements = storey.floor.problem.rooms.as_ref();
                json!({
                    "storey": k,
                    "name": storey.specification.name,
                    "edges": self.mesh.edges().len(),
                    "placements": placements.map_or(0, |r| r.placements.len()),
                    "rooms": kinds,
                    "valid": storey.is_valid(),
                    "proven": storey.outcome.ended == Ended::Proven,
                    "objective": cost.objective,
                    "bound": bound(storey),
                    "gap": gap(cost.objective, bound(storey)),
                    "length_m": cost.length * metres,
                    "travel_m": cost.travel * metres,
                    "corridor_m2": drawing.corridor_area(),
                    "floor_m2": drawing.area(),
                    "seconds": seconds(storey.outcome.elapsed),
                    "first_feasible_seconds": storey.outcome.first_feasible.map(seconds),
                })
            })
            .collect();
        let objective = sum(&|s| s.outcome.cost.objective);
        let least = sum(&bound);
        json!({
            "valid": self.storeys.iter().all(Storey::is_valid),
            "objective": objective,
            "bound": least,
            "gap": gap(objective, least),
            "length_m": sum(&|s| s.outcome.cost.length * metres),
            "travel_m": sum(&|s| s.outcome.cost.travel * metres),
            "seconds": self.seconds,
            "first_feasible_seconds": first,
            "storeys": storeys,
        })
    }
}

/// Key elements of the file as obstacles.
fn courts(site: &Site) -> Vec<Obstacle> {
    let court = |element: &crate::site::Element| Obstacle {
        name: String::new(),
        polygon: (element.polygon.exterior().0.iter())
            .map(|c| [c.x, c.y])
            .collect(),
        faces: Vec::new(),
        open: matches!(element.kind, ElementKind::Park | ElementKind::Lake),
    };
    site.elements.iter().map(court).collect()
}

/// Says why a storey has no plan: which families of constraints conflict.
fn why(storey: &Storey, k: usize, count: usize, limits: &Limits) -> Error {
    let whose = if count > 1 {
        format!("storey {k} has no plan")
    } else {
        "there is no plan".to_owned()
    };
    let questions = Limits {
        deadline: Some(limits.deadline.map_or(WHY, |d| d.min(WHY))),
        ..limits.clone()
    };
    let found = conflicts_by(&storey.floor.problem, &Search::default(), &questions);
    let words = |list: &[network_opt::solve::Constraints]| {
        let words: Vec<&str> = list.iter().map(|c| c.as_str()).collect();
        words.join("; ")
    };
    let proven = storey.outcome.ended == Ended::Infeasible;
    let sure = if proven {
        ""
    } else {
        ", as far as was found out in time"
    };
    match found {
        Ok(Some(Conflict { each, .. })) if !each.is_empty() => Error::unsatisfied(format!(
            "{whose}{sure}: any one of these left out would give one: {}",
            words(&each)
        )),
        Ok(Some(Conflict { together, .. })) => Error::unsatisfied(format!(
            "{whose}{sure}: these are in each other's way: {}",
            words(&together)
        )),
        _ => Error::unsatisfied(format!("{whose} yet: allow more time, or ask for less")),
    }
}

/// A storey of offices, as `floorplan` plans without a specification.
impl Default for FloorplanSpec {
    fn default() -> Self {
        Self {
            cell: 0.0,
            corridor_width: 1.8,
            door_width: 0.9,
            room: Vec::new(),
            shaft: Vec::new(),
            spread_shafts: 0,
            storey: vec![FloorSpecification::default()],
        }
    }
}
