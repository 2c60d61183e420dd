//! Results: to stdout, or to files that are written whole or not at all.

use crate::failure::{Failure, Problem};
use serde::Serialize;
use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Writes a text to stdout. A reader that has gone away (`| head`) is not an error.
///
/// # Errors
/// A stdout that takes no more, for instance a full disk behind it.
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
            Err(Problem::new(format!("stdout can't be written: {error}")).into())
        }
        _ => Ok(()),
    }
}

/// Writes a text to a file, or to stdout where there is none.
///
/// # Errors
/// As [`print()`] and [`write()`].
pub(crate) fn emit(text: &str, file: Option<&Path>) -> Result<(), Failure> {
    match file {
        None => print(text),
        Some(path) => {
            let newline = if text.ends_with('\n') { "" } else { "\n" };
            write(vec![(
                path.to_owned(),
                format!("{text}{newline}").into_bytes(),
            )])
        }
    }
}

/// A document for machines.
///
/// # Errors
/// Never for the documents of this program: their keys are texts.
pub(crate) fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(document)
        .map_err(|error| Problem::new(format!("the result is no JSON: {error}")).into())
}

/// Writes files: each goes to a temporary file in its folder first, and when all of them are
/// complete, they are renamed. So an error leaves the old files as they were.
///
/// # Errors
/// A folder that can't be written.
pub(crate) fn write(files: Vec<(PathBuf, Vec<u8>)>) -> Result<(), Failure> {
    let mut staged = Vec::new();
    for (path, bytes) in files {
        let staging = stage(&path, &bytes).map_err(|error| unwritable(&path, &error))?;
        staged.push((path, staging, bytes));
    }
    for (path, staging, bytes) in staged {
        let done = match staging {
            Staged::Temporary(file, target) => {
                file.persist(target).map(drop).map_err(|error| error.error)
            }
            Staged::Device => fs::write(&path, bytes),
        };
        done.map_err(|error| unwritable(&path, &error))?;
    }
    Ok(())
}

/// A file that waits for its name.
enum Staged {
    /// The file and its name.
    Temporary(NamedTempFile, PathBuf),
    /// Devices and pipes, `/dev/stdout` for instance, are written to and never replaced.
    Device,
}

fn stage(path: &Path, bytes: &[u8]) -> io::Result<Staged> {
    let existing = fs::metadata(path).ok();
    if let Some(existing) = &existing {
        if existing.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        if !existing.is_file() {
            return Ok(Staged::Device);
        }
    }
    // A link stays a link: what it points to is replaced.
    let target = match existing {
        Some(_) => fs::canonicalize(path)?,
        None => path.to_owned(),
    };
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".overact-");
    let permissions = existing
        .as_ref()
        .map(fs::Metadata::permissions)
        .or_else(usual_permissions);
    let mut file = match permissions {
        Some(permissions) => builder.permissions(permissions).tempfile_in(folder)?,
        None => builder.tempfile_in(folder)?,
    };
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(Staged::Temporary(file, target))
}

/// Those of any new file; the default of a temporary file is to be private.
#[cfg(unix)]
fn usual_permissions() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<fs::Permissions> {
    None
}

/// Fails early, before long work, if the folder of an output does not exist.
///
/// # Errors
/// A folder that does not exist.
pub(crate) fn check_folder(file: Option<&Path>) -> Result<(), Failure> {
    match file.and_then(Path::parent) {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let error = io::Error::from(io::ErrorKind::NotFound);
            Err(unwritable(file.unwrap_or(folder), &error))
        }
        _ => Ok(()),
    }
}

/// The error's own text may name the temporary file, which is nobody's business.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let reason = match error.kind() {
        io::ErrorKind::NotFound => "its folder does not exist".to_owned(),
        io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        kind => kind.to_string(),
    };
    let problem = Problem::new(format!("the file can't be written: {reason}"));
    problem.file(path.display().to_string()).into()
}

/// `1 leg`, `2 legs`.
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Rows in columns as wide as their widest cell; `left` tells which columns are aligned to the left.
pub(crate) fn table(rows: &[Vec<String>], left: &[bool]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cell = |(column, cell): (usize, &String)| {
            let width = widths[column];
            let is_left = left.get(column).copied().unwrap_or(false);
            if is_left {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        };
        let cells: Vec<String> = row.iter().enumerate().map(cell).collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{table, write};

    #[test]
    fn an_error_leaves_all_files_as_they_were() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let (good, bad) = (
            folder.path().join("a.csv"),
            folder.path().join("none/b.csv"),
        );
        std::fs::write(&good, "old")?;
        assert!(write(vec![(good.clone(), b"new".to_vec()), (bad, Vec::new())]).is_err());
        assert_eq!(std::fs::read_to_string(&good)?, "old");
        assert!(write(vec![(good.clone(), b"new".to_vec())]).is_ok());
        assert_eq!(std::fs::read_to_string(&good)?, "new");
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    }

    #[test]
    fn columns_are_aligned() {
        let row = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
        let rows = [row("name", "n"), row("x", "12")];
        assert_eq!(table(&rows, &[true, false]), "name   n\nx     12\n");
    }
}
