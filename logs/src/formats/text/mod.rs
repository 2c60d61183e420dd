//! Text files: lines of numbers, separated by commas, semicolons, tabs or blanks.
//!
//! Opening a file reads its first 64 KB and detects the dialect. `run/summary.rs` then reads the file
//! once, to check its cells, count samples and compute the frequency. Small files are kept in
//! memory. The numbers of a large file are written to a temporary file, or it is read again, row by
//! row.
//!
//! - `dialect`: separators, decimal commas and names; `separator`: records by a separator;
//! - `preamble`: lines before the samples; `groups`: columns with cells in the same rows;
//! - `lines`, `cells`: plain lines and their numbers; `cell_values`: numbers, dates and times of day;
//! - `row_diagnostics`: error messages for a row;
//! - `collapsed_blanks`: columns separated by several blanks;
//! - `rows`: rows of plain lines, or of records with quotation marks.

mod cell_values;
mod cells;
mod collapsed_blanks;
mod dialect;
mod groups;
mod lines;
mod preamble;
mod row_diagnostics;
mod rows;
mod separator;

use overact::Code;
use std::{
    fmt::Display,
    io::{Read, Seek, SeekFrom},
};

use self::dialect::Dialect;
use self::rows::Rows;
use crate::{
    bytes::byte_source::{ByteSource, Opened},
    error::{Error, Problem},
    formats::table_file::{RowReader, TableFile},
    problems::{Existing, only, unreadable},
};

/// Bytes at the start of the file that determine the dialect.
const BEGINNING: usize = 1 << 16;

/// Bytes of one read.
const BUFFER: usize = 1 << 18;

/// A text file and its dialect.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    /// The file as the caller named it.
    file: String,
    medium: ByteSource,
    dialect: Dialect,
    /// The group of columns that it has, if the file has several.
    group: Option<Vec<usize>>,
    /// Origin of dates, s since 1970.
    origin: i64,
}

impl Text {
    /// Opens a text and detects its dialect: one table, or one for each group of columns.
    ///
    /// # Errors
    /// A file that cannot be read, or an ambiguous one.
    pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Vec<Self>, Error> {
        let input = medium.open().map_err(|error| unreadable(&file, &error))?;
        let mut beginning = Vec::new();
        input
            .take(BEGINNING as u64)
            .read_to_end(&mut beginning)
            .map_err(|error| unreadable(&file, &error))?;
        let dialect = Dialect::of(&file, &beginning, beginning.len() < BEGINNING)?;
        let whole = Self {
            file,
            medium: medium.clone(),
            origin: 86_400 * dialect.first_day.unwrap_or(0),
            dialect,
            group: None,
        };
        let groups = &whole.dialect.groups;
        let part = |group: &Vec<usize>| Self {
            group: Some(group.clone()),
            ..whole.clone()
        };
        let parts: Vec<Self> = groups.iter().map(part).collect();
        Ok(if parts.is_empty() { vec![whole] } else { parts })
    }

    /// Whether a column is in this table: in its group, or in every row.
    fn has(&self, column: usize) -> bool {
        let mut others = self.dialect.groups.iter();
        self.group
            .as_ref()
            .is_none_or(|own| own.contains(&column) || !others.any(|group| group.contains(&column)))
    }

    /// Whether a row has no cell of the group.
    fn lacks_group<'c>(&self, cells: impl FnOnce() -> Vec<&'c [u8]>) -> bool {
        let Some(group) = &self.group else {
            return false;
        };
        let cells = cells();
        let is_empty = |cell: &&[u8]| cell.trim_ascii().is_empty();
        { group.iter() }.all(|column| cells.get(*column).is_none_or(is_empty))
    }

    /// Names of the columns; empty for those of other groups.
    fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.dialect.names.iter().enumerate();
        names.map(|(column, name)| if self.has(column) { name.as_str() } else { "" })
    }

    /// The file after its byte order mark and its preamble, and their length.
    fn data(&self) -> std::io::Result<(Opened, u64)> {
        let mut file = self.medium.open()?;
        let mut start = Vec::new();
        file.by_ref().take(3).read_to_end(&mut start)?;
        let mark = start.len() - dialect::without_mark(&start).len() + self.dialect.skipped_bytes;
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

impl TableFile for Text {
    fn file(&self) -> &str {
        &self.file
    }

    fn what(&self) -> &'static str {
        "a text"
    }

    fn is_part(&self) -> bool {
        self.group.is_some()
    }

    fn is_empty(&self) -> bool {
        self.dialect.columns == 0
    }

    fn is_slow(&self) -> bool {
        true
    }

    fn columns(&self) -> usize {
        if self.is_part() {
            0
        } else {
            self.dialect.columns
        }
    }

    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        only(&self.file, name, self.names())
    }

    fn origin(&self) -> Option<i64> {
        self.dialect.first_day.map(|_| self.origin)
    }

    fn set_origin(&mut self, origin: i64) {
        self.origin = origin;
    }

    fn note(&self) -> Option<String> {
        let lines = self.dialect.skipped_lines;
        let s = if lines == 1 { " is" } else { "s are" };
        (lines > 0).then(|| format!("the first {lines} line{s} not samples"))
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: self.names().filter(|name| !name.is_empty()).collect(),
            columns: self.columns(),
            what: "column",
        }
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let data = self.data();
        let (input, bytes) = data.map_err(|error| unreadable(&self.file, &error))?;
        Ok(Box::new(Rows::new(self, wanted, input, bytes)?))
    }
}
