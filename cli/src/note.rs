//! Notes about a description that may not be meant as it is, on stderr.

use overact_robot::CompiledFile;
use std::io::{self, Write};

/// Tells the note on stderr; never beside a JSON document, whose errors share stderr with it.
pub(crate) fn tell_note(compiled: &CompiledFile, as_json: bool) {
    if let (Some(note), false) = (compiled.note(), as_json) {
        // A closed stderr is no reason to stop.
        let _ = writeln!(io::stderr(), "note: {}: {note}", compiled.file);
    }
}
