//! How well an estimate predicts a run that it was not made from.

use serde::Serialize;

use super::stage::Stage;
use crate::{
    estimation::estimate::LineError,
    regression::projection::ModelKind,
    series::Series,
    validation::{TorqueComparison, Validation},
};

/// How well an estimate reproduces a run that it was not made from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrossValidation {
    /// Name of the run.
    pub run: String,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// ||Y - W χ||.
    pub residual_norm: f64,
    /// 100 ||Y - W χ||/||Y||.
    pub relative_error_percent: f64,
    /// Each line of Γ.
    pub lines: Vec<LineError>,
    /// Each actuator's torque against the least-norm prediction.
    pub torques: Vec<LineError>,
    /// Each measured torque, freed of its internal part (50), against the prediction; empty without
    /// redundancy.
    pub projected_torques: Vec<LineError>,
    /// Table 3: each actuator's torque against both predictions, the least-norm one and that of
    /// eq. (26).
    pub table: Vec<TorqueComparison>,
    /// The lines over time, for plots.
    #[serde(skip)]
    pub line_series: Vec<Series>,
    /// The torques over time, for plots.
    #[serde(skip)]
    pub torque_series: Vec<Series>,
}

impl CrossValidation {
    /// Joins what an estimate explains and of which parameters to its validation.
    #[must_use]
    pub fn new((model, stage): (ModelKind, Stage), payload: bool, validation: Validation) -> Self {
        Self {
            run: validation.run,
            payload,
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
