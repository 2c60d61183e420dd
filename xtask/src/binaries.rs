//! Test binaries of this workspace.

use crate::Failure;
use crate::files::read;
use crate::metadata::cargo;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Crates through which tests read the tier.
const TIER_READERS: [&str; 2] = ["overact_tests", "overact_tier"];

/// A test binary built by cargo.
pub(crate) struct Binary {
    /// Names of the package and the binary.
    pub(crate) name: String,
    file: PathBuf,
    /// Folder of the package, the working folder of its tests.
    folder: PathBuf,
}

impl Binary {
    /// Command that runs it as cargo does.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.file);
        command
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .stdin(Stdio::null());
        command
    }

    /// Whether its tests can differ between the tiers: whether a source names a crate that reads
    /// the tier.
    ///
    /// The compiler lists the sources in a file next to the binary. An unreadable source counts as
    /// one that reads the tier, so that no test is omitted by mistake.
    pub(crate) fn depends_on_tier(&self) -> Result<bool, Failure> {
        let list = self.file.with_extension("d");
        let text = fs::read_to_string(&list).map_err(|e| format!("{}: {e}", list.display()))?;
        let first = text.lines().next().unwrap_or_default();
        let (_, sources) = first
            .split_once(": ")
            .ok_or_else(|| format!("{}: no list of sources", list.display()))?;
        Ok(names_tier_reader(sources, read))
    }
}

/// Whether a listed Rust source names a crate that reads the tier, or is unreadable.
fn names_tier_reader(sources: &str, read: impl Fn(&str) -> Result<String, Failure>) -> bool {
    let mut sources = sources
        .split_whitespace()
        .filter(|path| path.ends_with(".rs"));
    sources.any(|path| {
        read(path).map_or(true, |text| {
            TIER_READERS.iter().any(|reader| text.contains(reader))
        })
    })
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

#[cfg(test)]
mod tests {
    use super::names_tier_reader;
    use crate::Failure;

    #[test]
    fn sources_that_may_read_the_tier_are_recognised() {
        let read = |path: &str| match path {
            "plain.rs" => Ok("use overact::Model;".to_owned()),
            "tiered.rs" => Ok("use overact_tier::by_tier;".to_owned()),
            "supported.rs" => Ok("use overact_tests::support::Failure;".to_owned()),
            other => Err(Failure::from(format!("no file {other}"))),
        };
        assert!(!names_tier_reader("plain.rs robot.toml", read));
        for sources in ["plain.rs tiered.rs", "supported.rs", "plain.rs missing.rs"] {
            assert!(names_tier_reader(sources, read), "{sources}");
        }
    }
}
