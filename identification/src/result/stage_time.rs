//! Times of the stages of an identification.

use serde::Serialize;

/// Time that a stage or a check took.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageTime {
    /// Name of the stage, or what a check examines.
    pub stage: String,
    /// Whether it is a check.
    pub is_check: bool,
    /// Elapsed time, s.
    pub seconds: f64,
    /// Time of all processors, s; `None` if the system does not tell it.
    pub processor_seconds: Option<f64>,
}
