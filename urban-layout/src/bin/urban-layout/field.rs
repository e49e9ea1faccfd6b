//! `urban-layout field`: the cross field of a site, drawn and measured.

use urban_layout::field::FieldStudy;
use urban_layout::io;
use urban_layout::{Error, Result, Site};

use crate::args::FieldJob;

pub(crate) fn run(job: &FieldJob) -> Result<u8> {
    let site = job.common.read(&job.site)?;
    warn(&site);
    let study = FieldStudy::new(&site, &job.design.options())?;
    let figures = study.to_json(&site);
    let json = serde_json::to_string_pretty(&figures).map_err(|e| Error::stage("field", e))? + "\n";
    io::write::write_all_or_nothing(&[
        (
            job.out.join("field.svg"),
            io::svg::field_svg(&study, &site).into_bytes(),
        ),
        (job.out.join("field.json"), json.into_bytes()),
    ])?;
    if job.common.json {
        println!("{figures}");
    } else {
        let number = |key: &str| figures[key].as_i64().unwrap_or(0);
        let (sum, corners, euler) = (
            number("index_sum"),
            number("boundary_quarter_turns"),
            number("euler"),
        );
        // The law holds for fields that follow the boundary.
        let sign = if sum + corners == 4 * euler {
            "="
        } else {
            "!="
        };
        let aligned = if figures["aligned"] == true {
            ""
        } else {
            " (it does not follow the boundary everywhere)"
        };
        println!(
            "{} vertices; {} singularities, indices {sum} + {corners} at corners {sign} 4 x {euler}{aligned}; mean |div| {:.2e} per metre; mesh {:.3} s, field {:.3} s",
            figures["vertices"],
            study.singularities().len(),
            figures["mean_abs_divergence"].as_f64().unwrap_or(0.0),
            study.mesh_seconds,
            study.field_seconds,
        );
        println!("written to {}", job.out.display());
    }
    Ok(0)
}

/// Says on standard error what was mended in a site, and what a field over the
/// whole of it leaves out.
pub(crate) fn warn(site: &Site) {
    for warning in &site.warnings {
        eprintln!("warning: {warning}");
    }
    if !(site.roads.is_empty() && site.elements.is_empty()) {
        eprintln!("warning: given roads and key elements are not part of the field's domain");
    }
}
