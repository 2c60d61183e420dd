//! Text files: lines of numbers, separated by commas, semicolons, tabs or blanks.
//!
//! A file is read once when it is opened. This pass checks every cell, counts samples and computes
//! the frequency. Small files are then in memory. The numbers of a large file are in a temporary
//! file, or it is read again, row by row.
//!
//! - `dialect`: separators, decimal commas and names;
//! - `lines`, `cells`: plain lines and their numbers;
//! - `row_diagnostics`: error messages for a row;
//! - `squeeze`: columns separated by several blanks;
//! - `rows`: rows of plain lines, or of records with quotation marks.

mod cells;
mod collapsed_blanks;
mod dialect;
mod lines;
mod row_diagnostics;
mod rows;

use overact::Code;
use std::{
    fmt::Display,
    io::{Read, Seek, SeekFrom},
};

use self::dialect::{BEGINNING, Dialect};
pub(crate) use self::rows::Rows;
use crate::{
    bytes::byte_source::{ByteSource, Opened},
    error::{Error, Problem},
    problems::{Existing, only, unreadable},
};

/// Bytes of one read.
const BUFFER: usize = 1 << 18;

/// A text file and its dialect.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    /// The file as the caller named it.
    file: String,
    medium: ByteSource,
    dialect: Dialect,
}

impl Text {
    /// Opens a text and detects its dialect.
    ///
    /// # Errors
    /// A file that cannot be read, or an ambiguous one.
    pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Self, Error> {
        let input = medium.open().map_err(|error| unreadable(&file, &error))?;
        let mut beginning = Vec::new();
        input
            .take(BEGINNING as u64)
            .read_to_end(&mut beginning)
            .map_err(|error| unreadable(&file, &error))?;
        let dialect = Dialect::of(&file, &beginning, beginning.len() < BEGINNING)?;
        Ok(Self {
            file,
            medium: medium.clone(),
            dialect,
        })
    }

    /// The file as the caller named it.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// Number of columns.
    pub(crate) const fn columns(&self) -> usize {
        self.dialect.columns
    }

    /// Index of the column with this name.
    ///
    /// # Errors
    /// Two columns with this name.
    pub(crate) fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let names = self.dialect.names.iter().map(String::as_str);
        only(&self.file, name, names)
    }

    /// The existing columns.
    pub(crate) fn existing(&self) -> Existing<'_> {
        let names = self.dialect.names.iter().map(String::as_str);
        Existing {
            names: names.filter(|name| !name.is_empty()).collect(),
            columns: self.columns(),
            what: "column",
        }
    }

    /// Reads some columns from the first row on; the names are for messages.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub(crate) fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Rows<'a>, Error> {
        let data = self.data();
        let (input, bytes) = data.map_err(|error| unreadable(&self.file, &error))?;
        Rows::new(self, wanted, input, bytes)
    }

    /// The file after its byte order mark, and the length of that mark.
    fn data(&self) -> std::io::Result<(Opened, u64)> {
        let mut file = self.medium.open()?;
        let mut start = Vec::new();
        file.by_ref().take(3).read_to_end(&mut start)?;
        let mark = start.len() - dialect::without_mark(&start).len();
        file.seek(SeekFrom::Start(mark as u64))?;
        Ok((file, mark as u64))
    }

    /// The problem of a broken text, with its line if known.
    fn broken(&self, error: &dyn Display, line: Option<usize>) -> Problem {
        let message = format!("the text can't be read: {error}");
        let problem = Problem::new(Code::LOG_FORMAT, message).file(self.file.as_str());
        match line {
            Some(line) => problem.line(line),
            None => problem,
        }
    }
}
