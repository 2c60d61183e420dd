//! A robot's description as a running robot: what a Rust user and the command line stand on.
//!
//! - [`load`]: a description is read and compiled;
//! - [`InterpretedRobot`]: its model, served as [`overact::Model`] without a compiler at hand;
//! - [`settings`], [`experiment`]: its tables as the inputs of identification and simulation;
//! - [`Error`]: what is wrong, all of it at once, each at its place.

mod error;
pub mod experiment;
mod interpreted;
pub mod load;
pub mod settings;

pub use error::{Column, Error, Problem};
pub use interpreted::InterpretedRobot;
