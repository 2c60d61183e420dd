//! The command line of `overact`: arguments in, results out. What a command does is done by the
//! libraries below it, [`overact_robot`] first.
//!
//! One file per subcommand in `commands`. What they share:
//!
//! - [`failure`]: what went wrong, as text for people or as JSON for machines, with the exit code;
//! - `output`: results go to stdout or, whole or not at all, to a file;
//! - `progress`: long work shows a bar on a terminal and nothing in a pipe;
//! - `guarded`: a defect of the program is told as such;
//! - `effort`: how hard the generator searches;
//! - `forms`: in which form a function is meant;
//! - `functions`: which functions are generated;
//! - `input`: descriptions with a bar, standard input;
//! - `names`: names of results in names of files;
//! - `note`: what a description says that may not be meant;
//! - [`report`]: an identification as a page, a document or a flat table;
//! - `signals`: what is left when a signal ends the process: nothing;
//! - `states`: states of a robot from JSON or CSV.

mod commands;
mod effort;
pub mod failure;
mod forms;
mod functions;
mod guarded;
mod input;
mod names;
mod note;
mod output;
mod progress;
pub mod report;
mod signals;
mod states;

use clap::{Parser, error::ErrorKind};
use overact_codegen::diagnostic::Code;
use std::{
    ffi::OsString,
    io::{self, IsTerminal, Write},
    process::ExitCode,
};

/// What is printed where no command is given is the help.
const NO_COMMAND: ErrorKind = ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;

/// Runs the command that the process was started with.
#[must_use]
pub fn run() -> ExitCode {
    signals::watch();
    // The thread that waits for parallel work takes part in it: else each piece is handed to another thread, which
    // has to be woken, while this one sleeps. Where there is a pool already, there is nothing to be done.
    let pool = rayon::ThreadPoolBuilder::new().use_current_thread();
    let _ = pool.build_global();
    ExitCode::from(run_with(std::env::args_os().collect()))
}

/// Runs the command of these arguments, the first of which is the program's name; returns the exit code.
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

/// Help and the version go to stdout; what is wrong with the arguments is told as everything else is.
fn misused(error: &clap::Error, wants_json: bool) -> u8 {
    if error.use_stderr() && !wants_json && error.kind() != NO_COMMAND {
        let colours = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        let said = match colours && io::stderr().is_terminal() {
            true => error.render().ansi().to_string(),
            false => error.render().to_string(),
        };
        let code = format!("error[{}]", Code::USAGE);
        let _ = write!(io::stderr(), "{}", said.replacen("error", &code, 1));
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    if !(error.use_stderr() && wants_json) {
        // There is nobody left to tell that the output is closed.
        let _ = error.print();
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    let said = error.render().to_string();
    let message = said.strip_prefix("error: ").unwrap_or(&said).trim_end();
    let failure = failure::Failure::Usage(message.to_owned());
    failure.report(true);
    failure.exit_code()
}
