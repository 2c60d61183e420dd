//! Notes about a description that may not be meant as it is, on stderr.

use overact_codegen::diagnostic::visible;
use overact_robot::CompiledFile;
use std::io::{self, Write};

/// Tells the note on stderr; never beside a JSON document, whose errors share stderr with it.
pub(crate) fn tell_note(compiled: &CompiledFile, as_json: bool) {
    tell(&compiled.file, compiled.note().as_deref(), as_json);
}

/// Tells on stderr which given parameters no body or joint has; never beside a JSON document.
pub(crate) fn tell_doubts(doubts: &[String], as_json: bool) {
    for doubt in doubts.iter().filter(|_| !as_json) {
        // A closed stderr is no reason to stop.
        let _ = writeln!(io::stderr(), "warning: {}", visible(doubt));
    }
}

/// Tells a note about a file.
pub(crate) fn tell(file: &str, note: Option<&str>, as_json: bool) {
    if let (Some(note), false) = (note, as_json) {
        // A closed stderr is no reason to stop.
        let _ = writeln!(io::stderr(), "note: {file}: {note}");
    }
}
