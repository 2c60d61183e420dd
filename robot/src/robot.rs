//! A description as a running robot.

use crate::{compiled_file::CompiledFile, error::Error, interpreted::InterpretedRobot};
use overact_codegen::{Effort, Request, description::Description, diagnostic::Source};
use std::path::Path;

/// A robot that runs: its description, and its model served as [`overact::Model`].
#[derive(Debug)]
pub struct Robot {
    source: Source,
    description: Description,
    model: InterpretedRobot,
}

impl Robot {
    /// The robot of a description in a file.
    ///
    /// Only the functions that an [`InterpretedRobot`] serves are compiled, and no search for fewer
    /// operations is made: what it would spare takes less time than the search.
    ///
    /// # Errors
    /// A file that can't be read, or everything that is wrong with the description.
    pub fn from_toml(path: impl AsRef<Path>) -> Result<Self, Error> {
        CompiledFile::read(path.as_ref(), &served()).map(Self::new)
    }

    /// The robot of a description in memory; errors call it `name`.
    ///
    /// ```
    /// use overact_robot::Robot;
    ///
    /// let error = Robot::from_text("empty.toml", "").unwrap_err();
    /// assert!(error.problems().iter().all(|problem| problem.file.as_deref() == Some("empty.toml")));
    /// ```
    ///
    /// # Errors
    /// Everything that is wrong with the description.
    pub fn from_text(name: &str, text: &str) -> Result<Self, Error> {
        CompiledFile::new(Source::new(name, text), &served()).map(Self::new)
    }

    /// The robot of a description that is compiled.
    #[must_use]
    pub fn new(compiled: CompiledFile) -> Self {
        Self {
            source: compiled.source,
            description: compiled.description,
            model: InterpretedRobot::new(compiled.model),
        }
    }

    /// What is compiled of a robot that runs: what an [`InterpretedRobot`] serves, without a search. With a
    /// watcher in `progress` and [`CompiledFile::read`] a robot of many joints is waited for less blindly than with
    /// [`Robot::from_toml`].
    #[must_use]
    pub fn request() -> Request<'static> {
        served()
    }

    /// The path or name by which errors call the description.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.source.name
    }

    /// The text of the description with its name.
    #[must_use]
    pub const fn source(&self) -> &Source {
        &self.source
    }

    /// What the description says.
    #[must_use]
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &InterpretedRobot {
        &self.model
    }
}

/// What is compiled of a robot that runs.
pub(crate) fn served() -> Request<'static> {
    Request {
        wanted: &InterpretedRobot::serves,
        side_by_side: false,
        ..Request::with_effort(Effort::None)
    }
}
