//! Robots of `robots/`, generated and checked in: to use, to read beside the paper, to compare.
//!
//! One module per robot that people read; `manifest.toml` beside this folder has the cost and a hash of
//! every function of every robot. `cargo xtask generated` writes both, `cargo xtask freshness` says
//! whether they are up to date, and `cargo xtask generated ROBOT` writes any other robot's module to
//! `target/generated/`.

#[rustfmt::skip]
mod dualv;
#[rustfmt::skip]
mod emps;
#[rustfmt::skip]
mod five_bar;
#[rustfmt::skip]
mod rx90;
#[rustfmt::skip]
mod three_leg_point;

pub use dualv::DualV;
pub use emps::Emps;
pub use five_bar::FiveBar;
pub use rx90::Rx90;
pub use three_leg_point::ThreeLegPoint;
