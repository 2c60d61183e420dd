//! overact in a browser: functions that the page's script calls in a worker.
//!
//! Inputs are texts; outputs are texts and JSON documents. Nothing here accesses the page, a
//! network or a disk. Errors are thrown as JSON: a list of problems with their lines.
//!
//! - `description`: errors and drawing of a description that is being edited;
//! - `model`: a compiled description: parameters, operations, Rust and C;
//! - `session`: virtual runs, logs and identification of a robot;
//! - `values`: functions at samples;
//! - `progress`: progress and internal errors, reported to the script.

mod description;
mod model;
mod problems;
mod progress;
mod session;
mod values;

pub use description::Description;
pub use model::Model;
pub use progress::listen;
pub use session::{Identified, Session};
