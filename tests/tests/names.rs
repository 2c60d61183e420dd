//! Number of values in the checked-in modules with a descriptive name instead of a number.

use overact_tests::support::{Failure, repository};
use std::fs;

/// Names that a module assigns with `let`.
fn assigned(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find("        let ") {
        rest = &rest[at + 12..];
        let Some(end) = rest.find(" =") else { break };
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let words = rest[..end].split(|c: char| !is_part(c));
        let words = words.filter(|word| !["", "_", "mut"].contains(word));
        names.extend(words.map(str::to_owned));
        rest = &rest[end..];
    }
    names
}

/// `t12` or `t3_leg1`.
fn is_numbered(name: &str) -> bool {
    let behind = name.strip_prefix('t').unwrap_or_default();
    let digits = behind.len()
        - behind
            .trim_start_matches(|c: char| c.is_ascii_digit())
            .len();
    digits > 0 && (digits == behind.len() || behind[digits..].starts_with('_'))
}

#[test]
fn most_generated_values_have_descriptive_names() -> Result<(), Failure> {
    let mut files = fs::read_dir(repository("generated/src"))?
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>, Failure>>()?;
    files.sort();
    let mut is_there = false;
    for file in files {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let names = assigned(&fs::read_to_string(&file)?);
        if names.is_empty() {
            continue;
        }
        let numbered = names.iter().filter(|name| is_numbered(name)).count();
        let percent = 100 - 100 * numbered / names.len();
        println!("{stem:16} {:>6} values, {percent} % named", names.len());
        let least = if stem == "dualv" { 85 } else { 60 };
        assert!(
            percent >= least,
            "{stem}: {percent} % of the values are named"
        );
        is_there |= stem == "dualv";
    }
    assert!(is_there, "the DualV's module is not there");
    Ok(())
}
