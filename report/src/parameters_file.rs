//! The consistent parameters as a file that commands and generator read back.

use crate::text::visible;
use overact_identification::{Consistent, Identification, significant};
use std::fmt::Write;

/// A TOML file of the physically consistent parameters of the first model; none where there are none.
#[must_use]
pub fn parameters_file(identification: &Identification) -> Option<String> {
    let consistent: &Consistent = identification.consistent.first()?;
    let mut text = format!(
        "# Physically consistent standard parameters of {}, SI units.\n# They leave {} % of the torques of {} unexplained, the base parameters {} %.\nrobot = \"{}\"\n\n[parameters]\n",
        visible(&identification.robot),
        significant(consistent.relative_error_percent, 4),
        match identification.runs.len() {
            1 => String::from("a run"),
            count => format!("{count} runs"),
        },
        significant(consistent.base_relative_error_percent, 4),
        visible(&identification.robot)
    );
    for one in &consistent.parameters {
        let _ = writeln!(text, "{} = {:e} # {}", one.name, one.value, one.unit);
    }
    Some(text)
}
