//! Checks advisories, licences, sources and duplicates of all workspaces' dependencies by
//! cargo-deny.

use crate::Failure;
use crate::files::repository;
use std::process::{Command, Stdio};

/// Folders of all workspaces of this repository, each with a Cargo.lock.
const WORKSPACES: [&str; 6] = [
    ".",
    "benchmarks/symplex",
    "examples/controller/firmware",
    "fleet",
    "page",
    "python",
];

/// Runs `cargo deny check CHECKS` on every workspace with the root's `deny.toml`; by default all
/// checks.
///
/// Without cargo-deny nothing is checked, and a message is printed.
pub(crate) fn check(checks: &[&str]) -> Result<(), Failure> {
    if !is_installed()? {
        println!("skipped: cargo-deny is not installed (`cargo install cargo-deny --locked`)");
        return Ok(());
    }
    let mut failed = Vec::new();
    for workspace in WORKSPACES {
        println!("{workspace}: cargo deny check {}", checks.join(" "));
        let manifest = repository(workspace).join("Cargo.toml");
        let mut deny = cargo_deny();
        deny.args(["--locked", "--manifest-path"]).arg(manifest);
        deny.arg("--config").arg(repository("deny.toml"));
        deny.arg("check").args(checks);
        if !deny.status()?.success() {
            failed.push(workspace);
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(format!("cargo deny failed in {}", failed.join(", ")).into())
}

fn cargo_deny() -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.arg("deny");
    command
}

/// Whether cargo has the subcommand `deny`.
fn is_installed() -> Result<bool, Failure> {
    let mut version = cargo_deny();
    version.arg("--version");
    version.stdout(Stdio::null()).stderr(Stdio::null());
    Ok(version.status()?.success())
}

#[cfg(test)]
mod tests {
    use super::WORKSPACES;
    use crate::files::repository;
    use std::path::{Path, PathBuf};

    #[test]
    fn every_lock_file_belongs_to_a_checked_workspace() {
        let mut locks = Vec::new();
        collect_locks(&repository(""), &mut locks);
        let mut checked: Vec<PathBuf> = WORKSPACES.iter().map(|w| lock_of(w)).collect();
        locks.sort();
        checked.sort();
        assert_eq!(locks, checked);
    }

    fn lock_of(workspace: &str) -> PathBuf {
        let lock = repository(workspace).join("Cargo.lock");
        lock.canonicalize().expect("a lock file")
    }

    fn collect_locks(folder: &Path, locks: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path
                .file_name()
                .and_then(|n| n.to_str())
                .unwrap_or_default();
            if path.is_dir() {
                if name != "target" && !name.starts_with('.') && name != "node_modules" {
                    collect_locks(&path, locks);
                }
            } else if name == "Cargo.lock" {
                locks.push(path.canonicalize().expect("a lock file"));
            }
        }
    }
}
