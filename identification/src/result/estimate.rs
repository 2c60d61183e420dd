//! One estimate of the robot's parameters.

use serde::Serialize;

use super::stage::Stage;
use crate::{
    estimation::{essential::Removal, estimate::LineError},
    regression::{projection::ModelKind, system::PartitionCondition},
};

/// Estimation method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// Ordinary or weighted least squares, according to the settings.
    LeastSquares,
    /// Ordinary least squares, in addition to weighted ones.
    ///
    /// If both differ by more than their standard deviations, the model does not explain all lines
    /// equally well.
    OrdinaryLeastSquares,
    /// Instrumental variables.
    InstrumentalVariables,
}

/// One estimate of the robot's parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// Model.
    pub model: ModelKind,
    /// Names of the kept actuators; empty for the platform projection.
    pub kept_actuators: Vec<String>,
    /// Stage: which parameters are estimated.
    pub stage: Stage,
    /// Estimation method.
    pub estimator: Estimator,
    /// Whether least squares were weighted.
    pub weighted: bool,
    /// Parameters.
    pub parameters: Vec<ParameterEstimate>,
    /// ||ρ||, unweighted.
    pub residual_norm: f64,
    /// 100 ||ρ||/||Y||, unweighted.
    pub relative_error_percent: f64,
    /// Condition number of W, neither weighted nor scaled.
    pub condition_number: f64,
    /// Number of equations, r_c.
    pub equations: usize,
    /// σ_ρ of the solved system.
    pub residual_deviation: f64,
    /// Residual of each line of Γ.
    pub lines: Vec<LineError>,
    /// Weight of each line's equations; all 1 for ordinary least squares.
    pub weights: Vec<f64>,
    /// Worst condition of the kept actuators, for an actuator projection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partition: Option<PartitionCondition>,
    /// Path from the base to the essential parameters, with the refused step, if there is one.
    pub removals: Vec<Removal>,
    /// Reason for the end of the elimination, in words; `None` at the base stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<String>,
}

impl Estimate {
    /// Indices of the parameters among the base parameters.
    #[must_use]
    pub fn columns(&self) -> Vec<usize> {
        self.parameters
            .iter()
            .map(|parameter| parameter.column)
            .collect()
    }

    /// Values of the parameters (SI units).
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.parameters
            .iter()
            .map(|parameter| parameter.value)
            .collect()
    }
}

/// Estimate of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterEstimate {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Index among the base parameters.
    #[serde(skip)]
    pub column: usize,
    /// Estimate.
    pub value: f64,
    /// σ for white residuals, (47).
    pub standard_deviation: f64,
    /// 100 σ/|χ|.
    pub relative_standard_deviation_percent: f64,
    /// σ for residuals correlated over time and between lines; prefer this one.
    ///
    /// At least that for white residuals; see the module `correlation`.
    pub correlated_standard_deviation: f64,
    /// 95 % interval of the true value, from the base estimate at every stage; see `intervals`.
    pub interval_95: [f64; 2],
    /// Whether the estimate is outside its interval, which is that of the base model.
    ///
    /// Elimination of others has then moved it to a value that the data contradict. The standard
    /// deviations above assume that eliminated parameters are zero, and do not show this.
    pub outside: bool,
    /// Regrouped true value, if known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_value: Option<f64>,
    /// 100 (estimate - true value)/|true value|, if the true value is known and not zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_percent: Option<f64>,
}
