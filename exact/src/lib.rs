//! Exact constants and their images in a finite field.
//!
//! A [`Number`] is a fraction, or a product of fractions, roots and powers of π that stays exact.
//! An [`Angle`] is a rational multiple of π plus a fraction of a radian. Both have an image in the
//! finite [`field`], in which two expressions are equal if they are equal as real numbers (Schwartz
//! and Zippel).
//!
//! ```
//! use overact_exact::{Angle, Number, Ratio};
//!
//! let angle = Angle::degrees(Ratio::decimal("30").ok_or("no number")?).ok_or("overflow")?;
//! let (cosine, sine) = angle.cosine_and_sine();
//! assert_eq!(sine, Number::ratio(Ratio::new(1, 2).ok_or("overflow")?));
//! assert_eq!(cosine.image() * cosine.image() + sine.image() * sine.image(), Number::ONE.image());
//! # Ok::<(), &str>(())
//! ```
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
