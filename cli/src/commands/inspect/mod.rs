//! `overact inspect`: shows composition, cost and drawing of a robot's model.

mod table;

use crate::{effort, failure::Failure, input, note::print_description_note, output};
use overact_robot::{Inspection, drawing};
use std::path::PathBuf;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write a drawing of the robot at its home configuration
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Arguments,
}

/// Runs the command.
///
/// # Errors
/// A description with errors.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let written = output::file(arguments.output.as_ref());
    let outputs = written.into_iter().chain(arguments.svg.as_deref());
    output::check(&[&arguments.file], &outputs.collect::<Vec<_>>())?;
    let robot = input::compiled(&arguments.file, &arguments.effort.request(), as_json)?;
    print_description_note(&robot, as_json);
    let drawing = arguments.svg.clone().map(|file| {
        let text = drawing::svg(&robot.model.mechanism);
        (file, text.into_bytes())
    });
    let document = Inspection::new(robot);
    let text = if as_json {
        output::json(&document)?
    } else {
        table::text(&document)
    };
    output::emit_with(&text, written, drawing.into_iter().collect())
}
