//! One run: the columns that a mapping requests from its files, as samples in SI units by joint.
//!
//! - `columns`, `signals`: requested columns, and their conversion to time and SI units;
//! - `source`, `open_files`: the files of a run, opened;
//! - `time_range`: the rows of a range of time;
//! - `rows`: reads a run, with its files joined;
//! - `clock`, `summary`: the first pass over a run, which checks and counts everything;
//! - `log`: a run, in memory or in its files; `dataset`: all runs of an identification;
//! - `column_plausibility`: whether columns can be the signals assigned to them.

mod clock;
mod column_plausibility;
mod columns;
pub(crate) mod dataset;
pub(crate) mod log;
mod open_files;
mod rows;
mod signals;
pub(crate) mod source;
mod summary;
pub(crate) mod time_range;
