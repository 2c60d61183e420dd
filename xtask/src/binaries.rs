//! The test binaries of this workspace.

use crate::Failure;
use crate::metadata::cargo;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A test binary as cargo has built it.
pub(crate) struct Binary {
    /// Its package and its own name.
    pub(crate) name: String,
    file: PathBuf,
    /// The package's folder, in which cargo runs it.
    folder: PathBuf,
}

impl Binary {
    /// What runs it as cargo does.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.file);
        command
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .stdin(Stdio::null());
        command
    }
}

/// Builds all tests.
pub(crate) fn binaries() -> Result<Vec<Binary>, Failure> {
    let messages = cargo(&["test", "--workspace", "--no-run", "--message-format=json"])?;
    let mut binaries = Vec::new();
    for line in messages.lines() {
        let message: Value = serde_json::from_str(line)?;
        let is_test = message["profile"]["test"] == true;
        if let (true, Some(file), Some(manifest)) = (
            is_test,
            message["executable"].as_str(),
            message["manifest_path"].as_str(),
        ) {
            let folder = Path::new(manifest).parent().unwrap_or(Path::new("."));
            let package = folder.file_name().unwrap_or_default().to_string_lossy();
            let kind = message["target"]["kind"][0].as_str().unwrap_or_default();
            let name = message["target"]["name"].as_str().unwrap_or_default();
            binaries.push(Binary {
                name: format!("{package}: {kind} {name}"),
                file: file.into(),
                folder: folder.to_owned(),
            });
        }
    }
    Ok(binaries)
}
