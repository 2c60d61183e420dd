//! Builds and tests the page for browsers with `page/build`, Node and a browser.

use crate::Failure;
use crate::files::repository;
use crate::metadata::target;
use std::io::ErrorKind;
use std::process::Command;

/// Node scripts that test the page.
const TESTS: [&str; 1] = ["browser.mjs"];

/// Builds the page in the target folder; prints a message without a WebAssembly toolchain.
pub(crate) fn build() -> Result<(), Failure> {
    let mut build = Command::new(repository("page/build"));
    build.env("CARGO_TARGET_DIR", target()?);
    succeeds(build)
}

/// Builds and tests the page; prints a message if Node or a browser is missing.
pub(crate) fn test() -> Result<(), Failure> {
    build()?;
    if let Err(error) = Command::new("node").arg("--version").output()
        && error.kind() == ErrorKind::NotFound
    {
        println!("skipped: the page is tested by Node, which is not there");
        return Ok(());
    }
    let target = target()?;
    for test in TESTS {
        let mut node = Command::new("node");
        node.arg(repository("page/test").join(test));
        node.arg(target.join("page"));
        if std::env::var_os("OVERACT_BINARY").is_none() {
            node.env("OVERACT_BINARY", target.join("debug/overact"));
        }
        succeeds(node)?;
    }
    Ok(())
}

fn succeeds(mut command: Command) -> Result<(), Failure> {
    let status = command.status();
    let status = status.map_err(|error| format!("{command:?}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{command:?} failed").into())
    }
}
