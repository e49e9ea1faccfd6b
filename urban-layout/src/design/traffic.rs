//! Traffic on a designed network: the paper's demand, predicted and simulated.

use std::path::Path;

use geo_types::Polygon;
use network_opt::traffic::sumo::{Simulated, SumoFiles, SumoOptions};
use network_opt::traffic::{
    assign, exits, nearest_nodes, roads_of, spread_points, Assignment, Demand, NodingOptions, Road,
    RoadClass, StreetGraph, Traffic, TrafficError, Trip,
};
use serde::Deserialize;
use serde_json::{json, Value};

use super::NetworkStudy;
use crate::error::{Error, Result};
use crate::network::entries;
use crate::site::Site;

/// How much traffic there is: what a specification has under `[demand]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct TrafficOptions {
    /// Cars per square kilometre and hour that leave the site, from places spread
    /// uniformly over it.
    ///
    /// Default value: 250, as in *Computational Network Design*, section 5.1.
    pub cars_per_km2: f64,
    /// Cars an hour besides, spread uniformly over all pairs of places where
    /// streets outside meet the boundary: the through traffic of the paper's
    /// figure 8, where it is 1,000.
    ///
    /// Default value: 0.
    pub external: f64,
    /// Cars besides from place to place: the demand of the paper's section 3, and
    /// the arrows of figure 8a.
    ///
    /// Default value: none.
    pub pairs: Vec<Journey>,
    /// For how many hours.
    ///
    /// Default value: 2.
    pub hours: f64,
    /// Cars set off from places along streets no farther apart than this,
    /// metres.
    ///
    /// Default value: 60.
    pub pieces: f64,
    /// Seed of the times of departure.
    ///
    /// Default value: 0.
    pub seed: u64,
}

/// So many cars an hour from the street nearest to one place to that nearest to
/// another, places in the coordinates of the site's file.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Journey {
    /// Where they set off.
    pub from: [f64; 2],
    /// Where they go.
    pub to: [f64; 2],
    /// How many an hour.
    pub cars: f64,
}

impl Default for TrafficOptions {
    fn default() -> Self {
        Self {
            cars_per_km2: 250.0,
            external: 0.0,
            pairs: Vec::new(),
            hours: 2.0,
            pieces: 60.0,
            seed: 0,
        }
    }
}

/// The traffic from within a site to its sinks, and that through it.
#[derive(Clone, Debug)]
pub struct StudyTraffic {
    /// The streets, local metres. What was given is of class 0, levels follow.
    pub graph: StreetGraph,
    /// Nodes where traffic leaves: the sinks of the first levels.
    pub exits: Vec<usize>,
    /// Every car.
    pub trips: Vec<Trip>,
    /// What the trips come to by shortest ways.
    pub predicted: Traffic,
}

impl StudyTraffic {
    /// Predicts the traffic of a study's network: each car goes to the sink
    /// that it reaches first. It sets off from the node nearest to its place
    /// that is no sink.
    ///
    /// # Errors
    ///
    /// Of usage, for an option out of its range; of input, if the network has no
    /// streets, or a street leads to no sink.
    pub fn new(study: &NetworkStudy, site: &Site, options: &TrafficOptions) -> Result<Self> {
        let cars = options.cars_per_km2 * options.hours * site.area() * 1e-6;
        if !(options.hours > 0.0 && options.hours <= 1000.0 && (0.0..1e6).contains(&cars)) {
            return Err(Error::usage(format!(
                "{} cars per km2 in {} h are {cars:.0} on this site; give up to a million, and some time",
                options.cars_per_km2, options.hours
            )));
        }
        let classes = classes(study);
        let mut roads: Vec<Road> = Vec::new();
        for part in &study.parts {
            roads.extend(roads_of(&part.levels, &part.streets, classes.len()));
        }
        let noding = NodingOptions {
            pieces: options.pieces,
            ..NodingOptions::default()
        };
        let graph = StreetGraph::from_roads(&roads, &classes, &noding).map_err(fault)?;
        let mut out: Vec<usize> = Vec::new();
        for part in &study.parts {
            out.extend(exits(&graph, &part.levels, REACH));
        }
        out.sort_unstable();
        out.dedup();
        let mut trips = trips(&graph, &out, &site.parts, cars, options).map_err(fault)?;
        trips.extend(external(&graph, site, options)?);
        trips.extend(journeys(&graph, site, options)?);
        trips.sort_by(|a, b| a.depart.total_cmp(&b.depart));
        let demand = Demand::of_trips(&trips, options.hours);
        let predicted = assign(&graph, &demand, &Assignment::ShortestTime).map_err(fault)?;
        Ok(Self {
            graph,
            exits: out,
            trips,
            predicted,
        })
    }

    /// The network and its trips as plain files of the simulator SUMO, called
    /// `network.nod.xml` and so on.
    ///
    /// # Errors
    ///
    /// None that is known: the graph is sound.
    pub fn sumo(&self) -> Result<SumoFiles> {
        SumoFiles::new(&self.graph, &self.trips, &SumoOptions::default()).map_err(fault)
    }

    /// Simulates the trips in a folder, once for each seed; `None` if SUMO is
    /// not installed.
    ///
    /// # Errors
    ///
    /// If SUMO fails.
    pub fn simulate(&self, folder: &Path, seeds: &[u64]) -> Result<Option<Simulated>> {
        match self.sumo()?.simulate(folder, seeds) {
            Ok(found) => Ok(Some(found)),
            Err(TrafficError::NoSumo { .. }) => Ok(None),
            Err(e) => Err(Error::stage("SUMO", e)),
        }
    }

    /// The figures that `network.json` has under `traffic`.
    #[must_use]
    pub fn to_json(&self, simulated: Option<&Simulated>) -> Value {
        let predicted = &self.predicted;
        let simulated = simulated.map(|found| {
            let sum = |of: fn(&network_opt::traffic::sumo::SimulatedRun) -> usize| {
                found.runs.iter().map(of).sum::<usize>()
            };
            json!({
                "runs": found.runs.len(),
                "trips": sum(|run| run.wanted),
                "arrived": sum(|run| run.arrived),
                "mean_distance_m": found.mean_distance,
                "mean_time_s": found.mean_time,
                "distance_ratio": ratio(found.mean_distance, predicted.mean_distance),
                "time_ratio": ratio(found.mean_time, predicted.mean_time),
            })
        });
        json!({
            "street_length_m": self.graph.street_length(),
            "exits": self.exits.len(),
            "trips": self.trips.len(),
            "cars_per_hour": predicted.trips,
            "busiest_cars_per_hour": predicted.both_ways(&self.graph).into_iter().fold(0.0, f64::max),
            "mean_distance_m": predicted.mean_distance,
            "mean_time_s": predicted.mean_time,
            "simulated": simulated,
        })
    }
}

/// How far a node may be from the boundary that it is on, metres.
const REACH: f64 = 0.05;

fn ratio(a: f64, b: f64) -> Option<f64> {
    (b > 0.0).then_some(a / b)
}

fn fault(e: TrafficError) -> Error {
    Error::input(format!("traffic: {e}"))
}

/// The paper's classes under the names of the levels, with their speeds.
fn classes(study: &NetworkStudy) -> Vec<RoadClass> {
    // From kilometres an hour to metres a second.
    let metres = |speed: f64| speed / 3.6;
    let paper = RoadClass::paper();
    let mut classes = vec![RoadClass {
        speed: study.spec.existing_speed.map_or(paper[0].speed, metres),
        ..paper[0].clone()
    }];
    for (k, level) in study.spec.level.iter().enumerate() {
        let like = &paper[(k + 1).min(paper.len() - 1)];
        classes.push(RoadClass {
            name: level.class.clone(),
            speed: metres(level.speed()),
            ..like.clone()
        });
    }
    classes
}

/// Trips between the places where streets outside meet the boundary.
fn external(graph: &StreetGraph, site: &Site, options: &TrafficOptions) -> Result<Vec<Trip>> {
    if options.external == 0.0 {
        return Ok(Vec::new());
    }
    let places: Vec<_> = entries(site).iter().map(|entry| entry.at).collect();
    let mut gates = nearest_nodes(graph, &places, &|_| true);
    gates.sort_unstable();
    gates.dedup();
    if gates.len() < 2 {
        return Err(Error::input(
            "traffic from outside needs two places where streets outside meet the boundary",
        ));
    }
    // A stream of chance of its own, whatever the trips from within.
    let seed = options.seed ^ 0x9e37_79b9_7f4a_7c15;
    let demand = Demand::among(&gates, options.external);
    demand.trips(options.hours, seed).map_err(fault)
}

/// Trips between named places.
fn journeys(graph: &StreetGraph, site: &Site, options: &TrafficOptions) -> Result<Vec<Trip>> {
    let mut demand = Demand::default();
    for (k, pair) in options.pairs.iter().enumerate() {
        if pair.from.iter().chain(&pair.to).any(|x| !x.is_finite()) {
            return Err(Error::usage(format!(
                "a place of pair {k} of the demand is not a number"
            )));
        }
        let places = [pair.from, pair.to].map(|place| site.frame.to_local(place.into()));
        let [from, to] = nearest_nodes(graph, &places, &|_| true)[..] else {
            return Err(Error::input("the network has no street to send cars over"));
        };
        demand = demand.plus(&Demand::pairs(&[(from, to)], pair.cars));
    }
    let seed = options.seed ^ 0xd1b5_4a32_d192_ed03;
    demand.trips(options.hours, seed).map_err(fault)
}

/// One trip for each of so many places spread over the site.
fn trips(
    graph: &StreetGraph,
    exits: &[usize],
    areas: &[Polygon<f64>],
    cars: f64,
    options: &TrafficOptions,
) -> std::result::Result<Vec<Trip>, TrafficError> {
    let places = spread_points(areas, cars.round() as usize);
    let origins = nearest_nodes(graph, &places, &|n| exits.binary_search(&n).is_err());
    if origins.len() < places.len() {
        return Err(TrafficError::BadGraph {
            what: "no street lies within the site".to_owned(),
        });
    }
    let per_hour = places.len() as f64 / options.hours;
    Demand::to_nearest(graph, &origins, exits, per_hour)?.trips(options.hours, options.seed)
}
