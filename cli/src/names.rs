//! Names of results in names of files.

/// A name as part of a file's name: letters, digits, `-` and `_`; all else becomes `_`.
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
