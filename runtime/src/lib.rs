//! What a generated robot model needs at run time, and nothing more: the [`Model`] trait, [`Error`],
//! a few functions of [`math`], forward kinematics in [`forward`], poses of platforms that move aside in [`aside`], numeric
//! inverse kinematics in [`inverse`], case 2 for any kept actuators in [`partition`], and the macro
//! `#[redundant_robot("robot.toml")]`.
//!
//! The crate is `no_std` and allocates nothing. With the feature `std` (default) square roots and
//! trigonometry come from the standard library, with the feature `libm` and without `std` from the crate of
//! that name. With the feature `dispatch` (default, and with it `std`) programs for any x86-64 that are optimised (level 2
//! and 3) find out when they run whether the processor has AVX2 or AVX-512, and use them: long functions are compiled once
//! or twice more, and last digits may differ from one kind of processor to another.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!(
    "overact needs square roots and trigonometry: enable the feature `std`, or `libm` where there is no standard library"
);

pub mod aside;
pub mod block;
mod filled;
pub mod float;
pub mod forward;
pub mod guard;
pub mod inverse;
pub mod lanes;
pub mod math;
pub mod model;
pub mod partition;
mod widest;

pub use filled::filled;
pub use model::{BaseParameter, Body, Info, Model, Parameter};
pub use overact_core::{
    ActuatorGroup, Actuators, Code, Columns, Condition, Error, Explanation, Extent, Function,
    Input, SINGULAR, SampleError, Sizes, StandardParameter, limits,
};
#[cfg(feature = "macro")]
pub use overact_macros::redundant_robot;
pub use widest::{roomiest, widest};
