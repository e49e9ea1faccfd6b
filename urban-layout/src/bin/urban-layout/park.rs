//! `urban-layout park`: a park from a grammar.

use std::collections::BTreeMap;

use park_grammar::DeriveOptions;
use urban_layout::io;
use urban_layout::park::{grammar, ParkStudy};
use urban_layout::{Error, Result};

use crate::args::ParkJob;
use crate::bar::Counter;

pub(crate) fn run(job: &ParkJob) -> Result<u8> {
    let site = job.common.read_park(&job.polygon)?;
    for warning in &site.warnings {
        eprintln!("warning: {warning}");
    }
    if !(site.roads.is_empty() && site.elements.is_empty()) {
        eprintln!("warning: given roads and key elements are no part of the park's design");
    }
    let grammar = grammar(&job.grammar)?;
    let options = DeriveOptions {
        seed: job.seed,
        params: params(&job.param)?,
        ..DeriveOptions::default()
    };
    let study = {
        let mut counter = Counter::new("planting");
        ParkStudy::new(&site, &grammar, &options, &mut |done| counter.report(done))?
    };
    for violation in study.violations() {
        eprintln!("warning: {violation}");
    }
    let figures = study.to_json();
    let svg = io::svg::park_svg(&study, &site);
    let plan = io::park_geojson::park_to_geojson(&study, &site.frame);
    let mut files = vec![(job.out.join("park.geojson"), plan.into_bytes())];
    if job.png {
        files.push((job.out.join("park.png"), super::png(&svg, "park.svg")?));
    }
    if job.gltf {
        let model = park_grammar::gltf::glb(&study.scene());
        files.push((job.out.join("park.glb"), model));
    }
    files.push((job.out.join("park.svg"), svg.into_bytes()));
    io::write::write_all_or_nothing(&files)?;
    if job.common.json {
        println!("{figures}");
    } else {
        let number = |key: &str| figures[key].as_f64().unwrap_or(0.0);
        println!(
            "{:.2} ha in {} pieces, {:.1} % of it paths; {} things, {} hedges and walls; {:.3} s",
            number("area_m2") / 1e4,
            figures["pieces"],
            100.0 * number("path_m2") / number("area_m2"),
            figures["objects"],
            figures["volumes"],
            study.seconds,
        );
        println!("written to {}", job.out.display());
    }
    Ok(0)
}

/// Values of parameters, each as `NAME=VALUE`.
fn params(words: &[String]) -> Result<BTreeMap<String, f64>> {
    let mut params = BTreeMap::new();
    for word in words {
        let bad = || Error::usage(format!("--param {word}: write NAME=VALUE with a number"));
        let (name, value) = word.split_once('=').ok_or_else(bad)?;
        let value: f64 = value.trim().parse().map_err(|_| bad())?;
        if !value.is_finite() {
            return Err(bad());
        }
        params.insert(name.trim().to_owned(), value);
    }
    Ok(params)
}
