//! Files and folders of the repository.

use crate::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Path of a file or folder, from its path relative to the repository's root.
pub(crate) fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Text of a file; errors name the file.
pub(crate) fn read(path: &str) -> Result<String, Failure> {
    fs::read_to_string(repository(path)).map_err(|error| format!("{path}: {error}").into())
}

/// Writes a file and creates its folders.
pub(crate) fn write(path: &str, text: &str) -> Result<(), Failure> {
    let file = repository(path);
    let folder = file.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folder.and_then(|()| fs::write(&file, text));
    written.map_err(|error| format!("{path}: {error}"))?;
    println!("{path}: written");
    Ok(())
}

/// Stems of a folder's files with an extension, sorted.
pub(crate) fn stems(folder: &str, extension: &str) -> Result<Vec<String>, Failure> {
    let mut stems = Vec::new();
    let entries = fs::read_dir(repository(folder)).map_err(|error| format!("{folder}: {error}"))?;
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == extension) {
            let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
            stems.extend(stem);
        }
    }
    stems.sort();
    Ok(stems)
}

/// Size of all files below a folder, bytes.
pub(crate) fn size(folder: &Path) -> Result<u64, Failure> {
    let mut bytes = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        bytes += if entry.file_type()?.is_dir() {
            size(&entry.path())?
        } else {
            entry.metadata()?.len()
        };
    }
    Ok(bytes)
}
