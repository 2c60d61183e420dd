//! Exact constants and their images in a finite field.
//!
//! A [`Number`] is a fraction, or a product of fractions, roots and powers of π that stays exact.
//! An [`Angle`] is a rational multiple of π plus a fraction of a radian. Both have an image in the
//! finite [`field`], in which two expressions are equal if they are equal as real numbers (Schwartz
//! and Zippel).
//!
//! The crate knows nothing about robots. The parser of descriptions and the computer algebra use
//! it.

pub mod angle;
pub mod field;
pub mod hasher;
pub mod number;
pub mod ratio;

pub use angle::Angle;
pub use number::Number;
pub use ratio::Ratio;
