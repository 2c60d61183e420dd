//! Standard parameters: their bodies, values from files and physical consistency.

pub(crate) mod body;
pub(crate) mod given_parameters;
pub(crate) mod physical;
