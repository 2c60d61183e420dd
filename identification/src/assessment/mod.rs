//! Whether an identification may be believed: checks, each with what was measured and what it was held
//! against, and the verdict that follows from them alone.
//!
//! - `check`: one result of one check, and the grades;
//! - `evidence`: the series that shows it;
//! - `checks`: all checks, a file for each;
//! - `verdict`: what may be done with the estimates of a model;
//! - `assumptions`: what no data can show;
//! - `positions`: positions that contradict the loops, and what would make them close;
//! - `rotation`: angles of many turns, of joints that rotate on or in degrees;
//! - `torques`: torques that contradict the model, and which fault would explain them; `whole`: faults of whole runs;
//! - `suspects`: what the model may lack, held against what it leaves unexplained;
//! - `explained`: what may have led to an error.

pub(crate) mod assumptions;
pub(crate) mod check;
pub(crate) mod checks;
pub(crate) mod evidence;
mod explained;
mod positions;
pub(crate) mod suspects;
pub(crate) mod torques;
pub(crate) mod verdict;
mod whole;

pub(crate) use checks::{Context, Watched, checks, raw_numbers::suspicious};
pub(crate) use explained::explained;
