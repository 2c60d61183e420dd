//! Prediction of a validation run by an estimate.

use serde::Serialize;

use super::stage::Stage;
use crate::{
    estimation::estimate::LineError,
    regression::projection::ModelKind,
    series::Series,
    validation::{TorqueComparison, Validation},
};
use overact_logs::Load;

/// Prediction of a validation run by an estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrossValidation {
    /// Name of the run.
    pub run: String,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Name of the payload, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload_name: Option<String>,
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// ||Y - W χ||.
    pub residual_norm: f64,
    /// Relative error, 100 ||Y - W χ||/||Y||.
    pub relative_error_percent: f64,
    /// Errors of each line of Γ.
    pub lines: Vec<LineError>,
    /// Errors of each actuator's torque, predicted with least norm.
    pub torques: Vec<LineError>,
    /// Errors of each measured torque without its internal part (50).
    ///
    /// Empty without redundancy.
    pub projected_torques: Vec<LineError>,
    /// Table 3: errors of each actuator's torque for both predictions, least norm and eq. (26).
    pub table: Vec<TorqueComparison>,
    /// Lines over time, for plots.
    #[serde(skip)]
    pub line_series: Vec<Series>,
    /// Torques over time, for plots.
    #[serde(skip)]
    pub torque_series: Vec<Series>,
}

impl CrossValidation {
    /// Combines a validation with the model and stage of its estimate.
    #[must_use]
    pub fn new(model: ModelKind, stage: Stage, carried: Load<'_>, validation: Validation) -> Self {
        Self {
            run: validation.run,
            payload: carried.is_some(),
            payload_name: carried.name().map(str::to_owned),
            model,
            stage,
            residual_norm: validation.residual_norm,
            relative_error_percent: validation.relative_error_percent,
            lines: validation.lines,
            torques: validation.torques,
            projected_torques: validation.projected_torques,
            table: validation.table,
            line_series: validation.line_series,
            torque_series: validation.torque_series,
        }
    }
}
