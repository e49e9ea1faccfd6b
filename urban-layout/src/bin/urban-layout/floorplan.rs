//! `urban-layout floorplan`: the floors of a building from a specification.

use std::time::Duration;

use network_opt::solve::Limits;
use urban_layout::floorplan::{FloorplanSpec, FloorplanStudy};
use urban_layout::io;
use urban_layout::{Error, Result};

use crate::args::FloorplanJob;

pub(crate) fn run(job: &FloorplanJob) -> Result<u8> {
    if !(job.deadline > 0.0 && job.deadline < 1e9) {
        return Err(Error::usage(format!(
            "the deadline is {} s; it must be positive",
            job.deadline
        )));
    }
    let building = job.common.read_building(&job.building)?;
    for warning in &building.warnings {
        eprintln!("warning: {warning}");
    }
    let spec = match &job.spec {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|e| Error::input(format!("{}: {e}", path.display())))?;
            FloorplanSpec::from_toml(&text)?
        }
        None => FloorplanSpec::default(),
    };
    let limits = Limits {
        deadline: Some(Duration::from_secs_f64(job.deadline)),
        gap: 0.0,
        threads: job.threads.max(1),
        seed: job.seed,
    };
    let study = FloorplanStudy::new(&building, &spec, &limits, &mut |_| true)?;
    let figures = study.to_json();
    let json = serde_json::to_string_pretty(&figures).map_err(|e| Error::stage("floorplan", e))?;
    let svg = io::svg::floorplan_svg(&study, &building);
    let plan = io::floorplan_geojson::floorplan_to_geojson(&study, &building.frame);
    let mut files = vec![
        (job.out.join("floorplan.geojson"), plan.into_bytes()),
        (job.out.join("floorplan.json"), (json + "\n").into_bytes()),
    ];
    if job.png {
        let picture = super::png(&svg, "floorplan.svg")?;
        files.push((job.out.join("floorplan.png"), picture));
    }
    files.push((job.out.join("floorplan.svg"), svg.into_bytes()));
    io::write::write_all_or_nothing(&files)?;
    if job.common.json {
        println!("{figures}");
    } else {
        let number = |key: &str| figures[key].as_f64().unwrap_or(0.0);
        let rooms: usize = study.drawings.iter().map(|d| d.rooms.len()).sum();
        println!(
            "{rooms} rooms on {:.0} m of corridors, {} storey{}, objective {:.2}, proven to be within {:.0} % of the least; {:.1} s, the first plan after {:.3} s",
            number("length_m"),
            study.storeys.len(),
            if study.storeys.len() == 1 { "" } else { "s" },
            number("objective"),
            100.0 * number("gap"),
            number("seconds"),
            number("first_feasible_seconds"),
        );
        println!("written to {}", job.out.display());
    }
    Ok(0)
}
