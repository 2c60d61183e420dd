//! Sections on offsets, lengths, gravity, drive gains and friction of gears.

pub(crate) mod calibration;
pub(crate) mod gains;
pub(crate) mod gears;
pub(crate) mod gravity;
