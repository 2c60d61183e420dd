//! Units of signals: plausible ranges of quantities, and common unit errors.
//!
//! - `quantity`: a measured quantity with its ranges, and its dependence on each signal's unit;
//! - `unit_error`: common unit errors, and which one explains quantities out of their ranges.

mod quantity;
#[cfg(test)]
mod tests;
mod unit_error;

pub(crate) use quantity::{Powers, Quantity, Range};
pub(crate) use unit_error::{Kinds, Signal, UNIT_ERRORS, UnitError, explanation, time_of_sampling};
