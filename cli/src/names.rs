//! Names of results as file names.

/// Name as part of a file name: letters, digits, `-` and `_`; others become `_`.
pub(crate) fn file_stem(name: &str) -> String {
    let keep = |c: char| {
        if c.is_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    };
    name.chars().map(keep).collect()
}
