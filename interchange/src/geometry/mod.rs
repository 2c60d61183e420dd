//! Rotations and numbers without loss of digits.

pub(crate) mod digits;
pub(crate) mod exact;
