//! What the macro says of wrong uses and wrong descriptions, and that right ones compile.
//!
//! The macro looks for descriptions beside the user's manifest. The manifest here is the one that
//! `trybuild` writes into the target folder, so the descriptions are copied there first. `trybuild` builds
//! all that the tests' package depends on once more, so they stand here, where that is the macro and
//! little else.

use overact_tier::is_full;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Where `trybuild` puts its crate: in the target folder, which is the third above a test's program
/// (`debug/deps/ui-...`).
fn user_crate() -> Result<PathBuf, Box<dyn Error>> {
    let program = env::current_exe()?;
    let target = program.ancestors().nth(3).ok_or("no target folder")?;
    Ok(target.join("tests/trybuild").join(env!("CARGO_PKG_NAME")))
}

fn copy_descriptions() -> Result<(), Box<dyn Error>> {
    let to = user_crate()?.join("descriptions");
    fs::create_dir_all(&to)?;
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    // A robot whose joints Newton's method finds.
    let newton = "newton_point.toml";
    fs::copy(package.join("../cli/tests/c").join(newton), to.join(newton))?;
    let from = package.join("tests/ui/descriptions");
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

/// The cases of the default tier: a robot that compiles, wrong uses of the macro, and two descriptions, one of
/// which is right but for its geometry. What else is said of descriptions is tested beside what says it.
const FEW: [&str; 7] = [
    "pass.rs",
    "pass_functions.rs",
    "pass_single.rs",
    "missing_file.rs",
    "on_an_enum.rs",
    "misspelled_key.rs",
    "stretched_leg.rs",
];

#[test]
fn wrong_uses_are_explained_and_right_ones_compile() -> Result<(), Box<dyn Error>> {
    copy_descriptions()?;
    let cases = trybuild::TestCases::new();
    for entry in fs::read_dir("tests/ui")? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default();
        let name = name.to_string_lossy();
        let is_of_the_tier = is_full() || FEW.contains(&&*name);
        if path.extension().is_none_or(|e| e != "rs") || !is_of_the_tier {
            continue;
        }
        match name.starts_with("pass") {
            true => cases.pass(path),
            false => cases.compile_fail(path),
        }
    }
    Ok(())
}
