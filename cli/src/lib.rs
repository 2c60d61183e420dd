//! The command line of `overact`: arguments in, results out. What a command does is done by the
//! libraries below it, [`overact_robot`] first.
//!
//! One file per subcommand in `commands`. What they share:
//!
//! - [`failure`]: what went wrong, as text for people or as JSON for machines, with the exit code;
//! - `output`: results go to stdout or, whole or not at all, to a file;
//! - `progress`: long work shows a bar on a terminal and nothing in a pipe;
//! - [`drawing`]: a robot as SVG;
//! - `guarded`: a defect of the program is told as such;
//! - `effort`: how hard the generator searches;
//! - `functions`: which functions are generated;
//! - `names`: names of results in names of files;
//! - `note`: what a description says that may not be meant;
//! - `report`: an identification as a page, a document or a flat table;
//! - `states`: states of a robot from JSON or CSV.

mod commands;
pub mod drawing;
mod effort;
pub mod failure;
mod functions;
mod guarded;
mod names;
mod note;
mod output;
mod progress;
mod report;
mod states;

use clap::Parser;
use std::process::ExitCode;

/// Runs the command that the process was started with.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = match commands::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return misused(&error),
    };
    let json = arguments.json;
    match guarded::run(&arguments.command, json) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report(json);
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Help and the version go to stdout; what is wrong with the arguments is told as everything else is.
fn misused(error: &clap::Error) -> ExitCode {
    let wants_json = std::env::args_os().any(|argument| argument == "--json");
    if !(error.use_stderr() && wants_json) {
        error.exit();
    }
    let said = error.render().to_string();
    let message = said.strip_prefix("error: ").unwrap_or(&said).trim_end();
    let failure = failure::Failure::Usage(message.to_owned());
    failure.report(true);
    ExitCode::from(failure.exit_code())
}
