//! Inputs: descriptions with a progress bar, and standard input for the path `-`.

use crate::{
    failure::{Failure, Problem},
    progress::Progress,
    signals,
};
use overact_codegen::{Progress as Step, Request, diagnostic::Code};
use overact_robot::{CompiledFile, Error, Robot};
use std::{
    fs::File,
    io,
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Whether a path means standard input or output.
pub(crate) fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Compiles a description for a request, with a progress bar.
///
/// # Errors
/// A file that cannot be read, or all errors of the description.
pub(crate) fn compiled(
    path: &Path,
    request: &Request<'_>,
    as_json: bool,
) -> Result<CompiledFile, Error> {
    let bar = Progress::new("deriving", as_json);
    let watch = |step: Step<'_>| {
        let whole = step.functions.max(1) as f64;
        bar.at(step.done as f64 / whole, step.work);
    };
    let request = Request {
        progress: &watch,
        ..*request
    };
    CompiledFile::read(path, &request)
}

/// Robot of a description.
///
/// # Errors
/// As [`compiled`].
pub(crate) fn robot(path: &Path, as_json: bool) -> Result<Robot, Error> {
    compiled(path, &Robot::request(), as_json).map(Robot::new)
}

/// Log from standard input or a pipe in a temporary file, because logs are read more than once.
#[derive(Debug)]
pub(crate) struct Spool(NamedTempFile);

impl Spool {
    /// Reads standard input to its end.
    ///
    /// # Errors
    /// A temporary folder that cannot be written, or an interrupted input.
    pub(crate) fn read() -> Result<Self, Failure> {
        Self::of(&mut io::stdin().lock()).map_err(|error| {
            let message = format!("standard input can't be read as a log: {error}");
            Problem::new(Code::STREAM, message).into()
        })
    }

    /// Reads a pipe to its end.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(crate) fn of_pipe(path: &Path) -> Result<Self, Failure> {
        let read = File::open(path).and_then(|mut pipe| Self::of(&mut pipe));
        read.map_err(|error| {
            let message = format!("the pipe can't be read as a log: {error}");
            let problem = Problem::new(Code::STREAM, message).file(path.display().to_string());
            problem.help("write it to a file first").into()
        })
    }

    fn of(input: &mut dyn io::Read) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("overact-");
        let mut file = signals::guarded(|| builder.tempfile())?;
        io::copy(input, file.as_file_mut())?;
        Ok(Self(file))
    }

    /// Path of the file.
    pub(crate) fn path(&self) -> PathBuf {
        self.0.path().to_owned()
    }
}
