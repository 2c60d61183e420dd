//! Predictions of all estimates against the runs that they are not made from.

use overact::Model;

use super::{prepare::Prepared, progress::Progress};
use crate::{
    assessment::{self, Watched},
    data::Log,
    error::Error,
    regression::observation::Observer,
    result::{CrossValidation, Estimate, Stage},
    series::RunFigures,
    settings::Settings,
    validation::{Candidate, Validation, validate},
};

/// What the runs of the cross-validation tell.
#[derive(Default)]
pub(super) struct HeldOut {
    pub(super) validations: Vec<CrossValidation>,
    /// The number of the projection of each.
    pub(super) owners: Vec<usize>,
    pub(super) motions: Vec<RunFigures>,
    pub(super) watched: Vec<Watched>,
    pub(super) warnings: Vec<String>,
}

/// Compares the runs of the cross-validation with the predictions of all estimates, of which each comes
/// with the number of its projection.
pub(super) fn cross_validate(
    model: &dyn Model,
    prepared: &Prepared,
    runs: &[Log],
    estimates: &[(usize, Estimate)],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<HeldOut, Error> {
    let observer = Observer {
        model,
        columns: &prepared.columns,
        base: &prepared.base.columns,
        projections: &prepared.projections,
        settings,
    };
    let parameters: Vec<(Vec<usize>, Vec<f64>)> = estimates
        .iter()
        .map(|(_, estimate)| (estimate.columns(), estimate.values()))
        .collect();
    let candidates: Vec<Candidate<'_>> = estimates
        .iter()
        .zip(&parameters)
        .map(|((projection, _), (selected, values))| Candidate {
            projection: *projection,
            selected,
            values,
        })
        .collect();
    let mut held_out = HeldOut::default();
    let (mut all, mut problems) = (Vec::new(), Vec::new());
    for log in runs {
        let run = log.name();
        let report = |done, samples| progress(Progress::Validation { run, done, samples });
        match validate(&observer, log, &candidates, &report) {
            Ok(validated) => {
                all.push((log.payload(), validated.validations));
                held_out.motions.push(validated.motion);
                held_out.watched.push(Watched {
                    monitor: validated.monitor,
                    closure_residual: validated.closure_residual,
                });
            }
            Err(error) => problems.extend(assessment::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    // In the order of the estimates, each on all runs.
    for (index, (projection, estimate)) in estimates.iter().enumerate() {
        for (payload, validations) in &all {
            held_out.add(*projection, estimate, *payload, &validations[index]);
        }
    }
    Ok(held_out)
}

impl HeldOut {
    /// Adds what a run tells of an estimate.
    fn add(
        &mut self,
        projection: usize,
        estimate: &Estimate,
        payload: bool,
        validation: &Result<Validation, Error>,
    ) {
        match validation {
            Ok(validation) => {
                let validation = CrossValidation::new(estimate, payload, validation.clone());
                self.validations.push(validation);
                self.owners.push(projection);
            }
            Err(error) if estimate.stage == Stage::Base => {
                self.warnings.push(format!("no cross-validation: {error}"));
            }
            Err(_) => {}
        }
    }
}
