//! Tells the attribute by which generator its expansions were made, and gives it a folder to keep them in.
//!
//! A released generator is known by its version. In the repository sources change from build to build, so that
//! their contents are what it is known by. That there is a build script at all gives the crate a folder of its
//! own in the target folder, `OUT_DIR`.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let mut contents = DefaultHasher::new();
    for crate_of_the_generator in ["codegen", "core", "macros"] {
        // In a package of the registry there are none beside it.
        let folder = Path::new("..").join(crate_of_the_generator).join("src");
        if folder.is_dir() {
            println!("cargo::rerun-if-changed={}", folder.display());
            add(&folder, &mut contents);
        }
    }
    println!(
        "cargo::rustc-env=OVERACT_GENERATOR={:016x}",
        contents.finish()
    );
}

/// Adds the names and texts of all files of a folder, in the order of their names.
fn add(folder: &Path, contents: &mut DefaultHasher) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        match path.is_dir() {
            true => add(&path, contents),
            false => (path.file_name(), fs::read(&path).ok()).hash(contents),
        }
    }
}
