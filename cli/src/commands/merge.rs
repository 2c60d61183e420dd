//! `overact merge`: merges factor files.

use crate::{failure::Failure, measurements::factors::left_out, output};
use overact_identification::factors::{gather, write_factors};
use std::path::{Path, PathBuf};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Factor files
    #[arg(value_name = "PARQUET", required = true)]
    files: Vec<PathBuf>,
    /// The merged file
    #[arg(short, long, value_name = "PARQUET")]
    output: PathBuf,
    /// Skip unusable parts, and report them
    #[arg(long)]
    skip_bad: bool,
}

/// Runs the command.
///
/// # Errors
/// Files that cannot be used or are incompatible, unless they are to be skipped.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let inputs: Vec<&Path> = arguments.files.iter().map(PathBuf::as_path).collect();
    output::check(&inputs, &[arguments.output.as_path()])?;
    let gathered = gather(&arguments.files, None, arguments.skip_bad)?;
    let bytes = write_factors(&gathered.runs)?;
    let said = if as_json {
        output::json(&serde_json::json!({
            "runs": gathered.runs.len(),
            "left_out": gathered.left_out,
            "bytes": bytes.len(),
        }))?
    } else {
        let mut text = format!(
            "{}, {} bytes\n",
            output::counted(gathered.runs.len(), "run", "runs"),
            bytes.len()
        );
        text.push_str(&left_out(&gathered.left_out));
        text
    };
    output::emit_with(&said, None, vec![(arguments.output.clone(), bytes)])
}
