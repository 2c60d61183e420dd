//! Tests of every robot of `robots/`, compiled and evaluated.
//!
//! They compare with the numeric reference, the energy and the recursive Newton-Euler algorithm.
//! They also cover singularities, exact zeros, parasitic motion, ranks of the regressor, agreement
//! of backends for every kind of input, and known parameters.
//!
//! One binary, so that each robot is derived once for all tests.

mod agreement;
mod contract;
mod finite;
mod function_forms;
mod known;
mod newton_euler;
mod parasitic;
mod pose_step;
mod power;
mod range;
mod ranks;
mod singularities;
