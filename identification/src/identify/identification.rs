//! The result of an identification, as it is printed and as it is serialised: the names of the
//! fields are the keys of the document.
//!
//! A report finds here: parameters with both standard deviations ([`ParameterEstimate`](crate::ParameterEstimate)), the path of
//! the elimination and its stop ([`Estimate::removals`], [`Estimate::stop`]), conditioning
//! ([`Estimate::partition`]), Table 3 ([`CrossValidation`], [`TorqueComparison`](crate::TorqueComparison)), Table 4
//! ([`Identification::tracking`], filled by others), checks and the verdicts that follow from them, and in
//! [`Identification::figures`] all that is plotted, in reduced resolution (see
//! [`Figures`](super::figures::Figures); it is left out of the document, and serialises by itself).

use std::collections::BTreeMap;

use serde::Serialize;

use crate::{
    assessment::{
        check::{Check, Grade},
        verdict::Verdict,
    },
    calibration::Calibration,
    consistent::Consistent,
    estimation::{base::BaseParameters, instruments::regressor::ErrorsInRegressor},
    gains::{DriveGain, JointParameter},
    gravity::GravityDirection,
    regression::columns::ColumnSet,
    result::{
        CrossValidation, Estimate, Estimator, FunctionParameter, MotorParameter, Regrouping,
        RunSummary,
    },
    settings::Settings,
    thresholds::Thresholds,
};

use super::{figures::Figures, tracking::TrackingError};

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
    /// The estimates: for each model base, recommended and essential, all by least squares; then those
    /// of the base parameters by instruments, where there are some.
    pub estimates: Vec<Estimate>,
    /// For each model the standard parameters that a robot can have and that explain the data best.
    pub consistent: Vec<Consistent>,
    /// Every estimate on every run that was not identified from.
    pub cross_validation: Vec<CrossValidation>,
    /// What the user should know before trusting the numbers.
    pub warnings: Vec<String>,
    /// What was checked; the words of those that found something stand among the warnings, too.
    pub checks: Vec<Check>,
    /// What the result rests on, since no data can show it.
    pub assumptions: Vec<String>,
    /// Faults that spoil parameters in a size that these data would not have shown: of each kind the worst.
    pub unseen: Vec<String>,
    /// What may be done with the estimates, and why: one for each case.
    pub verdicts: Vec<Verdict>,
    /// The thresholds of the second opinion and of the conditioning.
    pub thresholds: Thresholds,
    /// Encoder offsets and lengths with which everything was estimated, where they were calibrated from
    /// the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// The direction of gravity, where it was identified from the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<GravityDirection>,
    /// Gains of the drives, relative to those of the description, by which all torques were multiplied, where
    /// they were identified from the runs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<DriveGain>,
    /// The base parameters that were estimated together with the gains. Their deviations have a part that is
    /// the gains', as have `correlated_standard_deviation` and `interval_95` of the other estimates;
    /// `standard_deviation` of these holds for the gains as they were found.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gain_parameters: Vec<JointParameter>,
    /// Base estimates of the drives' parameters in front of their gears, where motors are described.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motors: Vec<MotorParameter>,
    /// The base estimate of the first model in the base parameters that functions like `inverse_dynamics_base`
    /// take, in their order. They may be other sums than those that are estimated, of the same names, where the
    /// functions' columns are chosen for the fewest operations.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub functions_base: Vec<FunctionParameter>,
    /// Table 4, where controlled runs were compared.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tracking: Vec<TrackingError>,
    /// For each model, whether errors of the regressor spoil it.
    pub errors_in_regressor: Vec<ErrorsInRegressor>,
    /// The settings used.
    pub settings: Settings,
    /// What is plotted.
    #[serde(skip)]
    pub figures: Figures,
}

impl Identification {
    /// The estimates by least squares: for each model base, recommended and essential.
    pub fn by_least_squares(&self) -> impl Iterator<Item = &Estimate> {
        let own = |one: &&Estimate| one.estimator == Estimator::LeastSquares;
        self.estimates.iter().filter(own)
    }

    /// What may be done with the result as a whole: the grade of the first case, which takes in all
    /// actuators.
    #[must_use]
    pub fn grade(&self) -> Grade {
        self.verdicts
            .first()
            .map_or(Grade::DoNotUse, |verdict| verdict.grade)
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
