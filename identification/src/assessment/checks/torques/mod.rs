//! Checks of torques: sensor faults, delay, gains, reversals and smoothing.

pub(crate) mod delay;
pub(crate) mod gains;
pub(crate) mod half_band;
pub(crate) mod reversals;
pub(in crate::assessment) mod smoothing;
pub(crate) mod torque_faults;
