//! Robot models.
#[rustfmt::skip]
mod dualv;
pub use dualv::DualV;
