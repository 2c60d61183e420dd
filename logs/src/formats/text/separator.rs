//! Records of a text by a separator, and the detection of the separator.

use csv::{ReaderBuilder, StringRecord, Trim};
use std::borrow::Cow;

use super::{
    BEGINNING,
    cell_values::{is_value, text_of},
    collapsed_blanks::CollapsedBlanks,
};

/// A reader of all records of the text, including a header.
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

/// Records of a text, each with its line.
pub(super) fn records(text: &[u8], separator: u8, comment: u8) -> Vec<(u64, StringRecord)> {
    let builder = builder(separator, comment);
    let mut found = Vec::new();
    let mut take = |reader: &mut dyn Iterator<Item = csv::Result<csv::ByteRecord>>| {
        // Errors of a record are reported when all records are read.
        for record in reader.map_while(Result::ok) {
            let line = record.position().map_or(0, csv::Position::line);
            let cells: Vec<Cow<'_, str>> = record.iter().map(text_of).collect();
            found.push((line, cells.iter().map(AsRef::as_ref).collect()));
        }
    };
    if separator == b' ' {
        let mut reader = builder.from_reader(CollapsedBlanks::new(text, BEGINNING));
        take(&mut reader.byte_records());
    } else {
        let mut reader = builder.from_reader(text);
        take(&mut reader.byte_records());
    }
    found
}

/// Number of cells up to the last non-empty one.
pub(super) fn width(record: &StringRecord) -> usize {
    let filled = |place: &usize| !record[*place].is_empty();
    let last = (0..record.len()).rev().find(filled);
    last.map_or(0, |last| last + 1)
}

/// Detects the column separator of a text.
pub(super) fn separator(text: &[u8], comment: u8) -> u8 {
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
        // Several adjacent tabs align columns, and leave cells without a name.
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
    let whole = last.iter().all(is_value);
    let by_commas = records(text, b',', comment);
    let has_commas = by_commas.last().is_some_and(|(_, record)| record.len() > 1);
    if whole || !has_commas { b' ' } else { b',' }
}
