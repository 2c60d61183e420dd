//! Text: lines of numbers, separated by commas, semicolons, tabs or blanks, with or without names.
//!
//! A file is looked through once, from end to end, when it is opened: every cell is checked, samples
//! are counted and the frequency is told. A small one is in memory then; a large one is read again,
//! row by row, whenever its run is gone through.

mod dialect;
mod squeeze;

use overact::Code;
use std::{
    fs::File,
    io::{Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

use csv::{ByteRecord, Trim};

use self::{
    dialect::{BEGINNING, Dialect},
    squeeze::Squeeze,
};
use super::problems::{Existing, only, shown, unreadable};
use crate::error::{Error, Problem};

/// Bytes that are read at once.
const BUFFER: usize = 1 << 18;

/// A text and how its columns are told apart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Text {
    /// The file as the caller named it.
    file: String,
    path: PathBuf,
    dialect: Dialect,
}

impl Text {
    /// Looks at the beginning of a text.
    ///
    /// # Errors
    /// A file that can't be read, or that can be read in more than one way.
    pub(super) fn open(file: String, path: &Path) -> Result<Self, Error> {
        let input = File::open(path).map_err(|error| unreadable(&file, &error))?;
        let mut beginning = Vec::new();
        input
            .take(BEGINNING as u64)
            .read_to_end(&mut beginning)
            .map_err(|error| unreadable(&file, &error))?;
        let dialect = Dialect::of(&file, &beginning, beginning.len() < BEGINNING)?;
        Ok(Self {
            file,
            path: path.to_owned(),
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
            is_first: true,
            is_helped: false,
        };
        if dialect.has_header {
            rows.advance()?;
        }
        Ok(rows)
    }

    /// The file behind the mark of its encoding, if it has one.
    fn data(&self) -> std::io::Result<Input> {
        let mut file = File::open(&self.path)?;
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
    Plain(File),
    Blanks(Squeeze<File>),
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
    /// Whether no row of numbers has been looked at.
    is_first: bool,
    /// Whether the way out of a cell without a number has been told.
    is_helped: bool,
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
    /// Every cell of the row that is no finite number, cells that are more than those of other rows, or a
    /// file that can't be read on.
    pub(super) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        if !self.advance()? {
            return Ok(false);
        }
        let is_first = std::mem::take(&mut self.is_first);
        let dialect = &self.text.dialect;
        if self.record.len() > dialect.most {
            let filled = |cell: &usize| !self.record[*cell].trim_ascii().is_empty();
            let last = (dialect.most..self.record.len()).rev().find(filled);
            if let Some(last) = last {
                let file = self.text.file.as_str();
                return Err(dialect.wider(file, self.line, last + 1).into());
            }
        }
        let mut problems = Vec::new();
        for (&(place, name), value) in self.wanted.iter().zip(values) {
            match number(self.record.get(place), dialect.decimal_comma) {
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
        if !problems.is_empty()
            && problems.len() == self.wanted.len()
            && let Some(problem) = self.words(is_first)
        {
            problems = vec![problem];
        } else if let Some(first) = problems.first_mut()
            && !std::mem::replace(&mut self.is_helped, true)
        {
            *first = first.clone().help(
                "cut the log before or after this line, or fill the gap; overact invents no samples",
            );
        }
        Error::check(problems)?;
        Ok(true)
    }

    /// What is said of a line that has words in the place of all its numbers: the header once more, or units
    /// below it.
    fn words(&self, is_first: bool) -> Option<Problem> {
        let cells = || self.record.iter().map(<[u8]>::trim_ascii);
        let number = |cell| number(Some(cell), self.text.dialect.decimal_comma);
        let is_number = |cell| number(cell).is_ok() || is_infinite(cell);
        let has_words = cells().any(|cell| cell.iter().any(u8::is_ascii_alphabetic));
        if self.record.len() < 2 || !has_words || cells().any(is_number) {
            return None;
        }
        let names = self.text.dialect.names.iter().map(String::as_bytes);
        let is_header = cells().eq(names);
        let shown: Vec<String> = cells()
            .filter(|cell| !cell.is_empty())
            .take(3)
            .map(|cell| format!("`{}`", shown(&String::from_utf8_lossy(cell))))
            .collect();
        let words = shown.join(", ");
        let message = match (is_header, is_first) {
            (true, _) => format!("the line repeats the names of the columns: {words}"),
            (false, true) => format!("the line below the names looks like units: {words}"),
            (false, false) => format!("the line has words where numbers are to be: {words}"),
        };
        let problem = Problem::new(Code::NOT_A_NUMBER, message);
        let problem = problem.file(self.text.file.as_str()).line(self.line);
        let comment = char::from(self.text.dialect.comment);
        Some(problem.help(format!(
            "delete the line, or start it with `{comment}`, the sign of a comment"
        )))
    }
}

/// Whether a cell is a word for a number that is not finite.
fn is_infinite(cell: &[u8]) -> bool {
    let text = String::from_utf8_lossy(cell.trim_ascii());
    text.parse::<f64>().is_ok()
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
