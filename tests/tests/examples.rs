//! Crates without documentation examples disable doctests, which saves a second each.
//!
//! A crate with an example must enable them again.

use overact_tests::support::{Failure, repository};
use std::fs;
use std::path::{Path, PathBuf};

/// Labels of code blocks that are compiled.
const COMPILED: [&str; 5] = ["", "rust", "no_run", "should_panic", "compile_fail"];

/// The folders of all packages.
fn packages() -> Result<Vec<PathBuf>, Failure> {
    let manifest: String = fs::read_to_string(repository("Cargo.toml"))?;
    let (_, members) = manifest.split_once("members = [").ok_or("no members")?;
    let (members, _) = members.split_once(']').ok_or("no end of the members")?;
    let names = members.split('"').skip(1).step_by(2);
    Ok(names.map(repository).collect())
}

/// All sources below a folder.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            sources(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    Ok(())
}

/// Whether the documentation in a source contains compiled code.
fn has_example(text: &str) -> bool {
    let lines = text.lines().map(str::trim_start);
    let documented = lines.filter_map(|line| {
        let rest = line.strip_prefix("//!");
        rest.or_else(|| line.strip_prefix("///")).map(str::trim)
    });
    // Every other fence opens a block.
    let fences = documented.filter_map(|line| line.strip_prefix("```"));
    let mut opening = fences.step_by(2);
    opening.any(|name| {
        let first = name.split([',', ' ']).next().unwrap_or_default();
        COMPILED.contains(&first) || first.starts_with("edition")
    })
}

#[test]
fn packages_without_doctests_have_no_examples() -> Result<(), Failure> {
    let mut silent = 0;
    for folder in packages()? {
        let manifest = fs::read_to_string(folder.join("Cargo.toml"))?;
        if !manifest.contains("doctest = false") {
            continue;
        }
        silent += 1;
        let mut files = Vec::new();
        sources(&folder.join("src"), &mut files)?;
        for file in files {
            let text = fs::read_to_string(&file)?;
            assert!(
                !has_example(&text),
                "{} has an example: take `doctest = false` out of its package",
                file.display()
            );
        }
    }
    assert!(silent > 0, "no package looks for no example");
    Ok(())
}

#[test]
fn doctest_blocks_are_distinguished_from_other_blocks() {
    assert!(has_example("//! ```\n//! let a = 1;\n//! ```\n"));
    assert!(has_example("/// ```no_run\n/// ```\n"));
    assert!(has_example("    /// ```edition2024\n    /// ```\n"));
    assert!(has_example(
        "//! ```text\n//! a\n//! ```\n//! ```rust,ignore\n//! ```\n"
    ));
    assert!(!has_example(
        "//! ```text\n//! a\n//! ```\nlet fence = \"```\";\n"
    ));
}
