//! The networks of the paper's figures 2 and 5 to 8, designed on the shipped
//! sites from the specifications beside this file.
//!
//! `cargo run --release -p urban-layout --example network_figures -- SITES OUT
//! [SECONDS] [FIGURE...]` reads the sites of a folder, writes a picture of each
//! figure and `figures.md`, the table of the guide's page on them. The time,
//! 30 s if not given, is divided among the levels of a figure. A specification
//! does as well for the command: `urban-layout network SITE --spec 2a.toml`.

mod figures;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use figures::{Figure, FIGURES};
use network_opt::formulate::{Formulated, Formulation};
use network_opt::solve::{Ended, Limits};
use urban_layout::design::{NetworkSpec, NetworkStudy};
use urban_layout::io::svg::network_svg;
use urban_layout::{Error, Result, Site};

const HEAD: &str = "\
| figure | what is asked | site | edges (paper) | variables (paper) | valid | first network after s | objective by level | gap % | found after s | paper's s |
|---|---|---|---|---|---|---|---|---|---|---|
";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (Some(sites), Some(out)) = (words.first(), words.get(1)) else {
        eprintln!("usage: network_figures SITES OUT [SECONDS] [FIGURE...]");
        return ExitCode::from(2);
    };
    let seconds = words.get(2).and_then(|w| w.parse().ok()).unwrap_or(30.0);
    match run(
        Path::new(sites),
        Path::new(out),
        seconds,
        words.get(3..).unwrap_or(&[]),
    ) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(sites: &Path, out: &Path, seconds: f64, only: &[String]) -> Result<()> {
    let io = |e: std::io::Error| Error::input(format!("{}: {e}", out.display()));
    std::fs::create_dir_all(out).map_err(io)?;
    let mut table = HEAD.to_owned();
    for figure in FIGURES {
        if !only.is_empty() && !only.iter().any(|name| name == figure.name) {
            continue;
        }
        let site = Site::read(sites.join(figure.site).with_extension("geojson"))?;
        let row = design(figure, &site, seconds, |svg| {
            std::fs::write(out.join(format!("figure_{}.svg", figure.name)), svg).map_err(io)
        })?;
        print!("{row}");
        table += &row;
    }
    std::fs::write(out.join("figures.md"), table).map_err(io)
}

/// Designs a figure's network, hands its picture over, and gives its row.
fn design(
    figure: &Figure,
    site: &Site,
    seconds: f64,
    draw: impl Fn(String) -> Result<()>,
) -> Result<String> {
    let spec = NetworkSpec::from_toml(figure.spec)?;
    let limits = Limits {
        deadline: Some(Duration::from_secs_f64(seconds)),
        ..Limits::default()
    };
    // When the search came upon what it had in the end.
    let mut improvements = Vec::new();
    let study = NetworkStudy::new(site, &spec, &limits, &mut |progress| {
        if progress.improved {
            improvements.push(progress.elapsed.as_secs_f64());
        }
        true
    })?;
    draw(network_svg(&study, site))?;
    let levels: Vec<_> = study.parts.iter().flat_map(|part| &part.levels).collect();
    let first = levels
        .first()
        .ok_or_else(|| Error::input("the site has no region"))?;
    let variables = Formulated::new(&first.problem, Formulation::Paper, None)
        .map(|paper| paper.program().columns().len().to_string())
        .unwrap_or_else(|_| "-".to_owned());
    let mut begun = 0.0;
    let (mut objectives, mut gaps, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for level in &levels {
        let outcome = &level.outcome;
        let end = begun + outcome.elapsed.as_secs_f64();
        let last = improvements.iter().filter(|&&t| t >= begun && t <= end);
        found.push(format!("{:.1}", last.fold(begun, |_, &t| t) - begun));
        begun = end;
        let objective = outcome.cost.objective;
        objectives.push(format!("{objective:.1}"));
        gaps.push(if outcome.ended == Ended::Proven {
            "0".to_owned()
        } else {
            format!("{:.0}", 100.0 * (objective - outcome.bound) / objective)
        });
    }
    let mut row = String::new();
    let _ = writeln!(
        row,
        "| {} | {} | {} | {} ({}) | {variables} ({}) | {} | {:.3} | {} | {} | {} | {} |",
        figure.name,
        figure.asks,
        figure.site.trim_start_matches("kotka_"),
        first.problem.edges(),
        figure.edges,
        figure.variables,
        if study.is_valid() { "yes" } else { "NO" },
        first
            .outcome
            .first_feasible
            .map_or(f64::NAN, |t| t.as_secs_f64()),
        objectives.join(" / "),
        gaps.join(" / "),
        found.join(" / "),
        figure.seconds,
    );
    Ok(row)
}
