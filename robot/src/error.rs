//! Errors: all problems at once, each with location and advice.

use overact_codegen::diagnostic::{Code, Diagnostic};
use overact_codegen::diagnostic::{Diagnostics, InternalError, Located, Source, visible};
pub use overact_logs::{Column, Problem};
use std::fmt;

/// A problem as compilers print it.
#[must_use]
pub fn compiler_style(problem: &Problem) -> String {
    let mut text = format!("error[{}]: {}", problem.code, visible(&problem.message));
    if let Some(file) = &problem.file {
        text += &format!("\n --> {}", visible(file));
        if let Some(line) = problem.line {
            text += &format!(":{line}");
        }
        if let Some(Column::Number(column)) = &problem.column {
            text += &format!(":{column}");
        }
    }
    if let Some(help) = &problem.help {
        text += &format!("\n  = help: {}", visible(help));
    }
    text
}

/// The problem of an internal error, which has no location.
#[must_use]
pub fn internal_problem(error: &InternalError) -> Problem {
    Problem::new(Code::INTERNAL, error.to_string()).help(InternalError::HELP)
}

/// The problem of an error of a description.
fn problem_of(located: Located, diagnostic: &Diagnostic) -> Problem {
    let mut problem = Problem::new(diagnostic.code, located.message);
    problem.file = Some(located.file);
    problem.line = located.line;
    problem.column = located.column.map(Column::Number);
    problem.help = located.help;
    problem
}

/// Error of reading, compiling or using a robot.
#[derive(Debug)]
pub enum Error {
    /// An invalid description.
    Description {
        /// Its text.
        source: Source,
        /// All its errors.
        diagnostics: Diagnostics,
    },
    /// Anything else.
    Problems(Vec<Problem>),
    /// Errors of several files.
    Several(Vec<Self>),
}

impl Error {
    /// All problems as data.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        match self {
            Self::Problems(problems) => problems.clone(),
            Self::Several(all) => all.iter().flat_map(Self::problems).collect(),
            Self::Description {
                source,
                diagnostics,
            } => {
                let located = diagnostics.located(source).into_iter().zip(diagnostics);
                let problem = |(own, diagnostic)| problem_of(own, diagnostic);
                located.map(problem).collect()
            }
        }
    }

    /// First broken invariant of the program itself, if that is the cause.
    #[must_use]
    pub fn internal(&self) -> Option<&InternalError> {
        match self {
            Self::Description { diagnostics, .. } => diagnostics.internal(),
            Self::Problems(_) => None,
            Self::Several(all) => all.iter().find_map(Self::internal),
        }
    }

    /// All problems as text, with or without terminal colours.
    #[must_use]
    pub fn render(&self, styled: bool) -> String {
        match self {
            Self::Description {
                source,
                diagnostics,
            } if styled => diagnostics.render_styled(source),
            Self::Description {
                source,
                diagnostics,
            } => diagnostics.render_plain(source),
            Self::Several(all) => {
                let texts: Vec<String> = all.iter().map(|one| one.render(styled)).collect();
                texts.join("\n\n")
            }
            Self::Problems(problems) => {
                let texts: Vec<String> = problems.iter().map(compiler_style).collect();
                texts.join("\n\n")
            }
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Error {}

impl From<Problem> for Error {
    fn from(problem: Problem) -> Self {
        Self::Problems(vec![problem])
    }
}

impl From<overact_identification::Error> for Error {
    fn from(error: overact_identification::Error) -> Self {
        Self::Problems(error.problems)
    }
}

#[cfg(test)]
mod tests {
    use super::{Code, Error, Problem};

    #[test]
    fn problems_are_printed_like_compiler_errors() {
        let problem = Problem::new(Code::MISSING_KEY, "no column")
            .file("log.csv")
            .line(Some(3));
        let error = Error::from(problem.help("name it"));
        let expected = "error[OA103]: no column\n --> log.csv:3\n  = help: name it";
        assert_eq!(error.render(false), expected);
    }
}
