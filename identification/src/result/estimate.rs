//! One estimate of the robot's parameters.

use serde::Serialize;

use super::stage::Stage;
use crate::{
    estimation::{essential::Removal, estimate::LineError},
    regression::{projection::ModelKind, system::PartitionCondition},
};

/// How parameters are estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimator {
    /// By ordinary or weighted least squares, as the settings ask for.
    LeastSquares,
    /// By ordinary least squares, beside weighted ones: where the two differ by more than their deviations, the
    /// model does not explain all lines equally well.
    OrdinaryLeastSquares,
    /// By instrumental variables.
    InstrumentalVariables,
}

/// One estimate of the robot's parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// Which inputs it explains.
    pub model: ModelKind,
    /// Names of the actuators on which the inputs are projected; empty for the platform.
    pub kept_actuators: Vec<String>,
    /// Which parameters are estimated.
    pub stage: Stage,
    /// How.
    pub estimator: Estimator,
    /// Whether least squares were weighted.
    pub weighted: bool,
    /// The parameters.
    pub parameters: Vec<ParameterEstimate>,
    /// ||ρ||, unweighted.
    pub residual_norm: f64,
    /// 100 ||ρ||/||Y||, unweighted.
    pub relative_error_percent: f64,
    /// Condition number of W, neither weighted nor scaled.
    pub condition_number: f64,
    /// r_c, number of equations.
    pub equations: usize,
    /// σ_ρ of the system that was solved.
    pub residual_deviation: f64,
    /// Each line of Γ.
    pub lines: Vec<LineError>,
    /// Weight of each line's equations; all 1 for ordinary least squares.
    pub weights: Vec<f64>,
    /// Where actuators are kept: how badly they determine the platform at worst.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partition: Option<PartitionCondition>,
    /// The way from the base parameters to the essential ones, with the step that was refused, if
    /// the second opinion refused one.
    pub removals: Vec<Removal>,
    /// Why the elimination ended where it did, in words; none at the base stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<String>,
}

impl Estimate {
    /// Places of the parameters among the base parameters.
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

/// The estimate of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterEstimate {
    /// Its name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Its column in the column set.
    #[serde(skip)]
    pub column: usize,
    /// Estimate.
    pub value: f64,
    /// σ under white residuals, (47).
    pub standard_deviation: f64,
    /// 100 σ/|χ|.
    pub relative_standard_deviation_percent: f64,
    /// σ under residuals that are correlated over time and between the lines (see the
    /// module `correlation`), never below the white one: the one to trust.
    pub correlated_standard_deviation: f64,
    /// The 95 % interval of the true value, from the base parameters at every stage (see the
    /// module `intervals`).
    pub interval_95: [f64; 2],
    /// Whether the estimate lies outside of its own interval, which is that of the model with all base
    /// parameters: cancelling others has moved it to where the data speak against it. The deviations above take
    /// the cancelled parameters for zero and know nothing of it.
    pub outside: bool,
    /// The regrouped true value, where it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_value: Option<f64>,
    /// 100 (estimate - true value)/|true value|, where the truth is known and not zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_percent: Option<f64>,
}
