//! Output to stdout, or to files that are written completely or not at all.

mod files;

pub(crate) use files::{check, check_distinct, write};
pub(crate) use overact_robot::counted;

use crate::{
    failure::{Failure, Problem},
    input::is_stream,
};
use overact_codegen::diagnostic::Code;
use serde::Serialize;
use std::{
    io,
    io::Write,
    path::{Path, PathBuf},
};

/// File for a result; `None` for stdout (`-`).
pub(crate) fn file(path: Option<&PathBuf>) -> Option<&Path> {
    let path = path.map(PathBuf::as_path);
    path.filter(|path| !is_stream(path))
}

/// Writes a text to stdout; a closed pipe (`| head`) is not an error.
///
/// # Errors
/// A stdout that cannot be written, for instance a full disk.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let newline = if text.ends_with('\n') || text.is_empty() {
        ""
    } else {
        "\n"
    };
    let written = write!(stdout, "{text}{newline}").and_then(|()| stdout.flush());
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Problem::new(Code::STREAM, format!("stdout can't be written: {error}")).into())
        }
        _ => Ok(()),
    }
}

/// Writes a text to a file, or to stdout if there is none.
///
/// # Errors
/// As [`print()`] and [`write()`].
pub(crate) fn emit(text: &str, file: Option<&Path>) -> Result<(), Failure> {
    emit_with(text, file, Vec::new())
}

/// [`emit`] together with other files; all are written, or none.
///
/// # Errors
/// As [`print()`] and [`write()`].
pub(crate) fn emit_with(
    text: &str,
    file: Option<&Path>,
    mut others: Vec<(PathBuf, Vec<u8>)>,
) -> Result<(), Failure> {
    if let Some(path) = file {
        let newline = if text.ends_with('\n') { "" } else { "\n" };
        let text = format!("{text}{newline}").into_bytes();
        others.push((path.to_owned(), text));
    }
    write(others)?;
    match file {
        Some(_) => Ok(()),
        None => print(text),
    }
}

/// Creates the folder for several files, if it does not exist.
///
/// # Errors
/// A folder that cannot be created.
pub(crate) fn make_folder(folder: &Path) -> Result<(), Failure> {
    made(folder).map_err(Failure::from)
}

/// Creates the folders of files; that of a single file usually exists.
///
/// # Errors
/// A folder that cannot be created.
pub(crate) fn make_folders(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Problem> {
    let folders = files.iter().filter_map(|(file, _)| file.parent());
    let mut folders = folders.filter(|folder| !folder.as_os_str().is_empty());
    folders.try_for_each(made)
}

fn made(folder: &Path) -> Result<(), Problem> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let problem = Problem::new(
            Code::OUTPUT,
            format!("the folder can't be created: {error}"),
        );
        problem.file(folder.display().to_string())
    })
}

/// JSON document.
///
/// # Errors
/// Never for the documents of this program: their keys are strings.
pub(crate) fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document).map_err(|error| {
        Problem::new(
            Code::NO_RESULT_TEXT,
            format!("the result cannot be written as JSON: {error}"),
        )
        .into()
    })
}
