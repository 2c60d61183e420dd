//! A robot with description and model.

use crate::{compiled_file::CompiledFile, error::Error, interpreted::InterpretedRobot};
use overact_codegen::{Effort, Request, description::Description, diagnostic::Source};
use std::path::Path;

/// A robot: its description, and its model as [`overact::Model`].
#[derive(Debug)]
pub struct Robot {
    source: Source,
    description: Description,
    model: InterpretedRobot,
}

impl Robot {
    /// Reads a robot's description from a file.
    ///
    /// Only the functions of an [`InterpretedRobot`] are compiled. Operation counts are not
    /// optimised, because this would take longer than it saves.
    ///
    /// # Errors
    /// A file that cannot be read, or all errors of the description.
    pub fn from_toml(path: impl AsRef<Path>) -> Result<Self, Error> {
        CompiledFile::read(path.as_ref(), &served()).map(Self::new)
    }

    /// Robot of a description in memory; `name` is its name in errors.
    ///
    /// ```
    /// use overact_robot::Robot;
    ///
    /// let error = Robot::from_text("empty.toml", "").unwrap_err();
    /// assert!(error.problems().iter().all(|problem| problem.file.as_deref() == Some("empty.toml")));
    /// ```
    ///
    /// # Errors
    /// All errors of the description.
    pub fn from_text(name: &str, text: &str) -> Result<Self, Error> {
        CompiledFile::new(Source::new(name, text), &served()).map(Self::new)
    }

    /// Robot of a compiled description.
    #[must_use]
    pub fn new(compiled: CompiledFile) -> Self {
        Self {
            source: compiled.source,
            description: compiled.description,
            model: InterpretedRobot::new(compiled.model),
        }
    }

    /// Compilation request for a robot: the functions of an [`InterpretedRobot`], without
    /// optimisation.
    ///
    /// With [`CompiledFile::read`], the request can have a `progress` callback, unlike
    /// [`Robot::from_toml`].
    #[must_use]
    pub fn request() -> Request<'static> {
        served()
    }

    /// Path or name of the description in errors.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.source.name
    }

    /// Text of the description with its name.
    #[must_use]
    pub const fn source(&self) -> &Source {
        &self.source
    }

    /// Parsed description.
    #[must_use]
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// Contents of the description that may be unintended, each with its line.
    #[must_use]
    pub fn description_warnings(&self) -> Vec<String> {
        let warnings = self.description.warnings.iter();
        let located = warnings.map(|warning| {
            let line = self.source.position(&warning.span).line;
            format!("{}:{line}: {}", self.source.name, warning.value)
        });
        located.collect()
    }

    /// Model of the robot.
    #[must_use]
    pub const fn model(&self) -> &InterpretedRobot {
        &self.model
    }
}

/// Compilation request for a robot.
pub(crate) fn served() -> Request<'static> {
    Request {
        wanted: &InterpretedRobot::serves,
        side_by_side: false,
        ..Request::with_effort(Effort::None)
    }
}
