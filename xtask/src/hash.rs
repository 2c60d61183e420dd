//! Hashes of texts and of the generator's sources.

use crate::Failure;
use crate::files::repository;
use std::fs;
use std::path::Path;

/// Sources that determine the generated code: generator, its use by this program, and dependency
/// versions.
const SOURCES: [&str; 7] = [
    "codegen/src",
    "core/src",
    "description/src",
    "exact/src",
    "xtask/src/robots.rs",
    "xtask/src/manifest.rs",
    "Cargo.lock",
];

/// 64-bit FNV-1a hash, independent of the compiler.
pub(crate) fn hash(text: &str) -> u64 {
    further(0xcbf2_9ce4_8422_2325, text.as_bytes())
}

/// Hash of the sources: file names, and contents without comment lines of Rust.
pub(crate) fn generator() -> Result<u64, Failure> {
    let mut all = hash("");
    for source in SOURCES {
        add(&repository(source), &mut all).map_err(|error| format!("{source}: {error}"))?;
    }
    Ok(all)
}

fn add(path: &Path, all: &mut u64) -> Result<(), Failure> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    *all = further(*all, name.as_bytes());
    if !path.is_dir() {
        *all = further(
            *all,
            without_comments(&fs::read_to_string(path)?).as_bytes(),
        );
        return Ok(());
    }
    let entries = fs::read_dir(path)?.map(|entry| Ok(entry?.path()));
    let mut paths = entries.collect::<Result<Vec<_>, std::io::Error>>()?;
    paths.sort();
    paths.iter().try_for_each(|path| add(path, all))
}

/// The text without lines that hold a comment of Rust only, which do not change what is generated.
fn without_comments(text: &str) -> String {
    let lines = text.split_inclusive('\n');
    lines
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect()
}

fn further(hash: u64, bytes: &[u8]) -> u64 {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(hash, step)
}

#[cfg(test)]
mod tests {
    use super::{generator, hash, without_comments};

    #[test]
    fn hashes_match_published_fnv_1a_values() {
        // Published values of the 64-bit variant.
        assert_eq!(hash(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(hash("foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn comments_do_not_change_the_hash() {
        let text = "//! A module.\n\n/// An item.\nfn f() {\n    // Nothing.\n    g(); // It.\n}\n";
        let rest = "\nfn f() {\n    g(); // It.\n}\n";
        assert_eq!(without_comments(text), rest);
    }

    #[test]
    fn the_source_hash_is_deterministic() {
        let once = generator().expect("the sources");
        assert_eq!(once, generator().expect("the sources"));
        assert_ne!(once, hash(""));
    }
}
