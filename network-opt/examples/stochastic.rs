//! The paper's comparison with a stochastic search (section 5.4, figure 12): the
//! same time for both on the specifications of figure 2.
//!
//! `cargo run --release -p network-opt --example stochastic -- [SECONDS] [SEEDS]`
//! prints a table: the best and the worst of the seeds, each with so many seconds
//! (5 and 3 if not given), and the best lower bound that the search proves.

use std::error::Error;
use std::time::Duration;

use network_opt::design::{Problem, Rim, Sinks, Specification, Tessellation};
use network_opt::geo_types::polygon;
use network_opt::quad::{quads, QuadOptions};
use network_opt::solve::{Limits, NetworkSolver, Outcome, Search, Stochastic};

/// Twelve by twelve squares: 312 edges, as in figure 2.
fn mesh() -> Result<Tessellation, Box<dyn Error>> {
    let site = polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 120., y: 120.), (x: 0., y: 120.)];
    let options = QuadOptions {
        edge_length: 10.0,
        ..QuadOptions::default()
    };
    Ok(quads(&site, &options)?)
}

/// The vertex nearest to a place.
fn at(mesh: &Tessellation, x: f64, y: f64) -> usize {
    let away = |v: &usize| (mesh.points()[*v].x - x).hypot(mesh.points()[*v].y - y);
    (0..mesh.points().len())
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .unwrap_or(0)
}

fn problems(mesh: &Tessellation) -> Result<Vec<(&'static str, Problem)>, Box<dyn Error>> {
    let short = Specification::default();
    let quick = Specification {
        length: 1e-4,
        travel: 1.0,
        ..short.clone()
    };
    let mixed = Specification {
        length: 5.0,
        travel: 1.0,
        ..short.clone()
    };
    let one = Specification {
        sinks: Sinks::At(vec![at(mesh, 60.0, 120.0)]),
        ..quick.clone()
    };
    let inside = [(40.0, 40.0), (80.0, 40.0), (40.0, 80.0), (80.0, 80.0)];
    let inside = Sinks::At(inside.map(|(x, y)| at(mesh, x, y)).to_vec());
    let rooms = Specification {
        sinks: inside.clone(),
        rim: Rim::Open,
        ..short.clone()
    };
    let lifts = Specification {
        sinks: inside,
        rim: Rim::Open,
        ..quick.clone()
    };
    let specs = [
        ("2a, length", short),
        ("2b, travel", quick),
        ("length and travel", mixed),
        ("2d, one sink", one),
        ("2e, sinks inside, length", rooms),
        ("2f, sinks inside, travel", lifts),
    ];
    let made = specs
        .into_iter()
        .map(|(name, spec)| Ok((name, spec.on(mesh)?)));
    made.collect()
}

/// Best and worst objective of some seeds, and the best bound.
fn solve(
    solver: &dyn NetworkSolver,
    problem: &Problem,
    seconds: f64,
    seeds: u64,
) -> Result<(String, f64), Box<dyn Error>> {
    let mut found: Vec<Outcome> = Vec::new();
    for seed in 0..seeds {
        let limits = Limits {
            deadline: Some(Duration::from_secs_f64(seconds)),
            seed,
            ..Limits::default()
        };
        found.push(solver.solve(problem, None, &limits, &mut |_| true)?);
    }
    let objective = |o: &Outcome| match o.network {
        Some(_) => o.cost.objective,
        None => f64::INFINITY,
    };
    let best = found.iter().map(objective).fold(f64::INFINITY, f64::min);
    let worst = found.iter().map(objective).fold(0.0, f64::max);
    let bound = found.iter().map(|o| o.bound).fold(0.0, f64::max);
    let word = |value: f64| {
        if value.is_finite() {
            format!("{value:.2}")
        } else {
            "none".to_owned()
        }
    };
    Ok((format!("{} / {}", word(best), word(worst)), bound))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let seconds: f64 = words.next().map_or(Ok(5.0), |word| word.parse())?;
    let seeds: u64 = words.next().map_or(Ok(3), |word| word.parse())?;
    let mesh = mesh()?;
    println!(
        "| figure | stochastic, best / worst | search, best / worst | bound |\n|---|---|---|---|"
    );
    for (name, problem) in problems(&mesh)? {
        let (theirs, _) = solve(&Stochastic::default(), &problem, seconds, seeds)?;
        let (ours, bound) = solve(&Search::default(), &problem, seconds, seeds)?;
        println!("| {name} | {theirs} | {ours} | {bound:.2} |");
    }
    Ok(())
}
