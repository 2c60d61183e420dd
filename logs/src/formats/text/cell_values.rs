//! Values of cells: numbers, dates and times of day, in UTF-8 or Latin-1.

use std::borrow::Cow;

use crate::formats::instant::Instant;

/// Parses a cell as a number, if it is one.
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

pub(super) fn is_number(cell: &str, decimal_comma: bool) -> bool {
    parse(cell, decimal_comma).is_some()
}

pub(super) fn is_instant(cell: &str) -> bool {
    Instant::parse(cell).is_some()
}

/// Whether a cell is a number, a date or a time of day.
pub(super) fn is_value(cell: &str) -> bool {
    is_number(cell, true) || is_instant(cell)
}

/// Text in UTF-8, or in Latin-1.
pub(super) fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    str::from_utf8(bytes).map_or_else(
        |_| bytes.iter().map(|byte| char::from(*byte)).collect(),
        Cow::Borrowed,
    )
}
