//! Lines of a file: safe comments, strings, and line breaks in long expressions.

/// Width of a line.
const WIDTH: usize = 100;

/// Text for a comment, without markers that end or begin one.
#[must_use]
pub fn comment_text(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *")
}

/// A text as a string literal.
#[must_use]
pub fn string(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            // Two question marks could begin a trigraph.
            '?' => out.push_str("\\?"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A comment before a declaration; an empty line separates paragraphs.
#[must_use]
pub fn documentation(paragraphs: &[String]) -> String {
    let mut out = String::from("/**\n");
    for paragraph in paragraphs {
        for line in filled(&comment_text(paragraph), WIDTH - 3) {
            out += format!(" * {line}").trim_end();
            out.push('\n');
        }
    }
    out += " */\n";
    out
}

/// A comment whose lines are not wrapped.
#[must_use]
pub fn verbatim(lines: &[String]) -> String {
    let mut out = String::from("/*\n");
    for line in lines {
        out += format!(" * {}", comment_text(line)).trim_end();
        out.push('\n');
    }
    out += " */\n";
    out
}

/// A line of code without strings, with indented continuation lines.
#[must_use]
pub fn code(indent: usize, text: &str) -> String {
    let mut out = String::new();
    let mut indent = indent;
    for (at, line) in filled(text, WIDTH - indent - 4).iter().enumerate() {
        if at == 1 {
            indent += 4;
        }
        out += &format!("{:indent$}{line}\n", "");
    }
    out
}

/// The words of a text on lines of at most `width` characters; longer words get their own line.
fn filled(text: &str, width: usize) -> Vec<String> {
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split(' ') {
        if line.chars().count() + 1 + word.chars().count() > width && !line.trim().is_empty() {
            lines.push(std::mem::take(&mut line));
        } else if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}

#[cfg(test)]
mod tests {
    use super::{code, documentation, string};

    #[test]
    fn comment_delimiters_in_documentation_are_escaped() {
        let hostile = documentation(&["a */ int x; /* b".to_owned()]);
        assert_eq!(hostile, "/**\n * a * / int x; / * b\n */\n");
    }

    #[test]
    fn string_literals_are_escaped() {
        assert_eq!(string("N m/rad"), "\"N m/rad\"");
        assert_eq!(string("a\"b\\c??/\n"), r#""a\"b\\c\?\?/ ""#);
    }

    #[test]
    fn long_lines_are_wrapped() {
        let long = format!("x = {};", vec!["abcdefg"; 20].join(" + "));
        let broken = code(4, &long);
        assert!(broken.lines().count() > 1);
        assert!(broken.lines().all(|line| line.len() <= 100), "{broken}");
        let squeeze = |s: &str| s.split_whitespace().collect::<String>();
        assert_eq!(squeeze(&broken), squeeze(&long));
    }
}
