//! UrbanFab's comparison (figures 5 to 9) on sites of one's own: six fields,
//! six criteria, and the paper's findings measured.
//!
//! `cargo run --release -p urban-layout --example urbanfab_comparison -- SITE.geojson... --out DIR [--rounds N]`
//!
//! Writes `DIR/SITE/FIELD-CRITERION.svg`, one picture for each; for each site
//! `DIR/SITE-CRITERION.svg` with the fields side by side; and `DIR/urbanfab.md`
//! with the tables and the findings.

mod cases;
mod findings;
mod page;
mod sheet;

use std::path::{Path, PathBuf};

use urban_layout::io::svg::{streamlines_svg, Paint, StreamlineSvgOptions};
use urban_layout::io::write::write_all_or_nothing;
use urban_layout::Site;

use cases::{Case, Setting, DESIGNS};
use findings::Compared;
use streamline::Criterion;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const USAGE: &str = "usage: urbanfab_comparison SITE.geojson... --out DIR [--rounds N]";

fn main() -> Fallible<()> {
    let mut sites = Vec::new();
    let mut out = None;
    let mut setting = Setting::default();
    let mut words = std::env::args_os().skip(1);
    while let Some(word) = words.next() {
        match word.to_str() {
            Some("--out") => out = words.next().map(PathBuf::from),
            Some("--rounds") => {
                let rounds = words.next().and_then(|w| w.to_str()?.parse().ok());
                setting.rounds = rounds.ok_or(USAGE)?;
            }
            _ => sites.push(PathBuf::from(word)),
        }
    }
    let (Some(out), false) = (out, sites.is_empty()) else {
        return Err(USAGE.into());
    };
    let mut files = Vec::new();
    let mut compared = Vec::new();
    let mut text = page::opening(&setting);
    for path in &sites {
        let site = Site::read(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        println!("{name}");
        let cases = cases::study(&site, &setting, &DESIGNS)?;
        let rows: Vec<_> = cases.iter().map(Case::figures).collect();
        if let Some(all) = Compared::new(&rows) {
            compared.push((name.to_string(), all));
        }
        let part = page::of_site(&name, &site, &setting, &cases, &rows);
        println!("{part}");
        text.push_str(&part);
        files.extend(pictures(&name, &site, &cases, &out));
    }
    let found = page::of_findings(&compared);
    println!("{found}");
    text.push_str(&found);
    files.push((out.join("urbanfab.md"), text.into_bytes()));
    write_all_or_nothing(&files)?;
    println!("{} files in {}", files.len(), out.display());
    Ok(())
}

/// One picture for each field and criterion, and one for each criterion.
fn pictures(name: &str, site: &Site, cases: &[Case], out: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for criterion in Criterion::ALL {
        let mut row = Vec::new();
        for case in cases {
            let Some(measured) = &case.measured else {
                continue;
            };
            let options = StreamlineSvgOptions {
                paint: Paint::Criterion(criterion),
                title: Some(case.design.name.to_owned()),
                ..StreamlineSvgOptions::default()
            };
            let svg = streamlines_svg(&measured.study, site, &options);
            let file = format!("{}-{}.svg", case.design.key, criterion.name());
            files.push((out.join(name).join(file), svg.into_bytes()));
            // Side by side they are small, and may be coarser.
            let small = StreamlineSvgOptions {
                long_side_mm: 60.0,
                tolerance_mm: 0.15,
                ..options
            };
            row.push(streamlines_svg(&measured.study, site, &small));
        }
        let file = format!("{name}-{}.svg", criterion.name());
        files.push((out.join(file), sheet::beside(&row).into_bytes()));
    }
    files
}
