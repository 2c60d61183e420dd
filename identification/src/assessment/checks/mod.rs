//! All checks, one per file, in a folder for each subject.
//!
//! Each is a function of a read-only [`Context`].
//! The table [`CHECKS`] lists them.

mod admissible_faults;
mod fault_hypotheses;
mod kinematics;
pub(crate) mod level;
mod motion;
mod parameters;
mod residuals;
pub(crate) mod samples;
pub(crate) mod torques;
pub(crate) mod units;

use overact::Model;

use super::{
    check::{About, Check, CheckKind},
    hypotheses::{Pace, Scores},
};
use crate::{
    estimation::{
        base::BaseParameters, column_noise::ColumnNoise, instruments::regressor::ErrorsInRegressor,
    },
    gains::known_values::RedundantValue,
    regression::{columns::ColumnSet, projection::ModelKind, system::System},
    result::{CrossValidation, Estimate, Estimator, Stage},
    settings::Settings,
};
use overact_logs::{Dataset, Error, Log, monitor::Monitor, with_joints};

/// Input of the checks.
pub(crate) struct Context<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) dataset: &'a Dataset<'a>,
    pub(crate) settings: &'a Settings,
    /// Columns of the model, and the base parameters among them.
    pub(crate) columns: &'a ColumnSet,
    pub(crate) base: &'a BaseParameters,
    /// For each projection its system in the base parameters, or the error.
    pub(crate) systems: &'a [Result<System, Error>],
    /// Statistics of the training runs, then of the validation runs.
    pub(crate) watched: &'a [RunMonitor],
    /// All estimates, each with the number of its projection.
    pub(crate) estimates: &'a [(usize, Estimate)],
    /// Models without a physically consistent solution.
    pub(crate) inconsistent: &'a [ModelKind],
    /// Scores of fault hypotheses on the residual of the first base estimate.
    pub(crate) scores: Option<&'a Scores>,
    /// The same in half the band, to distinguish faults from position errors.
    pub(crate) narrow: &'a dyn Fn() -> Result<Option<Scores>, Error>,
    /// Every estimate on every validation run.
    pub(crate) cross_validation: &'a [CrossValidation],
    /// For each model, instrumental variables compared with least squares.
    pub(crate) errors_in_regressor: &'a [ErrorsInRegressor],
    /// For each projection, the effect of position noise on its columns.
    pub(crate) column_noise: &'a [Option<ColumnNoise>],
    /// Known values that others determine, too, if the gains were identified.
    pub(crate) redundant_values: &'a [RedundantValue],
    /// Pose coordinates with their ranges in the training runs (m, rad).
    pub(crate) ranges: &'a [(String, f64)],
}

/// Statistics of a run, collected while its samples are read.
#[derive(Debug, Clone)]
pub(crate) struct RunMonitor {
    /// Statistics of the raw numbers.
    pub(crate) monitor: Monitor,
    /// Largest closure residual (m, rad).
    pub(crate) closure_residual: f64,
}

impl<'a> Context<'a> {
    /// Training runs, then validation runs, with their statistics.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (&'a Log, &'a RunMonitor)> {
        let all = self.dataset.runs.iter().chain(self.dataset.validation);
        all.zip(self.watched)
    }

    /// Whether the position of each actuator changes by more than its noise in a training run.
    pub(crate) fn moving_actuators(&self) -> Vec<bool> {
        let mut moving = vec![false; self.model.info().actuators.len()];
        for run in self.watched.iter().take(self.dataset.runs.len()) {
            for (moving, at_rest) in moving.iter_mut().zip(run.monitor.at_rest()) {
                *moving |= !at_rest;
            }
        }
        moving
    }

    /// Pace of each actuator's motion; `None` for those at rest.
    pub(crate) fn paces(&self, scores: &Scores) -> Vec<Option<Pace>> {
        let paces = scores.paces().into_iter().zip(self.moving_actuators());
        paces.map(|(pace, moves)| pace.filter(|_| moves)).collect()
    }

    /// The system of a model, if it has one.
    pub(crate) fn system(&self, model: ModelKind) -> Option<&'a System> {
        let mut systems = self.systems.iter().filter_map(|one| one.as_ref().ok());
        systems.find(|system| system.projection.model() == model)
    }

    /// The least-squares estimates.
    pub(crate) fn least_squares(&self) -> impl Iterator<Item = &'a Estimate> {
        let all = self.estimates.iter().map(|(_, one)| one);
        all.filter(|one| one.estimator == Estimator::LeastSquares)
    }

    /// The least-squares estimates of a stage.
    pub(crate) fn estimates_of(&self, stage: Stage) -> impl Iterator<Item = &'a Estimate> {
        self.least_squares().filter(move |one| one.stage == stage)
    }
}

/// Signature of a check.
type Function = fn(&Context<'_>) -> Result<Vec<Check>, Error>;

/// All checks with what they examine, in the order of the report.
const CHECKS: [(&str, Function); 25] = [
    ("raw samples", samples::raw_samples::check),
    ("cables", samples::cables::check),
    ("units", units::check),
    ("repeated samples", samples::repeated::check),
    ("excitation", motion::excitation::check),
    ("length of the motion", motion::motion_length::check),
    ("filters", motion::filters::check),
    ("closure of loops", kinematics::closure::check),
    ("faults of torques", torques::torque_faults::check),
    ("delays", torques::delay::check),
    ("smoothed torques", torques::smoothing::check),
    ("reversals", torques::reversals::check),
    ("clock", samples::clock::check),
    ("gains", torques::gains::check),
    ("geometry", kinematics::geometry::check),
    ("known values", parameters::known_values::check),
    ("payload labels", parameters::payload_labels::check),
    ("missing parameters", parameters::missing_parameters::check),
    (
        "negative parameters",
        parameters::negative_parameters::check,
    ),
    ("consistency", parameters::consistency::check),
    ("relative error", residuals::relative_error::check),
    (
        "correlated residuals",
        residuals::residual_correlation::check,
    ),
    ("regressor errors", residuals::regressor_errors::check),
    ("partition", residuals::partition::check),
    ("validation runs", residuals::held_out::check),
];

/// Removes units that follow from the torques if the range of a signal has already named that of
/// the same drive.
fn keep_first_units(checks: &mut Vec<Check>) {
    let is_unit = |check: &Check| check.kind == CheckKind::Unit && !check.passed;
    let of_ranges = checks
        .iter()
        .filter(|one| is_unit(one) && one.about == About::Data);
    let named: Vec<Option<String>> = of_ranges.map(|one| one.actuator.clone()).collect();
    checks.retain(|one| {
        !(is_unit(one) && one.about == About::Model && named.contains(&one.actuator))
    });
}

/// Runs all checks; calls `begins` with what each examines.
///
/// # Errors
/// A log cannot be read any more.
pub(crate) fn checks(
    context: &Context<'_>,
    begins: &dyn Fn(&'static str),
) -> Result<Vec<Check>, Error> {
    let mut all = Vec::new();
    for (name, check) in CHECKS {
        begins(name);
        all.extend(check(context)?);
    }
    all.extend(residuals::relative_error::silent(context, &all));
    keep_first_units(&mut all);
    admissible_faults::spoil(context, &mut all);
    for check in &mut all {
        check.words = with_joints(&check.words);
    }
    Ok(all)
}
