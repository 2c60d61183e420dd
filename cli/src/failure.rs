//! Failures of commands, as text or JSON.

use overact_codegen::diagnostic::Code;
use overact_codegen::diagnostic::InternalError;
use overact_robot::Error;
use std::io::{self, IsTerminal, Write};

pub use overact_robot::Problem;
use overact_robot::{compiler_style, internal_problem};

/// Largest number of codes for which `overact explain` is suggested.
const EXPLAINED: usize = 4;

/// Failure of a command.
#[derive(Debug)]
pub enum Failure {
    /// Incompatible arguments.
    Usage(String),
    /// Invalid input.
    Input(Error),
    /// A result with the verdict not to use it, with an option that makes this a failure.
    Refused(String),
    /// An internal error of the program.
    Internal(InternalError),
}

impl Failure {
    /// Exit code.
    ///
    /// | code | meaning |
    /// |---|---|
    /// | 1 | invalid input |
    /// | 2 | incompatible arguments |
    /// | 3 | result with the verdict not to use it |
    /// | 4 | internal error |
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(error) if error.internal().is_some() => 4,
            Self::Input(_) => 1,
            Self::Usage(_) => 2,
            Self::Refused(_) => 3,
            Self::Internal(_) => 4,
        }
    }

    /// All problems as data.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        match self {
            Self::Usage(message) => vec![Problem::new(Code::USAGE, message)],
            Self::Refused(message) => vec![Problem::new(Code::NOT_TO_BE_USED, message)],
            Self::Input(error) => error.problems(),
            Self::Internal(error) => vec![internal_problem(error)],
        }
    }

    /// All problems as text, with or without terminal colours.
    #[must_use]
    pub fn render(&self, styled: bool) -> String {
        match self {
            Self::Input(error) => error.render(styled),
            Self::Usage(_) | Self::Refused(_) | Self::Internal(_) => {
                let texts: Vec<String> = self.problems().iter().map(compiler_style).collect();
                texts.join("\n\n")
            }
        }
    }

    /// Hint on the command that explains the codes.
    fn more(&self) -> String {
        let mut codes: Vec<Code> = self.problems().iter().map(|one| one.code).collect();
        codes.sort_unstable();
        codes.dedup();
        let names: Vec<String> = codes.iter().take(EXPLAINED).map(Code::to_string).collect();
        format!("cause and remedy: overact explain {}", names.join(" "))
    }

    /// Writes all problems to stderr: coloured on a terminal, plain in a pipe, or as JSON.
    pub fn report(&self, json: bool) {
        let text = if json {
            serde_json::json!({ "errors": self.problems() }).to_string()
        } else {
            let colours = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
            let text = self.render(colours && io::stderr().is_terminal());
            format!("{text}\n\n{}", self.more())
        };
        // A closed stderr is ignored.
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

/// Problems found together; at least one.
impl From<Vec<Problem>> for Failure {
    fn from(problems: Vec<Problem>) -> Self {
        Self::Input(Error::Problems(problems))
    }
}

/// Errors of several files; at least one.
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
    use super::{Code, Error, Failure, InternalError, Problem};
    use overact_codegen::diagnostic::{Diagnostics, Source};

    #[test]
    fn only_conflicting_arguments_exit_with_the_usage_code() {
        assert_eq!(
            Failure::from(Problem::new(Code::USAGE, "no column")).exit_code(),
            1
        );
        assert_eq!(Failure::Usage("no".into()).exit_code(), 2);
        assert_eq!(
            Failure::Usage("no".into()).render(false),
            "error[OA601]: no"
        );
    }

    #[test]
    fn internal_errors_of_every_source_share_one_exit_code() {
        let error = || InternalError::new("lowering", "step 3 reads step 7").of_robot("DualV");
        let direct = Failure::Internal(error());
        let source = Source::new("dualv.toml", "");
        let diagnostics = Diagnostics::from(error());
        let compiled = Failure::Input(Error::Several(vec![Error::Description {
            source,
            diagnostics,
        }]));
        for failure in [direct, compiled] {
            assert_eq!(failure.exit_code(), 4);
            let text = failure.render(false);
            for part in [
                "internal error",
                env!("CARGO_PKG_VERSION"),
                "robot `DualV`",
                "`lowering`",
                "step 3 reads step 7",
                "please report",
            ] {
                assert!(text.contains(part), "{part} in {text}");
            }
        }
    }
}
