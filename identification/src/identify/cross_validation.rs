//! Predictions of the validation runs by all estimates.

use overact::Model;

use super::{prepare::PreparedSystem, progress::Progress};
use crate::{
    assessment::{self, RunMonitor},
    consistent::Consistent,
    regression::{observer::Observer, projection::ModelKind},
    result::{CrossValidation, Estimate, Stage},
    series::RunFigures,
    settings::Settings,
    validation::{Candidate, Validation, validate},
};
use overact_logs::{Error, Load, Log};

/// Results on the validation runs.
#[derive(Default)]
pub(super) struct ValidationRunResults {
    pub(super) validations: Vec<CrossValidation>,
    /// Number of the projection of each result.
    pub(super) owners: Vec<usize>,
    pub(super) motions: Vec<RunFigures>,
    pub(super) watched: Vec<RunMonitor>,
    pub(super) warnings: Vec<String>,
}

/// Parameters whose predictions are compared.
pub(super) struct Predictor {
    /// Number of the projection.
    pub(super) projection: usize,
    pub(super) model: ModelKind,
    pub(super) stage: Stage,
    /// Indices among the base parameters, and values.
    pub(super) columns: Vec<usize>,
    pub(super) values: Vec<f64>,
}

impl Predictor {
    /// Parameters of an estimate.
    pub(super) fn of_estimate(projection: usize, estimate: &Estimate) -> Self {
        Self {
            projection,
            model: estimate.model,
            stage: estimate.stage,
            columns: estimate.columns(),
            values: estimate.values(),
        }
    }

    fn candidate(&self) -> Candidate<'_> {
        Candidate {
            projection: self.projection,
            selected: &self.columns,
            values: &self.values,
        }
    }

    /// Base parameters of a consistent estimate.
    pub(super) fn of_consistent(projection: usize, own: &Consistent) -> Self {
        Self {
            projection,
            model: own.model,
            stage: Stage::Consistent,
            columns: (0..own.base_values.len()).collect(),
            values: own.base_values.clone(),
        }
    }
}

/// Compares the validation runs with all predictions.
pub(super) fn cross_validate(
    model: &dyn Model,
    prepared: &PreparedSystem,
    runs: &[Log],
    predictors: &[Predictor],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<ValidationRunResults, Error> {
    let observer = Observer {
        model,
        columns: &prepared.columns,
        base: &prepared.base.columns,
        projections: &prepared.projections,
        settings,
    };
    let candidates: Vec<Candidate<'_>> = predictors.iter().map(Predictor::candidate).collect();
    let mut results = ValidationRunResults::default();
    let (mut all, mut problems) = (Vec::new(), Vec::new());
    for log in runs {
        let run = log.name();
        let report = |done, samples| progress(Progress::Validation { run, done, samples });
        match validate(&observer, log, &candidates, &report) {
            Ok(validated) => {
                all.push((log.carried(), validated.validations));
                results.motions.push(validated.motion);
                results.watched.push(RunMonitor {
                    monitor: validated.monitor,
                    closure_residual: validated.closure_residual,
                });
            }
            Err(error) => problems.extend(assessment::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    // In the order of the estimates, each on all runs.
    for (index, predictor) in predictors.iter().enumerate() {
        for (carried, validations) in &all {
            results.add(predictor, *carried, &validations[index]);
        }
    }
    Ok(results)
}

impl ValidationRunResults {
    /// Adds the result of an estimate on a run.
    fn add(&mut self, own: &Predictor, carried: Load<'_>, validation: &Result<Validation, Error>) {
        match validation {
            Ok(validation) => {
                let validation =
                    CrossValidation::new(own.model, own.stage, carried, validation.clone());
                self.validations.push(validation);
                self.owners.push(own.projection);
            }
            Err(error) if own.stage == Stage::Base => {
                self.warnings.push(format!("no cross-validation: {error}"));
            }
            Err(_) => {}
        }
    }
}
