//! The result of an identification, as it is printed and as it is serialised: the names of the
//! fields are the keys of the document.
//!
//! A report finds here: parameters with both standard deviations ([`ParameterEstimate`]), the path of
//! the elimination and its stop ([`Estimate::removals`], [`Estimate::stop`]), conditioning
//! ([`Estimate::partition`]), Table 3 ([`CrossValidation`], [`TorqueComparison`]), Table 4
//! ([`Identification::tracking`], filled by others), findings and verdicts with their thresholds, and in
//! [`Identification::figures`] all that is plotted, in reduced resolution (see
//! [`Figures`](super::figures::Figures); it is left out of the document, and serialises by itself).

use std::collections::BTreeMap;

use serde::Serialize;

use crate::{
    data::Log,
    estimation::{base::BaseParameters, essential::Removal, estimate::LineError},
    finding::{Finding, Thresholds},
    regression::{
        columns::ColumnSet, observation::Seen, projection::ModelKind, system::PartitionCondition,
    },
    series::Series,
    settings::Settings,
    validation::{TorqueComparison, Validation},
};

use super::{
    figures::Figures,
    stage::Stage,
    verdict::{TrackingError, Verdict},
};

/// Everything that an identification found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identification {
    /// Name of the robot.
    pub robot: String,
    /// The runs identified from.
    pub runs: Vec<RunSummary>,
    /// The base parameters and what is regrouped into them.
    pub base_parameters: Vec<BaseParameter>,
    /// Standard parameters that have no effect on the model.
    pub without_effect: Vec<String>,
    /// The estimates: for each model base, recommended and essential.
    pub estimates: Vec<Estimate>,
    /// Every estimate on every run that was not identified from.
    pub cross_validation: Vec<CrossValidation>,
    /// What the user should know before trusting the numbers.
    pub warnings: Vec<String>,
    /// What is suspicious in the data; each one stands among the warnings, too.
    pub findings: Vec<Finding>,
    /// What can be trusted, and why: one for each case.
    pub verdicts: Vec<Verdict>,
    /// The thresholds of the verdicts and the second opinion.
    pub thresholds: Thresholds,
    /// Table 4, where controlled runs were compared.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tracking: Vec<TrackingError>,
    /// The settings used.
    pub settings: Settings,
    /// What is plotted.
    #[serde(skip)]
    pub figures: Figures,
}

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
    pub(super) fn new(log: &Log, seen: &Seen) -> Self {
        Self {
            name: log.name().to_owned(),
            samples: seen.samples,
            sampling_frequency: log.sampling_frequency(),
            payload: log.payload(),
            closure_residual: seen.closure_residual,
        }
    }
}

/// A base parameter: a kept standard parameter and what is regrouped into it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaseParameter {
    /// Its name, with the suffix `R` where others are regrouped into it.
    pub name: String,
    /// Name of the kept parameter.
    pub parameter: String,
    /// SI unit.
    pub unit: String,
    /// What is added to the kept parameter.
    pub regrouping: Vec<Regrouping>,
    /// Its true value, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_value: Option<f64>,
}

/// One term of a base parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regrouping {
    /// Name of the parameter that is regrouped.
    pub parameter: String,
    /// Its coefficient.
    pub coefficient: f64,
}

impl BaseParameter {
    /// All base parameters by name.
    #[must_use]
    pub fn all(
        columns: &ColumnSet,
        base: &BaseParameters,
        true_values: Option<&BTreeMap<String, f64>>,
    ) -> Vec<Self> {
        let name = |index: usize| {
            columns
                .as_slice()
                .get(index)
                .map_or_else(String::new, |column| column.name.clone())
        };
        let none = BTreeMap::new();
        let values = base.regrouped(columns, true_values.unwrap_or(&none));
        base.columns
            .iter()
            .zip(&base.regroupings)
            .zip(base.names.iter().zip(values))
            .map(|((&kept, regrouping), (own_name, true_value))| Self {
                name: own_name.clone(),
                parameter: name(kept),
                unit: columns
                    .as_slice()
                    .get(kept)
                    .map_or_else(String::new, |column| column.unit.to_owned()),
                regrouping: regrouping
                    .iter()
                    .map(|&(deleted, coefficient)| Regrouping {
                        parameter: name(deleted),
                        coefficient,
                    })
                    .collect(),
                true_value,
            })
            .collect()
    }
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
    /// The regrouped true value, where it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub true_value: Option<f64>,
    /// 100 (estimate - true value)/|true value|, where the truth is known and not zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_percent: Option<f64>,
}

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
    /// Joins an estimate's identity to its validation.
    #[must_use]
    pub fn new(estimate: &Estimate, payload: bool, validation: Validation) -> Self {
        Self {
            run: validation.run,
            payload,
            model: estimate.model,
            stage: estimate.stage,
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
