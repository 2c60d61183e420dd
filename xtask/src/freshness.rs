//! Whether `generated/` is what the generator writes now, and small enough to be kept.

use crate::Failure;
use crate::files::{read, repository, size, stems};
use crate::generated::{File, expected};

/// Bytes that may be checked in under `generated/`.
const LARGEST: u64 = 2_000_000;

/// Compares every file; all that differ are named, with the first line that does.
pub(crate) fn check() -> Result<(), Failure> {
    let expected = expected()?;
    let mut problems: Vec<String> = expected.iter().filter_map(difference).collect();
    for stem in stems("generated/src", "rs")? {
        let path = format!("generated/src/{stem}.rs");
        if stem != "lib" && !expected.iter().any(|file| file.path == path) {
            problems.push(format!("{path}: no task writes it"));
        }
    }
    let bytes = size(&repository("generated"))?;
    if bytes > LARGEST {
        problems.push(format!("generated/: {bytes} bytes, more than {LARGEST}"));
    }
    if problems.is_empty() {
        println!(
            "generated/ is fresh: {} files, {bytes} bytes in all",
            expected.len()
        );
        return Ok(());
    }
    let problems = problems.join("\n");
    Err(
        format!("generated/ is not fresh; renew it with `cargo xtask generated`\n{problems}")
            .into(),
    )
}

/// The first line in which a file differs from what it has to hold.
fn difference(file: &File) -> Option<String> {
    let found = match read(&file.path) {
        Ok(found) if found == file.text => return None,
        Ok(found) => found,
        Err(failure) => return Some(failure.to_string()),
    };
    let mut pairs = found.lines().zip(file.text.lines()).enumerate();
    let first = pairs.find(|(_, (found, expected))| found != expected);
    Some(match first {
        Some((at, (found, expected))) => format!(
            "{}:{}: `{}`, should be `{}`",
            file.path,
            at + 1,
            found.trim(),
            expected.trim()
        ),
        None => format!("{}: has another length than it should", file.path),
    })
}
