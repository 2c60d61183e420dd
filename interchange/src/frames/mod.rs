//! Computes modified Denavit-Hartenberg constants from axes in space.

pub(crate) mod leg;
pub(crate) mod step;
