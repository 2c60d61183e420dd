//! Table 4: tracking errors of controllers with the identified parameters.

use serde::Serialize;

/// Tracking errors of one controller on one run, as in Table 4.
///
/// The caller fills them after simulating or measuring controlled runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrackingError {
    /// Name of the run.
    pub run: String,
    /// `pd`, `computed torque, platform projection`, `computed torque, actuator projection`.
    pub controller: String,
    /// Names of the actuators.
    pub actuators: Vec<String>,
    /// max |q desired - q measured| of each actuator (m, rad).
    pub largest: Vec<f64>,
}
