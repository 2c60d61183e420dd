//! Notes about a description that may not be meant as it is, on stderr.

use overact_codegen::diagnostic::visible;
use overact_robot::CompiledFile;
use std::{
    cell::Cell,
    io::{self, IsTerminal, Write},
};

thread_local! {
    /// Whether nothing but errors is told; of the thread, as commands are run in one each.
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Sets whether nothing but errors is told on stderr.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.set(quiet);
}

/// Whether nothing but errors is told on stderr.
pub(crate) fn is_quiet() -> bool {
    QUIET.get()
}

/// Tells the note on stderr; never beside a JSON document, whose errors share stderr with it.
pub(crate) fn tell_note(compiled: &CompiledFile, as_json: bool) {
    tell(&compiled.file, compiled.note().as_deref(), as_json);
}

/// Tells on stderr which given parameters no body or joint has; never beside a JSON document.
pub(crate) fn tell_doubts(doubts: &[String], as_json: bool) {
    for doubt in doubts.iter().filter(|_| !as_json && !is_quiet()) {
        // A closed stderr is no reason to stop.
        let _ = writeln!(io::stderr(), "warning: {}", visible(doubt));
    }
}

/// Tells a note about a file.
pub(crate) fn tell(file: &str, note: Option<&str>, as_json: bool) {
    if let (Some(note), false) = (note, as_json || is_quiet()) {
        for line in note.lines() {
            // A closed stderr is no reason to stop.
            let _ = writeln!(io::stderr(), "note: {file}: {line}");
        }
    }
}

/// Tells warnings of a result on stderr, too, where the result goes elsewhere than to the same terminal.
pub(crate) fn tell_warnings(warnings: &[String], is_written: bool, as_json: bool) {
    let seen = !is_written && io::stdout().is_terminal() && io::stderr().is_terminal();
    if !seen {
        tell_doubts(warnings, as_json);
    }
}
