//! One file as a table of columns, whatever its format.

use std::path::Path;

use super::{
    arrays::{self, Arrays},
    format::{self, Format},
    mat_file,
    problems::display_name,
    text::{self, Text},
};
use crate::error::{Error, Problem};

/// A file that has been opened.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Table {
    /// Lines of numbers, which are read again and again.
    Text(Text),
    /// Arrays in memory.
    Arrays(Arrays),
}

impl Table {
    /// Opens a file, whatever its format.
    ///
    /// # Errors
    /// A file that can't be read, or whose format isn't.
    pub(super) fn open(path: &Path) -> Result<Self, Error> {
        let file = display_name(path);
        Ok(match format::recognise(&file, path)? {
            Format::Text => Self::Text(Text::open(file, path)?),
            Format::Mat => Self::Arrays(mat_file::open(file, path)?),
        })
    }

    /// The file as the caller named it.
    pub(super) fn file(&self) -> &str {
        match self {
            Self::Text(text) => text.file(),
            Self::Arrays(arrays) => arrays.file(),
        }
    }

    /// Whether the numbers are in memory already.
    pub(super) const fn in_memory(&self) -> bool {
        matches!(self, Self::Arrays(_))
    }

    /// The place of a column by its name, or by its number: `$1` is the first one.
    ///
    /// # Errors
    /// Several columns of this name.
    pub(super) fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let (named, columns) = match self {
            Self::Text(text) => (text.find(name)?, text.columns()),
            Self::Arrays(arrays) => (arrays.find(name), arrays.columns()),
        };
        let number = name
            .strip_prefix('$')
            .and_then(|number| number.parse::<usize>().ok());
        let numbered = number
            .and_then(|number| number.checked_sub(1))
            .filter(|place| *place < columns);
        Ok(named.or(numbered))
    }

    /// The values of a variable that may be a single number.
    pub(super) fn variable(&self, name: &str) -> Option<&[f64]> {
        match self {
            Self::Text(_) => None,
            Self::Arrays(arrays) => arrays.scalar(name),
        }
    }

    /// What is said of columns that are not there.
    pub(super) fn missing(&self, missing: &[&str]) -> Problem {
        match self {
            Self::Text(text) => text.missing(missing),
            Self::Arrays(arrays) => arrays.missing(missing, "variable"),
        }
    }

    /// What is said of a gain that is not there.
    pub(super) fn missing_gain(&self, name: &str) -> Problem {
        match self {
            Self::Text(text) => Problem::new(format!(
                "the torque gain is the variable `{name}`, but a text has no variables"
            ))
            .file(text.file())
            .column(name)
            .help("give the gain as a number"),
            Self::Arrays(arrays) => arrays.missing(&[name], "scalar variable"),
        }
    }

    /// Goes through some columns, whose names are for messages, from the first sample on.
    ///
    /// # Errors
    /// A file that can't be read any more, or columns of different lengths.
    pub(super) fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Rows<'a>, Error> {
        Ok(match self {
            Self::Text(text) => Rows::Text(text.rows(wanted)?),
            Self::Arrays(arrays) => Rows::Arrays(arrays.rows(wanted)?),
        })
    }
}

/// The rest of a table.
#[derive(Debug)]
pub(super) enum Rows<'a> {
    Text(text::Rows<'a>),
    Arrays(arrays::Rows<'a>),
}

impl Rows<'_> {
    /// Puts the numbers of the next sample into `values`; `false` at the end.
    ///
    /// # Errors
    /// Numbers that are not finite, or a file that can't be read on.
    pub(super) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        match self {
            Self::Text(rows) => rows.next(values),
            Self::Arrays(rows) => rows.next(values),
        }
    }

    /// Line of the last sample, where the file has lines.
    pub(super) const fn line(&self) -> Option<usize> {
        match self {
            Self::Text(rows) => Some(rows.line()),
            Self::Arrays(_) => None,
        }
    }

    /// Whether nothing more can be read.
    pub(super) const fn is_broken(&self) -> bool {
        match self {
            Self::Text(rows) => rows.is_broken(),
            Self::Arrays(_) => false,
        }
    }

    /// Bytes of the file that have been read.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Text(rows) => rows.bytes(),
            Self::Arrays(_) => 0,
        }
    }
}
