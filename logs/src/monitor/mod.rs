//! Statistics and plausibility of a run's raw numbers, collected while it is read.
//!
//! - `run_monitor`: stuck encoders, standstill, torques at an extreme;
//! - `lost_samples`: lost samples and repeated rows;
//! - `position`: statistics of an actuator's positions;
//! - `marks`: hashes of samples, to find those of another run;
//! - `peaks`: torques with flat peaks;
//! - `clipping`: their description;
//! - `roughness`: noise of signals, and equal signals;
//! - `suspicion`: implausible data;
//! - `torque_rest`: torques that do not change;
//! - `statistics`: statistics of a stream of numbers.

mod clipping;
mod lost_samples;
mod marks;
mod peaks;
mod position;
mod roughness;
mod run_monitor;
mod statistics;
mod suspicion;
#[cfg(test)]
mod tests;
mod torque_rest;

pub use marks::CommonSamples;
pub use run_monitor::Monitor;
pub use suspicion::{DataFault, Suspicion};
