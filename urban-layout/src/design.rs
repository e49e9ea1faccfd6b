//! The street network of a site from a specification alone: what
//! `urban-layout network` designs.
//!
//! Nothing of the planner takes part: a site is cut into quads, the edges of
//! the quads are chosen by [`network_opt`], level by level, and snakes make
//! streets of them.

use std::time::{Duration, Instant};

use geo_types::{Coord, Polygon};
use network_opt::design::{verify, Specification};
use network_opt::levels::{
    design_plans, streets, usual_speed, Level, LevelPlan, Street, StreetClass,
};
use network_opt::quad::{quads, QuadOptions};
use network_opt::snake::SnakeOptions;
use network_opt::solve::{Ended, Limits, Progress, Search};
use serde::Deserialize;
use serde_json::{json, Value};

use crate::error::{Error, Result};
use crate::site::Site;
use regions::{area, regions};

mod places;
mod regions;
mod traffic;

pub use places::{Places, SinkPlaces};
pub use traffic::{Journey, StudyTraffic, TrafficOptions};

/// What `--spec` holds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct NetworkSpec {
    /// Length of the edges of the first level's mesh, metres; 0 for a twelfth
    /// of the square root of the largest region's area. Default 0.
    pub edge_length: f64,
    /// How fast one drives on the streets that exist: the boundary where a level
    /// gives it. km/h. Default: as on the streets of the first level.
    pub existing_speed: Option<f64>,
    /// The levels, the widest streets first. Default: collectors alone.
    pub level: Vec<LevelSpec>,
    /// Who drives on the finished network.
    pub demand: TrafficOptions,
}

/// One level of streets.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct LevelSpec {
    /// What its streets are called. Default "collector".
    pub class: String,
    /// How wide they are, metres. Default 12.
    pub width: f64,
    /// How fast one drives there, km/h: travel counts time, so that faster
    /// streets attract. Default: by the class, that of the paper (40, 30, 20 and
    /// 20 miles an hour for "major", "collector", "local" and "cul-de-sac"; 30 for
    /// others).
    pub speed: Option<f64>,
    /// What they are for.
    pub network: Specification,
    /// Where the things are that it is told of.
    pub places: Places,
}

impl Default for NetworkSpec {
    fn default() -> Self {
        Self {
            edge_length: 0.0,
            existing_speed: None,
            level: vec![LevelSpec::default()],
            demand: TrafficOptions::default(),
        }
    }
}

impl Default for LevelSpec {
    fn default() -> Self {
        Self {
            class: "collector".to_owned(),
            width: 12.0,
            speed: None,
            network: Specification::default(),
            places: Places::default(),
        }
    }
}

impl LevelSpec {
    /// How fast one drives there, km/h.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed.unwrap_or_else(|| usual_speed(&self.class))
    }

    fn plan(&self) -> LevelPlan {
        LevelPlan {
            class: StreetClass {
                name: self.class.clone(),
                width: self.width,
                speed: self.speed(),
            },
            specification: self.network.clone(),
        }
    }
}

impl NetworkSpec {
    /// Reads a specification in TOML.
    ///
    /// # Errors
    ///
    /// An error of input that says where the text is not what it should be; no
    /// level; a width or speed that is not positive.
    ///
    /// # Examples
    ///
    /// ```
    /// use urban_layout::design::NetworkSpec;
    ///
    /// let spec = NetworkSpec::from_toml(
    ///     r#"
    ///     edge-length = 80.0
    ///     [[level]]
    ///     class = "collector"
    ///     [[level]]
    ///     class = "local"
    ///     width = 8.0
    ///     [level.network]
    ///     sinks = "streets"
    ///     dead-ends = { weighted = 3.0 }
    ///     coverage = { hops = 2 }
    ///     one-way = "new"
    ///     "#,
    /// )?;
    /// assert_eq!(spec.level[1].class, "local");
    /// assert!((spec.level[1].speed() - 32.19).abs() < 0.01);
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self> {
        let spec: Self =
            toml::from_str(text).map_err(|e| Error::input(format!("the specification: {e}")))?;
        if spec.level.is_empty() {
            return Err(Error::input(
                "the specification has no level; give a [[level]]",
            ));
        }
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if let Some(level) = spec.level.iter().find(|l| !positive(l.speed())) {
            return Err(Error::input(format!(
                "the speed on streets of the class {:?} is {}; give km/h",
                level.class,
                level.speed()
            )));
        }
        if let Some(speed) = spec.existing_speed.filter(|&speed| !positive(speed)) {
            return Err(Error::input(format!(
                "existing-speed is {speed}; give km/h"
            )));
        }
        if let Some(level) = spec.level.iter().find(|l| !positive(l.width)) {
            return Err(Error::input(format!(
                "streets of the class {:?} are {} m wide; give metres",
                level.class, level.width
            )));
        }
        Ok(spec)
    }
}

/// The network of one region of a site.
#[derive(Debug)]
pub struct PartNetwork {
    /// Its levels, as far as they were found.
    pub levels: Vec<Level>,
    /// Their streets, local metres.
    pub streets: Vec<Street>,
}

/// The networks of the regions of a site.
#[derive(Debug)]
pub struct NetworkStudy {
    /// One for each region between given roads and the boundary.
    pub parts: Vec<PartNetwork>,
    /// What was asked for.
    pub spec: NetworkSpec,
    /// Seconds in all.
    pub seconds: f64,
}

impl NetworkStudy {
    /// Designs the network of each region of `site`: the land between given
    /// roads and the boundary, which count as its rim. The time that `limits`
    /// give is divided among regions and levels. Vertices within key elements
    /// are obstacles.
    ///
    /// `told` hears of progress, and stops the work by false.
    ///
    /// # Errors
    ///
    /// Of input, if the site cannot be cut into quads, or the specification
    /// does not fit it.
    pub fn new(
        site: &Site,
        spec: &NetworkSpec,
        limits: &Limits,
        told: &mut dyn FnMut(&Progress<'_>) -> bool,
    ) -> Result<Self> {
        let began = Instant::now();
        let fault = |e: network_opt::DesignError| Error::input(e.to_string());
        let regions = regions(site)?;
        let edge_length = if spec.edge_length == 0.0 {
            let areas = regions.iter().map(area);
            areas.fold(0.0, f64::max).sqrt() / 12.0
        } else {
            spec.edge_length
        };
        let share = u32::try_from(regions.len().max(1)).unwrap_or(u32::MAX);
        let limits = Limits {
            deadline: limits.deadline.map(|deadline| deadline / share),
            ..limits.clone()
        };
        let elements: Vec<Polygon<f64>> = site.elements.iter().map(|e| e.polygon.clone()).collect();
        let mut parts = Vec::new();
        for (number, region) in regions.iter().enumerate() {
            let options = QuadOptions {
                edge_length,
                ..QuadOptions::default()
            };
            let mesh = quads(region, &options).map_err(fault)?;
            let mut plans = Vec::new();
            for (k, level) in spec.level.iter().enumerate() {
                let mut plan = level.plan();
                if k == 0 {
                    let obstacles = places::within(&mesh, &elements);
                    plan.specification.obstacles.extend(obstacles);
                }
                if !level.places.is_empty() {
                    let mesh = (0..k).fold(mesh.clone(), |mesh, _| mesh.refined());
                    level
                        .places
                        .settle(&mut plan.specification, &mesh, &regions, number, site)?;
                }
                plans.push(plan);
            }
            let existing = spec.existing_speed;
            let search = Search::default();
            let levels =
                design_plans(mesh, &plans, existing, &search, &limits, told).map_err(fault)?;
            let streets = streets(&levels, &SnakeOptions::default()).map_err(fault)?;
            parts.push(PartNetwork { levels, streets });
        }
        Ok(Self {
            parts,
            spec: spec.clone(),
            seconds: began.elapsed().as_secs_f64(),
        })
    }

    /// Whether every level of every part has a network, each valid by the
    /// checker that knows nothing of solvers.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let complete = |part: &PartNetwork| part.levels.len() == self.spec.level.len();
        self.parts.iter().all(complete) && self.levels().all(valid)
    }

    fn levels(&self) -> impl Iterator<Item = &Level> {
        self.parts.iter().flat_map(|part| &part.levels)
    }

    /// The sinks that were placed because a specification leaves open where they
    /// are: part, level and vertex of the mesh, local metres.
    pub fn placed_sinks(&self) -> impl Iterator<Item = (usize, usize, Coord<f64>)> + '_ {
        let levels = self.parts.iter().enumerate().flat_map(|(part, network)| {
            let levels = network.levels.iter().enumerate();
            levels.map(move |(k, level)| (part, k, level))
        });
        levels.flat_map(|(part, k, level)| {
            let sinks = level.outcome.network.iter().flat_map(|n| &n.sinks);
            sinks.map(move |&v| (part, k, level.mesh.points()[v]))
        })
    }

    /// The figures of `network.json`: sums over parts and levels.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let sum = |of: &dyn Fn(&Level) -> f64| self.levels().map(of).sum::<f64>();
        let objective = sum(&|l| l.outcome.cost.objective);
        let bound = sum(&|l| {
            if l.outcome.bound.is_finite() {
                l.outcome.bound
            } else {
                0.0
            }
        });
        let seconds = |time: Duration| time.as_secs_f64();
        // One part after the other: the first network of all is complete when
        // each first one is there.
        let mut first = Some(0.0);
        for level in self.levels() {
            first = first
                .zip(level.outcome.first_feasible)
                .map(|(sum, time)| sum + seconds(time));
        }
        let levels: Vec<Value> = self
            .parts
            .iter()
            .enumerate()
            .flat_map(|(part, network)| {
                network
                    .levels
                    .iter()
                    .enumerate()
                    .map(move |(k, level)| (part, k, level))
            })
            .map(|(part, k, level)| {
                let cost = level.outcome.cost;
                let network = level.outcome.network.as_ref();
                let there = network.map_or(0, |n| {
                    let routes = level.problem.routes.iter();
                    routes.filter(|route| route.is_there(&n.active)).count()
                });
                json!({
                    "part": part,
                    "level": k,
                    "class": self.spec.level[k].class,
                    "edges": level.mesh.edges().len(),
                    "valid": valid(level),
                    "proven": level.outcome.ended == Ended::Proven,
                    "objective": cost.objective,
                    "bound": level.outcome.bound.is_finite().then_some(level.outcome.bound),
                    "length_m": cost.length * level.metres(),
                    "travel_m": cost.travel * level.metres(),
                    "placed_sinks": network.map_or(0, |n| n.sinks.len()),
                    "spans": level.problem.routes.len(),
                    "spans_there": there,
                    "seconds": seconds(level.outcome.elapsed),
                })
            })
            .collect();
        json!({
            "valid": self.is_valid(),
            "objective": objective,
            "bound": bound,
            "gap": if objective > 0.0 { (objective - bound) / objective } else { 0.0 },
            "length_m": sum(&|l| l.outcome.cost.length * l.metres()),
            "travel_m": sum(&|l| l.outcome.cost.travel * l.metres()),
            "seconds": self.seconds,
            "first_feasible_seconds": first,
            "levels": levels,
        })
    }
}

fn valid(level: &Level) -> bool {
    let network = level.outcome.network.as_ref();
    network.is_some_and(|network| verify(&level.problem, network).is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use network_opt::design::{Among, Feature, Pairs, Parts, Place, Sinks};

    /// The example of the documentation.
    #[test]
    fn traffic_and_sinks_are_read() {
        let spec = NetworkSpec::from_toml(
            r#"
            [[level]]
            [level.network]
            sinks = { placed = { count = 3, among = "interior" } }
            [level.network.traffic]
            to-sinks = 0.5
            inside = { parts = { count = 6 }, tolerance = 3, missing = { weighted = 1.0 } }
            [level.network.traffic.across]
            pairs = { between = [[{ u = 0.5, v = 0.0 }, { x = 120.0, y = 35.5 }], [0, 12]] }
            [[level]]
            [level.network]
            sinks = { placed = { count = 1 } }
            traffic = { inside = { parts = { around = [{ u = 0.2, v = 0.2 }, 7] } }, across = { pairs = { count = 2 } } }
            [[level]]
            network = { sinks = { placed = { count = 1, among = { list = [3, { u = 1.0, v = 1.0 }] } } } }
            "#,
        )
        .expect("read");
        let [first, second, third] = [0, 1, 2].map(|k| &spec.level[k].network);
        let placed = |count, among| Sinks::Placed { count, among };
        assert_eq!(first.sinks, placed(3, Among::Interior));
        assert_eq!(first.traffic.to_sinks, 0.5);
        let inside = first.traffic.inside.as_ref().expect("inside");
        assert_eq!(
            (inside.tolerance, inside.missing),
            (3, Feature::Weighted(1.0))
        );
        let across = first.traffic.across.as_ref().expect("across");
        let south = Place::Share { u: 0.5, v: 0.0 };
        let point = Place::Point { x: 120.0, y: 35.5 };
        let pairs = vec![[south, point], [Place::Vertex(0), Place::Vertex(12)]];
        assert_eq!(across.pairs, Pairs::Between(pairs));
        assert_eq!(across.missing, Feature::Forbidden);
        assert_eq!(second.sinks, placed(1, Among::Boundary));
        let around = vec![Place::Share { u: 0.2, v: 0.2 }, Place::Vertex(7)];
        let inside = second.traffic.inside.as_ref().expect("inside");
        assert_eq!(inside.parts, Parts::Around(around));
        let corner = Place::Share { u: 1.0, v: 1.0 };
        let list = Among::List(vec![Place::Vertex(3), corner]);
        assert_eq!(third.sinks, placed(1, list));
        for wrong in [
            "inside = { part = 3 }",
            "across = { pairs = 2 }",
            "inward = 1",
        ] {
            let text = format!("[[level]]\nnetwork = {{ traffic = {{ {wrong} }} }}");
            assert!(NetworkSpec::from_toml(&text).is_err(), "{wrong}");
        }
    }
}
