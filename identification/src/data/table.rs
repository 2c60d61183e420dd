//! One file as a table of columns, whatever its format.

use std::path::Path;

use super::{
    arrays::{self, Arrays},
    format::{self, Format},
    mat_file, numpy,
    parquet_file::{self, Parquet},
    problems::{Existing, display_name},
    text::{self, Text},
};
use crate::error::{Error, Problem};

/// A file that has been opened.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Table {
    /// Lines of numbers, which are read again and again.
    Text(Text),
    /// Columns that are read again and again, page by page.
    Parquet(Parquet),
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
            Format::Parquet => Self::Parquet(Parquet::open(file, path)?),
            Format::Array => Self::Arrays(numpy::open_array(file, path)?),
            Format::Archive => Self::Arrays(numpy::open_archive(file, path)?),
        })
    }

    /// The file as the caller named it.
    pub(super) fn file(&self) -> &str {
        match self {
            Self::Text(text) => text.file(),
            Self::Parquet(parquet) => parquet.file(),
            Self::Arrays(arrays) => arrays.file(),
        }
    }

    /// Whether the numbers are in memory already.
    pub(super) const fn in_memory(&self) -> bool {
        matches!(self, Self::Arrays(_))
    }

    /// Number of columns.
    pub(super) fn columns(&self) -> usize {
        match self {
            Self::Text(text) => text.columns(),
            Self::Parquet(parquet) => parquet.columns(),
            Self::Arrays(arrays) => arrays.columns(),
        }
    }

    /// The place of a column that is called by its name.
    ///
    /// # Errors
    /// Several columns of this name.
    pub(super) fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        match self {
            Self::Text(text) => text.find(name),
            Self::Parquet(parquet) => parquet.find(name),
            Self::Arrays(arrays) => Ok(arrays.find(name)),
        }
    }

    /// Whether a column can be read as numbers.
    ///
    /// # Errors
    /// What it holds in their place.
    pub(super) fn check(&self, place: usize) -> Result<(), Problem> {
        match self {
            // Cells of a text are looked at one by one; other arrays than those of numbers are left out.
            Self::Text(_) | Self::Arrays(_) => Ok(()),
            Self::Parquet(parquet) => parquet.check(place),
        }
    }

    /// What the instants of a file are counted from, s since 1970, where it has instants.
    pub(super) const fn origin(&self) -> Option<i64> {
        match self {
            Self::Text(_) | Self::Arrays(_) => None,
            Self::Parquet(parquet) => parquet.origin(),
        }
    }

    /// Says what instants are counted from.
    pub(super) fn set_origin(&mut self, origin: i64) {
        if let Self::Parquet(parquet) = self {
            parquet.set_origin(origin);
        }
    }

    /// What a file of this format is called.
    pub(super) const fn what(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Parquet(_) => "a Parquet file",
            Self::Arrays(_) => "a file of arrays",
        }
    }

    /// The values of a variable, which may be a single number; only arrays are variables.
    pub(super) fn variable(&self, name: &str) -> Option<&[f64]> {
        match self {
            Self::Text(_) => None,
            Self::Parquet(_) => None,
            Self::Arrays(arrays) => arrays.values(name),
        }
    }

    /// What columns there are.
    pub(super) fn existing(&self) -> Existing<'_> {
        match self {
            Self::Text(text) => text.existing(),
            Self::Parquet(parquet) => parquet.existing(),
            Self::Arrays(arrays) => arrays.existing(),
        }
    }

    /// The first column of a matrix that is called as if it were a vector.
    pub(super) fn first_column(&self, name: &str) -> Option<&str> {
        match self {
            Self::Text(_) => None,
            Self::Parquet(_) => None,
            Self::Arrays(arrays) => arrays.first_column(name),
        }
    }

    /// Goes through some columns, whose names are for messages, from the first sample on.
    ///
    /// # Errors
    /// A file that can't be read any more, or columns of different lengths.
    pub(super) fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Rows<'a>, Error> {
        Ok(match self {
            Self::Text(text) => Rows::Text(text.rows(wanted)?),
            Self::Parquet(parquet) => Rows::Parquet(parquet.rows(wanted)?),
            Self::Arrays(arrays) => Rows::Arrays(arrays.rows(wanted)?),
        })
    }
}

/// The rest of a table.
#[derive(Debug)]
pub(super) enum Rows<'a> {
    Text(text::Rows<'a>),
    Parquet(parquet_file::Rows<'a>),
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
            Self::Parquet(rows) => rows.next(values),
            Self::Arrays(rows) => rows.next(values),
        }
    }

    /// Line of the last sample, where the file has lines.
    pub(super) const fn line(&self) -> Option<usize> {
        match self {
            Self::Text(rows) => Some(rows.line()),
            Self::Arrays(_) => None,
            Self::Parquet(_) => None,
        }
    }

    /// Whether nothing more can be read.
    pub(super) const fn is_broken(&self) -> bool {
        match self {
            Self::Text(rows) => rows.is_broken(),
            Self::Parquet(rows) => rows.is_broken(),
            Self::Arrays(_) => false,
        }
    }

    /// Bytes of the file that have been read.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Text(rows) => rows.bytes(),
            Self::Parquet(rows) => rows.bytes(),
            Self::Arrays(_) => 0,
        }
    }
}
