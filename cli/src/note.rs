//! Notes on stderr about descriptions with possibly unintended contents.

use overact_codegen::diagnostic::visible;
use overact_robot::CompiledFile;
use std::{
    cell::Cell,
    io::{self, IsTerminal, Write},
};

thread_local! {
    /// Whether only errors are printed; per thread, as each thread runs one command.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Sets whether only errors are printed on stderr.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.set(quiet);
}

/// Whether only errors are printed on stderr.
pub(crate) fn is_quiet() -> bool {
    QUIET.get()
}

/// Prints the note of a description on stderr; never with `--json`, because errors share stderr.
pub(crate) fn print_description_note(compiled: &CompiledFile, as_json: bool) {
    print_note(&compiled.file, compiled.note().as_deref(), as_json);
}

/// Prints warnings on stderr; not with `--json`.
pub(crate) fn print_warnings(warnings: &[String], as_json: bool) {
    for warning in warnings.iter().filter(|_| !as_json && !is_quiet()) {
        // A closed stderr is ignored.
        let _ = writeln!(io::stderr(), "warning: {}", visible(warning));
    }
}

/// Prints the parameters without effect; not with `--json`, since JSON errors share stderr.
pub(crate) fn print_without_effect(without_effect: &[String], as_json: bool) {
    if !without_effect.is_empty() && !as_json && !is_quiet() {
        let names = without_effect.join(", ");
        // A closed stderr is ignored.
        let _ = writeln!(io::stderr(), "note: without effect on the model: {names}");
    }
}

/// Prints a note about a file.
pub(crate) fn print_note(file: &str, note: Option<&str>, as_json: bool) {
    if let (Some(note), false) = (note, as_json || is_quiet()) {
        for line in note.lines() {
            // A closed stderr is ignored.
            let _ = writeln!(io::stderr(), "note: {file}: {line}");
        }
    }
}

/// Prints warnings of a result on stderr, unless the result with them goes to the same place.
pub(crate) fn print_result_warnings(warnings: &[String], is_written: bool, as_json: bool) {
    if is_written || !is_same_output() {
        print_warnings(warnings, as_json);
    }
}

/// Whether stdout and stderr are one terminal, pipe or file, as after `2>&1`.
fn is_same_output() -> bool {
    let is_terminal = io::stdout().is_terminal() && io::stderr().is_terminal();
    is_terminal || is_same_file()
}

/// Whether stdout and stderr are one open file.
#[cfg(unix)]
fn is_same_file() -> bool {
    use std::os::{
        fd::{AsFd, BorrowedFd},
        unix::fs::MetadataExt,
    };
    let identity = |stream: BorrowedFd<'_>| {
        let file = std::fs::File::from(stream.try_clone_to_owned().ok()?);
        let about = file.metadata().ok()?;
        Some((about.dev(), about.ino()))
    };
    let out = identity(io::stdout().as_fd());
    out.is_some() && out == identity(io::stderr().as_fd())
}

/// Whether stdout and stderr are one open file, which other systems do not say.
#[cfg(not(unix))]
const fn is_same_file() -> bool {
    false
}
