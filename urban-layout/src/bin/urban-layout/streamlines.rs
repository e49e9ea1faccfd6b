//! `urban-layout streamlines`: evenly spaced lines of a field, drawn and judged.

use urban_layout::io::{self, svg::StreamlineSvgOptions};
use urban_layout::streamlines::StreamlineStudy;
use urban_layout::{Error, Result};

use crate::args::StreamlineJob;
use crate::field::warn;

pub(crate) fn run(job: &StreamlineJob) -> Result<u8> {
    let site = job.common.read(&job.site)?;
    warn(&site);
    let study = StreamlineStudy::new(&site, &job.options())?;
    let figures = study.to_json();
    let json = serde_json::to_string_pretty(&figures).map_err(|e| Error::stage("criteria", e))?;
    let options = StreamlineSvgOptions {
        paint: job.paint.into(),
        ..StreamlineSvgOptions::default()
    };
    let svg = io::svg::streamlines_svg(&study, &site, &options);
    let lines = io::streamlines_geojson::streamlines_to_geojson(&study, &site.frame);
    let mut files = vec![
        (job.out.join("streamlines.geojson"), lines.into_bytes()),
        (job.out.join("criteria.json"), (json + "\n").into_bytes()),
    ];
    if job.png {
        let picture = super::png(&svg, "streamlines.svg")?;
        files.push((job.out.join("streamlines.png"), picture));
    }
    files.push((job.out.join("streamlines.svg"), svg.into_bytes()));
    io::write::write_all_or_nothing(&files)?;
    if job.common.json {
        println!("{figures}");
    } else {
        let totals = &study.criteria.totals;
        println!(
            "{} lines, {:.1} km; {} tiles; mesh {:.3} s, field {:.3} s, lines {:.3} s, criteria {:.3} s",
            totals.lines,
            totals.length / 1e3,
            totals.tiles,
            study.field.mesh_seconds,
            study.field.field_seconds,
            study.placement_seconds,
            study.criteria_seconds,
        );
        print!("{}", study.criteria);
        println!("written to {}", job.out.display());
    }
    Ok(0)
}
