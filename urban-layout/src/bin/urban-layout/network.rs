//! `urban-layout network`: a street network from a specification.

use std::time::Duration;

use network_opt::solve::Limits;
use network_opt::traffic::sumo::Simulated;
use serde_json::Value;
use urban_layout::design::{NetworkSpec, NetworkStudy, StudyTraffic, TrafficOptions};
use urban_layout::io;
use urban_layout::{Error, Result, Site};

use crate::args::{read_spec, NetworkJob};

pub(crate) fn run(job: &NetworkJob) -> Result<u8> {
    let site = job.common.read(&job.site)?;
    for warning in &site.warnings {
        eprintln!("warning: {warning}");
    }
    let spec = match &job.spec {
        Some(path) => read_spec(path)?,
        None => NetworkSpec::default(),
    };
    if !(job.deadline > 0.0 && job.deadline < 1e9) {
        return Err(Error::usage(format!(
            "the deadline is {} s; it must be positive",
            job.deadline
        )));
    }
    if !(0.0..=1.0).contains(&job.gap) {
        return Err(Error::usage(format!(
            "the gap is {}; it must be from 0 to 1",
            job.gap
        )));
    }
    let limits = Limits {
        deadline: Some(Duration::from_secs_f64(job.deadline)),
        gap: job.gap,
        threads: job.threads.max(1),
        seed: job.seed,
    };
    let study = NetworkStudy::new(&site, &spec, &limits, &mut |_| true)?;
    if !study.is_valid() {
        return Err(Error::input(
            "no network was found in time that keeps the specification; allow more time or more of it",
        ));
    }
    let mut figures = study.to_json();
    let (traffic, simulated) = traffic(job, &study, &site)?;
    figures["traffic"] = traffic
        .as_ref()
        .map_or(Value::Null, |traffic| traffic.to_json(simulated.as_ref()));
    let json = serde_json::to_string_pretty(&figures).map_err(|e| Error::stage("network", e))?;
    let svg = io::svg::network_svg(&study, &site);
    let streets = io::network_geojson::network_to_geojson(&study, &site.frame);
    let mut files = vec![
        (job.out.join("network.geojson"), streets.into_bytes()),
        (job.out.join("network.json"), (json + "\n").into_bytes()),
    ];
    if job.png {
        let picture = super::png(&svg, "network.svg")?;
        files.push((job.out.join("network.png"), picture));
    }
    files.push((job.out.join("network.svg"), svg.into_bytes()));
    if let Some(traffic) = &traffic {
        let svg = io::svg::traffic_svg(traffic, &site);
        if job.png {
            let picture = super::png(&svg, "traffic.svg")?;
            files.push((job.out.join("traffic.png"), picture));
        }
        files.push((job.out.join("traffic.svg"), svg.into_bytes()));
        if job.sumo {
            let plain = traffic.sumo()?;
            let plain = plain.files().iter();
            files.extend(plain.map(|(name, text)| (job.out.join(name), text.clone().into_bytes())));
        }
    }
    io::write::write_all_or_nothing(&files)?;
    if job.common.json {
        println!("{figures}");
    } else {
        let number = |key: &str| figures[key].as_f64().unwrap_or(0.0);
        println!(
            "{:.1} km of streets, objective {:.2}, proven to be within {:.0} % of the least; {:.1} s, the first network after {:.3} s",
            number("length_m") / 1e3,
            number("objective"),
            100.0 * number("gap"),
            number("seconds"),
            number("first_feasible_seconds"),
        );
        if let Some(traffic) = &traffic {
            println!("{}", words(traffic, simulated.as_ref()));
        }
        println!("written to {}", job.out.display());
    }
    Ok(0)
}

/// How many times SUMO simulates the same trips.
const SUMO_RUNS: u64 = 3;

/// The traffic on the network, predicted and, if asked for and SUMO is there,
/// simulated. A network that nobody can be sent out on is no error unless files
/// for SUMO are asked for.
fn traffic(
    job: &NetworkJob,
    study: &NetworkStudy,
    site: &Site,
) -> Result<(Option<StudyTraffic>, Option<Simulated>)> {
    let wanted = &study.spec.demand;
    let options = TrafficOptions {
        cars_per_km2: job.cars.unwrap_or(wanted.cars_per_km2),
        external: job.external.unwrap_or(wanted.external),
        seed: wanted.seed.wrapping_add(job.seed),
        ..wanted.clone()
    };
    let traffic = match StudyTraffic::new(study, site, &options) {
        Ok(traffic) => traffic,
        Err(error) if error.is_input() && !job.sumo => {
            eprintln!("warning: {error}");
            return Ok((None, None));
        }
        Err(error) => return Err(error),
    };
    let mut simulated = None;
    if job.sumo {
        let folder = tempfile::tempdir().map_err(|e| Error::stage("SUMO", e))?;
        let seeds: Vec<u64> = (0..SUMO_RUNS).map(|k| job.seed.wrapping_add(k)).collect();
        simulated = traffic.simulate(folder.path(), &seeds)?;
        if simulated.is_none() {
            eprintln!("warning: SUMO is not installed, so that nothing was simulated; Debian: apt-get install sumo");
        }
    }
    Ok((Some(traffic), simulated))
}

/// What the traffic comes to, in a line.
fn words(traffic: &StudyTraffic, simulated: Option<&Simulated>) -> String {
    let predicted = &traffic.predicted;
    let mut line = format!(
        "{:.0} cars an hour, {:.0} m and {:.0} s each on average",
        predicted.trips, predicted.mean_distance, predicted.mean_time
    );
    if let Some(found) = simulated {
        line += &format!(
            "; SUMO says {:.0} m and {:.0} s",
            found.mean_distance, found.mean_time
        );
    }
    line
}
