//! Errors of the macro for wrong uses and wrong descriptions, and compilation of correct ones.
//!
//! The macro looks for descriptions relative to the user's manifest. Here that is the one that
//! `trybuild` writes into the target folder, so the descriptions are copied there first. `trybuild`
//! rebuilds all dependencies of the tests' package. So the tests are in this package, which depends
//! on little more than the macro.

use overact_tier::is_full;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The folder of `trybuild`'s crate in the target folder, which is the third parent of a test
/// program (`debug/deps/ui-...`).
fn user_crate() -> Result<PathBuf, Box<dyn Error>> {
    let program = env::current_exe()?;
    let target = program.ancestors().nth(3).ok_or("no target folder")?;
    Ok(target.join("tests/trybuild").join(env!("CARGO_PKG_NAME")))
}

fn copy_descriptions() -> Result<(), Box<dyn Error>> {
    let to = user_crate()?.join("descriptions");
    fs::create_dir_all(&to)?;
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    // A robot whose joints are found by Newton's method.
    let newton = "newton_point.toml";
    fs::copy(package.join("../cli/tests/c").join(newton), to.join(newton))?;
    let from = package.join("tests/ui/descriptions");
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Cases of the default tier: a robot that compiles, wrong uses of the macro, and two descriptions,
/// one of which has only a wrong geometry. Other errors of descriptions are tested next to the code
/// that reports them.
const DEFAULT_TIER_CASES: [&str; 7] = [
    "pass.rs",
    "pass_functions.rs",
    "pass_single.rs",
    "missing_file.rs",
    "on_an_enum.rs",
    "misspelled_key.rs",
    "stretched_leg.rs",
];

/// The program in the README, as a file next to its description.
fn readme() -> Result<PathBuf, Box<dyn Error>> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = user_crate()?;
    fs::copy(
        repository.join("robots/dualv.toml"),
        folder.join("dualv.toml"),
    )?;
    let text = fs::read_to_string(repository.join("README.md"))?;
    let (_, rest) = text.split_once("```rust\n").ok_or("no program")?;
    let (program, _) = rest.split_once("```").ok_or("no end of the program")?;
    let file = folder.join("readme.rs");
    fs::write(&file, program)?;
    Ok(file)
}

#[test]
fn invalid_attributes_are_explained_and_valid_ones_compile() -> Result<(), Box<dyn Error>> {
    copy_descriptions()?;
    let cases = trybuild::TestCases::new();
    for entry in fs::read_dir("tests/ui")? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default();
        let name = name.to_string_lossy();
        let is_of_the_tier = is_full() || DEFAULT_TIER_CASES.contains(&&*name);
        if path.extension().is_none_or(|e| e != "rs") || !is_of_the_tier {
            continue;
        }
        if name.starts_with("pass") {
            cases.pass(path)
        } else {
            cases.compile_fail(path)
        }
    }
    if is_full() {
        cases.pass(readme()?);
    }
    Ok(())
}
