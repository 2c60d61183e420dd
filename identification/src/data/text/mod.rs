//! Text: lines of numbers, separated by commas, semicolons, tabs or blanks, with or without names.
//!
//! A file is looked through once, from end to end, when it is opened: every cell is checked, samples
//! are counted and the frequency is told. A small one is in memory then; a large one is read again,
//! row by row, whenever its run is gone through.

mod dialect;
mod squeeze;

use overact::Code;
use std::io::{Read, Seek, SeekFrom};

use csv::{ByteRecord, Trim};

use self::{
    dialect::{BEGINNING, Dialect},
    squeeze::Squeeze,
};
use super::{
    medium::{Medium, Opened},
    problems::{Existing, only, shown, unreadable},
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
        let dialect = &self.dialect;
        let input = self
            .data()
            .map_err(|error| unreadable(&self.file, &error))?;
        let mut rows = Rows {
            text: self,
            wanted: wanted.to_vec(),
            reader: Dialect::builder(dialect.separator, dialect.comment)
                // Only cells that are read are trimmed.
                .trim(Trim::None)
                .buffer_capacity(BUFFER)
                .from_reader(input),
            record: ByteRecord::new(),
            line: 0,
            is_broken: false,
        };
        if dialect.has_header {
            rows.advance()?;
        }
        Ok(rows)
    }

    /// The file behind the mark of its encoding, if it has one.
    fn data(&self) -> std::io::Result<Input> {
        let mut file = self.medium.open()?;
        let mut start = Vec::new();
        file.by_ref().take(3).read_to_end(&mut start)?;
        let mark = start.len() - dialect::without_mark(&start).len();
        file.seek(SeekFrom::Start(mark as u64))?;
        Ok(match self.dialect.separator {
            b' ' => Input::Blanks(Squeeze::new(file, BUFFER)),
            _ => Input::Plain(file),
        })
    }

    /// A text that is not one.
    fn broken(&self, error: &csv::Error) -> Problem {
        let line = error.position().map(|position| position.line() as usize);
        let message = format!("the text can't be read: {error}");
        let problem = Problem::new(Code::LOG_FORMAT, message).file(self.file.as_str());
        match line {
            Some(line) => problem.line(line),
            None => problem,
        }
    }
}

/// Where a text comes from.
#[derive(Debug)]
enum Input {
    Plain(Opened),
    Blanks(Squeeze<Opened>),
}

impl Read for Input {
    fn read(&mut self, output: &mut [u8]) -> std::io::Result<usize> {
        match self {
            Self::Plain(file) => file.read(output),
            Self::Blanks(squeezed) => squeezed.read(output),
        }
    }
}

/// The rows of a text that is being read.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    text: &'a Text,
    /// Places and names of the columns that are read.
    wanted: Vec<(usize, &'a str)>,
    reader: csv::Reader<Input>,
    record: ByteRecord,
    /// Line of the last row in the file.
    line: usize,
    /// Whether nothing more can be read.
    is_broken: bool,
}

impl Rows<'_> {
    /// Line of the last row.
    pub(super) const fn line(&self) -> usize {
        self.line
    }

    /// Whether nothing more can be read.
    pub(super) const fn is_broken(&self) -> bool {
        self.is_broken
    }

    /// Bytes that have been read.
    pub(super) fn bytes(&self) -> u64 {
        self.reader.position().byte()
    }

    /// Goes to the next record; `false` at the end.
    fn advance(&mut self) -> Result<bool, Error> {
        match self.reader.read_byte_record(&mut self.record) {
            Ok(true) => {}
            Ok(false) => return Ok(false),
            Err(error) => {
                self.is_broken = true;
                return Err(self.text.broken(&error).into());
            }
        }
        // The record's own position is before comments and empty lines that precede it; the
        // reader's is behind its line break, if it has one.
        let before = self.record.position().map_or(0, csv::Position::line);
        let behind = self.reader.position().line().saturating_sub(1);
        self.line = before.max(behind) as usize;
        Ok(true)
    }

    /// Puts the numbers of the next row into `values`; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, or a file that can't be read on.
    pub(super) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        if !self.advance()? {
            return Ok(false);
        }
        let decimal_comma = self.text.dialect.decimal_comma;
        let mut problems = Vec::new();
        for (&(place, name), value) in self.wanted.iter().zip(values) {
            match number(self.record.get(place), decimal_comma) {
                Ok(found) => *value = found,
                Err(message) => {
                    *value = f64::NAN;
                    problems.push(
                        Problem::new(Code::NOT_A_NUMBER, format!("column `{name}`: {message}"))
                            .file(self.text.file.as_str())
                            .line(self.line)
                            .column(name),
                    );
                }
            }
        }
        Error::check(problems)?;
        Ok(true)
    }
}

/// A cell as a finite number, or what is wrong with it.
fn number(cell: Option<&[u8]>, decimal_comma: bool) -> Result<f64, String> {
    let Some(cell) = cell else {
        return Err(String::from("the line ends before this column"));
    };
    let text = String::from_utf8_lossy(cell.trim_ascii());
    match dialect::parse(&text, decimal_comma) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(format!("`{}` is not a finite number", shown(&text))),
        None if text.is_empty() => Err(String::from("the cell is empty")),
        None => Err(format!("`{}` is not a number", shown(&text))),
    }
}
