//! The street network of a site from a specification alone: what
//! `urban-layout network` designs.
//!
//! Nothing of the planner takes part: a site is cut into quads, the edges of
//! the quads are chosen by [`network_opt`], level by level, and snakes make
//! streets of them.

use std::time::{Duration, Instant};

use geo_types::{Coord, Polygon};
use network_opt::design::{verify, Specification, Tessellation};
use network_opt::levels::{design_levels, streets, Level, Street};
use network_opt::quad::{quads, QuadOptions};
use network_opt::snake::SnakeOptions;
use network_opt::solve::{Ended, Limits, Progress, Search};
use serde::Deserialize;
use serde_json::{json, Value};

use crate::error::{Error, Result};
use crate::site::{Boundary, Site};

/// What `--spec` holds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct NetworkSpec {
    /// Length of the edges of the first level's mesh, metres; 0 for a twelfth
    /// of the square root of the area. Default 0.
    pub edge_length: f64,
    /// The levels, the widest streets first. Default: collectors alone.
    pub level: Vec<LevelSpec>,
}

/// One level of streets.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct LevelSpec {
    /// What its streets are called. Default "collector".
    pub class: String,
    /// How wide they are, metres. Default 12.
    pub width: f64,
    /// What they are for.
    pub network: Specification,
}

impl Default for NetworkSpec {
    fn default() -> Self {
        Self {
            edge_length: 0.0,
            level: vec![LevelSpec::default()],
        }
    }
}

impl Default for LevelSpec {
    fn default() -> Self {
        Self {
            class: "collector".to_owned(),
            width: 12.0,
            network: Specification::default(),
        }
    }
}

impl NetworkSpec {
    /// Reads a specification in TOML.
    ///
    /// # Errors
    ///
    /// An error of input that says where the text is not what it should be; no
    /// level; a width that is not positive.
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
    ///     "#,
    /// )?;
    /// assert_eq!(spec.level[1].class, "local");
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
        if let Some(level) = spec
            .level
            .iter()
            .find(|l| !(l.width > 0.0 && l.width.is_finite()))
        {
            return Err(Error::input(format!(
                "streets of the class {:?} are {} m wide; give metres",
                level.class, level.width
            )));
        }
        Ok(spec)
    }
}

/// The network of one part of a site.
#[derive(Debug)]
pub struct PartNetwork {
    /// Its levels, as far as they were found.
    pub levels: Vec<Level>,
    /// Their streets, local metres.
    pub streets: Vec<Street>,
}

/// The networks of the parts of a site.
#[derive(Debug)]
pub struct NetworkStudy {
    /// One for each of [`Site::parts`].
    pub parts: Vec<PartNetwork>,
    /// What was asked for.
    pub spec: NetworkSpec,
    /// Seconds in all.
    pub seconds: f64,
}

impl NetworkStudy {
    /// Designs the network of each part of `site`; the time that `limits` give
    /// is divided among parts and levels. Vertices within key elements are
    /// obstacles; given roads are not part of it.
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
        let share = u32::try_from(site.parts.len().max(1)).unwrap_or(u32::MAX);
        let limits = Limits {
            deadline: limits.deadline.map(|deadline| deadline / share),
            ..limits.clone()
        };
        let mut parts = Vec::new();
        for part in &site.parts {
            let options = QuadOptions {
                edge_length: spec.edge_length,
                ..QuadOptions::default()
            };
            let mesh = quads(part, &options).map_err(fault)?;
            let mut wanted: Vec<Specification> =
                spec.level.iter().map(|l| l.network.clone()).collect();
            if let Some(first) = wanted.first_mut() {
                first.obstacles.extend(obstacles(&mesh, site));
            }
            let levels =
                design_levels(mesh, &wanted, &Search::default(), &limits, told).map_err(fault)?;
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

/// Vertices within key elements, but those on the boundary, where streets exist.
fn obstacles(mesh: &Tessellation, site: &Site) -> Vec<usize> {
    let mut on_rim = vec![false; mesh.points().len()];
    for (ends, rim) in mesh.edges().iter().zip(mesh.rim()) {
        ends.iter().for_each(|&v| on_rim[v] |= rim);
    }
    let elements: Vec<Polygon<f64>> = site.elements.iter().map(|e| e.polygon.clone()).collect();
    let within = Boundary::new(&elements);
    (0..mesh.points().len())
        .filter(|&v| !on_rim[v] && within.contains(mesh.points()[v]))
        .collect()
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
