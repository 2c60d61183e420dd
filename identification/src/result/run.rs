//! What is told of a run identified from.

use serde::Serialize;

use crate::{data::Log, regression::observation::Seen};

/// A run identified from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSummary {
    /// Its name.
    pub name: String,
    /// Samples used, before decimation.
    pub samples: usize,
    /// f_m, Hz.
    pub sampling_frequency: f64,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Name of the payload, where there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_name: Option<String>,
    /// Largest miss of the loops' closure by the measured actuators (m, rad).
    pub closure_residual: f64,
    /// Of each actuator's joint the equations that were left out because it stood still; empty where none
    /// were to be.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub standstill_equations: Vec<usize>,
}

impl RunSummary {
    /// What is told of a run.
    pub(crate) fn new(log: &Log, seen: &Seen) -> Self {
        Self {
            name: log.name().to_owned(),
            samples: seen.samples,
            sampling_frequency: log.sampling_frequency(),
            payload: log.payload(),
            payload_name: log.payload_name().map(str::to_owned),
            closure_residual: seen.closure_residual,
            standstill_equations: seen.still.clone(),
        }
    }
}
