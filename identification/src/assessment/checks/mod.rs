//! All checks. Each has a file of its own and is a function of a read-only [`Context`]; the table
//! [`CHECKS`] lists them.

mod clock;
mod closure;
mod consistency;
mod course;
mod delay;
mod excitation;
mod gains;
mod geometry;
mod half_band;
mod held_out;
pub(crate) mod level;
mod missing_parameters;
mod negative_parameters;
mod partition;
mod payload_labels;
pub(crate) mod raw_numbers;
mod regressor_errors;
mod relative_error;
mod repeated;
mod residual_correlation;
mod reversals;
mod rotation;
pub(super) mod smoothing;
mod suspected;
mod torque_faults;
pub(crate) mod units;

use overact::Model;

pub(super) use suspected::HARMFUL;

use super::{check::Check, suspects::Scores};
use crate::{
    called::with_joints,
    data::{Dataset, Log},
    error::Error,
    estimation::{
        base::BaseParameters, column_noise::ColumnNoise, instruments::regressor::ErrorsInRegressor,
    },
    monitor::Monitor,
    regression::{columns::ColumnSet, projection::ModelKind, system::System},
    result::{CrossValidation, Estimate, Estimator, Stage},
    settings::Settings,
};

/// What checks look at.
pub(crate) struct Context<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) dataset: &'a Dataset<'a>,
    pub(crate) settings: &'a Settings,
    /// The columns of the model and the base parameters among them.
    pub(crate) columns: &'a ColumnSet,
    pub(crate) base: &'a BaseParameters,
    /// For each projection its system in the base parameters, or why it has none.
    pub(crate) systems: &'a [Result<System, Error>],
    /// What has been watched of the runs identified from, then of those that were held out.
    pub(crate) watched: &'a [Watched],
    /// All estimates, each with the number of its projection.
    pub(crate) estimates: &'a [(usize, Estimate)],
    /// The models of which no physically consistent parameters were found.
    pub(crate) inconsistent: &'a [ModelKind],
    /// What the residual of the first base estimate says of faults that the model lacks.
    pub(crate) scores: Option<&'a Scores>,
    /// The same from half of the band, for what has to be told from errors of the positions.
    pub(crate) narrow: &'a dyn Fn() -> Result<Option<Scores>, Error>,
    /// Every estimate on every run that was held out.
    pub(crate) cross_validation: &'a [CrossValidation],
    /// For each model, the estimates by instruments beside those by least squares.
    pub(crate) errors_in_regressor: &'a [ErrorsInRegressor],
    /// For each projection, what noise of the positions does to its columns.
    pub(crate) column_noise: &'a [Option<ColumnNoise>],
    /// The coordinates of the pose with the ranges in which the runs identified from move them (m, rad).
    pub(crate) ranges: &'a [(String, f64)],
}

/// What has been watched of a run while it was gone through.
#[derive(Debug, Clone)]
pub(crate) struct Watched {
    /// Its raw numbers.
    pub(crate) monitor: Monitor,
    /// Largest miss of the loops' closure (m, rad).
    pub(crate) closure_residual: f64,
}

impl<'a> Context<'a> {
    /// The runs identified from and those that were held out, with what has been watched of them.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (&'a Log, &'a Watched)> {
        let all = self.dataset.runs.iter().chain(self.dataset.validation);
        all.zip(self.watched)
    }

    /// The system of a model, where it has one.
    pub(crate) fn system(&self, model: ModelKind) -> Option<&'a System> {
        let mut systems = self.systems.iter().filter_map(|one| one.as_ref().ok());
        systems.find(|system| system.projection.model() == model)
    }

    /// The estimates by least squares.
    pub(crate) fn least_squares(&self) -> impl Iterator<Item = &'a Estimate> {
        let all = self.estimates.iter().map(|(_, one)| one);
        all.filter(|one| one.estimator == Estimator::LeastSquares)
    }

    /// Those of a stage.
    pub(crate) fn estimates_of(&self, stage: Stage) -> impl Iterator<Item = &'a Estimate> {
        self.least_squares().filter(move |one| one.stage == stage)
    }
}

/// A check.
type Function = fn(&Context<'_>) -> Result<Vec<Check>, Error>;

/// All checks, in the order in which they are told.
const CHECKS: [Function; 22] = [
    raw_numbers::check,
    units::check,
    repeated::check,
    excitation::check,
    course::check,
    closure::check,
    torque_faults::check,
    delay::check,
    smoothing::check,
    reversals::check,
    clock::check,
    gains::check,
    geometry::check,
    payload_labels::check,
    missing_parameters::check,
    negative_parameters::check,
    consistency::check,
    relative_error::check,
    residual_correlation::check,
    regressor_errors::check,
    partition::check,
    held_out::check,
];

/// What all checks say.
///
/// # Errors
/// A log that can't be read any more.
pub(crate) fn checks(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let mut all = Vec::new();
    for check in CHECKS {
        all.extend(check(context)?);
    }
    all.extend(relative_error::silent(context, &all));
    for check in &mut all {
        check.words = with_joints(&check.words);
    }
    Ok(all)
}
