//! `overact new`: a description from a commented template.

use crate::{
    failure::{Failure, Problem},
    output::{json, print, write},
};
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

/// Templates with their names.
const TEMPLATES: [(&str, &str); 2] = [
    (
        "planar-4rrr",
        include_str!("../../templates/planar-4rrr.toml"),
    ),
    ("serial-2r", include_str!("../../templates/serial-2r.toml")),
];

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// What kind of robot to start from
    #[arg(value_parser = PossibleValuesParser::new(TEMPLATES.map(|(name, _)| name)))]
    template: String,
    /// The description to write; it must not exist
    #[arg(value_name = "TOML")]
    file: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A file that exists or can't be written.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let file = arguments.file.display().to_string();
    // A link that leads nowhere is a file, too.
    if arguments.file.symlink_metadata().is_ok() {
        let problem = Problem::new("the file exists and is not overwritten").file(file);
        return Err(problem
            .help("choose another name, or remove the file first")
            .into());
    }
    let text = TEMPLATES
        .iter()
        .find(|(name, _)| *name == arguments.template)
        .map_or("", |t| t.1);
    write(vec![(arguments.file.clone(), text.as_bytes().to_vec())])?;
    if as_json {
        return print(&json(
            &serde_json::json!({ "file": file, "template": arguments.template }),
        )?);
    }
    print(&format!(
        "wrote {file}; `overact check {file}` checks it, `overact identify {file}` makes its virtual experiment"
    ))
}
