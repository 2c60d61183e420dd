//! Makes names and sentences from users safe for page and terminal.
//!
//! Names come from descriptions, logs and file names. They must not end an element, colour a
//! terminal or look like another name. Invisible characters ([`is_invisible`]) are shown as the
//! replacement character, so that different names look different. The generator instead removes
//! them from its comments.

use overact_core::text::is_invisible;

/// Text on one line: line breaks become spaces, invisible characters the replacement character.
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

/// Text escaped for an element or attribute of XML.
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

/// Shortens a text to `most` characters by removing its middle, since names differ at their ends.
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

/// Last component of a path, which distinguishes runs where space is limited.
pub(crate) fn last_part(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::{escape, fitted, last_part, visible};

    #[test]
    fn paths_are_shortened_to_file_names() {
        assert_eq!(last_part("logs/a/run.csv"), "run.csv");
        assert_eq!(last_part("loaded 1"), "loaded 1");
    }

    #[test]
    fn markup_characters_are_escaped() {
        assert_eq!(
            escape("<script>\"a\" & 'b'\u{0}"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;\u{FFFD}"
        );
    }

    #[test]
    fn names_are_printed_without_control_characters() {
        assert_eq!(visible("a\r\nb\u{2028}c"), "a  b c");
        assert_eq!(visible("\u{1b}[31mred"), "\u{FFFD}[31mred");
        assert_eq!(visible("leg\u{202e}1"), "leg\u{FFFD}1");
        assert_ne!(visible("leg\u{200b}1"), visible("leg1"));
        assert_eq!(visible("α₁ — x²"), "α₁ — x²");
    }

    #[test]
    fn long_names_are_shortened_in_the_middle() {
        assert_eq!(fitted("fs_1_leg1", 9), "fs_1_leg1");
        assert_eq!(fitted("fs_1_shoulder_left", 9), "fs_1…left");
        assert_eq!(fitted("αβγδεζ", 4), "αβ…ζ");
        assert_eq!(fitted("abcdef", 0), "a…f");
    }
}
