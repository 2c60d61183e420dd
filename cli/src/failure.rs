//! Why a command has no result, as text for people or as JSON for machines.

use overact_robot::Error;
use std::io::{self, IsTerminal, Write};

pub use overact_robot::Problem;

/// Why a command has no result.
#[derive(Debug)]
pub enum Failure {
    /// The arguments do not go together.
    Usage(String),
    /// Something that the arguments name is wrong.
    Input(Error),
}

impl Failure {
    /// The exit code: 2 for arguments that do not go together, 1 for all else.
    #[must_use]
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(_) => 1,
        }
    }

    /// All problems as data.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        match self {
            Self::Usage(message) => vec![Problem::new(message)],
            Self::Input(error) => error.problems(),
        }
    }

    /// All problems as text, with a terminal's colours or without.
    #[must_use]
    pub fn render(&self, styled: bool) -> String {
        match self {
            Self::Usage(message) => Problem::new(message).to_string(),
            Self::Input(error) => error.render(styled),
        }
    }

    /// Writes all problems to stderr: coloured on a terminal that wants colours, plain in a pipe, as
    /// one document with `json`.
    pub fn report(&self, json: bool) {
        let text = if json {
            serde_json::json!({ "errors": self.problems() }).to_string()
        } else {
            let colours = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
            self.render(colours && io::stderr().is_terminal())
        };
        // There is nobody left to tell that stderr is closed.
        let _ = writeln!(io::stderr(), "{text}");
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Input(error)
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Input(problem.into())
    }
}

/// Problems that were found together; at least one.
impl From<Vec<Problem>> for Failure {
    fn from(problems: Vec<Problem>) -> Self {
        Self::Input(Error::Problems(problems))
    }
}

/// What went wrong with several files; at least one.
impl From<Vec<Error>> for Failure {
    fn from(errors: Vec<Error>) -> Self {
        Self::Input(Error::Several(errors))
    }
}

impl From<overact_identification::Error> for Failure {
    fn from(error: overact_identification::Error) -> Self {
        Self::Input(error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::{Failure, Problem};

    #[test]
    fn only_arguments_that_do_not_go_together_are_a_usage_error() {
        assert_eq!(Failure::from(Problem::new("no column")).exit_code(), 1);
        assert_eq!(Failure::Usage("no".into()).exit_code(), 2);
        assert_eq!(Failure::Usage("no".into()).render(false), "error: no");
    }
}
