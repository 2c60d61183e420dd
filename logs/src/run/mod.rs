//! One run: the columns that a mapping requests from its files, as samples in SI units by joint.
//!
//! - `columns`, `signals`: requested columns, and their conversion to time and SI units;
//! - `source`, `open_files`: the files of a run, opened;
//! - `time_range`: the rows of a range of time;
//! - `gaps`: gaps in the time of a run, and the stretches between them;
//! - `rows`: reads a run, with its files joined;
//! - `clock`, `summary`: the first pass over a run, which checks and counts everything;
//! - `block_ranges`: ranges of the positions, and long standstills;
//! - `log`: a run, in memory or in its files; `dataset`: all runs of an identification;
//! - `column_plausibility`: whether columns can be the signals assigned to them.

mod block_ranges;
mod clock;
mod column_plausibility;
mod columns;
pub(crate) mod dataset;
pub(crate) mod gaps;
pub(crate) mod log;
mod open_files;
mod rows;
mod signals;
pub(crate) mod source;
pub(crate) mod summary;
pub(crate) mod time_range;
