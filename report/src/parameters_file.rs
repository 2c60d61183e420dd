//! Physically consistent parameters as a file for commands and generator.

use crate::{
    line_errors::{base_words, relative_words},
    text::visible,
};
use overact_identification::{Consistent, Identification};
use std::fmt::Write;

/// TOML file of the first model's consistent parameters, if there are any.
#[must_use]
pub fn parameters_file(identification: &Identification) -> Option<String> {
    let consistent: &Consistent = identification.consistent.first()?;
    let mut text = format!(
        "# Physically consistent standard parameters of {}, SI units.\n# Relative residual of {2}: {1}, with the base parameters {3}.\nrobot = \"{4}\"\n\n[parameters]\n",
        visible(&identification.robot),
        relative_words(&consistent.lines, consistent.relative_error_percent, 4),
        match identification.runs.len() {
            1 => String::from("a run"),
            count => format!("{count} runs"),
        },
        base_words(identification, consistent),
        visible(&identification.robot)
    );
    for one in &consistent.parameters {
        let _ = writeln!(text, "{} = {:e} # {}", one.name, one.value, one.unit);
    }
    Some(text)
}
