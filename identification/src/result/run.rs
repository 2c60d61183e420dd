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
    /// Largest miss of the loops' closure by the measured actuators (m, rad).
    pub closure_residual: f64,
}

impl RunSummary {
    /// What is told of a run.
    pub(crate) fn new(log: &Log, seen: &Seen) -> Self {
        Self {
            name: log.name().to_owned(),
            samples: seen.samples,
            sampling_frequency: log.sampling_frequency(),
            payload: log.payload(),
            closure_residual: seen.closure_residual,
        }
    }
}
