//! `overact completions` and `overact manual`: shell completions and manual pages.

use crate::{
    failure::{Failure, Problem},
    output::{self, print},
};
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use overact_codegen::diagnostic::Code;
use std::path::{Path, PathBuf};

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub(crate) struct Completions {
    /// The shell; see its manual for the location of completion files
    #[arg(value_enum)]
    shell: Shell,
}

/// Arguments of `manual`.
#[derive(Debug, clap::Args)]
pub(crate) struct Manual {
    /// A folder, to which `overact.1` and a page of each command are written; without it the first page goes to
    /// standard output
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
}

/// Prints shell completions.
///
/// # Errors
/// A stdout that cannot be written.
pub(super) fn completions(arguments: &Completions) -> Result<(), Failure> {
    let mut text = Vec::new();
    let mut command = super::Arguments::command();
    clap_complete::generate(arguments.shell, &mut command, "overact", &mut text);
    print(&as_text(text)?)
}

/// Writes manual pages.
///
/// # Errors
/// A folder that cannot be created or written.
pub(super) fn manual(arguments: &Manual) -> Result<(), Failure> {
    let mut command = super::Arguments::command();
    command.build();
    let Some(folder) = output::file(arguments.output.as_ref()) else {
        return print(&as_text(page(&command)?)?);
    };
    let mut files = vec![(folder.join("overact.1"), page(&command)?)];
    for one in command.get_subcommands().filter(|one| !one.is_hide_set()) {
        let name = format!("overact-{}.1", one.get_name());
        let own = one
            .clone()
            .display_name(format!("overact-{}", one.get_name()));
        files.push((folder.join(name), page(&own)?));
    }
    output::make_folder(folder)?;
    let outputs: Vec<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    output::check(&[], &outputs)?;
    let lines: Vec<String> = outputs
        .iter()
        .map(|path| format!("{}: written", path.display()))
        .collect();
    output::write(files)?;
    print(&lines.join("\n"))
}

fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    // Without a date, the same command line gives the same bytes.
    let man = Man::new(command.clone()).date("");
    man.render(&mut text).map_err(|error| unwritten(&error))?;
    Ok(text)
}

fn as_text(bytes: Vec<u8>) -> Result<String, Failure> {
    String::from_utf8(bytes).map_err(|error| unwritten(&error))
}

fn unwritten(error: &dyn std::error::Error) -> Failure {
    Problem::new(Code::NO_RESULT_TEXT, error.to_string()).into()
}
