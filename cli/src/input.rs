//! Inputs: descriptions with a bar while they are derived, and standard input where a path is `-`.

use crate::{
    failure::{Failure, Problem},
    progress::Progress,
    signals,
};
use overact_codegen::{Progress as Step, Request, diagnostic::Code};
use overact_robot::{CompiledFile, Error, Robot};
use std::{
    io,
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Whether a path means standard input or output.
pub(crate) fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// A description with what is asked for, and a bar while its functions are derived.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
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

/// A description as a running robot.
///
/// # Errors
/// As [`compiled`].
pub(crate) fn robot(path: &Path, as_json: bool) -> Result<Robot, Error> {
    compiled(path, &Robot::request(), as_json).map(Robot::new)
}

/// A log from standard input in a file of its own: logs are gone through more than once.
#[derive(Debug)]
pub(crate) struct Spool(NamedTempFile);

impl Spool {
    /// Reads standard input to its end.
    ///
    /// # Errors
    /// A folder for temporary files that can't be written, or an input that breaks off.
    pub(crate) fn read() -> Result<Self, Failure> {
        let spooled = || {
            let mut builder = tempfile::Builder::new();
            builder.prefix("overact-");
            let mut file = signals::guarded(|| builder.tempfile())?;
            io::copy(&mut io::stdin().lock(), file.as_file_mut())?;
            Ok(Self(file))
        };
        spooled().map_err(|error: io::Error| {
            let message = format!("standard input can't be read as a log: {error}");
            Problem::new(Code::STREAM, message).into()
        })
    }

    /// The file.
    pub(crate) fn path(&self) -> PathBuf {
        self.0.path().to_owned()
    }
}
