//! Text: lines of numbers, separated by commas, semicolons, tabs or blanks, with or without names.
//!
//! A file is looked through once, from end to end, when it is opened: every cell is checked, samples
//! are counted and the frequency is told. A small one is in memory then; the numbers of a large one stand in a
//! temporary file, or it is read again, row by row, whenever its run is gone through.
//!
//! - `dialect`: what separates columns and decimals, and where the names are;
//! - `lines`, `cells`: plain lines and their numbers, where they stand;
//! - `squeeze`: columns apart by any number of blanks;
//! - `rows`: rows of plain lines, or of records with quotation marks.

mod cells;
mod closely;
mod dialect;
mod lines;
mod rows;
mod squeeze;

use overact::Code;
use std::{
    fmt::Display,
    io::{Read, Seek, SeekFrom},
};

use self::dialect::{BEGINNING, Dialect};
pub(super) use self::rows::Rows;
use super::{
    medium::{Medium, Opened},
    problems::{Existing, only, unreadable},
};
use crate::error::{Error, Problem};

/// Bytes that are read at once.
const BUFFER: usize = 1 << 18;

/// A text and how its columns are told apart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Text {
    /// The file as the caller named it.
    file: String,
    medium: Medium,
    dialect: Dialect,
}

impl Text {
    /// Looks at the beginning of a text.
    ///
    /// # Errors
    /// A file that can't be read, or that can be read in more than one way.
    pub(super) fn open(file: String, medium: &Medium) -> Result<Self, Error> {
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
    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// Number of columns.
    pub(super) const fn columns(&self) -> usize {
        self.dialect.columns
    }

    /// The place of a column that is called by its name.
    ///
    /// # Errors
    /// Two columns of one name: nobody knows which one is meant.
    pub(super) fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let names = self.dialect.names.iter().map(String::as_str);
        only(&self.file, name, names)
    }

    /// What columns there are.
    pub(super) fn existing(&self) -> Existing<'_> {
        let names = self.dialect.names.iter().map(String::as_str);
        Existing {
            names: names.filter(|name| !name.is_empty()).collect(),
            columns: self.columns(),
            what: "column",
        }
    }

    /// Goes through some columns, whose names are for messages, from the first row on.
    ///
    /// # Errors
    /// A file that can't be read any more.
    pub(super) fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Rows<'a>, Error> {
        let input = self
            .data()
            .map_err(|error| unreadable(&self.file, &error))?;
        Rows::new(self, wanted, input)
    }

    /// The file behind the mark of its encoding, if it has one, and the length of that.
    fn data(&self) -> std::io::Result<(Opened, u64)> {
        let mut file = self.medium.open()?;
        let mut start = Vec::new();
        file.by_ref().take(3).read_to_end(&mut start)?;
        let mark = start.len() - dialect::without_mark(&start).len();
        file.seek(SeekFrom::Start(mark as u64))?;
        Ok((file, mark as u64))
    }

    /// A text that is not one, from a line on where that is known.
    fn broken(&self, error: &dyn Display, line: Option<usize>) -> Problem {
        let message = format!("the text can't be read: {error}");
        let problem = Problem::new(Code::LOG_FORMAT, message).file(self.file.as_str());
        match line {
            Some(line) => problem.line(line),
            None => problem,
        }
    }
}
