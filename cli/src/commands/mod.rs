//! Command line: one file per subcommand.

mod check;
mod evaluate;
mod excite;
mod explain;
mod export;
mod factor;
mod generate;
mod identify;
mod import;
mod inspect;
mod merge;
mod new;
mod partitions;
mod shell;
mod simulate;

use crate::failure::Failure;
use clap::{Parser, Subcommand};
use std::{path::PathBuf, slice};

/// Dynamic models and parameter identification of robots with closed loops and redundant motors.
#[derive(Debug, Parser)]
#[command(name = "overact", version, propagate_version = true)]
pub(crate) struct Arguments {
    /// Print one JSON document instead of tables; errors as JSON, too
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Print only errors on standard error: no progress, notes or warnings
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Start a description from a commented template
    New(new::Arguments),
    /// Print all errors of a description, each with its line
    Check(check::Arguments),
    /// Print sizes, bodies, base parameters, operation counts and conditioning
    Inspect(inspect::Arguments),
    /// Write a robot's functions as source in Rust, C or C++
    Generate(generate::Arguments),
    /// Evaluate a function on given states
    Evaluate(evaluate::Arguments),
    /// Compute runs that determine the parameters best within limits
    Excite(excite::Arguments),
    /// Simulate the virtual experiment of a description
    Simulate(simulate::Arguments),
    /// Estimate a robot's parameters from logs, or from its virtual experiment
    Identify(identify::Arguments),
    /// Write the R factors of logs: small files from which parameters can be identified
    Factor(factor::Arguments),
    /// Merge factor files without duplicates
    Merge(merge::Arguments),
    /// Compare all choices of kept actuators of the actuator projection
    Partitions(partitions::Arguments),
    /// Explain the cause and the remedy of an error code
    Explain(explain::Arguments),
    /// Print shell completions
    Completions(shell::Completions),
    /// Print or write pages for `man`
    Manual(shell::Manual),
    /// Import a description from MJCF, URDF, SDFormat or .par, with loops
    Import(import::Arguments),
    /// Write identified parameters into the MJCF or URDF from which a description was imported, or a
    /// skeleton as a serial robot
    Export(export::Arguments),
}

impl Command {
    /// Runs the command.
    ///
    /// # Errors
    /// The error of the command; then no output was changed.
    pub(crate) fn run(&self, json: bool) -> Result<(), Failure> {
        match self {
            Self::New(arguments) => new::run(arguments, json),
            Self::Check(arguments) => check::run(arguments, json),
            Self::Inspect(arguments) => inspect::run(arguments, json),
            Self::Generate(arguments) => generate::run(arguments, json),
            Self::Evaluate(arguments) => evaluate::run(arguments, json),
            Self::Excite(arguments) => excite::run(arguments, json),
            Self::Simulate(arguments) => simulate::run(arguments, json),
            Self::Identify(arguments) => identify::run(arguments, json),
            Self::Factor(arguments) => factor::run(arguments, json),
            Self::Merge(arguments) => merge::run(arguments, json),
            Self::Partitions(arguments) => partitions::run(arguments, json),
            Self::Explain(arguments) => explain::run(arguments, json),
            Self::Completions(arguments) => shell::completions(arguments),
            Self::Manual(arguments) => shell::manual(arguments),
            Self::Import(arguments) => import::run(arguments, json),
            Self::Export(arguments) => export::run(arguments, json),
        }
    }

    /// Name of the command.
    pub(crate) const fn name(&self) -> &'static str {
        match self {
            Self::New(_) => "new",
            Self::Check(_) => "check",
            Self::Inspect(_) => "inspect",
            Self::Generate(_) => "generate",
            Self::Evaluate(_) => "evaluate",
            Self::Excite(_) => "excite",
            Self::Simulate(_) => "simulate",
            Self::Identify(_) => "identify",
            Self::Factor(_) => "factor",
            Self::Merge(_) => "merge",
            Self::Partitions(_) => "partitions",
            Self::Explain(_) => "explain",
            Self::Completions(_) => "completions",
            Self::Manual(_) => "manual",
            Self::Import(_) => "import",
            Self::Export(_) => "export",
        }
    }

    /// Descriptions of the command, for reports of internal errors.
    pub(crate) fn descriptions(&self) -> String {
        let files: &[PathBuf] = match self {
            Self::New(_)
            | Self::Merge(_)
            | Self::Explain(_)
            | Self::Completions(_)
            | Self::Manual(_) => &[],
            Self::Factor(arguments) => slice::from_ref(&arguments.file),
            Self::Check(arguments) => arguments.files.as_slice(),
            Self::Generate(arguments) => arguments.files.as_slice(),
            Self::Inspect(arguments) => slice::from_ref(&arguments.file),
            Self::Evaluate(arguments) => slice::from_ref(&arguments.file),
            Self::Excite(arguments) => slice::from_ref(&arguments.file),
            Self::Simulate(arguments) => slice::from_ref(&arguments.file),
            Self::Identify(arguments) => slice::from_ref(&arguments.file),
            Self::Partitions(arguments) => slice::from_ref(&arguments.file),
            Self::Import(arguments) => slice::from_ref(&arguments.file),
            Self::Export(arguments) => return arguments.file().display().to_string(),
        };
        let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::Arguments;
    use clap::CommandFactory;

    #[test]
    fn clap_accepts_the_command_line_definition() {
        Arguments::command().debug_assert();
    }
}
