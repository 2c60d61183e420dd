//! Errors: all problems at once, each with location and advice.

use overact_codegen::diagnostic::{Code, Diagnostic};
use overact_codegen::diagnostic::{Diagnostics, InternalError, Located, Source, visible};
use serde::{Serialize, Serializer};
use std::fmt;

/// Serialises a code as its text.
fn as_text<S: Serializer>(code: &Code, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(code)
}

/// One problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Problem {
    /// Code under which the problem is explained.
    #[serde(serialize_with = "as_text")]
    pub code: Code,
    /// Message of one sentence.
    pub message: String,
    /// File name as the user gave it.
    pub file: Option<String>,
    /// Line, counted from 1.
    pub line: Option<usize>,
    /// Position in the line.
    pub column: Option<Column>,
    /// Advice.
    pub help: Option<String>,
}

/// Position in a line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Column {
    /// Number of a character in a text, counted from 1.
    Number(usize),
    /// Name of a column of a table.
    Name(String),
}

impl Problem {
    /// Problem without a location.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            code,
            message,
            file: None,
            line: None,
            column: None,
            help: None,
        }
    }

    /// Sets the file.
    #[must_use]
    pub fn file(self, file: impl Into<String>) -> Self {
        let file = Some(file.into());
        Self { file, ..self }
    }

    /// Sets the line, if there is one.
    #[must_use]
    pub fn line(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// Sets the advice.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        let help = Some(help.into());
        Self { help, ..self }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "error[{}]: {}", self.code, visible(&self.message))?;
        if let Some(file) = &self.file {
            write!(f, "\n --> {}", visible(file))?;
            if let Some(line) = self.line {
                write!(f, ":{line}")?;
            }
            if let Some(Column::Number(column)) = &self.column {
                write!(f, ":{column}")?;
            }
        }
        if let Some(help) = &self.help {
            write!(f, "\n  = help: {}", visible(help))?;
        }
        Ok(())
    }
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
                let problem = |(l, d): (Located, &Diagnostic)| Problem {
                    code: d.code,
                    message: l.message,
                    file: Some(l.file),
                    line: l.line,
                    column: l.column.map(Column::Number),
                    help: l.help,
                };
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
                let texts: Vec<String> = problems.iter().map(Problem::to_string).collect();
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

/// Converts an internal error to a problem without a location.
impl From<&InternalError> for Problem {
    fn from(error: &InternalError) -> Self {
        Self::new(Code::INTERNAL, error.to_string()).help(InternalError::HELP)
    }
}

impl From<Problem> for Error {
    fn from(problem: Problem) -> Self {
        Self::Problems(vec![problem])
    }
}

impl From<overact_identification::Error> for Error {
    fn from(error: overact_identification::Error) -> Self {
        let problem = |p: overact_identification::Problem| Problem {
            code: p.code,
            message: p.message,
            file: p.file,
            line: p.line,
            column: p.column.map(Column::Name),
            help: p.help,
        };
        Self::Problems(error.problems.into_iter().map(problem).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{Code, Error, Problem};

    #[test]
    fn a_problem_reads_like_a_compiler_error() {
        let problem = Problem::new(Code::MISSING_KEY, "no column")
            .file("log.csv")
            .line(Some(3));
        let error = Error::from(problem.help("name it"));
        let expected = "error[OA103]: no column\n --> log.csv:3\n  = help: name it";
        assert_eq!(error.render(false), expected);
    }
}
