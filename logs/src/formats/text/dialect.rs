//! Detects the dialect of a text: separator, decimal comma, header.
//!
//! The start of the file determines it. Ambiguous texts are an error.
//!
//! Semicolons and tabs always separate. Commas separate, unless blanks separate numbers with
//! decimal commas. A first line of words above a line of numbers is a header. A comment with as
//! many words as columns above numeric lines names the columns, too.

use csv::StringRecord;
use overact::Code;

use super::{
    cell_values::{is_instant, is_number, text_of},
    groups,
    preamble::Preamble,
    separator::{records, separator, width},
};
use crate::{
    error::{Error, Problem},
    formats::instant::Instant,
    problems::shown,
};

/// Dialect of a text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dialect {
    /// Column separator; a blank also means several blanks, and tabs.
    pub(super) separator: u8,
    /// Start of comment lines.
    pub(super) comment: u8,
    /// Whether the decimal separator is a comma.
    pub(super) decimal_comma: bool,
    /// Whether the first line that is no comment is a header.
    pub(super) has_header: bool,
    /// Names of the columns, if they have any.
    pub(super) names: Vec<String>,
    /// Number of columns.
    pub(super) columns: usize,
    /// Largest number of cells in a line: those of the first line, including empty ones.
    pub(super) most: usize,
    /// Lines before the first line to be read, and their bytes: those of a preamble.
    pub(super) skipped_lines: usize,
    pub(super) skipped_bytes: usize,
    /// Columns of dates or times of day.
    pub(super) instants: Vec<usize>,
    /// Day of the first date, in days since 1970.
    pub(super) first_day: Option<i64>,
    /// Columns that have numbers in the same rows, if there are several such groups.
    pub(super) groups: Vec<Vec<usize>>,
}

impl Dialect {
    /// Detects the dialect from the `beginning` of a text, which is all of it if `is_whole`.
    ///
    /// # Errors
    /// Commas of ambiguous meaning, or lines with more columns than names.
    pub(super) fn of(file: &str, beginning: &[u8], is_whole: bool) -> Result<Self, Error> {
        let text = without_mark(beginning);
        let whole_lines = text.iter().rposition(|byte| *byte == b'\n');
        let text = match whole_lines {
            Some(end) if !is_whole => &text[..=end],
            _ => text,
        };
        let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
        let comment = if first == Some(&b'%') { b'%' } else { b'#' };
        let preamble = Preamble::of(text, comment);
        let text = &text[preamble.bytes..];
        let separator = preamble
            .separator
            .unwrap_or_else(|| separator(text, comment));
        let records = records(text, separator, comment);
        let decimal_comma = decimal_comma(file, separator, &records, preamble.lines)?;
        let is_value = |cell: &str| is_number(cell, decimal_comma) || is_instant(cell);
        let has_header = has_header(&records, &is_value);
        let columns = records.first().map_or(0, |(_, first)| width(first));
        let mut dialect = Self {
            separator,
            comment,
            decimal_comma,
            has_header,
            names: Vec::new(),
            columns,
            most: records.first().map_or(0, |(_, first)| first.len()),
            skipped_lines: preamble.lines,
            skipped_bytes: preamble.bytes,
            instants: Vec::new(),
            first_day: None,
            groups: Vec::new(),
        };
        let samples = records.iter().skip(usize::from(has_header));
        dialect.groups = groups::of(samples.map(|(_, cells)| cells), dialect.most);
        if has_header {
            let (_, header) = &records[0];
            dialect.names = header.iter().map(str::to_owned).collect();
            if let Some((line, second)) = records.get(1)
                && width(second) > dialect.most
            {
                let line = preamble.lines + *line as usize;
                return Err(dialect.wider(file, line, width(second)).into());
            }
        } else if preamble.names.is_empty() {
            dialect.names = names_in_comments(text, &dialect, &is_value);
        }
        if let Some((_, first)) = records.get(usize::from(has_header)) {
            dialect.find_instants(first);
        }
        Ok(dialect.named_by(&preamble))
    }

    /// Applies the names of a preamble.
    fn named_by(mut self, preamble: &Preamble) -> Self {
        if !preamble.names.is_empty() {
            self.most = self.most.max(preamble.names.len());
            self.columns = self.columns.max(preamble.names.len().min(self.most));
            self.names.clone_from(&preamble.names);
        }
        self
    }

    /// Finds the columns of dates and times of day by the first sample.
    fn find_instants(&mut self, first: &StringRecord) {
        for (column, cell) in first.iter().enumerate() {
            if is_number(cell, self.decimal_comma) {
                continue;
            }
            if let Some(instant) = Instant::parse(cell) {
                self.instants.push(column);
                self.first_day = self.first_day.or(instant.day);
            }
        }
    }

    /// The problem of a line with more cells than the first one.
    pub(super) fn wider(&self, file: &str, line: usize, cells: usize) -> Problem {
        let names = self.most;
        let message = if self.has_header {
            format!("the line has {cells} columns, but the header names {names}")
        } else {
            format!("the line has {cells} columns, but the first one has {names}")
        };
        let problem = Problem::new(Code::LOG_SHAPE, message).file(file).line(line);
        problem.help(match (self.separator, self.has_header) {
            (b',', _) => {
                "if commas are decimal marks, separate the columns by semicolons or tabs; otherwise name every column"
            }
            (_, false) => "give every line the same columns",
            (b' ', true) => {
                "name every column, without blanks in the names, or separate them by semicolons"
            }
            (_, true) => "name every column",
        })
    }
}

/// The text without its byte order mark.
pub(super) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// Detects a decimal comma; `before` is the number of lines before the records.
///
/// # Errors
/// Both commas and points as decimal separators.
fn decimal_comma(
    file: &str,
    separator: u8,
    records: &[(u64, StringRecord)],
    before: usize,
) -> Result<bool, Error> {
    let cells = |mark: char| {
        records.iter().find_map(|(line, record)| {
            let mut cells = record.iter();
            let has = |cell: &&str| cell.contains(mark) && is_number(cell, true);
            cells.find(has).map(|cell| (*line, cell))
        })
    };
    match (cells(','), cells('.')) {
        (Some((line, comma)), Some((_, point))) => {
            let message = format!(
                "`{}` has a comma where `{}` has a decimal point",
                shown(comma),
                shown(point)
            );
            let problem = Problem::new(Code::NOT_A_NUMBER, message)
                .file(file)
                .line(before + line as usize);
            let help = if separator == b',' {
                "use decimal points, and no quotation marks"
            } else {
                "use decimal points or decimal commas throughout, and no mark between thousands"
            };
            Err(problem.help(help).into())
        }
        (comma, _) => Ok(comma.is_some()),
    }
}

/// Whether the first record is a header: words above numbers.
fn has_header(records: &[(u64, StringRecord)], is_value: &dyn Fn(&str) -> bool) -> bool {
    let Some((_, first)) = records.first() else {
        return false;
    };
    let is_word = |cell: &str| !cell.is_empty() && !is_value(cell);
    match records.get(1) {
        Some((_, second)) => {
            let mut pairs = first.iter().zip(second.iter());
            let all_words = first.iter().all(|cell| !is_value(cell));
            all_words || pairs.any(|(above, below)| is_word(above) && is_value(below))
        }
        None => first.iter().any(is_word),
    }
}

/// Names from the last comment before the numbers that has as many words as columns.
fn names_in_comments(
    text: &[u8],
    dialect: &Dialect,
    is_value: &dyn Fn(&str) -> bool,
) -> Vec<String> {
    let text = text_of(text);
    let lines = text.lines().map(str::trim);
    let marks = [char::from(dialect.comment), ' ', '\t'];
    let comments = lines
        .take_while(|line| line.is_empty() || line.starts_with(marks[0]))
        .map(|line| line.trim_start_matches(marks));
    let split = |line: &str| -> Option<Vec<String>> {
        [b';', b',', dialect.separator, b' ']
            .into_iter()
            .find_map(|separator| {
                let all = records(line.as_bytes(), separator, 0);
                let (_, record) = all.first()?;
                let fits = record.len() == dialect.columns
                    && record
                        .iter()
                        .all(|cell| !cell.is_empty() && !is_value(cell));
                fits.then(|| record.iter().map(str::to_owned).collect())
            })
    };
    comments.filter_map(split).last().unwrap_or_default()
}
