//! `urban-layout check`: the certificate of a layout.

use urban_layout::check::{check, read_layout, CheckOptions};
use urban_layout::{Error, Result};

use crate::args::Check;

pub(crate) fn run(job: &Check) -> Result<u8> {
    let site = job.common.read(&job.site)?;
    let text = std::fs::read_to_string(&job.layout).map_err(|e| Error::reading(&job.layout, e))?;
    let layout = read_layout(&text, &site.frame)?;
    if layout.tiles.is_empty() {
        return Err(Error::input(format!(
            "{} holds no tile of a layout (parcel, street_area, ...); give the layout.geojson that `generate` writes",
            job.layout.display()
        )));
    }
    let certificate = check(
        &site,
        &layout,
        &CheckOptions {
            frontage: job.frontage,
            ..CheckOptions::default()
        },
    );
    if job.common.json {
        println!("{}", certificate.to_json());
    } else {
        for law in &certificate.laws {
            let word = if law.passed { "ok    " } else { "FAILED" };
            println!(
                "{word} {:<24} {:.3} (allowed {:.3})",
                law.law, law.measured, law.allowed
            );
            for line in &law.detail {
                println!("         {line}");
            }
        }
    }
    Ok(if certificate.is_ok() { 0 } else { 3 })
}
