//! What is to be thought of a result, in words, and what others found out about it.

use serde::Serialize;

/// How far one may trust something.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// What is judged: `case 1`, `case 2`, `joint model`, `data`.
    pub subject: String,
    /// Whether it can be trusted.
    pub trusted: bool,
    /// Why, in sentences.
    pub reasons: Vec<String>,
}

/// Tracking errors of one controller on one run, as in Table 4: filled by whoever simulates or measures
/// controlled runs; the identification leaves the list empty.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrackingError {
    /// Name of the run.
    pub run: String,
    /// `pd`, `computed torque, case 1`, `computed torque, case 2`.
    pub controller: String,
    /// Names of the actuators.
    pub actuators: Vec<String>,
    /// max |q desired - q measured| of each actuator (m, rad).
    pub largest: Vec<f64>,
}
