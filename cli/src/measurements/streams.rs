//! Logs that can be read only once: standard input and pipes, such as `<(gzip -dc log.csv.gz)`.
//!
//! Logs are read several times, so the content of a stream is copied to a temporary file.

use crate::{
    failure::Failure,
    input::{self, Spool},
};
use overact_robot::Problem;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Temporary copies of streams; the files are removed with this value.
#[derive(Debug, Default)]
pub(super) struct Streams {
    /// Streams as given, with their copies.
    copies: Vec<(PathBuf, Spool)>,
}

impl Streams {
    /// Copies the streams among the files of a log; `None` if there are none.
    ///
    /// The result is the path of the log with the copies, and with its range of time.
    ///
    /// # Errors
    /// A stream that cannot be read, or a temporary folder without space.
    pub(super) fn copied(&mut self, log: &Path) -> Result<Option<PathBuf>, Failure> {
        let parts = overact_logs::parts(log);
        if !parts.iter().any(|part| is_stream(part)) {
            return Ok(None);
        }
        let mut files = Vec::new();
        for part in &parts {
            files.push(if is_stream(part) {
                self.copy(part)?.display().to_string()
            } else {
                part.display().to_string()
            });
        }
        let length = parts
            .iter()
            .map(|part| part.as_os_str().len() + 1)
            .sum::<usize>()
            - 1;
        let range = log.to_str().and_then(|text| text.get(length..));
        let range = range.unwrap_or_default();
        Ok(Some(PathBuf::from(files.join("+") + range)))
    }

    /// Copy of a stream.
    fn copy(&mut self, stream: &Path) -> Result<PathBuf, Failure> {
        let known = self.copies.iter().find(|(given, _)| given == stream);
        if let Some((_, copy)) = known {
            return Ok(copy.path());
        }
        let copy = if input::is_stream(stream) {
            Spool::read()?
        } else {
            Spool::of_pipe(stream)?
        };
        let path = copy.path();
        self.copies.push((stream.to_owned(), copy));
        Ok(path)
    }

    /// Replaces the copies by the user's names of the streams in a problem.
    pub(super) fn as_given(&self, problem: &mut Problem) {
        for (given, copy) in &self.copies {
            let (given, copy) = (
                given.display().to_string(),
                copy.path().display().to_string(),
            );
            let renamed = |text: &String| text.replace(&copy, &given);
            problem.file = problem.file.as_ref().map(renamed);
            problem.message = renamed(&problem.message);
            problem.help = problem.help.as_ref().map(renamed);
        }
    }
}

/// Whether a file can be read only once.
fn is_stream(part: &Path) -> bool {
    input::is_stream(part) || is_pipe(part)
}

/// Whether a file is a pipe; devices may be endless and are refused as logs.
#[cfg(unix)]
fn is_pipe(part: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    fs::metadata(part).is_ok_and(|found| found.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(part: &Path) -> bool {
    let _ = fs::metadata(part);
    false
}
