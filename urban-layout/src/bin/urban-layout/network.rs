//! `urban-layout network`: a street network from a specification.

use std::time::Duration;

use network_opt::solve::Limits;
use urban_layout::design::{NetworkSpec, NetworkStudy};
use urban_layout::io;
use urban_layout::{Error, Result};

use crate::args::{read_spec, NetworkJob};

pub(crate) fn run(job: &NetworkJob) -> Result<u8> {
    let site = job.common.read(&job.site)?;
    for warning in &site.warnings {
        eprintln!("warning: {warning}");
    }
    if !site.roads.is_empty() {
        eprintln!("warning: given roads are not part of the network");
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
    let figures = study.to_json();
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
        println!("written to {}", job.out.display());
    }
    Ok(0)
}
