//! Logs whose time, positions or torques are in another unit than the description says, and what identifications
//! report of them.

mod cell;
mod slip;

pub use cell::{Cell, Verdict, cells};
pub use slip::{Drives, Signal, Slip, slips};
