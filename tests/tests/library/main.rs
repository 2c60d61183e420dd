//! Every robot of `robots/`, compiled and evaluated: against the numeric reference, against the energy,
//! against the recursive Newton-Euler algorithm, at singularities and where something is exactly zero, platforms that move aside, the
//! ranks of its regressor, and backend against backend for every kind of input,
//! and with known parameters.
//!
//! One binary, so that each robot is derived once for all of these.

mod agreement;
mod contract;
mod finite;
mod forms;
mod known;
mod newton_euler;
mod parasitic;
mod pose_step;
mod power;
mod range;
mod ranks;
mod singularities;
