//! Checks of the motion: excitation, length and filter bands.

pub(crate) mod excitation;
pub(crate) mod filters;
pub(crate) mod motion_length;
