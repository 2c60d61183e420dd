//! Logs with time, positions or torques in another unit than described, and the results of
//! identifications.

mod cell;
mod slip;

pub use cell::{Cell, Verdict, cells};
pub use slip::{Drives, Signal, Slip, slips};
