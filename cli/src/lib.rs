//! Command line of `overact`: parses arguments, calls the libraries and writes results.
//!
//! ```
//! // `overact explain OA102`; the value is the exit code.
//! let arguments = ["overact", "explain", "OA102"];
//! assert_eq!(overact_cli::run_with(arguments.map(Into::into).to_vec()), 0);
//! ```
//!
//! Use the command itself first: `overact --help` lists its subcommands. Programs in Rust call
//! [`overact_robot`] instead of this crate.
//!
//! Most of the work is done by [`overact_robot`]. There is one file per subcommand in `commands`.
//! They share:
//!
//! - [`failure`]: failures as text or JSON, with exit codes;
//! - `output`: results to stdout or, completely or not at all, to files;
//! - `progress`: progress bars on a terminal;
//! - `guarded`: panics as internal errors;
//! - `effort`: effort of the generator's search;
//! - `forms`: forms of a function;
//! - `functions`: selection of generated functions;
//! - `input`: descriptions with a progress bar, standard input;
//! - `names`: names of results as file names;
//! - `note`: notes on unintended contents of a description;
//! - [`report`]: an identification as a page, JSON or a flat table;
//! - `signals`: removal of temporary files if a signal ends the process;
//! - `states`: states of a robot from JSON or CSV;
//! - `stopwatch`: times of the stages of a command.

mod commands;
mod effort;
pub mod failure;
mod function_options;
mod functions;
mod guarded;
mod input;
mod measurements;
mod names;
mod note;
mod output;
mod progress;
pub mod report;
mod signals;
mod states;
mod stopwatch;

use clap::{Parser, error::ErrorKind};
use overact_codegen::diagnostic::Code;
use std::{
    ffi::OsString,
    io::{self, IsTerminal, Write},
    process::ExitCode,
};

/// Without a command, the help is printed.
const NO_COMMAND: ErrorKind = ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;

/// Runs the command that the process was started with.
#[must_use]
pub fn run() -> ExitCode {
    signals::watch();
    // Let the waiting thread take part in parallel work; otherwise each task wakes another thread.
    // An existing pool is kept.
    let pool = rayon::ThreadPoolBuilder::new().use_current_thread();
    let _ = pool.build_global();
    ExitCode::from(run_with(std::env::args_os().collect()))
}

/// Runs the command of these arguments, the first of which is the program's name; returns the exit
/// code.
#[must_use]
pub fn run_with(arguments: Vec<OsString>) -> u8 {
    let wants_json = arguments.iter().any(|argument| argument == "--json");
    let arguments = match commands::Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => return misused(&error, wants_json),
    };
    let json = arguments.json;
    note::set_quiet(arguments.quiet);
    match guarded::run(&arguments.command, json) {
        Ok(()) => 0,
        Err(failure) => {
            failure.report(json);
            failure.exit_code()
        }
    }
}

/// Prints help and version on stdout, and argument errors like all other errors.
fn misused(error: &clap::Error, wants_json: bool) -> u8 {
    if error.use_stderr() && !wants_json && error.kind() != NO_COMMAND {
        let colours = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let said = if colours && io::stderr().is_terminal() {
            error.render().ansi().to_string()
        } else {
            error.render().to_string()
        };
        let code = format!("error[{}]", Code::USAGE);
        let _ = write!(io::stderr(), "{}", said.replacen("error", &code, 1));
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    if !(error.use_stderr() && wants_json) {
        // A closed output is ignored.
        let _ = error.print();
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    let said = error.render().to_string();
    let message = said.strip_prefix("error: ").unwrap_or(&said).trim_end();
    let failure = failure::Failure::Usage(message.to_owned());
    failure.report(true);
    failure.exit_code()
}
