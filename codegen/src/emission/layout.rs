//! Layout of a generated file: long arrays are filled line by line instead of one element per line.

/// Width of a line.
const WIDTH: usize = 100;

/// Packs the elements of arrays that the pretty printer has put on lines of their own.
#[must_use]
pub fn pack_arrays(code: &str) -> String {
    let mut out = String::with_capacity(code.len());
    let mut inside = false;
    // The line that is being filled, and its indentation.
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

fn push_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

/// Whether an element stands on this line as a whole.
fn is_balanced(text: &str) -> bool {
    let count = |c: char| text.matches(c).count();
    count('(') == count(')') && count('[') == count(']') && count('{') == count('}')
}

#[cfg(test)]
mod tests {
    #[test]
    fn elements_share_lines_and_nothing_is_lost() {
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
