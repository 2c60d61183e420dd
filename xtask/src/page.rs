//! The page for browsers: `page/build` makes it, Node and a browser test it.

use crate::Failure;
use crate::files::repository;
use crate::metadata::target;
use std::io::ErrorKind;
use std::process::Command;

/// Tests of the page, each a script of Node.
const TESTS: [&str; 1] = ["browser.mjs"];

/// Builds the page into `page` of the target folder. Without a Rust for browsers nothing is done, with a word.
pub(crate) fn build() -> Result<(), Failure> {
    let mut build = Command::new(repository("page/build"));
    build.env("CARGO_TARGET_DIR", target()?);
    succeeds(build)
}

/// Builds the page and tests it; what is not there, Node or a browser, is told.
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
    match status.success() {
        true => Ok(()),
        false => Err(format!("{command:?} failed").into()),
    }
}
