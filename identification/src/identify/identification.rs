//! Result of an identification, for printing and serialisation.
//!
//! The field names are the keys of the document. A report uses these parts:
//!
//! - parameters with both standard deviations: [`ParameterEstimate`](crate::ParameterEstimate);
//! - path and stop of the elimination: [`Estimate::removals`], [`Estimate::stop`];
//! - conditioning: [`Estimate::partition`];
//! - Table 3: [`CrossValidation`], [`TorqueComparison`](crate::TorqueComparison);
//! - Table 4: [`Identification::tracking`], filled by others;
//! - checks and verdicts;
//! - plots in reduced resolution: [`Identification::figures`], serialised separately (see
//!   [`Figures`](super::figures::Figures)).

use std::collections::BTreeMap;

use serde::Serialize;

use crate::{
    assessment::{
        check::{Check, Grade},
        detectable::Detectable,
        detection_limits::detection_limits,
        verdict::Verdict,
    },
    calibration::Calibration,
    consistent::Consistent,
    estimation::{base::BaseParameters, instruments::regressor::ErrorsInRegressor},
    gains::{DriveGain, JointParameter},
    gravity::GravityDirection,
    online::OnlineEstimate,
    regression::columns::ColumnSet,
    result::{
        CrossValidation, Estimate, Estimator, FunctionParameter, MotorParameter, Regrouping,
        RunSummary, StageTime,
    },
    settings::Settings,
    thresholds::Thresholds,
};

use super::{
    figures::Figures, gear_friction::DriveGearFriction, stribeck_velocity::StribeckVelocity,
    tracking::TrackingError,
};

/// Result of an identification.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identification {
    /// Name of the robot.
    pub robot: String,
    /// Training runs.
    pub runs: Vec<RunSummary>,
    /// Base parameters and their regroupings.
    pub base_parameters: Vec<BaseParameter>,
    /// Standard parameters that have no effect on the model.
    pub without_effect: Vec<String>,
    /// Estimates: for each model base, recommended and essential parameters by least squares.
    ///
    /// Then follow base parameters by ordinary least squares and by instrumental variables, if
    /// available.
    pub estimates: Vec<Estimate>,
    /// Physically consistent parameters with the best fit, for each model.
    pub consistent: Vec<Consistent>,
    /// Every estimate on every validation run.
    pub cross_validation: Vec<CrossValidation>,
    /// Warnings before using the result.
    pub warnings: Vec<String>,
    /// All checks; failed ones are also among the warnings.
    pub checks: Vec<Check>,
    /// Assumptions that these data cannot test.
    pub assumptions: Vec<String>,
    /// Detection limits: for each kind of fault the harmful faults that these data would not show.
    ///
    /// [`Identification::detection_limits`] has all of them with all parameters that they shift.
    pub unseen: Vec<String>,
    /// Verdicts: whether the estimates may be used, and why, one for each model.
    pub verdicts: Vec<Verdict>,
    /// Thresholds of the elimination and the conditioning.
    pub thresholds: Thresholds,
    /// Calibrated encoder offsets and lengths, if they were estimated from the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// Direction of gravity, if it was identified from the runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<GravityDirection>,
    /// Gains of the drives relative to the described ones, if they were identified from the runs.
    ///
    /// All torques were multiplied by them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<DriveGain>,
    /// Base parameters estimated together with the gains.
    ///
    /// Their standard deviations include the uncertainty of the gains. So do
    /// `correlated_standard_deviation` and `interval_95` of the other estimates, unlike
    /// `standard_deviation`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gain_parameters: Vec<JointParameter>,
    /// Friction of the gears, if it was identified from the runs.
    ///
    /// All torques are those that the gears transmit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gear_friction: Vec<DriveGearFriction>,
    /// Stribeck velocities, if they were identified from the runs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stribeck_velocities: Vec<StribeckVelocity>,
    /// Motor-side parameters of the drives, if motors are described.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub motors: Vec<MotorParameter>,
    /// First model's base estimate in the parameters of functions like `inverse_dynamics_base`.
    ///
    /// They may be other combinations than the estimated ones of the same names, if the functions'
    /// columns are chosen for the fewest operations.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub functions_base: Vec<FunctionParameter>,
    /// Table 4, if controlled runs were compared.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tracking: Vec<TrackingError>,
    /// Time of each stage, if it was measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub timings: Vec<StageTime>,
    /// Base parameters of the first model over time, if a replay was requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub online: Vec<OnlineEstimate>,
    /// Effect of regressor errors, for each model.
    pub errors_in_regressor: Vec<ErrorsInRegressor>,
    /// The settings used.
    pub settings: Settings,
    /// Data for plots.
    #[serde(skip)]
    pub figures: Figures,
}

impl Identification {
    /// Least-squares estimates: for each model base, recommended and essential parameters.
    pub fn by_least_squares(&self) -> impl Iterator<Item = &Estimate> {
        let own = |one: &&Estimate| one.estimator == Estimator::LeastSquares;
        self.estimates.iter().filter(own)
    }

    /// Grade of the result as a whole: that of the first model, which includes all actuators.
    #[must_use]
    pub fn grade(&self) -> Grade {
        self.verdicts
            .first()
            .map_or(Grade::DoNotUse, |verdict| verdict.grade)
    }

    /// Harmful faults that these data would not show, by kind; none for a refused result.
    #[must_use]
    pub fn detection_limits(&self) -> Vec<&Detectable> {
        let refused = |one: &Verdict| one.grade == Grade::DoNotUse;
        if self.verdicts.iter().all(refused) {
            return Vec::new();
        }
        detection_limits(&self.checks)
    }
}

/// A base parameter: a kept standard parameter with its regrouping.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaseParameter {
    /// Name, with the suffix `R` if others are regrouped into it.
    pub name: String,
    /// Name of the kept parameter.
    pub parameter: String,
    /// SI unit.
    pub unit: String,
    /// Terms added to the kept parameter.
    pub regrouping: Vec<Regrouping>,
    /// True value, if known.
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
