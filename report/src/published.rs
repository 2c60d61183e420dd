//! Published results of a robot for comparison; never an input of an identification.
//!
//! They are read from a TOML file such as `robots/published/dualv.toml`. Its tables contain
//! parameters by base parameter name, and torque and tracking errors by actuator.

use overact_identification::ModelKind;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Published results of a robot.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// Publication.
    pub source: String,
    /// Note for readers.
    #[serde(default)]
    pub note: Option<String>,
    /// Names of the actuators, in the order of all lists.
    #[serde(default)]
    pub actuators: Vec<String>,
    /// Estimated parameters, as in Table 2.
    #[serde(default, rename = "estimate")]
    pub estimates: Vec<PublishedEstimate>,
    /// Errors of predicted torques, as in Table 3.
    #[serde(default, rename = "cross_validation")]
    pub cross_validation: Vec<PublishedTorques>,
    /// Tracking errors, as in Table 4.
    #[serde(default)]
    pub tracking: Vec<PublishedTracking>,
}

/// The estimate of one model.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedEstimate {
    /// `platform`, `actuators` or `joints`.
    pub model: ModelKind,
    /// 100 ||ρ||/||Y||.
    #[serde(default)]
    pub relative_error_percent: Option<f64>,
    /// Parameters by base parameter name.
    pub parameters: BTreeMap<String, PublishedParameter>,
}

/// One parameter.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedParameter {
    /// Estimate (SI units).
    pub value: f64,
    /// 100 σ/|χ|.
    #[serde(default)]
    pub deviation_percent: Option<f64>,
}

/// Relative errors of the torques of one run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedTorques {
    /// Name of the run.
    pub run: String,
    /// `platform`, `actuators` or `joints`.
    pub model: ModelKind,
    /// 100 ||τ - τ*||/||τ|| of each actuator.
    pub torques_percent: Vec<f64>,
}

/// Tracking errors of one controller on one run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedTracking {
    /// Name of the run.
    pub run: String,
    /// The controller.
    pub controller: String,
    /// max |q desired - q measured| of each actuator (m, rad).
    pub largest: Vec<f64>,
}

impl Published {
    /// The estimate of a model.
    #[must_use]
    pub fn estimate(&self, model: ModelKind) -> Option<&PublishedEstimate> {
        self.estimates.iter().find(|one| one.model == model)
    }

    /// All lists whose length is not the number of actuators: their owner and length.
    #[must_use]
    pub fn wrong_lengths(&self) -> Vec<(String, usize)> {
        let torques = self.cross_validation.iter().map(|one| {
            let what = format!("cross_validation `{}`, {}", one.run, one.model);
            (what, one.torques_percent.len())
        });
        let tracking = self.tracking.iter().map(|one| {
            let what = format!("tracking `{}`, {}", one.run, one.controller);
            (what, one.largest.len())
        });
        torques
            .chain(tracking)
            .filter(|(_, length)| *length != self.actuators.len())
            .collect()
    }
}
