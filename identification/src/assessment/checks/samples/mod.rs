//! Checks of raw samples, times and repeated logs.

pub(crate) mod cables;
pub(crate) mod clock;
pub(crate) mod raw_samples;
pub(crate) mod repeated;
pub(crate) mod rotation;
