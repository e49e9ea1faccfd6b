//! Solves an instance of network design and prints what it found, as JSON.
//!
//! ```sh
//! cargo run --release -p network-opt --features highs --example solve_instance -- \
//!     INSTANCE.json --deadline 30 --threads 2
//! ```
//!
//! Prints one object: `objective bound length distance seconds
//! processor_seconds first_feasible_seconds active_edges[[i, j]] rooms`, the last with the type
//! and faces of each room. Numbers are null where nothing was found. Progress
//! goes to the standard error with `--verbose`. `--cpu` ends the run after so
//! much processor time, for machines that are busy with other work.

use std::error::Error;
use std::process::ExitCode;
use std::time::Duration;

use network_opt::design::{verify, Network, Problem};
use network_opt::formulate::Formulation;
use network_opt::mip::MipSolver;
use network_opt::solve::{Exact, Limits, NetworkSolver, Outcome, Progress, Search};
use serde_json::{json, Value};

mod instance;

const USAGE: &str = "solve_instance INSTANCE.json [--deadline SECONDS] [--threads N] [--gap PART] \
    [--seed N] [--solver highs|windows|rust|microlp] [--formulation recommended|flow|travel|single|paper] [--window EDGES] \
    [--cpu SECONDS] [--verbose]";

struct Arguments {
    path: String,
    limits: Limits,
    solver: Solver,
    formulation: Formulation,
    window: usize,
    cpu: f64,
    verbose: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Solver {
    Highs,
    Windows,
    Rust,
    Microlp,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments = parse(std::env::args().skip(1))?;
    let text = std::fs::read_to_string(&arguments.path)
        .map_err(|error| format!("{}: {error}", arguments.path))?;
    let instance: instance::Instance = serde_json::from_str(&text)?;
    let problem = instance.problem()?;
    let verbose = arguments.verbose;
    let mut told = Duration::ZERO;
    let mut watch = |progress: &Progress<'_>| {
        if verbose && (progress.improved || progress.elapsed > told + Duration::from_secs(5)) {
            told = progress.elapsed;
            let best = progress
                .best
                .map_or(f64::INFINITY, |(_, cost)| cost.objective);
            let seconds = progress.elapsed.as_secs_f64();
            eprintln!(
                "{seconds:8.2} s  best {best:.3}  bound {:.3}",
                progress.bound
            );
        }
        processor_seconds().is_none_or(|spent| spent < arguments.cpu)
    };
    let outcome = match arguments.solver {
        Solver::Rust => Search::default().solve(&problem, None, &arguments.limits, &mut watch)?,
        Solver::Microlp => exact(network_opt::mip::Microlp, &arguments).solve(
            &problem,
            None,
            &arguments.limits,
            &mut watch,
        )?,
        Solver::Highs | Solver::Windows => with_highs(&problem, &arguments, &mut watch)?,
    };
    println!("{}", report(&problem, &outcome)?);
    Ok(())
}

/// Processor time of all threads so far, where the system tells it as Linux
/// does: in hundredths of a second, the 14th and 15th word of a file, counted
/// from the name in brackets, the second.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, words) = stat.rsplit_once(')')?;
    let ticks = words.split_whitespace().skip(11).take(2);
    let ticks: Option<Vec<f64>> = ticks.map(|word| word.parse().ok()).collect();
    Some(ticks?.iter().sum::<f64>() / 100.0)
}

fn exact<M: MipSolver>(solver: M, arguments: &Arguments) -> Exact<M> {
    Exact {
        formulation: arguments.formulation,
        ..Exact::new(solver)
    }
}

#[cfg(feature = "highs")]
fn with_highs(
    problem: &Problem,
    arguments: &Arguments,
    watch: &mut dyn FnMut(&Progress<'_>) -> bool,
) -> Result<Outcome, Box<dyn Error>> {
    let (highs, limits) = (network_opt::mip::Highs, &arguments.limits);
    Ok(if arguments.solver == Solver::Windows {
        let windows = network_opt::solve::Windows {
            size: arguments.window,
            formulation: arguments.formulation,
            ..network_opt::solve::Windows::new(highs)
        };
        network_opt::solve::Started::new(windows).solve(problem, None, limits, watch)?
    } else {
        let race = network_opt::solve::Race {
            exact: exact(highs, arguments),
            ..network_opt::solve::Race::new(highs)
        };
        network_opt::solve::Started::new(race).solve(problem, None, limits, watch)?
    })
}

#[cfg(not(feature = "highs"))]
fn with_highs(
    _: &Problem,
    _: &Arguments,
    _: &mut dyn FnMut(&Progress<'_>) -> bool,
) -> Result<Outcome, Box<dyn Error>> {
    Err("this was built without HiGHS; build with --features highs, or give --solver rust".into())
}

fn report(problem: &Problem, outcome: &Outcome) -> Result<Value, Box<dyn Error>> {
    let empty = Network::default();
    let found = outcome.network.as_ref();
    if let Some(violation) = found.and_then(|n| verify(problem, n).into_iter().next()) {
        return Err(format!("the network is not valid: {violation}").into());
    }
    let network = found.unwrap_or(&empty);
    let number = |value: f64| found.map(|_| value);
    let active = network.active.iter().enumerate().filter(|(_, &on)| on);
    let edges: Vec<[usize; 2]> = active.map(|(e, _)| problem.ends[e]).collect();
    let rooms = problem.rooms.as_ref().map_or(&[][..], |r| &r.placements);
    let rooms = network.rooms.iter().map(|&k| {
        let placement = &rooms[k];
        json!({ "type": placement.template, "faces": placement.faces })
    });
    Ok(json!({
        "objective": number(outcome.cost.objective),
        "bound": outcome.bound.is_finite().then_some(outcome.bound),
        "length": number(outcome.cost.length),
        "distance": number(outcome.cost.travel),
        "seconds": outcome.elapsed.as_secs_f64(),
        "processor_seconds": processor_seconds(),
        "first_feasible_seconds": outcome.first_feasible.map(|t| t.as_secs_f64()),
        "active_edges": edges,
        "rooms": rooms.collect::<Vec<_>>(),
    }))
}

fn parse(mut given: impl Iterator<Item = String>) -> Result<Arguments, Box<dyn Error>> {
    let mut path = None;
    let mut arguments = Arguments {
        path: String::new(),
        limits: Limits::default(),
        solver: if cfg!(feature = "highs") {
            Solver::Highs
        } else {
            Solver::Rust
        },
        formulation: Formulation::Recommended,
        window: 90,
        cpu: f64::INFINITY,
        verbose: false,
    };
    while let Some(argument) = given.next() {
        let mut value = || {
            given
                .next()
                .ok_or_else(|| format!("{argument} takes a value\n{USAGE}"))
        };
        match argument.as_str() {
            "--deadline" => {
                let seconds = Duration::try_from_secs_f64(value()?.parse()?)?;
                arguments.limits.deadline = Some(seconds);
            }
            "--threads" => arguments.limits.threads = value()?.parse()?,
            "--gap" => arguments.limits.gap = value()?.parse()?,
            "--seed" => arguments.limits.seed = value()?.parse()?,
            "--window" => arguments.window = value()?.parse()?,
            "--cpu" => arguments.cpu = value()?.parse()?,
            "--verbose" => arguments.verbose = true,
            "--solver" => {
                arguments.solver = match value()?.as_str() {
                    "highs" => Solver::Highs,
                    "windows" => Solver::Windows,
                    "rust" => Solver::Rust,
                    "microlp" => Solver::Microlp,
                    other => return Err(format!("no solver {other}\n{USAGE}").into()),
                }
            }
            "--formulation" => {
                arguments.formulation = match value()?.as_str() {
                    "recommended" => Formulation::Recommended,
                    "flow" => Formulation::Flow,
                    "travel" => Formulation::TravelFlow,
                    "single" => Formulation::SingleSink,
                    "paper" => Formulation::Paper,
                    other => return Err(format!("no formulation {other}\n{USAGE}").into()),
                }
            }
            other if other.starts_with('-') || path.is_some() => {
                return Err(format!("what is {other}?\n{USAGE}").into());
            }
            _ => path = Some(argument),
        }
    }
    arguments.path = path.ok_or(USAGE)?;
    Ok(arguments)
}
