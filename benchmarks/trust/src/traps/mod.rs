//! Traps: data with one known fault each, and the results of identifications.
//!
//! - `list`: faults;
//! - `alter`: application to faultless records;
//! - `outcome`: parameter errors and verdicts.

mod alter;
mod list;
mod outcome;

pub use list::{Change, Trap, traps};
pub use outcome::{Outcome, Standing, clean, identified, outcome, prepared};
