//! Runtime of generated robot models.
//!
//! It has the [`Model`] trait, [`Error`], a few functions of [`math`], and the macro
//! `#[redundant_robot("robot.toml")]`. Forward kinematics is in [`forward`], numeric inverse
//! kinematics in [`inverse`], poses of platforms with parasitic motion in [`parasitic_motion`], and the
//! actuator projection for any kept actuators in [`partition`]. [`online`] estimates parameters while
//! the robot moves.
//!
//! The crate is `no_std` and allocates nothing. Its features are:
//!
//! - `std` (default): square roots and trigonometry come from the standard library;
//! - `libm`, without `std`: they come from the crate of that name;
//! - `dispatch` (default, with `std`): optimised programs (level 2 and 3) for any x86-64 detect
//!   AVX2 and AVX-512 at run time and use them. Long functions are compiled once or twice more, and
//!   last digits may differ between processors.
#![cfg_attr(not(feature = "std"), no_std)]

/// Compiles the program of the page on online estimation.
#[cfg(doctest)]
#[doc = include_str!("../../docs/online.md")]
mod online_page {}

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!(
    "overact needs square roots and trigonometry: enable the feature `std`, or `libm` where there is no standard library"
);

pub mod block;
pub mod float;
pub mod forward;
pub mod guard;
pub mod inverse;
pub mod math;
pub mod model;
pub mod online;
pub mod parasitic_motion;
pub mod partition;
pub mod simd;
mod with_avx;
mod zeroed_then_fill;

pub use model::{BaseParameter, Body, Info, Model, Parameter};
pub use overact_core::{
    ActuatorGroup, Actuators, Code, Columns, Condition, Error, Explanation, Extent, Function,
    Input, SINGULAR, SampleError, Sizes, StandardParameter, limits,
};
#[cfg(feature = "macro")]
pub use overact_macros::redundant_robot;
pub use with_avx::{with_avx2, with_avx512};
pub use zeroed_then_fill::zeroed_then_fill;
