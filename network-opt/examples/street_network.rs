//! A street network for a site, from a specification alone: the site is cut
//! into quads, the search chooses edges, and snakes make streets of them.
//!
//! `cargo run --release -p network-opt --example street_network` prints what
//! each specification comes to, and writes `images/street_network.svg` into the
//! crate.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Duration;

use network_opt::design::{distances, verify, Coverage, Problem, Specification, Tessellation};
use network_opt::geo_types::{Coord, LineString, Polygon};
use network_opt::quad::{quads, QuadOptions, QuadQuality};
use network_opt::snake::{smooth, SmoothNetwork, SnakeOptions};
use network_opt::solve::{Limits, NetworkSolver, Search};

/// Between two roads, a river and older houses; metres.
fn site() -> Polygon<f64> {
    let bank = (0..=12).map(|k| {
        let t = f64::from(k) / 12.0;
        (
            40.0 + 760.0 * t,
            40.0 + 55.0 * (std::f64::consts::TAU * t).sin(),
        )
    });
    let rest = [
        (860.0, 420.0),
        (620.0, 470.0),
        (600.0, 380.0),
        (430.0, 400.0),
        (400.0, 560.0),
        (30.0, 520.0),
    ];
    let ring: Vec<(f64, f64)> = bank.chain(rest).collect();
    Polygon::new(ring.into(), vec![])
}

/// Shades from near a sink to far from it.
const SHADES: [&str; 5] = ["#1864ab", "#0b7285", "#2b8a3e", "#e67700", "#c92a2a"];
const WIDE: f64 = 900.0;
const HIGH: f64 = 620.0;

fn path(points: &[Coord<f64>], left: f64, top: f64) -> String {
    let mut data = String::new();
    for (k, p) in points.iter().enumerate() {
        let letter = if k == 0 { 'M' } else { 'L' };
        let _ = write!(
            data,
            "{letter}{:.0} {:.0}",
            left + p.x,
            top + HIGH - 20.0 - p.y
        );
    }
    data
}

fn stroke(svg: &mut String, data: &str, colour: &str, pen: f64) {
    let _ = writeln!(
        svg,
        "<path d=\"{data}\" stroke=\"{colour}\" stroke-width=\"{pen}\"/>"
    );
}

/// The mesh, and on it the edges by the way from their nearer ends to a sink.
fn draw_edges(
    svg: &mut String,
    mesh: &Tessellation,
    problem: &Problem,
    active: &[bool],
    at: (f64, f64),
) {
    let line = |e: usize| path(&mesh.edges()[e].map(|v| mesh.points()[v]), at.0, at.1);
    let all: String = (0..mesh.edges().len()).map(line).collect();
    stroke(svg, &all, "#dee2e6", 1.0);
    let away = distances(problem, active);
    let nearer = |e: usize| {
        mesh.edges()[e]
            .map(|v| away[v])
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    let far = (0..active.len())
        .filter(|&e| active[e])
        .map(nearer)
        .fold(1.0, f64::max);
    for (k, colour) in SHADES.iter().enumerate() {
        let shade = |e: &usize| ((nearer(*e) / far * 5.0) as usize).min(4) == k;
        let chosen = (0..active.len()).filter(|&e| active[e] && !problem.is_given(e));
        stroke(
            svg,
            &chosen.filter(shade).map(line).collect::<String>(),
            colour,
            5.0,
        );
    }
    let given: String = (0..active.len())
        .filter(|&e| problem.is_given(e))
        .map(line)
        .collect();
    stroke(svg, &given, "#212529", 4.0);
}

fn draw_streets(svg: &mut String, site: &Polygon<f64>, streets: &SmoothNetwork, at: (f64, f64)) {
    let lines: String = streets
        .streets
        .iter()
        .map(|(_, line)| path(&line.0, at.0, at.1))
        .collect();
    stroke(svg, &lines, "#adb5bd", 14.0);
    stroke(svg, &lines, "#fff", 9.0);
    let rim: &LineString<f64> = site.exterior();
    stroke(svg, &path(&rim.0, at.0, at.1), "#212529", 4.0);
}

fn main() -> Result<(), Box<dyn Error>> {
    let site = site();
    let mesh = quads(
        &site,
        &QuadOptions {
            edge_length: 36.0,
            ..QuadOptions::default()
        },
    )?;
    println!("{}", QuadQuality::of(&mesh));
    let short = Specification {
        coverage: Coverage::Metres(80.0),
        ..Specification::default()
    };
    let quick = Specification {
        length: 1.0,
        travel: 1.0,
        ..short.clone()
    };
    let limits = Limits {
        deadline: Some(Duration::from_secs(3)),
        ..Limits::default()
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" fill=\"none\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        2.0 * WIDE,
        2.0 * HIGH
    );
    for (row, (name, spec)) in [("short", short), ("quick", quick)].iter().enumerate() {
        let problem = spec.on(&mesh)?;
        let found = Search::default().solve(&problem, None, &limits, &mut |_| true)?;
        let network = found.network.ok_or("no network in time")?;
        assert!(verify(&problem, &network).is_empty());
        let given: Vec<bool> = (0..mesh.edges().len())
            .map(|e| problem.is_given(e))
            .collect();
        let streets = smooth(&mesh, &network.active, &given, &SnakeOptions::default())?;
        println!(
            "{name}: {:.1} edges long, ways of {:.1}, objective {:.2} (at least {:.2}), first after {:.1} ms",
            found.cost.length,
            found.cost.travel,
            found.cost.objective,
            found.bound,
            found.first_feasible.unwrap_or_default().as_secs_f64() * 1e3
        );
        let top = row as f64 * HIGH;
        draw_edges(&mut svg, &mesh, &problem, &network.active, (0.0, top));
        draw_streets(&mut svg, &site, &streets, (WIDE, top));
    }
    svg.push_str("</svg>\n");
    std::fs::write(
        concat!(env!("CARGO_MANIFEST_DIR"), "/images/street_network.svg"),
        svg,
    )?;
    Ok(())
}
