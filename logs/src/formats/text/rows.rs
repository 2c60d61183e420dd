//! Rows of a text: plain lines as long as possible, then CSV records.

use csv::{ByteRecord, Trim};
use std::io::{Read, Result as IoResult};

use super::{
    BUFFER, Text, cells,
    collapsed_blanks::CollapsedBlanks,
    dialect::Dialect,
    lines::{Lines, Next, Rest},
    row_diagnostics::{Row, RowDiagnostics},
    separator::builder,
};
use crate::{bytes::byte_source::Opened, error::Error, formats::table_file::RowReader};

/// Remaining rows of a text.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    text: &'a Text,
    /// Indices and names of the requested columns.
    wanted: Vec<(usize, &'a str)>,
    /// Requested columns by increasing index, each with its number in the request.
    order: Vec<(usize, usize)>,
    source: Source,
    /// Line of the last row in the file.
    line: usize,
    /// Whether nothing more can be read.
    is_broken: bool,
    diagnostics: RowDiagnostics,
}

/// Source of the rows.
#[derive(Debug)]
enum Source {
    Lines(Lines),
    Records(Box<Records>),
}

impl<'a> Rows<'a> {
    /// Rows of a file from its position, which is byte number `bytes`, after an optional header.
    pub(super) fn new(
        text: &'a Text,
        wanted: &[(usize, &'a str)],
        input: Opened,
        bytes: u64,
    ) -> Result<Self, Error> {
        let places = wanted.iter().zip(0..);
        let mut order: Vec<(usize, usize)> =
            places.map(|((own, _), place)| (*own, place)).collect();
        order.sort_unstable();
        let mut rows = Self {
            text,
            wanted: wanted.to_vec(),
            order,
            source: Source::Lines(Lines::new(input, bytes, text.dialect.skipped_lines)),
            line: 0,
            is_broken: false,
            diagnostics: RowDiagnostics::new(wanted.len()),
        };
        if text.dialect.has_header {
            rows.pass_header()?;
        }
        Ok(rows)
    }

    /// Skips the header.
    fn pass_header(&mut self) -> Result<(), Error> {
        let Dialect {
            separator, comment, ..
        } = self.text.dialect;
        while let Source::Lines(lines) = &mut self.source {
            match lines.pass_header() {
                Ok(Some(line)) => {
                    let line = inside(lines.line(line), separator);
                    if line.first().is_some_and(|first| *first != comment) {
                        return Ok(());
                    }
                }
                Ok(None) => self.leave_lines()?,
                Err(error) => return Err(self.broken(&error)),
            }
        }
        self.advance().map(|_| ())
    }

    /// Switches to the CSV reader.
    fn leave_lines(&mut self) -> Result<(), Error> {
        if let Source::Lines(lines) = &self.source {
            let (passed, bytes, rest) = (lines.passed(), lines.bytes(), lines.rest());
            let rest = rest.map_err(|error| self.broken(&error))?;
            let records = Records::new(&self.text.dialect, passed, bytes, rest);
            self.source = Source::Records(Box::new(records));
        }
        Ok(())
    }

    /// Reads the next record; `false` at the end.
    fn advance(&mut self) -> Result<bool, Error> {
        let Source::Records(records) = &mut self.source else {
            return Ok(false);
        };
        match records.next() {
            Ok(Some(line)) => {
                self.line = line;
                Ok(true)
            }
            Ok(None) => Ok(false),
            Err(error) => {
                let line = error.position().map(csv::Position::line);
                let line = line.map(|line| records.lines + line as usize);
                self.is_broken = true;
                Err(self.text.broken(&error, line).into())
            }
        }
    }

    /// The error of a file that cannot be read further.
    fn broken(&mut self, error: &std::io::Error) -> Error {
        self.is_broken = true;
        self.text.broken(error, None).into()
    }
}

impl RowReader for Rows<'_> {
    fn line(&self) -> Option<usize> {
        Some(self.line)
    }

    fn is_broken(&self) -> bool {
        self.is_broken
    }

    fn bytes(&self) -> u64 {
        match &self.source {
            Source::Lines(lines) => lines.bytes(),
            Source::Records(records) => records.bytes(),
        }
    }

    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        let Dialect {
            separator,
            comment,
            decimal_comma,
            ..
        } = self.text.dialect;
        while let Source::Lines(lines) = &mut self.source {
            let line = match lines.next() {
                Ok(Next::Line(line)) => lines.line(line),
                Ok(Next::End) => return Ok(false),
                Ok(Next::Unusual) => {
                    self.leave_lines()?;
                    break;
                }
                Err(error) => return Err(self.broken(&error)),
            };
            let line = inside(line, separator);
            if line.first().is_none_or(|first| *first == comment) {
                continue;
            }
            if self.text.lacks_group(|| cells::split(line, separator)) {
                continue;
            }
            self.line = lines.passed();
            let most = self.text.dialect.most;
            if !decimal_comma && cells::read(line, separator, most, &self.order, values) {
                self.diagnostics.is_first = false;
                return Ok(true);
            }
            let cells = cells::split(line, separator);
            let row = Row {
                text: self.text,
                line: self.line,
                cells: &cells,
            };
            return self.diagnostics.read(&row, &self.wanted, values);
        }
        let cells: Vec<&[u8]> = loop {
            if !self.advance()? {
                return Ok(false);
            }
            let Source::Records(records) = &self.source else {
                return Ok(false);
            };
            if !self.text.lacks_group(|| records.record.iter().collect()) {
                break records.record.iter().collect();
            }
        };
        let row = Row {
            text: self.text,
            line: self.line,
            cells: &cells,
        };
        self.diagnostics.read(&row, &self.wanted, values)
    }
}

/// A line without surrounding blanks, if blanks separate columns.
fn inside(line: &[u8], separator: u8) -> &[u8] {
    if separator == b' ' {
        line.trim_ascii()
    } else {
        line
    }
}

/// Source of the records.
#[derive(Debug)]
enum Input {
    Plain(Rest),
    Blanks(CollapsedBlanks<Rest>),
}

impl Read for Input {
    fn read(&mut self, output: &mut [u8]) -> IoResult<usize> {
        match self {
            Self::Plain(file) => file.read(output),
            Self::Blanks(squeezed) => squeezed.read(output),
        }
    }
}

/// Records from a line on.
#[derive(Debug)]
struct Records {
    reader: csv::Reader<Input>,
    record: ByteRecord,
    /// Number of lines before the records, and their bytes.
    lines: usize,
    passed: u64,
}

impl Records {
    fn new(dialect: &Dialect, lines: usize, passed: u64, rest: Rest) -> Self {
        let input = match dialect.separator {
            b' ' => Input::Blanks(CollapsedBlanks::new(rest, BUFFER)),
            _ => Input::Plain(rest),
        };
        Self {
            reader: builder(dialect.separator, dialect.comment)
                // Only requested cells are trimmed.
                .trim(Trim::None)
                .buffer_capacity(BUFFER)
                .from_reader(input),
            record: ByteRecord::new(),
            lines,
            passed,
        }
    }

    /// Number of bytes of the file read.
    fn bytes(&self) -> u64 {
        self.passed + self.reader.position().byte()
    }

    /// Reads the next record and returns its line in the file; `None` at the end.
    fn next(&mut self) -> csv::Result<Option<usize>> {
        if !self.reader.read_byte_record(&mut self.record)? {
            return Ok(None);
        }
        // The record's own position is before preceding comments and empty lines. The reader's
        // position is after its line break, if it has one.
        let before = self.record.position().map_or(0, csv::Position::line);
        let behind = self.reader.position().line().saturating_sub(1);
        Ok(Some(self.lines + before.max(behind) as usize))
    }
}
