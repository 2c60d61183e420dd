//! The command line of `overact`, and [`InterpretedRobot`]: a robot's description served as
//! [`overact::Model`] without a compiler at hand.
//!
//! One file per subcommand in `commands`. What they share:
//!
//! - [`load`]: a description is read and compiled;
//! - [`failure`]: what went wrong, as text for people or as JSON for machines, with the exit code;
//! - `output`: results go to stdout or, whole or not at all, to a file;
//! - `progress`: long work shows a bar on a terminal and nothing in a pipe;
//! - [`drawing`]: a robot as SVG;
//! - `effort`: how hard the generator searches;
//! - `experiment`, `settings`: a description's tables as the inputs of simulation and
//!   identification;
//! - `report`: an identification as a page, a document or a flat table;
//! - `states`: states of a robot from JSON or CSV.

mod commands;
pub mod drawing;
mod effort;
mod experiment;
pub mod failure;
pub mod interpreted;
pub mod load;
mod output;
mod progress;
mod report;
mod settings;
mod states;

pub use interpreted::InterpretedRobot;

use clap::Parser;
use std::process::ExitCode;

/// Runs the command that the process was started with.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = commands::Arguments::parse();
    let json = arguments.json;
    match arguments.command.run(json) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report(json);
            ExitCode::from(failure.exit_code())
        }
    }
}
