//! Tests of the workspace against numbers that were found independently.
//!
//! - [`mod@reference`] computes everything numerically, by other means than the generator;
//! - [`support`] brings descriptions, generated code and reference together.

pub mod reference;
pub mod support;
