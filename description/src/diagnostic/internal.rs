//! Errors of the generator itself: violated invariants, as opposed to errors of the description.

use super::{Code, Diagnostic, Diagnostics};
use std::fmt;

/// A violated invariant of overact, with the data for a bug report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InternalError {
    /// The robot, if known.
    robot: Option<String>,
    /// The stage or pass that violated it.
    stage: String,
    /// Description of the violation.
    message: String,
}

impl InternalError {
    /// Advice to the user.
    pub const HELP: &str = "this is a defect of overact and not of your input: please report it with the description and the command";

    /// A violated invariant in a stage or pass.
    #[must_use]
    pub fn new(stage: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            robot: None,
            stage: stage.into(),
            message: message.into(),
        }
    }

    /// Adds the name of the robot if it is not known yet.
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
    /// The violated invariant, if the error is not in the description.
    #[must_use]
    pub fn internal(&self) -> Option<&InternalError> {
        self.internal.as_deref()
    }
}
