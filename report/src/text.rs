//! Names and sentences of others as they may stand on the page and in a terminal: names come from
//! descriptions, from logs and from the names of files, and must neither end an element nor colour a
//! terminal nor look like another name.
//!
//! The generator leaves out of its comments what is not seen; here it is shown as the replacement
//! character, so that names that differ look different. Both ask [`is_invisible`].

use overact_core::text::is_invisible;

/// The text on one line: what breaks a line becomes a space, what is not seen the replacement character.
pub(crate) fn visible(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        out.push(match c {
            '\n' | '\r' | '\t' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}' => ' ',
            c if is_invisible(c) => '\u{FFFD}',
            c => c,
        });
    }
    out
}

/// A text as it may stand in an element or an attribute of XML.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in visible(text).chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A text of so many characters at most: what is too long loses its middle, since names differ at their
/// ends.
pub(crate) fn fitted(text: &str, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text.to_owned();
    }
    let kept = most.max(3) - 1;
    let (first, last) = (kept.div_ceil(2), kept / 2);
    let begin = text.chars().take(first);
    let end = text.chars().skip(length - last);
    begin.chain(['…']).chain(end).collect()
}

/// The last part of a name that is a path: what tells runs apart in a place with little room.
pub(crate) fn last_part(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::{escape, fitted, last_part, visible};

    #[test]
    fn a_path_is_called_by_its_file() {
        assert_eq!(last_part("logs/a/run.csv"), "run.csv");
        assert_eq!(last_part("loaded 1"), "loaded 1");
    }

    #[test]
    fn no_text_becomes_markup() {
        assert_eq!(
            escape("<script>\"a\" & 'b'\u{0}"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;\u{FFFD}"
        );
    }

    #[test]
    fn a_name_stays_on_its_line_and_turns_nothing() {
        assert_eq!(visible("a\r\nb\u{2028}c"), "a  b c");
        assert_eq!(visible("\u{1b}[31mred"), "\u{FFFD}[31mred");
        assert_eq!(visible("leg\u{202e}1"), "leg\u{FFFD}1");
        assert_ne!(visible("leg\u{200b}1"), visible("leg1"));
        assert_eq!(visible("α₁ — x²"), "α₁ — x²");
    }

    #[test]
    fn a_long_name_keeps_its_ends() {
        assert_eq!(fitted("fs_1_leg1", 9), "fs_1_leg1");
        assert_eq!(fitted("fs_1_shoulder_left", 9), "fs_1…left");
        assert_eq!(fitted("αβγδεζ", 4), "αβ…ζ");
        assert_eq!(fitted("abcdef", 0), "a…f");
    }
}
