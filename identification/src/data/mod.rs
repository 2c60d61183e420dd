//! Measured runs: a [`Log`] holds the actuator positions and torques of one run, uniformly sampled;
//! a [`Mapping`] says which columns of a file they are and what turns them into SI units.
//!
//! Readers for CSV with a header and MATLAB v5 `.mat` files report every missing column, every
//! cell that is not a number (up to twenty) and the first step of a time that is not uniform. A large
//! CSV file stays on the disk and is read block by block whenever its run is gone through.

mod csv_file;
mod dataset;
mod log;
mod mapping;
mod mat_file;
pub(crate) mod periods;

use std::{
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

pub use csv_file::read_csv;
pub use dataset::Dataset;
pub use log::{Log, Reader, Samples};
pub use mapping::{Gain, Mapping};
pub use mat_file::read_mat;
pub use periods::Periods;
use rayon::prelude::*;

use crate::error::{Error, Problem, suggestion};

/// Cells that are reported one by one; a file of text would else fill the screen.
const LARGEST_NUMBER_OF_PROBLEMS: usize = 20;

/// Reads a run from a file whose extension tells its format: `.mat` is MATLAB v5, all else CSV.
///
/// # Errors
/// See [`read_csv`] and [`read_mat`].
pub fn read(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    read_telling(path, mapping, payload, &|_| {})
}

/// Reads a run from a file; `advance` is told every now and then how many bytes more have been read.
fn read_telling(
    path: &Path,
    mapping: &Mapping,
    payload: bool,
    advance: &dyn Fn(u64),
) -> Result<Log, Error> {
    let is_mat = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("mat"));
    if is_mat {
        read_mat(path, mapping, payload)
    } else {
        csv_file::read_telling(path, mapping, payload, advance)
    }
}

/// Reads several runs at once, each with a word on its payload. `progress` is told the part of all bytes
/// that has been read, from 0 to 1.
#[must_use]
pub fn read_all(
    files: &[(&Path, bool)],
    mapping: &Mapping,
    progress: &(dyn Fn(f64) + Sync),
) -> Vec<Result<Log, Error>> {
    // A file that can't be asked for its size can't be read either, which is told then.
    let size = |path: &Path| std::fs::metadata(path).map_or(0, |file| file.len());
    let total: u64 = files.iter().map(|(path, _)| size(path)).sum();
    let done = AtomicU64::new(0);
    let advance = |bytes: u64| {
        let now = bytes + done.fetch_add(bytes, Ordering::Relaxed);
        progress(now as f64 / total.max(1) as f64);
    };
    let read = |&(path, payload): &(&Path, bool)| read_telling(path, mapping, payload, &advance);
    files.par_iter().map(read).collect()
}

/// The name by which a file is called in messages: as the caller gave it.
fn display_name(path: &Path) -> String {
    path.display().to_string()
}

/// A file that can't be opened or read.
fn unreadable(file: &str, error: &std::io::Error) -> Problem {
    let problem = Problem::new(format!("the file can't be read: {error}")).file(file);
    if error.kind() == std::io::ErrorKind::NotFound {
        problem.help("check the path; it is taken from the folder in which the program was started")
    } else {
        problem
    }
}

/// The error that names all columns that are missing and all that are there.
fn missing_columns(file: &str, missing: &[&str], existing: &[&str], what: &str) -> Problem {
    let quoted = |names: &[&str]| -> String {
        names
            .iter()
            .map(|name| format!("`{name}`"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let mut problem = Problem::new(format!(
        "there {} no {what}{} {}; the file has {}",
        if missing.len() == 1 { "is" } else { "are" },
        if missing.len() == 1 { "" } else { "s" },
        quoted(missing),
        if existing.is_empty() {
            String::from("none")
        } else {
            quoted(existing)
        }
    ))
    .file(file);
    if let Some(first) = missing.first() {
        problem = problem.column(*first);
    }
    let guesses: Vec<String> = missing
        .iter()
        .filter_map(|name| {
            suggestion(name, existing.iter().copied()).map(|near| format!("`{near}` for `{name}`"))
        })
        .collect();
    if guesses.is_empty() {
        problem.help("name the columns in the mapping")
    } else {
        problem.help(format!("did you mean {}?", guesses.join(", ")))
    }
}
