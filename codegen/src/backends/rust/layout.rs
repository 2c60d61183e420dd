//! Layout of a generated file: long arrays are packed into lines, and sections of long functions
//! get headings.
//!
//! Headings are comments, which tokens cannot represent.

/// Width of a line.
const WIDTH: usize = 100;

/// The sections of a function's body.
#[derive(Debug, Clone)]
pub struct Sections {
    /// Name of the function.
    pub function: String,
    /// For every section its first assigned name and its heading.
    pub starts: Vec<(String, String)>,
    /// Parameters of the columns of a matrix that is written number by number.
    pub columns: Vec<String>,
}

impl Sections {
    /// A function without sections.
    #[must_use]
    pub fn none(function: &str) -> Self {
        Self {
            function: function.to_owned(),
            starts: Vec::new(),
            columns: Vec::new(),
        }
    }
}

/// Inserts headings of sections, and names of columns after their numbers, into formatted code.
///
/// Functions have the order of `sections`.
#[must_use]
pub(crate) fn with_comments(code: &str, sections: &[Sections]) -> String {
    let mut out = String::with_capacity(code.len());
    let mut left = sections.iter();
    let mut starts = [].iter().peekable();
    let mut columns: &[String] = &[];
    // The column of an unfinished statement.
    let mut open: Option<&str> = None;
    for line in code.lines() {
        let text = line.trim_start();
        let declared = text.strip_prefix("pub fn ");
        if let Some(name) = declared.and_then(|rest| rest.split('(').next()) {
            let own = left.clone().position(|s| s.function == name);
            if let Some(found) = own.and_then(|at| left.nth(at)) {
                starts = found.starts.iter().peekable();
                columns = &found.columns;
            }
        }
        let indent = &line[..line.len() - text.len()];
        while let Some((_, heading)) = starts.next_if(|(name, _)| assigns(text, name)) {
            push_line(&mut out, &format!("{indent}// --- {heading}"));
        }
        open = unnamed(text, columns).or(open);
        match open.take_if(|_| text.ends_with(';')) {
            Some(name) => push_line(&mut out, &format!("{line} // {name}")),
            None => push_line(&mut out, line),
        }
    }
    out
}

/// The name of the column that a statement writes, unless the value contains it.
///
/// For `output[0][9] = x * y;` it is the name of column 9.
fn unnamed<'c>(statement: &str, columns: &'c [String]) -> Option<&'c str> {
    let (place, value) = statement.strip_prefix("output[")?.split_once("] = ")?;
    let (_row, column) = place.split_once("][")?;
    let name = columns.get(column.parse::<usize>().ok()?)?;
    (!value.starts_with(&format!("{name}_on_"))).then_some(name)
}

/// Whether a statement starts with an assignment to this name, alone or with another one.
fn assigns(line: &str, name: &str) -> bool {
    let Some(rest) = line.strip_prefix("let ") else {
        return false;
    };
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut words = rest
        .split(|c: char| !is_part(c))
        .filter(|word| !word.is_empty() && *word != "mut");
    let is_pair = rest.starts_with(['(', '[']);
    words.next() == Some(name) || (is_pair && words.next() == Some(name))
}

/// Packs array elements that the pretty printer has put on separate lines.
#[must_use]
pub(crate) fn pack_arrays(code: &str) -> String {
    let mut out = String::with_capacity(code.len());
    let mut inside = false;
    // The line being filled, and its indentation.
    let mut open: Option<(String, usize)> = None;
    for line in code.lines() {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        let element = inside && text.ends_with(',') && is_balanced(text);
        if element {
            open = Some(match open.take() {
                Some((filled, at)) if at == indent && filled.len() + text.len() < WIDTH => {
                    (format!("{filled} {text}"), at)
                }
                Some((filled, _)) => {
                    push_line(&mut out, &filled);
                    (line.to_owned(), indent)
                }
                None => (line.to_owned(), indent),
            });
            continue;
        }
        if let Some((filled, _)) = open.take() {
            push_line(&mut out, &filled);
        }
        push_line(&mut out, line);
        inside = text.ends_with('[');
    }
    if let Some((filled, _)) = open {
        push_line(&mut out, &filled);
    }
    out
}

/// Joins the head of an inlined closure, which the pretty printer writes on three lines, and
/// indents its body like a block.
#[must_use]
pub(crate) fn join_closures(code: &str) -> String {
    let mut out = String::with_capacity(code.len());
    let mut lines = code.lines().peekable();
    // Indentation of the call whose closure is open.
    let mut open: Option<usize> = None;
    while let Some(line) = lines.next() {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        let Some(outer) = open else {
            let is_head = text.ends_with('(')
                && lines
                    .next_if(|next| next.trim() == "#[inline(always)]")
                    .is_some();
            match is_head.then(|| lines.next()).flatten() {
                Some(closure) => {
                    let closure = closure.trim_start();
                    push_line(&mut out, &format!("{line}#[inline(always)] {closure}"));
                    open = Some(indent);
                }
                None => push_line(&mut out, line),
            }
            continue;
        };
        if indent == outer + 4 && text == "}," {
            let end = lines.next().unwrap_or_default().trim_start();
            push_line(&mut out, &format!("{:outer$}}}{end}", ""));
            open = None;
        } else {
            push_line(&mut out, line.strip_prefix("    ").unwrap_or(line));
        }
    }
    out
}

fn push_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

/// Whether this line contains a whole element.
fn is_balanced(text: &str) -> bool {
    let count = |c: char| text.matches(c).count();
    count('(') == count(')') && count('[') == count(']') && count('{') == count('}')
}

#[cfg(test)]
mod tests {
    #[test]
    fn matrix_entries_are_commented_with_their_column() {
        let columns = ["m1".to_owned(), "fv_1".to_owned()];
        let statements = [
            ("output[0][1] = -x * y;", Some("fv_1")),
            ("output[2][0] = f(", Some("m1")),
            ("output[0][1] = fv_1_on_vx;", None),
            ("output[0][2] = x;", None),
            ("output[0][0..2].fill(x);", None),
            ("output[0] = x;", None),
            ("let a = output[0][1];", None),
        ];
        for (statement, wanted) in statements {
            assert_eq!(super::unnamed(statement, &columns), wanted, "{statement}");
        }
        let sections = super::Sections {
            function: "g_into".to_owned(),
            starts: vec![("y".to_owned(), "Rates".to_owned())],
            columns: columns.to_vec(),
        };
        let code = "pub fn g() {\n    output[0][1] = 1.0;\n}\npub fn g_into(x: f64) {\n    let y = x;\n    output[0][1] = y\n        + x;\n}\n";
        let wanted = "pub fn g() {\n    output[0][1] = 1.0;\n}\npub fn g_into(x: f64) {\n    // --- Rates\n    let y = x;\n    \
                      output[0][1] = y\n        + x; // fv_1\n}\n";
        assert_eq!(super::with_comments(code, &[sections]), wanted);
    }

    #[test]
    fn closures_start_on_the_line_of_their_call() {
        let code = "fn f() {\n    a::with_avx2(\n        #[inline(always)]\n        || {\n            \
                    let x = g(\n                [1],\n            );\n            x\n        },\n    )\n}\n";
        let wanted = "fn f() {\n    a::with_avx2(#[inline(always)] || {\n        \
                      let x = g(\n            [1],\n        );\n        x\n    })\n}\n";
        assert_eq!(super::join_closures(code), wanted);
    }

    #[test]
    fn array_elements_are_packed_into_lines_without_loss() {
        let code = "let x = [\n    a,\n    b * c,\n    [\n        1.0,\n        2.0,\n    ],\n    d,\n];\n";
        let packed = super::pack_arrays(code);
        assert_eq!(
            packed,
            "let x = [\n    a, b * c,\n    [\n        1.0, 2.0,\n    ],\n    d,\n];\n"
        );
        let squeeze = |s: &str| s.split_whitespace().collect::<String>();
        assert_eq!(squeeze(code), squeeze(&packed));
    }
}
