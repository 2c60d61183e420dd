//! Table 4: how well controllers track runs with the identified parameters.

use serde::Serialize;

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
