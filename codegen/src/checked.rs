//! Check of a description without its model.
//!
//! It reports all errors of [`compile`](crate::compile()), but does not derive, choose and lower
//! functions, which takes long for chains of many joints.

use crate::derivation::derivable;
use crate::mechanism::{self, Mechanism};
use overact_description::Description;
use overact_description::diagnostic::{Diagnostics, Source};

/// A description without errors.
#[derive(Debug)]
pub struct Checked {
    /// The parsed text.
    pub description: Description,
    /// The mechanism with its home configuration.
    pub mechanism: Mechanism,
}

/// Checks a description's text; returns a mechanism that has a model.
///
/// # Errors
/// All errors of the description, each at its location; the same as those of
/// [`compile`](crate::compile()).
pub fn check(source: &Source) -> Result<Checked, Diagnostics> {
    let description = overact_description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    derivable(&mechanism).map_err(|error| error.locate(&description))?;
    Ok(Checked {
        description,
        mechanism,
    })
}
