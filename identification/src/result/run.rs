//! Summary of a training run.

use serde::Serialize;
use std::collections::BTreeSet;

use crate::regression::observation::RunObservation;
use overact_logs::{Load, Log};

/// A training run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunSummary {
    /// Name.
    pub name: String,
    /// Number of samples used, before decimation.
    pub samples: usize,
    /// Sampling frequency f_m, Hz.
    pub sampling_frequency: f64,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Name of the payload, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_name: Option<String>,
    /// Name of the recording session, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub session: Option<String>,
    /// Largest closure residual of the measured positions (m, rad).
    pub closure_residual: f64,
    /// Equations of each actuator's joint excluded at standstill.
    ///
    /// Empty if none were to be excluded.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub standstill_equations: Vec<usize>,
}

impl RunSummary {
    /// Number of recording sessions of some runs.
    pub(crate) fn sessions(runs: &[Self]) -> usize {
        let names: BTreeSet<Option<&str>> = runs.iter().map(|run| run.session.as_deref()).collect();
        names.len()
    }

    /// Payload of the run.
    #[must_use]
    pub fn carried(&self) -> Load<'_> {
        Load::new(self.payload, self.payload_name.as_deref())
    }

    /// Summary of a run.
    pub(crate) fn new(log: &Log, observation: &RunObservation) -> Self {
        Self {
            name: log.name().to_owned(),
            samples: observation.samples,
            sampling_frequency: log.sampling_frequency(),
            payload: log.payload(),
            payload_name: log.payload_name().map(str::to_owned),
            session: log.session().map(str::to_owned),
            closure_residual: observation.closure_residual,
            standstill_equations: observation.still.clone(),
        }
    }
}
