//! Notes about a description that may not be meant as it is, on stderr.

use overact_robot::load::{Robot, note};
use std::io::{self, Write};

/// Tells the [`note`] on stderr; never beside a JSON document, whose errors share stderr with it.
pub(crate) fn tell_note(robot: &Robot, as_json: bool) {
    if let (Some(note), false) = (note(robot), as_json) {
        // A closed stderr is no reason to stop.
        let _ = writeln!(io::stderr(), "note: {}: {note}", robot.file);
    }
}
