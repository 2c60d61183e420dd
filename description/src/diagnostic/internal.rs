//! Errors of the generator itself: a broken invariant is told as such, and never as an error of the
//! description.

use super::{Code, Diagnostic, Diagnostics};
use std::fmt;

/// A broken invariant of overact, with what a report of it needs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InternalError {
    /// The robot at which it was seen, as far as it is known.
    robot: Option<String>,
    /// The stage or pass that broke it.
    stage: String,
    /// What is wrong.
    message: String,
}

impl InternalError {
    /// What to do about it.
    pub const HELP: &str = "this is a defect of overact and not of your input: please report it with the description and the command";

    /// A broken invariant in a stage or pass.
    #[must_use]
    pub fn new(stage: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            robot: None,
            stage: stage.into(),
            message: message.into(),
        }
    }

    /// With the name of the robot, where none is known yet.
    #[must_use]
    pub fn of_robot(self, robot: impl Into<String>) -> Self {
        let robot = self.robot.or_else(|| Some(robot.into()));
        Self { robot, ..self }
    }
}

impl fmt::Display for InternalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let version = env!("CARGO_PKG_VERSION");
        write!(f, "internal error of overact {version} in `{}`", self.stage)?;
        if let Some(robot) = &self.robot {
            write!(f, " at robot `{robot}`")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for InternalError {}

impl From<InternalError> for Diagnostics {
    fn from(error: InternalError) -> Self {
        let diagnostic =
            Diagnostic::global(Code::INTERNAL, error.to_string()).help(InternalError::HELP);
        Self {
            internal: Some(Box::new(error)),
            ..Self::from(diagnostic)
        }
    }
}

impl Diagnostics {
    /// The broken invariant, if it is not the description that is wrong.
    #[must_use]
    pub fn internal(&self) -> Option<&InternalError> {
        self.internal.as_deref()
    }
}
