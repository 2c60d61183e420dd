//! What the raw numbers of a run tell by themselves while they are gone through: data that can't be
//! right.
//!
//! - `watch`: stuck encoders, lost samples, a robot that stands still;
//! - `position`: what is followed of an actuator's positions;
//! - `marks`: samples by which a run is known again;
//! - `peaks`: torques that are flat at their extremes;
//! - `clipping`: what is told of them;
//! - `roughness`: noise of signals, and signals that are equal;
//! - `suspicion`: what is suspicious;
//! - `statistics`: what is kept of numbers that pass.

mod clipping;
mod marks;
mod peaks;
mod position;
mod roughness;
mod statistics;
mod suspicion;
#[cfg(test)]
mod tests;
mod watch;

pub(crate) use suspicion::{Suspicion, Trouble};
pub(crate) use watch::Monitor;
