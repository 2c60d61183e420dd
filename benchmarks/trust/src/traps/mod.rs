//! Traps: data with one known fault each, and the results of identifications.
//!
//! - `list`: faults;
//! - `alter`: application to faultless records;
//! - `physics`: effects that a model lacks, of one drive or of all; motions that excite too little;
//! - `known_fault`: faults for which reports state detection limits;
//! - `outcome`: parameter errors and verdicts.

mod alter;
mod known_fault;
mod list;
mod outcome;
mod physics;

pub use known_fault::{KnownFault, Place};
pub use list::{Change, PlanChange, Trap, traps};
pub use outcome::{Outcome, Standing, clean, identified, identified_logs, outcome, prepared};
pub use physics::physics;
