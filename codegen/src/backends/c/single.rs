//! Conversion of C code to single precision.
//!
//! `double` becomes `float`, numbers get the suffix `f` and fewer digits, and functions of `math.h`
//! become those for `float`. Comments and strings do not change.

/// Functions and macros of `math.h` in the code; `isfinite` works for all types.
const LIBRARY: [(&str, &str); 6] = [
    ("sqrt", "sqrtf"),
    ("sin", "sinf"),
    ("cos", "cosf"),
    ("atan2", "atan2f"),
    ("fabs", "fabsf"),
    ("HUGE_VAL", "HUGE_VALF"),
];

/// Converts code with `double` to code with `float`.
#[must_use]
pub fn converted(code: &str) -> String {
    let mut out = String::with_capacity(code.len());
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let length = token(rest, first);
        let (token, behind) = rest.split_at(length);
        match first {
            'a'..='z' | 'A'..='Z' | '_' => out.push_str(word(token)),
            '0'..='9' => out.push_str(&number(token)),
            _ => out.push_str(token),
        }
        rest = behind;
    }
    out
}

/// Length of the first token of a text: a comment, a string, a word, a number, or one character.
fn token(text: &str, first: char) -> usize {
    let until = |end: &str, begin: usize| {
        let found = text.get(begin..).and_then(|rest| rest.find(end));
        found.map_or(text.len(), |at| begin + at + end.len())
    };
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    match first {
        '/' if text.starts_with("/*") => until("*/", 2),
        '"' => string(text),
        'a'..='z' | 'A'..='Z' | '_' => {
            let end = text.find(|c: char| !(is_part(c) && c != '.'));
            end.unwrap_or(text.len())
        }
        '0'..='9' => {
            // A sign after an exponent belongs to the number.
            let mut before = ' ';
            let end = text.find(|c: char| {
                let goes_on = is_part(c) || (matches!(c, '+' | '-') && before == 'e');
                before = c;
                !goes_on
            });
            end.unwrap_or(text.len())
        }
        other => other.len_utf8(),
    }
}

/// Length of the string at the start of a text.
fn string(text: &str) -> usize {
    let mut is_escaped = false;
    let end = text.char_indices().skip(1).find(|&(_, c)| {
        let ends = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        ends
    });
    end.map_or(text.len(), |(at, _)| at + 1)
}

fn word(word: &str) -> &str {
    let known = LIBRARY.iter().find(|(double, _)| *double == word);
    match known {
        Some((_, single)) => single,
        None if word == "double" => "float",
        None => word,
    }
}

/// Rounds numbers with a point or an exponent; others are counts.
fn number(text: &str) -> String {
    let value = text.contains(['.', 'e']).then(|| text.parse::<f64>().ok());
    match value.flatten() {
        Some(value) => format!("{:?}f", value as f32),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::converted;

    #[test]
    fn only_numbers_types_and_functions_become_single_precision() {
        let code = "/* a double 1.0 */ static const double A2[3] = { -0.30000000000000004, 1e-7, 2.0 };\n\
            x_sin[2] = sin(A2[0]) - fabs(1.5e+3 * y1) + sqrt(16) ; s = \"double \\\" 1.0\"; n = 10;";
        let wanted = "/* a double 1.0 */ static const float A2[3] = { -0.3f, 1e-7f, 2.0f };\n\
            x_sin[2] = sinf(A2[0]) - fabsf(1500.0f * y1) + sqrtf(16) ; s = \"double \\\" 1.0\"; n = 10;";
        assert_eq!(converted(code), wanted);
    }
}
