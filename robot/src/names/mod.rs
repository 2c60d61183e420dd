//! Actuators and functions of a robot by name.

pub(crate) mod kept;
pub(crate) mod named;
