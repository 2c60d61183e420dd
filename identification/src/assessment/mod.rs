//! Assessment of an identification: checks, and the verdict that follows from them alone.
//!
//! - `check`: result of one check, and the grades;
//! - `detectable`: detection limit of one fault, `detection_limits`: those of all checks;
//! - `evidence`: the series that shows it;
//! - `checks`: all checks, one per file;
//! - `verdict`: whether the estimates of a model may be used;
//! - `assumptions`: what no data can test;
//! - `positions`: positions that violate the closure, and corrections that restore it;
//! - `torques`: torques that contradict the model, and the fault that explains them;
//! - `run_level_faults`: faults of whole runs or of the model;
//! - `hypotheses`: fault hypotheses tested on the residual;
//! - `explained`: hints at the cause of an error.

pub(crate) mod assumptions;
pub(crate) mod check;
pub(crate) mod checks;
pub(crate) mod detectable;
pub(crate) mod detection_limits;
pub(crate) mod evidence;
mod explained;
pub(crate) mod hypotheses;
mod positions;
mod run_level_faults;
pub(crate) mod torques;
pub(crate) mod verdict;

pub(crate) use checks::{Context, RunMonitor, checks, samples::raw_samples::suspicious};
pub(crate) use explained::explained;
