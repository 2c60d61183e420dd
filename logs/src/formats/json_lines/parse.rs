//! Parses one object, with numbers that are not finite.

use serde_json::{Deserializer, de::SliceRead};

use super::records::{Fault, Record};

/// Parses an object; numbers that are not finite, which are not JSON, are parsed as strings.
///
/// `take` is called again if there are such numbers.
///
/// # Errors
/// Text that is not JSON.
pub(super) fn parse(
    record: &Record<'_>,
    take: &mut dyn FnMut(&mut Deserializer<SliceRead<'_>>) -> serde_json::Result<()>,
) -> Result<(), Fault> {
    let mut whole = |text: &[u8]| {
        let mut input = Deserializer::from_slice(text);
        take(&mut input)?;
        input.end()
    };
    let Err(error) = whole(record.text) else {
        return Ok(());
    };
    if quoted(record.text).is_some_and(|text| whole(&text).is_ok()) {
        return Ok(());
    }
    let what = error.to_string();
    let what = what.split(" at line ").next().unwrap_or_default();
    Err(Fault {
        line: record.line + error.line().saturating_sub(1),
        what: format!("this is not JSON: {what}, at character {}", error.column()),
        help: Some(if error.is_eof() {
            "write an object for each sample, one per line; if the log was cut off while it was written, delete its last line"
        } else {
            "write an object for each sample, one per line"
        }),
    })
}

/// The text with quotation marks around numbers that are not finite; `None` without any.
fn quoted(text: &[u8]) -> Option<Vec<u8>> {
    let mut quoted = Vec::with_capacity(text.len() + 16);
    let (mut is_text, mut is_escaped, mut has_any) = (false, false, false);
    let mut rest = text;
    while let Some((byte, behind)) = rest.split_first() {
        let is_word = |byte: &u8| byte.is_ascii_alphabetic() || b"+-".contains(byte);
        if !is_text && is_word(byte) {
            let length = rest.iter().take_while(|byte| is_word(byte)).count();
            let (word, behind) = rest.split_at(length);
            let is_infinite = ["nan", "inf", "infinity"].iter().any(|known| {
                let bare = word.strip_prefix(b"-").or_else(|| word.strip_prefix(b"+"));
                bare.unwrap_or(word).eq_ignore_ascii_case(known.as_bytes())
            });
            let mark: &[u8] = if is_infinite { b"\"" } else { b"" };
            has_any |= is_infinite;
            quoted.extend([mark, word, mark].concat());
            rest = behind;
            continue;
        }
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = is_text,
            b'"' => is_text = !is_text,
            _ => {}
        }
        quoted.push(*byte);
        rest = behind;
    }
    has_any.then_some(quoted)
}
