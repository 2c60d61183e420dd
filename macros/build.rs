//! Identifies the generator for the cache of expansions, and gives the cache a folder.
//!
//! A released generator is identified by its version. In the repository sources change between
//! builds, so their contents identify it. The existence of a build script gives the crate a folder
//! of its own, `OUT_DIR`.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let mut contents = DefaultHasher::new();
    for crate_of_the_generator in ["codegen", "core", "macros"] {
        // Packages from the registry have no neighbouring sources.
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

/// Hashes the names and contents of all files of a folder, in the order of their names.
fn add(folder: &Path, contents: &mut DefaultHasher) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            add(&path, contents)
        } else {
            (path.file_name(), fs::read(&path).ok()).hash(contents)
        }
    }
}
