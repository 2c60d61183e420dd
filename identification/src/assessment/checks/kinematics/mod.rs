//! Checks of the closure, encoders and lengths.

pub(crate) mod closure;
pub(crate) mod geometry;
