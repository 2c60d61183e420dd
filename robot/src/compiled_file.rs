//! A description read from a file and compiled for a request.

use crate::error::{Error, Problem};
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    Request, RobotModel, compile_with, description::Description, diagnostic::Source,
    mechanism::Mechanism,
};
use std::{
    fs::File,
    io::{self, Read},
    path::Path,
};

/// A description with its model.
#[derive(Debug)]
#[non_exhaustive]
pub struct CompiledFile {
    /// The path as the user gave it.
    pub file: String,
    /// Text, to locate errors that are found later.
    pub source: Source,
    /// Parsed description.
    pub description: Description,
    /// The model.
    pub model: RobotModel,
    /// Sentences on values of a parameter file that no body or joint has.
    pub warnings: Vec<String>,
}

impl CompiledFile {
    /// Reads and compiles a description.
    ///
    /// # Errors
    /// A file that cannot be read, or all errors of the description.
    pub fn read(path: &Path, request: &Request<'_>) -> Result<Self, Error> {
        Self::new(read(path)?, request)
    }

    /// Compiles a description.
    ///
    /// # Errors
    /// All errors of the description.
    pub fn new(source: Source, request: &Request<'_>) -> Result<Self, Error> {
        match compile_with(&source, request) {
            Ok(compiled) => Ok(Self {
                file: source.name.clone(),
                source,
                description: compiled.description,
                model: compiled.model,
                warnings: Vec::new(),
            }),
            Err(diagnostics) => Err(Error::Description {
                source,
                diagnostics,
            }),
        }
    }

    /// Contents of the description that may be unintended.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        note(&self.source, &self.description, &self.model.mechanism)
    }
}

/// Contents of a description that may be unintended, one per line.
pub(crate) fn note(
    source: &Source,
    description: &Description,
    mechanism: &Mechanism,
) -> Option<String> {
    let warnings = description.warnings.iter().map(|warning| {
        let line = source.position(&warning.span).line;
        format!("line {line}: {}", warning.value)
    });
    let mut notes: Vec<String> = warnings.collect();
    notes.extend(redundancy(description, mechanism));
    (!notes.is_empty()).then(|| notes.join("\n"))
}

/// Note on actuation redundancy that the description does not declare.
///
/// A motor marked by mistake looks like redundancy.
fn redundancy(description: &Description, mechanism: &Mechanism) -> Option<String> {
    let (n, r) = (mechanism.actuator_count(), mechanism.dof());
    let said = (description.platform.as_ref()).is_some_and(|p| p.redundancy.is_some());
    // Descriptions of skeletons have no key for it.
    if n <= r || said || mechanism.skeleton().is_some() {
        return None;
    }
    Some(format!(
        "{n} actuators ({}) drive {}. If this is intended, write redundancy = {} in [platform]; otherwise remove `actuated = true` from a joint, or a motor",
        mechanism.actuator_names().join(", "),
        match r {
            1 => "1 degree of freedom".to_owned(),
            _ => format!("{r} degrees of freedom"),
        },
        n - r,
    ))
}

/// Largest size of a description or parameter file, bytes; a device may have no end.
const MOST_BYTES: u64 = 64 << 20;

/// Reads a text of at most [`MOST_BYTES`].
fn bounded(input: impl Read) -> io::Result<String> {
    let mut text = String::new();
    input.take(MOST_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MOST_BYTES {
        let message = format!("it has more than {} MB", MOST_BYTES >> 20);
        return Err(io::Error::other(message));
    }
    Ok(text)
}

/// Reads the text of a description.
///
/// # Errors
/// A file that cannot be read or is not UTF-8.
pub(crate) fn read(path: &Path) -> Result<Source, Error> {
    read_or(
        path,
        "check the path; `overact new` lists templates, and `overact new TEMPLATE my.toml` writes a first description",
    )
}

/// Reads a text, from standard input if the path is `-`.
///
/// `origin` is advice on how to create such a file if it does not exist.
///
/// # Errors
/// A file that cannot be read or is not UTF-8.
pub(crate) fn read_or(path: &Path, origin: &str) -> Result<Source, Error> {
    let name = path.display().to_string();
    let text = match name.as_str() {
        "-" => bounded(io::stdin()),
        _ => File::open(path).and_then(bounded),
    };
    match text {
        Ok(text) => Ok(Source::new(name, text)),
        Err(error) => {
            let missing = error.kind() == std::io::ErrorKind::NotFound;
            let problem = Problem::new(
                Code::UNREADABLE_DESCRIPTION,
                format!("the file can't be read: {error}"),
            )
            .file(name);
            Err(if missing {
                problem.help(origin)
            } else {
                problem
            }
            .into())
        }
    }
}
