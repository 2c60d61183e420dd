//! Sanitises text of a description for comments and documentation.
//!
//! A `summary`, a `source` or a file name must neither end a comment nor change how its context is
//! read. So line breaks, invisible characters and those that change the writing direction are
//! removed. In documentation, Markdown syntax is escaped, too.

use overact_core::text::is_invisible;

/// The text on one line: words separated by one space, without invisible characters.
#[must_use]
pub fn plain(text: &str) -> String {
    let visible = |c: &char| !is_invisible(*c);
    let is_break = |c: char| c.is_whitespace() || matches!(c, '\u{2028}' | '\u{2029}');
    let words = text.split(is_break);
    let words = words.map(|word| word.chars().filter(visible).collect::<String>());
    let words: Vec<String> = words.filter(|word| !word.is_empty()).collect();
    words.join(" ")
}

/// The text as part of a documentation comment, with escaped Markdown.
#[must_use]
pub fn documentation(text: &str) -> String {
    let text = plain(text);
    let mut out = String::with_capacity(text.len());
    // A leading digit or mark could begin a list or a heading.
    let number = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    for (at, c) in text.char_indices() {
        let is_mark = matches!(
            c,
            '\\' | '`' | '*' | '[' | ']' | '<' | '>' | '~' | '|' | '&'
        );
        let begins = at == 0 && matches!(c, '#' | '+' | '-' | '=' | '_');
        let numbers = at == number && number > 0 && matches!(c, '.' | ')');
        if is_mark || begins || numbers {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{documentation, plain};

    #[test]
    fn line_breaks_become_single_spaces() {
        for text in [
            "a\nb",
            "a\r\nb",
            "a\rb",
            " a \t b ",
            "a\u{2028}b",
            "a\u{85}b",
            "a\u{b}b",
        ] {
            assert_eq!(plain(text), "a b", "{text:?}");
        }
    }

    #[test]
    fn invisible_characters_are_removed() {
        for hidden in [
            '\u{202e}',
            '\u{2066}',
            '\u{200b}',
            '\u{feff}',
            '\0',
            '\u{7f}',
            '\u{e0041}',
        ] {
            assert_eq!(plain(&format!("a{hidden}b")), "ab", "{hidden:?}");
        }
        assert_eq!(
            plain("α², Γ¹ — Gautier’s 6-UPS"),
            "α², Γ¹ — Gautier’s 6-UPS"
        );
    }

    #[test]
    fn markdown_syntax_is_escaped() {
        assert_eq!(documentation("```\nno code\n```"), r"\`\`\` no code \`\`\`");
        assert_eq!(documentation("~~~"), r"\~\~\~");
        assert_eq!(documentation("see [Vec]"), r"see \[Vec\]");
        assert_eq!(documentation("<b> */ /*"), r"\<b\> \*/ /\*");
        assert_eq!(documentation("# no heading"), r"\# no heading");
        assert_eq!(documentation("12. no list"), r"12\. no list");
        assert_eq!(documentation("- no list"), r"\- no list");
        assert_eq!(documentation("    no code"), "no code");
        assert_eq!(
            documentation("Briot, Krut 2015, sections 5.1"),
            "Briot, Krut 2015, sections 5.1"
        );
    }
}
