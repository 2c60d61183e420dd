//! Every robot of `robots/`, compiled and evaluated: against the numeric reference, against the energy,
//! against the recursive Newton-Euler algorithm, at singularities, and the ranks of its regressor.
//!
//! One binary, so that each robot is derived once for all of these.

mod agreement;
mod newton_euler;
mod power;
mod ranks;
mod singularities;
