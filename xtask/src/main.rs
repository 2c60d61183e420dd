//! Tasks of this repository: `cargo xtask TASK`.

mod at_once;
mod binaries;
mod book;
mod deny;
mod files;
mod freshness;
mod generated;
mod hash;
mod links;
mod manifest;
mod measure;
mod metadata;
mod page;
mod release;
mod robots;
mod times;
#[cfg(test)]
mod workflows;

use std::process::ExitCode;

/// Error of a task.
type Failure = Box<dyn std::error::Error + Send + Sync>;

const HELP: &str = "\
cargo xtask generated           write generated/: five robots as text, all in the manifest
cargo xtask generated ROBOT...  write robots/ROBOT.toml as target/generated/ROBOT.rs, to read
cargo xtask freshness           fail unless generated/ is what the generator writes: of robots whose sources are
                                those that it was made from, some are generated
cargo xtask freshness all       the same, all robots are
cargo xtask measure EFFORT FILE what generation makes of a description, in numbers (JSON)
cargo xtask book                write docs/errors.md, and the book to target/book for mdbook
cargo xtask deny [CHECK]...     advisories, licences, sources and duplicates of all workspaces by cargo-deny; skipped
                                if it is not installed
cargo xtask links               fail unless every link of the documentation leads somewhere and errors.md is fresh
cargo xtask package [OPTION]... archives of all published packages, built as they will be (cargo package)
cargo xtask page                build the page for browsers into target/page; skipped without a Rust for them
cargo xtask page test           build it and test it in a browser
cargo xtask release             versions, licences, Rust versions and registry keys of all packages
cargo xtask release --tag TAG   all reasons not to publish a tag: those above, a version or date that does not match,
                                a dirty tree, a missing token, yanked dependencies
cargo xtask tests               all test binaries, one for each processor at a time
cargo xtask tests of-tier       the same without binaries whose tests are the same in all tiers
cargo xtask times [SECONDS]     processor time of each test binary; fail if all take more";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        ["generated"] => generated::write_all(),
        ["generated", ref robots @ ..] => generated::write_to_read(robots),
        ["measure", effort, file] => measure::print(effort, file),
        ["freshness"] => freshness::check(false),
        ["freshness", "all"] => freshness::check(true),
        ["book"] => book::write_all(),
        ["deny", ref checks @ ..] => deny::check(checks),
        ["links"] => links::check().and_then(|()| book::check()),
        ["package", ref options @ ..] => release::package(options),
        ["page"] => page::build(),
        ["page", "test"] => page::test(),
        ["release"] => release::check(),
        ["release", "--tag", tag] => release::guard::check(tag),
        ["tests"] => at_once::run(at_once::Binaries::All),
        ["tests", "of-tier"] => at_once::run(at_once::Binaries::OfTier),
        ["times"] => times::table(None),
        ["times", seconds] => times::table(Some(seconds)),
        _ => {
            eprintln!("{HELP}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
