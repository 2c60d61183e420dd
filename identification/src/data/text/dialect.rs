//! How a text stands for columns of numbers: what separates them, whether decimals stand behind a comma,
//! where their names are. All of it is told from the beginning of the file, and nothing is guessed where
//! two readings are possible.
//!
//! Semicolons and tabs separate wherever they stand; commas do unless blanks separate numbers that have
//! decimal commas. A first line with words where the second one has numbers names the columns; so does a
//! comment of as many words before lines that are all numbers.

use csv::{ReaderBuilder, StringRecord, Trim};
use overact::Code;

use super::squeeze::Squeeze;
use crate::{
    data::problems::shown,
    error::{Error, Problem},
};

/// Bytes of the beginning from which the dialect is told.
pub(super) const BEGINNING: usize = 1 << 16;

/// How a text stands for columns of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dialect {
    /// What separates the columns; of blanks there may be several, and tabs among them.
    pub(super) separator: u8,
    /// What lines that are no data start with.
    pub(super) comment: u8,
    /// Whether decimals stand behind a comma.
    pub(super) decimal_comma: bool,
    /// Whether the first line that is no comment has the names.
    pub(super) has_header: bool,
    /// Names of the columns, where there are some.
    pub(super) names: Vec<String>,
    /// Number of columns.
    pub(super) columns: usize,
    /// Cells of the first line, empty ones at its end as well: those of others are not more.
    pub(super) most: usize,
}

impl Dialect {
    /// Tells the dialect of a text from its `beginning`, which is all of it where `is_whole`.
    ///
    /// # Errors
    /// Numbers of which nobody knows what a comma in them means, or lines with more columns than there
    /// are names.
    pub(super) fn of(file: &str, beginning: &[u8], is_whole: bool) -> Result<Self, Error> {
        let text = without_mark(beginning);
        let whole_lines = text.iter().rposition(|byte| *byte == b'\n');
        let text = match whole_lines {
            Some(end) if !is_whole => &text[..=end],
            _ => text,
        };
        let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
        let comment = if first == Some(&b'%') { b'%' } else { b'#' };
        let separator = separator(text, comment);
        let records = records(text, separator, comment);
        let decimal_comma = decimal_comma(file, separator, &records)?;
        let is_value = |cell: &str| is_number(cell, decimal_comma);
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
        };
        if has_header {
            let (_, header) = &records[0];
            dialect.names = header.iter().map(str::to_owned).collect();
            if let Some((line, second)) = records.get(1)
                && width(second) > dialect.most
            {
                return Err(dialect.wider(file, *line as usize, width(second)).into());
            }
        } else {
            dialect.names = names_in_comments(text, &dialect, &is_value);
        }
        Ok(dialect)
    }

    /// What is said of a line with more cells than the first one: they would be those of other columns.
    pub(super) fn wider(&self, file: &str, line: usize, cells: usize) -> Problem {
        let names = self.most;
        let message = match self.has_header {
            true => format!("the line has {cells} columns, but the header names {names}"),
            false => format!("the line has {cells} columns, but the first one has {names}"),
        };
        let problem = Problem::new(Code::LOG_SHAPE, message).file(file).line(line);
        problem.help(match (self.separator, self.has_header) {
            (b',', _) => {
                "if decimals stand behind commas, separate the columns by semicolons or tabs; else name every column"
            }
            (_, false) => "give every line the same columns",
            (b' ', true) => {
                "name every column, without blanks in the names, or separate them by semicolons"
            }
            (_, true) => "name every column",
        })
    }

    /// A reader of the text's records, all of them, a header as well.
    pub(super) fn builder(separator: u8, comment: u8) -> ReaderBuilder {
        let mut builder = ReaderBuilder::new();
        builder
            .trim(Trim::All)
            .flexible(true)
            .has_headers(false)
            .comment(Some(comment))
            .delimiter(separator);
        builder
    }
}

/// A cell as a number, if it is one.
pub(super) fn parse(cell: &str, decimal_comma: bool) -> Option<f64> {
    if !decimal_comma || !cell.contains(',') {
        return cell.parse().ok();
    }
    let (whole, decimals) = cell.split_once(',')?;
    // A comma at an end of a number separates it from the next one.
    let inside = whole.ends_with(|c: char| c.is_ascii_digit())
        && decimals.starts_with(|c: char| c.is_ascii_digit());
    inside
        .then(|| cell.replacen(',', ".", 1).parse().ok())
        .flatten()
}

fn is_number(cell: &str, decimal_comma: bool) -> bool {
    parse(cell, decimal_comma).is_some()
}

/// The text without the mark of its encoding.
pub(super) fn without_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// The records of a text, each with its line.
fn records(text: &[u8], separator: u8, comment: u8) -> Vec<(u64, StringRecord)> {
    let builder = Dialect::builder(separator, comment);
    let mut found = Vec::new();
    let mut take = |reader: &mut dyn Iterator<Item = csv::Result<csv::ByteRecord>>| {
        // A record that can't be read is told where all of them are gone through.
        for record in reader.map_while(Result::ok) {
            let line = record.position().map_or(0, csv::Position::line);
            found.push((line, StringRecord::from_byte_record_lossy(record)));
        }
    };
    if separator == b' ' {
        let mut reader = builder.from_reader(Squeeze::new(text, BEGINNING));
        take(&mut reader.byte_records());
    } else {
        let mut reader = builder.from_reader(text);
        take(&mut reader.byte_records());
    }
    found
}

/// Number of cells up to the last one that is not empty.
fn width(record: &StringRecord) -> usize {
    let filled = |place: &usize| !record[*place].is_empty();
    let last = (0..record.len()).rev().find(filled);
    last.map_or(0, |last| last + 1)
}

/// What separates the columns of a text.
fn separator(text: &[u8], comment: u8) -> u8 {
    let splits = |separator: u8| -> bool {
        let all = records(text, separator, comment);
        let ends = [all.first(), all.last()];
        ends.into_iter()
            .flatten()
            .any(|(_, record)| record.len() > 1)
    };
    if splits(b';') {
        return b';';
    }
    if splits(b'\t') {
        // Tabs that only line columns up come in runs, which leave cells without a name.
        let all = records(text, b'\t', comment);
        let gaps = |(_, record): &(u64, StringRecord)| {
            record.iter().take(width(record)).any(str::is_empty)
        };
        if !all.iter().take(2).all(gaps) {
            return b'\t';
        }
        return b' ';
    }
    let by_blanks = records(text, b' ', comment);
    let Some((_, last)) = by_blanks.last().filter(|(_, record)| record.len() > 1) else {
        return b',';
    };
    let whole = last.iter().all(|cell| is_number(cell, true));
    let by_commas = records(text, b',', comment);
    let has_commas = by_commas.last().is_some_and(|(_, record)| record.len() > 1);
    if whole || !has_commas { b' ' } else { b',' }
}

/// Whether decimals stand behind a comma.
///
/// # Errors
/// Both commas and points before decimals.
fn decimal_comma(
    file: &str,
    separator: u8,
    records: &[(u64, StringRecord)],
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
                .line(line as usize);
            let help = if separator == b',' {
                "write all decimals behind points, and without quotation marks"
            } else {
                "write all decimals behind points, or all behind commas, and no mark between thousands"
            };
            Err(problem.help(help).into())
        }
        (comma, _) => Ok(comma.is_some()),
    }
}

/// Whether the first record has the names of the columns: words where the second one has numbers.
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

/// The names in the last comment before the numbers that has as many words as there are columns.
fn names_in_comments(
    text: &[u8],
    dialect: &Dialect,
    is_value: &dyn Fn(&str) -> bool,
) -> Vec<String> {
    let text = String::from_utf8_lossy(text);
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
