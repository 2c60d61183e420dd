//! Parses a row cell by cell to report its errors.

use overact::Code;

use super::{
    Text,
    cell_values::{parse, text_of},
};
use crate::{
    error::{Error, Problem},
    formats::instant::{Instant, Midnights},
    problems::shown,
};

/// Cells of a line of a text.
pub(super) struct Row<'a> {
    pub(super) text: &'a Text,
    pub(super) line: usize,
    pub(super) cells: &'a [&'a [u8]],
}

/// State of the messages on previous rows.
#[derive(Debug)]
pub(super) struct RowDiagnostics {
    /// Whether no row of numbers has been parsed.
    pub(super) is_first: bool,
    /// Whether the help for a cell without a number has been given.
    is_helped: bool,
    /// Times of day of each requested column.
    midnights: Vec<Midnights>,
}

impl RowDiagnostics {
    /// No message yet, for rows of `wanted` columns.
    pub(super) fn new(wanted: usize) -> Self {
        Self {
            is_first: true,
            is_helped: false,
            midnights: vec![Midnights::default(); wanted],
        }
    }

    /// Parses the numbers of a row into `values`.
    ///
    /// # Errors
    /// Every cell that is no finite number; more cells than in other rows.
    pub(super) fn read(
        &mut self,
        row: &Row<'_>,
        wanted: &[(usize, &str)],
        values: &mut [f64],
    ) -> Result<bool, Error> {
        let is_first = std::mem::take(&mut self.is_first);
        row.check_width()?;
        let mut problems = Vec::new();
        let columns = wanted.iter().zip(values).zip(&mut self.midnights);
        for ((&(place, name), value), midnights) in columns {
            match row.value(place, midnights) {
                Ok(found) => *value = found,
                Err(message) => {
                    *value = f64::NAN;
                    let message = format!("column `{name}`: {message}");
                    problems.push(row.problem(message).column(name));
                }
            }
        }
        if !problems.is_empty()
            && problems.len() == wanted.len()
            && let Some(problem) = row.words(is_first)
        {
            problems = vec![problem];
        } else if let Some(first) = problems.first_mut()
            && !std::mem::replace(&mut self.is_helped, true)
        {
            *first = first
                .clone()
                .help("cut the log before or after this line, or fill the gap");
        }
        Error::check(problems)?;
        Ok(true)
    }
}

impl Row<'_> {
    /// The number in a column, or the time of its date or time of day, s.
    fn value(&self, column: usize, midnights: &mut Midnights) -> Result<f64, String> {
        let cell = self.cells.get(column).copied();
        let found = number(cell, self.text.dialect.decimal_comma);
        if found.is_ok() || !self.text.dialect.instants.contains(&column) {
            return found;
        }
        let text = text_of(cell.unwrap_or_default());
        match Instant::parse(text.trim_matches(['"', ' '])) {
            Some(instant) if instant.day.is_some() => Ok(instant.since(self.text.origin)),
            Some(instant) => Ok(midnights.next(instant.seconds)),
            None => found,
        }
    }

    fn problem(&self, message: String) -> Problem {
        let problem = Problem::new(Code::NOT_A_NUMBER, message);
        problem.file(self.text.file.as_str()).line(self.line)
    }

    /// Checks that the row has no more cells than the first one; empty ones do not count.
    fn check_width(&self) -> Result<(), Error> {
        let dialect = &self.text.dialect;
        let beyond = self.cells.iter().enumerate().skip(dialect.most);
        let filled = beyond.filter(|(_, cell)| !cell.trim_ascii().is_empty());
        match filled.map(|(at, _)| at).next_back() {
            Some(last) => {
                let file = self.text.file.as_str();
                Err(dialect.wider(file, self.line, last + 1).into())
            }
            None => Ok(()),
        }
    }

    /// The problem of a line with words instead of numbers: a repeated header, or units.
    fn words(&self, is_first: bool) -> Option<Problem> {
        let dialect = &self.text.dialect;
        let cells = || self.cells.iter().map(|cell| cell.trim_ascii());
        let number = |cell| number(Some(cell), dialect.decimal_comma);
        let is_number = |cell| number(cell).is_ok() || is_infinite(cell);
        let has_words = cells().any(|cell| cell.iter().any(u8::is_ascii_alphabetic));
        if self.cells.len() < 2 || !has_words || cells().any(is_number) {
            return None;
        }
        let is_header = cells().eq(dialect.names.iter().map(String::as_bytes));
        let shown: Vec<String> = cells()
            .filter(|cell| !cell.is_empty())
            .take(3)
            .map(|cell| format!("`{}`", shown(&String::from_utf8_lossy(cell))))
            .collect();
        let words = shown.join(", ");
        let problem = self.problem(match (is_header, is_first) {
            (true, _) => format!("the line repeats the names of the columns: {words}"),
            (false, true) => format!("the line below the names looks like units: {words}"),
            (false, false) => format!("the line has words instead of numbers: {words}"),
        });
        let comment = char::from(dialect.comment);
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

/// Parses a cell as a finite number, or describes its error.
fn number(cell: Option<&[u8]>, decimal_comma: bool) -> Result<f64, String> {
    let Some(cell) = cell else {
        return Err(String::from("the line ends before this column"));
    };
    let text = String::from_utf8_lossy(cell.trim_ascii());
    match parse(&text, decimal_comma) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(format!("`{}` is not a finite number", shown(&text))),
        None if text.is_empty() => Err(String::from("the cell is empty")),
        None => Err(format!("`{}` is not a number", shown(&text))),
    }
}
