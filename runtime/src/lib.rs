//! Generated dynamics of robots: the attribute `#[redundant_robot]` and its runtime.
//!
//! The attribute turns a struct into a robot. Its functions follow from a description in TOML, here
//! of a pendulum:
//!
#![cfg_attr(not(feature = "macro"), doc = "```ignore")]
#![cfg_attr(feature = "macro", doc = "```")]
//! use overact::redundant_robot;
//!
//! #[redundant_robot("examples/pendulum.toml")] // relative to the folder of Cargo.toml
//! struct Pendulum;
//!
//! let (q, velocity, acceleration) = ([0.0], [1.0], [2.0]); // rad, rad/s, rad/s²
//! let row = Pendulum::idm_red_platform(&q, &velocity, &acceleration)?;
//! let names = Pendulum::PARAMETERS.map(|parameter| parameter.name);
//! assert_eq!(names, ["zz_1", "mx_1", "fv_1"]);
//! assert_eq!(row, [[2.0, 9.81, 1.0]]); // torque = zz · 2 + mx · 9.81 + fv · 1
//! # Ok::<(), overact::Error>(())
//! ```
//!
//! What to do first:
//!
//! - write a description with the [tutorial]; the [keys] are documented with the robots;
//! - read [generated Rust] for build scripts, choices of functions and 32-bit numbers;
//! - identify the parameters with `overact-robot`, or the command `overact` of `overact-cli`.
//!
//! [tutorial]: https://github.com/overact/overact/blob/main/docs/tutorial.md
//! [keys]: https://github.com/overact/overact/blob/main/robots/README.md
//! [generated Rust]: https://github.com/overact/overact/blob/main/docs/rust.md
//!
//! The runtime has the [`Model`] trait, [`Error`], a few functions of [`math`], and the macro
//! `#[redundant_robot("robot.toml")]`. Forward kinematics is in [`forward`], numeric inverse
//! kinematics in [`inverse`], poses of platforms with parasitic motion in [`parasitic_motion`], and of skeletons with
//! dependent joints in [`dependent_joints`], and the
//! actuator projection for any kept actuators in [`partition`]. [`tension`] distributes the forces of
//! cable robots. [`transmission`] converts torques, gains and limits between motors and joints, and
//! [`online`] estimates parameters while the robot moves.
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

/// Compiles the program of the page on transmissions.
#[cfg(all(doctest, feature = "macro"))]
#[doc = include_str!("../../docs/transmissions.md")]
mod transmissions_page {}

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!(
    "overact needs square roots and trigonometry: enable the feature `std`, or `libm` where there is no standard library"
);

/// Compiles the program of the package's page.
#[cfg(all(doctest, feature = "macro"))]
#[doc = include_str!("../README.md")]
mod readme {}

pub mod block;
pub mod dependent_joints;
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
pub mod tension;
pub mod transmission;
mod with_avx;
mod zeroed_then_fill;

pub use model::{BaseParameter, Body, Info, Model, Parameter};
pub use overact_core::{
    ActuatorGroup, Actuators, Code, Columns, Condition, Effect, Error, Explanation, Extent,
    FrameFunction, FrameQuantity, Function, Input, SINGULAR, SampleError, Sizes, StandardParameter,
    limits,
};
#[cfg(feature = "macro")]
pub use overact_macros::redundant_robot;
pub use with_avx::{with_avx2, with_avx512};
pub use zeroed_then_fill::zeroed_then_fill;
