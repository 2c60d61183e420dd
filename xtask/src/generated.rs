//! What is written into `generated/`, and any other robot's module to read.

use crate::files::{stems, write};
use crate::robots::{Module, TEXT, all, several};
use crate::{Failure, manifest};

/// A file of `generated/` and what it has to hold.
pub(crate) struct File {
    /// Its path from the repository's root.
    pub(crate) path: String,
    /// Its text.
    pub(crate) text: String,
}

/// All files of `generated/` that the generator writes.
pub(crate) fn expected() -> Result<Vec<File>, Failure> {
    let modules = all()?;
    let mut files = vec![File {
        path: "generated/manifest.toml".to_owned(),
        text: manifest::text(&modules),
    }];
    let kept = modules
        .into_iter()
        .filter(|m| TEXT.contains(&m.stem.as_str()));
    files.extend(kept.map(|module| File {
        path: format!("generated/src/{}.rs", module.stem),
        text: module.text,
    }));
    Ok(files)
}

/// Writes `generated/`.
pub(crate) fn write_all() -> Result<(), Failure> {
    expected()?
        .iter()
        .try_for_each(|file| write(&file.path, &file.text))
}

/// Writes the modules of some robots where nothing keeps them.
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
