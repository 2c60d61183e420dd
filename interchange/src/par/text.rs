//! Syntax of .par files: keys with a value or a list in braces, and comments.

use crate::files::{Files, Place};
use std::collections::BTreeMap;

/// Values by key in capitals, each with its location.
pub(super) type Entries = BTreeMap<String, (Place, Vec<(String, Place)>)>;

/// Reads the entries; `None` after an error.
pub(super) fn entries(files: &Files, file: usize, text: &str) -> Option<Entries> {
    let bare = without_comments(files, file, text)?;
    let mut entries = Entries::new();
    let mut at = 0;
    while let Some(equals) = bare[at..].find('=').map(|offset| at + offset) {
        let key = bare[at..equals].trim();
        let place = |from: usize, to: usize| Place {
            file,
            span: from..to.max(from + 1).min(bare.len()),
        };
        let start = at + bare[at..equals].find(key).unwrap_or(0);
        let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let behind =
            equals + 1 + (bare[equals + 1..].len() - bare[equals + 1..].trim_start().len());
        let (inside, end) = match bare[behind..].strip_prefix('{') {
            // A brace that opens before one closes belongs to the next key.
            Some(list) => match list
                .find(['{', '}'])
                .filter(|&at| list[at..].starts_with('}'))
            {
                Some(close) => (behind + 1..behind + 1 + close, behind + close + 2),
                None => {
                    let help = "write `}` behind its last value";
                    files.report(&place(behind, behind + 1), "a list is not closed", help);
                    return None;
                }
            },
            None => {
                let end = behind + bare[behind..].find('\n').unwrap_or(bare[behind..].len());
                (behind..end, end)
            }
        };
        if !is_key {
            files.report(
                &place(start, equals),
                "this is not a key",
                "write KEY = value, or KEY = {value, value}",
            );
            return None;
        }
        let values = parts(&bare[inside.clone()]).into_iter().map(|(from, to)| {
            let (from, to) = (inside.start + from, inside.start + to);
            (bare[from..to].to_owned(), place(from, to))
        });
        let entry = (place(start, equals), values.collect());
        if entries.insert(key.to_ascii_uppercase(), entry).is_some() {
            files.report(
                &place(start, equals),
                format!("`{key}` occurs twice"),
                "keep one of them",
            );
            return None;
        }
        at = end;
    }
    if !bare[at..].trim().is_empty() {
        let from = at + bare[at..].len() - bare[at..].trim_start().len();
        let place = Place {
            file,
            span: from..from + 1,
        };
        files.report(
            &place,
            "this line belongs to no key",
            "write KEY = value, or KEY = {value, value}",
        );
        return None;
    }
    Some(entries)
}

/// The name in `(* Robotname = 'NAME' *)`.
pub(super) fn robot_name(text: &str) -> Option<&str> {
    let behind = text.split("Robotname").nth(1)?;
    let name = behind.split(['\'', '"']).nth(1)?;
    (!name.is_empty() && name.len() < 100 && !name.contains('\n')).then_some(name)
}

/// Replaces comments by blanks, which preserves locations.
fn without_comments(files: &Files, file: usize, text: &str) -> Option<String> {
    let mut bare = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find("(*") {
        bare.push_str(&rest[..start]);
        let Some(length) = rest[start..].find("*)") else {
            let from = text.len() - rest.len() + start;
            let place = Place {
                file,
                span: from..from + 2,
            };
            files.report(&place, "a comment is not closed", "write `*)` behind it");
            return None;
        };
        let comment = &rest[start..start + length + 2];
        bare.extend(
            comment
                .bytes()
                .map(|byte| if byte == b'\n' { '\n' } else { ' ' }),
        );
        rest = &rest[start + length + 2..];
    }
    bare.push_str(rest);
    Some(bare)
}

/// Splits at commas outside parentheses and trims the parts.
fn parts(text: &str) -> Vec<(usize, usize)> {
    let mut ends = vec![];
    let (mut depth, mut from) = (0_i32, 0);
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth <= 0 => {
                ends.push((from, at));
                from = at + 1;
            }
            _ => {}
        }
    }
    ends.push((from, text.len()));
    let trimmed = |(from, to): (usize, usize)| {
        let part = &text[from..to];
        let start = from + part.len() - part.trim_start().len();
        (start, start + part.trim().len())
    };
    ends.into_iter().map(trimmed).collect()
}
