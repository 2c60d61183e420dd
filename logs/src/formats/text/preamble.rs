//! Lines before the samples that are not samples: settings of the recorder, names and units.
//!
//! LabVIEW (`.lvm`) and many test benches write such lines. The samples are the last
//! lines of the beginning whose cells fit the last line. The names of their columns are in the
//! nearest line above with a different word for each column. A text with lines of numbers above
//! these names is not touched, so that a broken line in the middle of samples stays an error.

use super::{
    cell_values::{is_value, text_of},
    separator::separator,
};

/// Largest number of lines between the names and the samples.
const BETWEEN: usize = 40;

/// Units of signals, as written below or next to names.
const UNITS: [&str; 40] = [
    "s", "sec", "ms", "us", "µs", "ns", "min", "h", "rad", "mrad", "deg", "°", "rev", "turns",
    "rad/s", "deg/s", "°/s", "rpm", "1/min", "1/s", "Hz", "m", "mm", "um", "m/s", "mm/s", "N",
    "kN", "Nm", "N m", "N*m", "N·m", "N.m", "mNm", "A", "mA", "V", "mV", "%", "-",
];

/// Lines before the samples.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Preamble {
    /// Separator of columns, if a line `sep=;` gives it.
    pub(super) separator: Option<u8>,
    /// Number of lines before the samples, and their bytes; 0 if a header alone is above them.
    pub(super) lines: usize,
    pub(super) bytes: usize,
    /// Names of the columns, if a line has them.
    pub(super) names: Vec<String>,
}

/// A line with its first byte.
struct Line<'a> {
    start: usize,
    cells: Vec<String>,
    text: &'a [u8],
}

impl Preamble {
    /// The preamble of a text.
    pub(super) fn of(text: &[u8], comment: u8) -> Self {
        let (given, start) = given_separator(text);
        let without = Self {
            separator: given,
            lines: usize::from(start > 0),
            bytes: start,
            names: Vec::new(),
        };
        let separator = given.unwrap_or_else(|| separator(&text[start..], comment));
        let lines = lines(text, start, separator);
        let is_content = |line: &&Line<'_>| {
            !line.text.trim_ascii().is_empty() && !line.text.starts_with(&[comment])
        };
        let content: Vec<&Line<'_>> = lines.iter().filter(is_content).collect();
        let Some((last, above)) = content.split_last() else {
            return without;
        };
        let is_like = |line: &&Line<'_>| is_sample(&line.cells, &last.cells);
        if !is_like(last) || last.cells.len() < 2 {
            return without;
        }
        let samples = 1 + above.iter().rev().take_while(|line| is_like(line)).count();
        let above = &content[..content.len() - samples];
        if above.len() < 2 || above.iter().any(is_like) {
            return without;
        }
        let first = content[above.len()];
        let number = lines
            .iter()
            .take_while(|line| line.start < first.start)
            .count();
        Self {
            lines: number + usize::from(start > 0),
            bytes: first.start,
            names: names(above, &last.cells),
            ..without
        }
    }
}

/// The separator of a first line `sep=;`, as spreadsheets write it, and the bytes of that line.
fn given_separator(text: &[u8]) -> (Option<u8>, usize) {
    let end = text
        .iter()
        .position(|byte| *byte == b'\n')
        .map_or(0, |end| end + 1);
    let line = text[..end].trim_ascii_end();
    let line = line
        .strip_prefix(b"\"")
        .map_or(line, |inner| inner.strip_suffix(b"\"").unwrap_or(inner));
    match line {
        [s, e, p, b'=', separator] if [s, e, p].map(u8::to_ascii_lowercase) == *b"sep" => {
            (Some(*separator), end)
        }
        // A tab at the line's end was trimmed.
        [s, e, p, b'='] if [s, e, p].map(u8::to_ascii_lowercase) == *b"sep" => (Some(b'\t'), end),
        _ => (None, 0),
    }
}

/// Lines of a text from a byte on, split into cells.
fn lines(text: &[u8], start: usize, separator: u8) -> Vec<Line<'_>> {
    let mut at = start;
    let pieces = text[start..].split_inclusive(|byte| *byte == b'\n');
    pieces
        .map(|piece| {
            let own = piece.trim_ascii_end();
            // Empty cells at the end count.
            let own = if separator == b'\t' {
                &piece[..piece.len() - ending(piece)]
            } else {
                own
            };
            let cells = super::cells::split(own, separator).into_iter();
            let line = Line {
                start: at,
                cells: cells
                    .map(|cell| unquoted(&text_of(cell)).to_owned())
                    .collect(),
                text: piece,
            };
            at += piece.len();
            line
        })
        .collect()
}

/// Number of bytes of a line's end.
fn ending(line: &[u8]) -> usize {
    line.iter()
        .rev()
        .take_while(|byte| matches!(byte, b'\r' | b'\n'))
        .count()
}

fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    let inner = cell
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(cell)
}

/// Whether cells are a sample like those of the last line: numbers where it has numbers.
///
/// Cells may be empty, and up to half of them broken, but not the first one, which labels a setting.
fn is_sample(cells: &[String], last: &[String]) -> bool {
    let of_numbers = || cells.iter().zip(last).filter(|(_, last)| is_value(last));
    let numbers = of_numbers().filter(|(cell, _)| is_value(cell)).count();
    let words = of_numbers()
        .filter(|(cell, _)| !cell.is_empty() && !is_value(cell))
        .count();
    let is_label = of_numbers()
        .next()
        .is_some_and(|(cell, _)| !cell.is_empty() && !is_value(cell));
    let is_long = cells.len() >= last.len() || (cells.len() > 1 && numbers == cells.len());
    numbers > words && !is_label && is_long
}

/// Names of columns from the lines above the samples.
///
/// The nearest line of different words; if there is none, one whose words repeat, as those of times.
fn names(above: &[&Line<'_>], last: &[String]) -> Vec<String> {
    let near = above
        .iter()
        .rev()
        .take(BETWEEN)
        .map(|line| filled(&line.cells));
    let are_names = |cells: &&[String]| {
        cells.len() > 1
            && cells.len() >= filled(last).len()
            && cells.iter().all(|cell| !cell.is_empty() && !is_value(cell))
            && !cells.iter().all(|cell| is_unit(cell))
    };
    let differ = |cells: &&[String]| {
        let mut all = cells.iter().enumerate();
        all.all(|(place, cell)| !cells[..place].contains(cell))
    };
    let lines: Vec<&[String]> = near.filter(are_names).collect();
    let found = lines
        .iter()
        .copied()
        .find(differ)
        .or(lines.first().copied());
    found.unwrap_or_default().to_vec()
}

/// Cells up to the last that is not empty.
fn filled(cells: &[String]) -> &[String] {
    let count = cells
        .iter()
        .rposition(|cell| !cell.is_empty())
        .map_or(0, |last| last + 1);
    &cells[..count]
}

/// Whether a cell is a unit, possibly in brackets, or empty.
fn is_unit(cell: &str) -> bool {
    let inner = cell
        .trim()
        .trim_matches(|c| matches!(c, '[' | ']' | '(' | ')' | '"'));
    inner.is_empty() || UNITS.contains(&inner)
}
