//! Problems of descriptions, logs, settings and their fit to a robot.
//!
//! Every problem has a location and, if there is one, a remedy. Problems that can be found together
//! are reported together.

use std::fmt;

use overact::Code;
use serde::{Serialize, Serializer};

/// Serialises a code as its text.
fn as_text<S: Serializer>(code: &Code, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(code)
}

/// One problem.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Problem {
    /// Code of the problem, under which it is explained.
    #[serde(serialize_with = "as_text")]
    pub code: Code,
    /// Message, in one sentence.
    pub message: String,
    /// File as the user named it, or name of the run.
    pub file: Option<String>,
    /// Line of the file, counted from 1 (the header of a CSV file is line 1).
    pub line: Option<usize>,
    /// Column of a table, or place in the line of a text.
    pub column: Option<Column>,
    /// Remedy.
    pub help: Option<String>,
}

/// A column: of a table, or of a text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Column {
    /// Number of a character in its line, counted from 1.
    Number(usize),
    /// Name of a column or variable of a table.
    Name(String),
}

impl Problem {
    /// A problem without a location.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            file: None,
            line: None,
            column: None,
            help: None,
        }
    }

    /// Sets the file or run.
    #[must_use]
    pub fn file(mut self, file: impl Into<String>) -> Self {
        self.file = Some(file.into());
        self
    }

    /// Sets the line, if there is one.
    #[must_use]
    pub fn line(mut self, line: impl Into<Option<usize>>) -> Self {
        self.line = line.into();
        self
    }

    /// Sets the column or variable of a table.
    #[must_use]
    pub fn column(mut self, column: impl Into<String>) -> Self {
        self.column = Some(Column::Name(column.into()));
        self
    }

    /// Name of the column or variable of a table.
    #[must_use]
    pub fn column_name(&self) -> Option<&str> {
        match &self.column {
            Some(Column::Name(name)) => Some(name),
            Some(Column::Number(_)) | None => None,
        }
    }

    /// Sets the remedy.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}")?;
            if let Some(line) = self.line {
                write!(f, ":{line}")?;
            }
            write!(f, ": ")?;
        }
        write!(f, "{}", self.message)?;
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

/// One or more problems found together.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Error {
    /// Problems in the order in which they were found; at least one.
    #[serde(rename = "errors")]
    pub problems: Vec<Problem>,
}

impl Error {
    /// `Ok` if there is no problem.
    pub fn check(problems: Vec<Problem>) -> Result<(), Self> {
        if problems.is_empty() {
            Ok(())
        } else {
            Err(Self { problems })
        }
    }
}

impl From<Vec<Problem>> for Error {
    fn from(problems: Vec<Problem>) -> Self {
        Self { problems }
    }
}

impl From<Problem> for Error {
    fn from(problem: Problem) -> Self {
        Self {
            problems: vec![problem],
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// The `candidates` entry nearest to `name`, if it is near enough for a typing error.
#[must_use]
pub fn suggestion<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, _)| *distance <= name.chars().count().div_ceil(2).min(3))
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance, ignoring case.
fn edit_distance(a: &str, b: &str) -> usize {
    strsim::levenshtein(&a.to_lowercase(), &b.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::{edit_distance, suggestion};

    #[test]
    fn edit_distances_ignore_case_and_give_suggestions() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
        assert_eq!(edit_distance("Time", "time"), 0);
        assert_eq!(
            suggestion("q_leg1", ["time", "q_leg_1", "tau"]),
            Some("q_leg_1")
        );
        assert_eq!(suggestion("time", ["velocity"]), None);
    }
}
