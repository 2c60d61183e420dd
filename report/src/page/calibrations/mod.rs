//! Sections on quantities estimated besides parameters: offsets, lengths, gravity, drive gains.

pub(crate) mod calibration;
pub(crate) mod gains;
pub(crate) mod gears;
pub(crate) mod gravity;
