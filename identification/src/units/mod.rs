//! Units of signals: quantities with the values that robots can have, and the usual slips.
//!
//! - `quantity`: a measured quantity with its bounds, and how it grows with a factor in each signal;
//! - `slip`: the usual slips, and which explains quantities out of their bounds.

mod quantity;
mod slip;
#[cfg(test)]
mod tests;

pub(crate) use quantity::{Powers, Quantity, Range};
pub(crate) use slip::{Kinds, SLIPS, Signal, Slip, explanation, time_of_sampling};
