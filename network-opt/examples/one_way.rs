//! One site, three networks: streets with traffic both ways, the same with
//! every new street one-way, and one-way streets within a ring road that is
//! one-way too and twice as fast. The program chooses which way each runs.
//!
//! `cargo run --release -p network-opt --example one_way` prints what each
//! comes to, and writes `images/one_way.svg` into the crate.

use std::error::Error;
use std::fmt::Write as _;
use std::time::Duration;

use network_opt::design::{
    distances, distances_from, verify, Coverage, Network, OneWay, Problem, Sinks, Specification,
    Streets, Tessellation, Way,
};
use network_opt::geo_types::{Coord, Polygon};
use network_opt::quad::{quads, QuadOptions};
use network_opt::solve::{Limits, NetworkSolver, Outcome, Search};

/// A district of 700 by 560 m with a cut corner; metres.
fn site() -> Polygon<f64> {
    let ring = [
        (0.0, 0.0),
        (700.0, 0.0),
        (700.0, 420.0),
        (560.0, 560.0),
        (0.0, 560.0),
    ];
    Polygon::new(ring.to_vec().into(), vec![])
}

/// Shades from near a sink to far from it.
const SHADES: [&str; 5] = ["#1864ab", "#0b7285", "#2b8a3e", "#e67700", "#c92a2a"];
const WIDE: f64 = 760.0;
const HIGH: f64 = 640.0;

/// The ways of an edge out and in, their mean.
fn travel(problem: &Problem, network: &Network) -> Vec<f64> {
    let (to, from) = (
        distances(problem, network),
        distances_from(problem, network),
    );
    let streets = Streets::from(network);
    let ends = problem.ends.iter().enumerate();
    ends.map(|(e, &[a, b])| match streets.way(problem, e) {
        Way::Forward => (to[b] + from[a]) / 2.0,
        Way::Backward => (to[a] + from[b]) / 2.0,
        _ => (to[a].min(to[b]) + from[a].min(from[b])) / 2.0,
    })
    .collect()
}

fn draw(svg: &mut String, mesh: &Tessellation, problem: &Problem, network: &Network, left: f64) {
    let place = |p: Coord<f64>| (left + 30.0 + p.x, HIGH - 50.0 - p.y);
    let line = |e: usize| {
        let [(x, y), (u, v)] = mesh.edges()[e].map(|v| place(mesh.points()[v]));
        format!("M{x:.1} {y:.1}L{u:.1} {v:.1}")
    };
    let mut stroke = |data: &str, colour: &str, pen: f64| {
        let _ = writeln!(
            svg,
            "<path d=\"{data}\" stroke=\"{colour}\" stroke-width=\"{pen}\"/>"
        );
    };
    let edges = 0..mesh.edges().len();
    let of = |keep: &dyn Fn(usize) -> bool| -> String {
        edges.clone().filter(|&e| keep(e)).map(line).collect()
    };
    stroke(&of(&|_| true), "#e9ecef", 1.0);
    stroke(&of(&|e| problem.is_given(e)), "#495057", 9.0);
    let travel = travel(problem, network);
    let own = |e: usize| network.active[e] && !problem.is_given(e);
    let far = edges
        .clone()
        .filter(|&e| own(e))
        .map(|e| travel[e])
        .fold(1.0, f64::max);
    for (k, colour) in SHADES.iter().enumerate() {
        let shade = |e: usize| own(e) && ((travel[e] / far * 5.0) as usize).min(4) == k;
        stroke(&of(&shade), colour, 7.0);
    }
    // An arrow on each one-way street.
    let streets = Streets::from(network);
    for e in edges.clone().filter(|&e| network.active[e]) {
        let [(x, y), (u, v)] = mesh.edges()[e].map(|v| place(mesh.points()[v]));
        let turn = match streets.way(problem, e) {
            Way::Forward => (v - y).atan2(u - x),
            Way::Backward => (y - v).atan2(x - u),
            _ => continue,
        };
        let _ = writeln!(
            svg,
            "<path d=\"M-8 -8L10 0L-8 8Z\" fill=\"#212529\" stroke=\"#fff\" stroke-width=\"2.5\" \
             transform=\"translate({:.1} {:.1}) rotate({:.1})\"/>",
            (x + u) / 2.0,
            (y + v) / 2.0,
            turn.to_degrees()
        );
    }
    for v in (0..problem.vertices).filter(|&v| problem.sinks[v]) {
        let (x, y) = place(mesh.points()[v]);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{}\" fill=\"#fff\" stroke=\"#212529\" stroke-width=\"4\"/>",
            if problem.sinks.iter().filter(|&&s| s).count() > 8 { 4 } else { 11 }
        );
    }
}

fn solve(name: &str, problem: &Problem) -> Result<Outcome, Box<dyn Error>> {
    let limits = Limits {
        deadline: Some(Duration::from_secs(5)),
        ..Limits::default()
    };
    let found = Search::default().solve(problem, None, &limits, &mut |_| true)?;
    let network = found.network.as_ref().ok_or("no network in time")?;
    assert_eq!(verify(problem, network), []);
    println!(
        "{name}: {} streets' edges, length {:.1}, travel {:.1}, objective {:.2}, no less than {:.2}",
        network.active.iter().filter(|&&on| on).count(),
        found.cost.length,
        found.cost.travel,
        found.cost.objective,
        found.bound,
    );
    Ok(found)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = quads(
        &site(),
        &QuadOptions {
            edge_length: 50.0,
            ..QuadOptions::default()
        },
    )?;
    let nearest = |x: f64, y: f64| {
        let off = |v: &usize| (mesh.points()[*v].x - x).hypot(mesh.points()[*v].y - y);
        (0..mesh.points().len()).min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    // Two exits, on the west and in the south east.
    let exits: Vec<usize> = [nearest(0.0, 280.0), nearest(700.0, 0.0)]
        .into_iter()
        .flatten()
        .collect();
    let both = Specification {
        coverage: Coverage::Hops(1),
        travel: 0.1,
        sinks: Sinks::At(exits),
        ..Specification::default()
    };
    let new = Specification {
        one_way: OneWay::New,
        ..both.clone()
    };
    let all = Specification {
        one_way: OneWay::All,
        ..both.clone()
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {HIGH}\" width=\"1140\" fill=\"none\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\" font-family=\"sans-serif\" font-size=\"24\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        3.0 * WIDE
    );
    let cases = [
        ("two-way", both, false),
        ("new streets one-way", new, false),
        ("all one-way, fast ring", all, true),
    ];
    for (k, (name, specification, fast)) in cases.iter().enumerate() {
        let mut problem = specification.on(&mesh)?;
        if *fast {
            let half = |e: usize| problem.lengths[e] / if problem.is_given(e) { 2.0 } else { 1.0 };
            problem.travel_costs = (0..problem.edges()).map(half).collect();
        }
        let found = solve(name, &problem)?;
        let left = WIDE * k as f64;
        if let Some(network) = &found.network {
            draw(&mut svg, &mesh, &problem, network, left);
        }
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" fill=\"#212529\">{name}: length {:.0}, travel {:.0}</text>",
            left + 30.0,
            HIGH - 10.0,
            found.cost.length,
            found.cost.travel
        );
    }
    svg.push_str("</svg>\n");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/images/one_way.svg");
    std::fs::write(path, svg)?;
    Ok(())
}
