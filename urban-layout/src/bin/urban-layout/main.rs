//! The command `urban-layout`: a site in, a plan out, and the judge of plans.

mod args;
mod bar;
mod check;
mod field;
mod floorplan;
mod generate;
mod network;
mod park;
mod streamlines;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Verb};

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(problem) => {
            // Help and version are no errors; anything else is usage.
            let code = if problem.use_stderr() { 2 } else { 0 };
            // If not even the terminal can be written to, nobody is there to be told.
            let _ = problem.print();
            return ExitCode::from(code);
        }
    };
    let done = match &arguments.verb {
        Verb::Generate(job) => generate::run(job),
        Verb::Check(job) => check::run(job),
        Verb::Field(job) => field::run(job),
        Verb::Streamlines(job) => streamlines::run(job),
        Verb::Network(job) => network::run(job),
        Verb::Floorplan(job) => floorplan::run(job),
        Verb::Park(job) => park::run(job),
    };
    match done {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("urban-layout: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// A picture as PNG, for `--png`.
#[cfg(feature = "png")]
fn png(svg: &str, _: &str) -> urban_layout::Result<Vec<u8>> {
    urban_layout::io::png::png(svg, 2000)
}

/// Says that there is no such picture, and which file has it as SVG.
#[cfg(not(feature = "png"))]
fn png(_: &str, name: &str) -> urban_layout::Result<Vec<u8>> {
    Err(urban_layout::Error::usage(format!(
        "--png: this build has no `png` feature; rebuild with it or convert {name}"
    )))
}
