//! The command `urban-layout`: a site in, a plan out, and the judge of plans.

mod args;
mod bar;
mod check;
mod field;
mod generate;

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
    };
    match done {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("urban-layout: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
