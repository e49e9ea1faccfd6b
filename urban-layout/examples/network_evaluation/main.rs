//! Networks of one site from different specifications, judged as in section 5.1
//! of *Computational Network Design*: the mean way of a car as it is predicted
//! by shortest paths, and as the simulator SUMO has it.
//!
//! `cargo run --release -p urban-layout --example network_evaluation --
//! tests/data/sites/kotka_east.geojson OUT [SECONDS]` designs each network,
//! SECONDS for each (10 if not given), and writes `evaluation.md`, the tables of
//! the guide's page on traffic, and a picture of each network with its traffic.
//! Without SUMO (Debian: `apt-get install sumo`) its columns stay empty.
//!
//! The same cars set off at the same times from the same places in every
//! network, 250 per square kilometre and hour for four hours, spread uniformly:
//! once each to the nearest sink, once each to another place of the site.

mod scenarios;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use network_opt::solve::Limits;
use network_opt::traffic::sumo::{SumoFiles, SumoOptions};
use network_opt::traffic::{
    assign, nearest_nodes, spread_points, Assignment, Demand, StreetGraph, TrafficError, Trip,
};
use scenarios::{Scenario, SCENARIOS};
use urban_layout::design::{NetworkSpec, NetworkStudy, StudyTraffic, TrafficOptions};
use urban_layout::io::svg::{network_svg, traffic_svg};
use urban_layout::{Error, Result, Site};

const HOURS: f64 = 4.0;
/// Each network is simulated with these.
const SEEDS: [u64; 3] = [1, 2, 3];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (Some(site), Some(out)) = (words.first(), words.get(1)) else {
        eprintln!("usage: network_evaluation SITE OUT [SECONDS]");
        return ExitCode::from(2);
    };
    let seconds = words.get(2).and_then(|w| w.parse().ok()).unwrap_or(10.0);
    match run(Path::new(site), Path::new(out), seconds) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(site: &Path, out: &Path, seconds: f64) -> Result<()> {
    let io = |e: std::io::Error| Error::input(format!("{}: {e}", out.display()));
    std::fs::create_dir_all(out).map_err(io)?;
    let site = Site::read(site)?;
    let (mut leaving, mut staying) = (Vec::new(), Vec::new());
    for scenario in &SCENARIOS {
        let spec = NetworkSpec::from_toml(&scenario.spec())?;
        let limits = Limits {
            deadline: Some(Duration::from_secs_f64(seconds)),
            ..Limits::default()
        };
        let study = NetworkStudy::new(&site, &spec, &limits, &mut |_| true)?;
        if !study.is_valid() {
            eprintln!("{}: no network in time", scenario.name);
            continue;
        }
        let options = TrafficOptions {
            hours: HOURS,
            ..TrafficOptions::default()
        };
        let traffic = StudyTraffic::new(&study, &site, &options)?;
        let file = scenario.name.replace(' ', "_");
        let write = |name: String, svg: String| std::fs::write(out.join(name), svg).map_err(io);
        write(format!("{file}.network.svg"), network_svg(&study, &site))?;
        write(format!("{file}.traffic.svg"), traffic_svg(&traffic, &site))?;
        let within = within(&traffic, &site);
        for (rows, trips) in [(&mut leaving, &traffic.trips), (&mut staying, &within)] {
            match judge(scenario, &traffic.graph, trips)? {
                Some(row) => {
                    eprintln!("{row:?}");
                    rows.push(row);
                }
                None => eprintln!("{}: the streets are not in one piece", scenario.name),
            }
        }
    }
    let mut page = String::new();
    for (rows, what) in [
        (&leaving, "to the nearest sink"),
        (&staying, "from place to place"),
    ] {
        table(&mut page, rows, what);
    }
    print!("{page}");
    std::fs::write(out.join("evaluation.md"), page).map_err(io)
}

/// What comes of a scenario.
#[derive(Debug)]
struct Row {
    name: &'static str,
    asks: &'static str,
    /// Metres of street.
    length: f64,
    trips: usize,
    /// Mean metres and seconds of a trip.
    predicted: (f64, f64),
    simulated: Option<(f64, f64)>,
}

/// Trips from each place to another, by whatever nodes are near.
fn within(traffic: &StudyTraffic, site: &Site) -> Vec<Trip> {
    let places = spread_points(&site.parts, traffic.trips.len());
    let is_inside = |n: usize| traffic.exits.binary_search(&n).is_err();
    let nodes = nearest_nodes(&traffic.graph, &places, &is_inside);
    // A shuffle that is the same for all networks.
    let mut partners: Vec<usize> = (0..nodes.len()).collect();
    partners.sort_by_key(|&k| (k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let step = HOURS * 3600.0 / nodes.len() as f64;
    let chain = partners.iter().zip(partners.iter().cycle().skip(1));
    let trips = chain.enumerate().map(|(k, (&a, &b))| Trip {
        from: nodes[a],
        to: nodes[b],
        depart: (k as f64 + 0.5) * step,
    });
    trips.filter(|trip| trip.from != trip.to).collect()
}

/// `None` where no way leads from some place to another: streets that lead to
/// different exits need not meet.
fn judge(scenario: &Scenario, graph: &StreetGraph, trips: &[Trip]) -> Result<Option<Row>> {
    let fault = |e: TrafficError| Error::input(format!("{}: {e}", scenario.name));
    let demand = Demand::of_trips(trips, HOURS);
    let predicted = match assign(graph, &demand, &Assignment::ShortestTime) {
        Err(TrafficError::Unreachable { .. }) => return Ok(None),
        other => other.map_err(fault)?,
    };
    let files = SumoFiles::new(graph, trips, &SumoOptions::default()).map_err(fault)?;
    let folder = tempfile::tempdir().map_err(|e| Error::input(e.to_string()))?;
    let simulated = match files.simulate(folder.path(), &SEEDS) {
        Ok(found) => {
            let lost = found.runs.iter().any(|run| run.arrived != run.wanted);
            if lost {
                eprintln!("{}: not all cars have arrived", scenario.name);
            }
            Some((found.mean_distance, found.mean_time))
        }
        Err(error @ TrafficError::NoSumo { .. }) => {
            eprintln!("{error}");
            None
        }
        Err(error) => return Err(fault(error)),
    };
    Ok(Some(Row {
        name: scenario.name,
        asks: scenario.asks,
        length: graph.street_length(),
        trips: trips.len(),
        predicted: (predicted.mean_distance, predicted.mean_time),
        simulated,
    }))
}

/// A table as in the paper's figure 8 and section 5.1, with both rankings by
/// distance, the shortest first, and what they have in common.
fn table(page: &mut String, rows: &[Row], what: &str) {
    let cars = rows.first().map_or(0, |row| row.trips);
    let _ = writeln!(
        page,
        "Cars {what} ({cars} of them):\n\n\
         | scenario | what is asked | L m | d m | SUMO m | SUMO / d | rank by d | rank by SUMO | time s | SUMO s | SUMO / time |\n\
         |---|---|---|---|---|---|---|---|---|---|---|"
    );
    let ranks = |of: &dyn Fn(&Row) -> f64| -> Vec<usize> {
        let values: Vec<f64> = rows.iter().map(of).collect();
        let shorter = |v: f64| values.iter().filter(|&&o| o < v).count() + 1;
        values.iter().map(|&v| shorter(v)).collect()
    };
    let simulated = |row: &Row| row.simulated.map_or(f64::NAN, |s| s.0);
    let (ours, theirs) = (ranks(&|row| row.predicted.0), ranks(&simulated));
    for (k, row) in rows.iter().enumerate() {
        let (d, time) = row.predicted;
        let _ = write!(
            page,
            "| {} | {} | {:.0} | {d:.0} ",
            row.name, row.asks, row.length
        );
        let _ = match row.simulated {
            Some((m, s)) => writeln!(
                page,
                "| {m:.0} | {:.3} | {} | {} | {time:.1} | {s:.1} | {:.2} |",
                m / d,
                ours[k],
                theirs[k],
                s / time
            ),
            None => writeln!(page, "| | | {} | | {time:.1} | | |", ours[k]),
        };
    }
    if rows.iter().all(|row| row.simulated.is_some()) {
        let same = ours.iter().zip(&theirs).filter(|(a, b)| a == b).count();
        let _ = writeln!(
            page,
            "\n{same} of {} scenarios have the same rank by both.",
            rows.len()
        );
    }
    page.push('\n');
}
