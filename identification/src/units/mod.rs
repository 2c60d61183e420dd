//! Units of signals: plausible ranges of quantities, and common unit errors.
//!
//! - `quantity`: a measured quantity with its ranges, and its dependence on each signal's unit;
//! - `slip`: common unit errors, and which one explains quantities out of their ranges.

mod quantity;
mod slip;
#[cfg(test)]
mod tests;

pub(crate) use quantity::{Powers, Quantity, Range};
pub(crate) use slip::{Kinds, SLIPS, Signal, Slip, explanation, time_of_sampling};
