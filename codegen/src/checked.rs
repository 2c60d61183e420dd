//! A description checked without its model: all that [`compile`](crate::compile()) would refuse, and none of
//! the work of deriving, choosing and lowering functions, which takes long for chains of many joints.

use crate::derivation::derivable;
use crate::mechanism::{self, Mechanism};
use overact_description::Description;
use overact_description::diagnostic::{Diagnostics, Source};

/// A description without errors.
#[derive(Debug)]
pub struct Checked {
    /// What the text says.
    pub description: Description,
    /// The mechanism with its home configuration.
    pub mechanism: Mechanism,
}

/// From a description's text to a mechanism that has a model.
///
/// # Errors
/// All errors of the description, each at its place; the same as those of
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
