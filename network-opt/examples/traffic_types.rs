//! What types of traffic and placed sinks make of one mesh, the paper's figure
//! 2: to the boundary; from place to place inside; across; with sinks inside
//! given and placed, and with three sinks placed on the boundary.
//!
//! `cargo run --release -p network-opt --example traffic_types` prints what each
//! comes to, and writes `images/traffic_types.svg` into the crate.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Duration;

use network_opt::design::{
    distances, partition, verify, Across, Among, Feature, Inside, Network, Pairs, Parts, Place,
    Problem, Rim, RouteKind, Sinks, Specification, Tessellation, Traffic,
};
use network_opt::geo_types::polygon;
use network_opt::quad::{quads, QuadOptions};
use network_opt::solve::{Limits, NetworkSolver, Search};

const SIDE: f64 = 120.0;
const PANEL: f64 = 150.0;
/// Shades from near a sink to far from it, and of parts.
const SHADES: [&str; 5] = ["#1864ab", "#0b7285", "#2b8a3e", "#e67700", "#c92a2a"];
const TINTS: [&str; 6] = [
    "#fff3bf", "#d3f9d8", "#d0ebff", "#ffe3e3", "#e5dbff", "#ffe8cc",
];

fn scenarios() -> Vec<(&'static str, Specification)> {
    let quick = Specification {
        length: 0.2,
        travel: 1.0,
        ..Specification::default()
    };
    let inside = |missing| Inside {
        parts: Parts::Count(6),
        missing,
        ..Inside::default()
    };
    let joined = Traffic {
        inside: Some(inside(Feature::Forbidden)),
        ..Traffic::default()
    };
    let south_north = [[0.25, 0.25], [0.5, 0.5], [0.75, 0.75]];
    let through =
        south_north.map(|[a, b]| [Place::Share { u: a, v: 0.0 }, Place::Share { u: b, v: 1.0 }]);
    let across = Traffic {
        inside: Some(inside(Feature::Weighted(1.0))),
        across: Some(Across {
            pairs: Pairs::Between(through.to_vec()),
            missing: Feature::Weighted(2.0),
            ..Across::default()
        }),
        ..Traffic::default()
    };
    let placed = |count, among| Specification {
        sinks: Sinks::Placed { count, among },
        rim: Rim::Open,
        ..quick.clone()
    };
    vec![
        ("to the boundary", quick.clone()),
        (
            "and inside",
            Specification {
                traffic: joined.clone(),
                ..quick.clone()
            },
        ),
        (
            "mixed with routes across",
            Specification {
                traffic: across,
                ..quick.clone()
            },
        ),
        ("two sinks placed inside", placed(2, Among::Interior)),
        (
            "and inside",
            Specification {
                traffic: joined,
                ..placed(2, Among::Interior)
            },
        ),
        (
            "three sinks placed on the boundary",
            placed(3, Among::Boundary),
        ),
    ]
}

/// The two vertices that a path joins.
fn ends(problem: &Problem, path: &[usize]) -> Vec<usize> {
    let all: Vec<usize> = path.iter().flat_map(|&e| problem.ends[e]).collect();
    let once = all
        .iter()
        .filter(|v| all.iter().filter(|w| w == v).count() == 1);
    once.copied().collect()
}

fn draw(
    svg: &mut String,
    (name, mesh): (&str, &Tessellation),
    problem: &Problem,
    network: &Network,
    (left, top): (f64, f64),
) {
    let at = |v: usize| {
        let p = mesh.points()[v];
        (left + 15.0 + p.x, top + 135.0 - p.y)
    };
    let inside = problem.routes.iter().any(|r| r.kind == RouteKind::Inside);
    if let (true, Ok(parts)) = (inside, partition(mesh, 6, 0)) {
        for (face, part) in mesh.faces().iter().zip(parts) {
            let corners = face.iter().map(|&v| at(v));
            let corners: String = corners.map(|(x, y)| format!("{x:.1},{y:.1} ")).collect();
            let _ = writeln!(
                svg,
                "<polygon points=\"{}\" fill=\"{}\"/>",
                corners.trim_end(),
                TINTS[part]
            );
        }
    }
    let piece = |e: usize| {
        let [(x, y), (u, v)] = mesh.edges()[e].map(at);
        format!("M{x:.1} {y:.1}L{u:.1} {v:.1}")
    };
    let all: String = (0..mesh.edges().len()).map(piece).collect();
    let _ = writeln!(
        svg,
        "<path d=\"{all}\" stroke=\"#dee2e6\" stroke-width=\".4\"/>"
    );
    let mut line = |e: usize, colour: &str, pen: f64| {
        let _ = writeln!(
            svg,
            "<path d=\"{}\" stroke=\"{colour}\" stroke-width=\"{pen}\"/>",
            piece(e)
        );
    };
    let settled = problem.settled(&network.sinks);
    let away = distances(&settled, &network.active);
    for (e, [a, b]) in mesh.edges().iter().enumerate() {
        if network.active[e] && !problem.is_given(e) {
            let shade = (away[*a].min(away[*b]) / 2.0) as usize;
            line(e, SHADES[shade.min(4)], 2.2);
        } else if network.active[e] {
            line(e, "#212529", 1.6);
        }
    }
    let mut dot = |v: usize, size: f64, colour: &str| {
        let (x, y) = at(v);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size}\" fill=\"{colour}\" stroke=\"#212529\" stroke-width=\".4\"/>"
        );
    };
    for route in &problem.routes {
        let colour = match (route.kind, route.is_there(&network.active)) {
            (RouteKind::Across, true) => "#51cf66",
            (_, true) => "#ffd43b",
            (_, false) => "#868e96",
        };
        for v in route
            .paths
            .first()
            .map_or_else(Vec::new, |path| ends(problem, path))
        {
            dot(v, 2.4, colour);
        }
    }
    network.sinks.iter().for_each(|&v| dot(v, 3.0, "#fa5252"));
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"7\" font-family=\"sans-serif\" fill=\"#212529\">{name}</text>",
        left + 15.0,
        top + 11.0
    );
}

fn main() -> Result<(), Box<dyn Error>> {
    let site = polygon![(x: 0., y: 0.), (x: SIDE, y: 0.), (x: SIDE, y: SIDE), (x: 0., y: SIDE)];
    let mesh = quads(
        &site,
        &QuadOptions {
            edge_length: 10.0,
            ..QuadOptions::default()
        },
    )?;
    let limits = Limits {
        deadline: Some(Duration::from_secs(4)),
        ..Limits::default()
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" stroke-linecap=\"round\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        3.0 * PANEL,
        2.0 * PANEL
    );
    for (k, (name, spec)) in scenarios().iter().enumerate() {
        let problem = spec.on(&mesh)?;
        let found = Search::default().solve(&problem, None, &limits, &mut |_| true)?;
        let network = found.network.ok_or("no network in time")?;
        assert!(verify(&problem, &network).is_empty());
        let there = problem
            .routes
            .iter()
            .filter(|r| r.is_there(&network.active));
        println!(
            "{name}: {:.0} edges long, ways of {:.0}, {} of {} spans, objective {:.1}, first after {:.1} ms",
            found.cost.length,
            found.cost.travel,
            there.count(),
            problem.routes.len(),
            found.cost.objective,
            found.first_feasible.unwrap_or_default().as_secs_f64() * 1e3
        );
        let place = ((k % 3) as f64 * PANEL, (k / 3) as f64 * PANEL);
        draw(&mut svg, (name, &mesh), &problem, &network, place);
    }
    svg.push_str("</svg>\n");
    std::fs::write(
        concat!(env!("CARGO_MANIFEST_DIR"), "/images/traffic_types.svg"),
        svg,
    )?;
    Ok(())
}
