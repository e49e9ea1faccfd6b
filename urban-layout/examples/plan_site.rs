//! Lays out a site and writes the layout and its figures:
//! `cargo run --example plan_site -- SITE.geojson FOLDER [SEED]`.

use std::path::PathBuf;

use urban_layout::io::layout_geojson::layout_to_geojson;
use urban_layout::io::write::write_all_or_nothing;
use urban_layout::metrics::metrics;
use urban_layout::{generate, PlanOptions, Quiet, Site};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let (Some(path), Some(folder)) = (words.next(), words.next().map(PathBuf::from)) else {
        return Err("usage: plan_site SITE.geojson FOLDER [SEED]".into());
    };
    let seed = words.next().map_or(Ok(0), |s| s.parse())?;
    let site = Site::read(&path)?;
    let options = PlanOptions {
        seed,
        ..PlanOptions::default()
    };
    let plan = generate(&site, &options, &mut Quiet)?;
    let mut figures = metrics(&plan.layout, &site);
    figures.seconds = Some(plan.seconds.clone());
    write_all_or_nothing(&[
        (
            folder.join("layout.geojson"),
            layout_to_geojson(&plan.layout, &site.frame).into_bytes(),
        ),
        (
            folder.join("metrics.json"),
            figures.to_json().to_string().into_bytes(),
        ),
    ])?;
    println!("{} parcels on {:.2} km2", figures.parcels, figures.site_km2);
    Ok(())
}
