//! Writes `generated/`, and modules of other robots for reading.

use crate::files::{stems, write};
use crate::hash::generator;
use crate::robots::{Module, TEXT, all, several};
use crate::{Failure, manifest};

/// A module kept as text.
pub(crate) struct File {
    /// Path relative to the repository's root.
    pub(crate) path: String,
    /// Expected text.
    pub(crate) text: String,
}

/// Writes `generated/`.
pub(crate) fn write_all() -> Result<(), Failure> {
    // Hash the sources first, before they can change during the long generation.
    let generator = generator()?;
    let modules = all()?;
    write(
        "generated/manifest.toml",
        &manifest::text(&modules, generator),
    )?;
    texts(modules)
        .iter()
        .try_for_each(|file| write(&file.path, &file.text))
}

/// Modules that are kept as text.
pub(crate) fn texts(modules: Vec<Module>) -> Vec<File> {
    let kept = modules
        .into_iter()
        .filter(|m| TEXT.contains(&m.stem.as_str()));
    let file = |module: Module| File {
        path: format!("generated/src/{}.rs", module.stem),
        text: module.text,
    };
    kept.map(file).collect()
}

/// Writes the modules of some robots outside the repository's files.
pub(crate) fn write_to_read(robots: &[&str]) -> Result<(), Failure> {
    let known = stems("robots", "toml")?;
    let unknown: Vec<&str> = robots
        .iter()
        .copied()
        .filter(|robot| !known.iter().any(|known| known == robot))
        .collect();
    if !unknown.is_empty() {
        let (unknown, known) = (unknown.join(", "), known.join(", "));
        return Err(format!("no description in robots/: {unknown}; there are: {known}").into());
    }
    let robots: Vec<String> = robots.iter().map(|&robot| robot.to_owned()).collect();
    for Module { stem, text, .. } in several(&robots)? {
        write(&format!("target/generated/{stem}.rs"), &text)?;
    }
    Ok(())
}
