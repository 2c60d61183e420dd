//! Import of robot files, with validation of the description.

use crate::{
    check::check_text,
    error::{Error, Problem},
};
use overact_codegen::{Source, diagnostic::Code};
use overact_interchange::{Errors, Imported, Options};
use std::path::Path;

/// Imports a robot file (MJCF, URDF, SDFormat or .par) and validates the description.
///
/// The validation is that of [`check`](crate::check).
///
/// ```
/// use overact_interchange::Options;
///
/// let error = overact_robot::import("no_such_robot.urdf".as_ref(), &Options::default());
/// assert!(error.is_err());
/// ```
///
/// # Errors
/// All errors of the file with their lines, including those that invalidate the description.
pub fn import(path: &Path, options: &Options) -> Result<Imported, Error> {
    let imported = overact_interchange::import(path, options).map_err(errors_of_files)?;
    let source = Source::new("import", imported.text.as_str());
    match check_text(source) {
        Ok(_) => Ok(imported),
        Err(error) if error.internal().is_some() => Err(error),
        Err(Error::Description { diagnostics, .. }) => {
            Err(errors_of_files(imported.located(&diagnostics)))
        }
        Err(other) => Err(other),
    }
}

/// Converts the errors of imported files.
#[must_use]
pub fn errors_of_files(errors: Errors) -> Error {
    if errors.0.is_empty() {
        return Problem::new(Code::FOREIGN, "the file can't be read").into();
    }
    let each = errors
        .0
        .into_iter()
        .map(|(source, diagnostics)| Error::Description {
            source,
            diagnostics,
        });
    Error::Several(each.collect())
}
