//! Durations, for which Parquet has no type.
//!
//! Writers based on Arrow (PyArrow, pandas, Polars) store integers, and the unit in Arrow's own
//! schema, which they add to the file as text. The text is base64 of one Arrow message, a
//! FlatBuffer. Its tables locate their fields by an offset table. Only the path to durations is
//! parsed.

/// Key of the schema in a file.
pub(super) const KEY: &str = "ARROW:schema";

/// Arrow's number for the type of durations.
const DURATION: u8 = 18;

/// Duration columns of an Arrow schema with units per second; empty if it cannot be parsed.
pub(super) fn durations(schema: &str) -> Vec<(String, i64)> {
    let found = decode(schema).and_then(|bytes| find(&bytes));
    found.unwrap_or_default()
}

/// Parses the columns of a schema.
fn find(bytes: &[u8]) -> Option<Vec<(String, i64)>> {
    // A marker of four bytes, absent in old files, then the message's length.
    let start = if number(bytes, 0, 4)? == 0xffff_ffff {
        8
    } else {
        4
    };
    let message = Table::at(bytes.get(start..)?, 0)?;
    let columns = message.table(2)?.place(1)?;
    let columns = columns + message.number(columns, 4)?;
    let count = message.number(columns, 4)?;
    let mut found = Vec::new();
    for column in 0..count {
        let place = columns + 4 + 4 * column;
        let column = Table::at(message.bytes, place)?;
        let kind = column.place(2).and_then(|place| message.bytes.get(place));
        if kind != Some(&DURATION) {
            continue;
        }
        // Milliseconds are the default and not stored.
        let unit = match column.table(3)?.place(0) {
            Some(place) => message.number(place, 2)?,
            None => 1,
        };
        let parts = 1000_i64.checked_pow(u32::try_from(unit).ok()?)?;
        found.push((column.text(0)?, parts));
    }
    Some(found)
}

/// A little-endian number.
fn number(bytes: &[u8], place: usize, size: usize) -> Option<usize> {
    let bytes = bytes.get(place..place.checked_add(size)?)?;
    let digits = bytes.iter().rev();
    Some(digits.fold(0, |all, byte| all << 8 | usize::from(*byte)))
}

/// A table of a FlatBuffer.
struct Table<'a> {
    bytes: &'a [u8],
    start: usize,
}

impl<'a> Table<'a> {
    /// The table that the offset at `place` refers to.
    fn at(bytes: &'a [u8], place: usize) -> Option<Self> {
        let start = place.checked_add(number(bytes, place, 4)?)?;
        Some(Self { bytes, start })
    }

    fn number(&self, place: usize, size: usize) -> Option<usize> {
        number(self.bytes, place, size)
    }

    /// Position of a field, unless it is absent.
    fn place(&self, field: usize) -> Option<usize> {
        let back = u32::try_from(self.number(self.start, 4)?).ok()?;
        let back = isize::try_from(back.cast_signed()).ok()?;
        let places = self.start.checked_add_signed(back.checked_neg()?)?;
        let own = 4 + 2 * field;
        if own + 2 > self.number(places, 2)? {
            return None;
        }
        let offset = self.number(places + own, 2)?;
        (offset > 0).then_some(self.start + offset)
    }

    /// The table in a field.
    fn table(&self, field: usize) -> Option<Self> {
        Self::at(self.bytes, self.place(field)?)
    }

    /// The text in a field.
    fn text(&self, field: usize) -> Option<String> {
        let place = self.place(field)?;
        let place = place.checked_add(self.number(place, 4)?)?;
        let start = place + 4;
        let end = start.checked_add(self.number(place, 4)?)?;
        String::from_utf8(self.bytes.get(start..end)?.to_vec()).ok()
    }
}

/// Decodes base64.
fn decode(text: &str) -> Option<Vec<u8>> {
    let (mut bytes, mut bits, mut count) = (Vec::new(), 0_u32, 0);
    for letter in text.bytes().filter(|letter| *letter != b'=') {
        let digit = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(digit);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    Some(bytes)
}
