//! Traps: data with one known fault each, and what an identification says of them.
//!
//! - `list`: the faults;
//! - `alter`: how they are made of faultless records;
//! - `outcome`: how wrong the parameters get, and what the verdict says.

mod alter;
mod list;
mod outcome;

pub use list::{Change, Trap, traps};
pub use outcome::{Outcome, Standing, clean, identified, outcome, prepared};
