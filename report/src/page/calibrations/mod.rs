//! Sections on offsets, lengths, gravity, drive gains, friction of gears and Stribeck velocities.

pub(crate) mod calibration;
pub(crate) mod gains;
pub(crate) mod gears;
pub(crate) mod gravity;
pub(crate) mod stribeck;
