//! Tests of the workspace against independently computed numbers.
//!
//! - [`mod@reference`] computes everything numerically, with other methods than the generator;
//! - [`support`] combines descriptions, generated code and reference.

pub mod reference;
pub mod support;
