//! The identification procedure: from runs to parameters with their quality.
//!
//! [`identify`] estimates the platform and actuator projections of a redundant robot, or the joint
//! model otherwise, each with base, recommended and essential parameters. [`study()`] compares the
//! actuator projection for many partitions. Both use [`prepare`], one pass over the data for all
//! projections, and [`estimate_projection`].

mod consistency;
mod cross_validation;
mod estimates;
pub(crate) mod figures;
mod gear_friction;
mod identification;
mod instruments;
mod plots;
mod prepare;
mod progress;
mod stribeck_velocity;
mod study;
pub(crate) mod tracking;

use overact::Model;

pub use estimates::{ProjectionEstimates, estimate_projection};
pub use gear_friction::{DriveGearFriction, GearCoefficient, GearFrictionEstimate, gear_friction};
pub use identification::{BaseParameter, Identification};
pub(crate) use prepare::session_numbers;
pub use prepare::{PreparedSystem, prepare};
pub use progress::Progress;
pub use stribeck_velocity::{
    StribeckVelocities, StribeckVelocity, VelocityEstimate, stribeck_velocities,
};
pub use study::{RankedProjection, Study, study};

use consistency::{consistent_all, contradicted_bounds};
use cross_validation::{Predictor, cross_validate};
use estimates::estimate_all;
use prepare::{check_runs, prepared_warnings};

use crate::{
    assessment::{
        self, Context, RunMonitor,
        assumptions::{PreviouslyIdentified, assumptions, not_tested, rests_on},
        check::{Check, Grade},
        detection_limits::{detection_limits, sentences},
        hypotheses::{PositionRange, ScoreTest, fault_hypotheses},
        verdict::verdicts,
    },
    estimation::instruments::regressor::ErrorsInRegressor,
    gains::Gains,
    gravity::GravityDirection,
    online::{OnlineEstimate, Replay},
    regression::projection::{ModelKind, Projection},
    result::{Estimate, RunSummary, Stage},
    settings::Settings,
    thresholds::Thresholds,
};
use overact_logs::{Dataset, Error};

/// Identifies a robot from the runs of a data set and cross-validates the estimates.
///
/// # Errors
/// As [`prepare`], or data that determine no parameter. Problems of the actuator projection alone
/// are warnings.
pub fn identify(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Identification, Error> {
    identify_after(model, dataset, PriorStage::Nothing, settings, progress)
}

/// Quantities identified before the parameters.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum PriorStage<'a> {
    /// Nothing.
    Nothing,
    /// Gains of the drives; the torques of the runs have been multiplied by them.
    Gains(&'a Gains),
    /// Direction of gravity; the model already has it.
    Gravity(&'a GravityDirection),
    /// Friction of the gears; the settings contain it.
    GearFriction(&'a GearFrictionEstimate),
    /// Stribeck velocities; the settings contain them.
    Stribeck(&'a StribeckVelocities),
}

/// [`identify`] after a previous identification.
///
/// Standard deviations and intervals include its uncertainty.
///
/// # Errors
/// As [`identify`].
pub fn identify_after(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    before: PriorStage<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Identification, Error> {
    let info = model.info();
    let stage = |name: &'static str| progress(Progress::Stage { name });
    // Report unusable validation runs before the long computation.
    check_runs(model, dataset.validation, settings)?;
    let projections = Projection::usual(&info, &settings.kept_actuators);
    let mut prepared = prepare(model, dataset.runs, &projections, settings, progress)?;
    let found = PreviouslyIdentified {
        gains: matches!(before, PriorStage::Gains(_)),
        gravity: matches!(before, PriorStage::Gravity(_)),
    };
    match before {
        PriorStage::Nothing => {}
        PriorStage::Gains(gains) => {
            let correction = gains.correction();
            prepared = prepared.with_correction(model, dataset.runs, &correction, settings)?;
        }
        PriorStage::GearFriction(gears) => {
            prepared = gears.propagated(prepared, model, dataset.runs, settings)?;
        }
        PriorStage::Stribeck(found) => {
            prepared = found.propagated(prepared, model, dataset.runs, settings)?;
        }
        PriorStage::Gravity(direction) => prepared = prepared.with_gravity(direction),
    }
    let mut warnings = prepared_warnings(&prepared, dataset.validation);
    let logs = dataset.runs.iter().chain(dataset.validation);
    let notes = logs.filter_map(|log| Some(format!("{}: {}", log.name(), log.note()?)));
    warnings.extend(notes);
    let outcomes = estimate_all(&prepared, settings, dataset.true_values, progress);
    let (errors_in_regressor, alternatives) = regressor_errors(&outcomes);
    let estimates = estimates(outcomes, &projections, &mut warnings)?;
    stage("physical consistency");
    let (consistent, inconsistent) = consistent_all(&info, &prepared, &estimates, &settings.prior);
    warnings.extend(
        consistent
            .iter()
            .filter_map(|(_, own)| contradicted_bounds(own, &settings.prior)),
    );
    let least_squares = estimates
        .iter()
        .map(|(projection, one)| Predictor::of_estimate(*projection, one));
    let others = consistent
        .iter()
        .map(|(projection, own)| Predictor::of_consistent(*projection, own));
    stage("cross-validation");
    let held_out = cross_validate(
        model,
        &prepared,
        dataset.validation,
        &least_squares.chain(others).collect::<Vec<_>>(),
        settings,
        progress,
    )?;
    warnings.extend(held_out.warnings);
    let cross_validation = held_out.validations;
    let identified = prepared.observations.iter().map(|observation| RunMonitor {
        monitor: observation.monitor.clone(),
        closure_residual: observation.closure_residual,
    });
    let watched: Vec<RunMonitor> = identified.chain(held_out.watched).collect();
    let position_ranges = position_ranges(&watched[..dataset.runs.len()]);
    let base = estimates.iter().find(|(_, one)| one.stage == Stage::Base);
    let base = base.filter(|_| settings.checks.has_fault_hypotheses());
    let test = base.map(|(_, estimate)| ScoreTest {
        model,
        dataset,
        columns: &prepared.columns,
        base: &prepared.base.columns,
        estimate,
        hypotheses: fault_hypotheses(model, dataset.variants.len(), estimate.model),
        position_ranges: &position_ranges,
        periodic_motions: &prepared.periodic_motions,
        settings,
    });
    if test.is_some() {
        stage("fault hypotheses: columns");
    }
    let scores = test.as_ref().map(|test| test.scores(1)).transpose()?;
    if let Some(scores) = &scores {
        stage("fault hypotheses: tests");
        scores.test_all();
    }
    let narrow = || test.as_ref().map(|test| test.scores(2)).transpose();
    stage("position noise");
    let column_noise = prepared.column_noise(model, dataset.runs, settings)?;
    let ranges = prepared.ranges(model);
    let redundant_values = match before {
        PriorStage::Gains(gains) => gains.redundant.as_slice(),
        _ => &[],
    };
    let checks = assessment::checks(
        &Context {
            model,
            dataset,
            settings,
            columns: &prepared.columns,
            base: &prepared.base,
            systems: &prepared.systems,
            watched: &watched,
            estimates: &estimates,
            inconsistent: &inconsistent,
            scores: scores.as_ref(),
            narrow: &narrow,
            cross_validation: &cross_validation,
            errors_in_regressor: &errors_in_regressor,
            column_noise: &column_noise,
            redundant_values,
            ranges: &ranges,
        },
        &|name| progress(Progress::Check { name }),
    )?;
    stage("plots");
    let failed = checks.iter().filter(|check| !check.passed);
    warnings.extend(failed.map(Check::located));
    let figures = plots::figures(
        model,
        &prepared,
        &estimates,
        &cross_validation,
        held_out.motions,
        settings,
    )?;
    if settings.online.is_some() {
        stage("online filter");
    }
    let online = replay(model, dataset, &prepared, &estimates, settings)?;
    let models: Vec<ModelKind> = projections.iter().map(Projection::model).collect();
    let estimates: Vec<Estimate> = estimates.into_iter().map(|(_, one)| one).collect();
    let rests_on = rests_on(model, found, settings.checks);
    let verdicts = verdicts(&estimates, &checks, rests_on.as_deref());
    // Detection limits are irrelevant for a refused result.
    let refused = verdicts.iter().all(|one| one.grade == Grade::DoNotUse);
    let unseen = if refused {
        Vec::new()
    } else {
        sentences(&detection_limits(&checks))
    };
    let sessions = RunSummary::sessions(&prepared.runs);
    Ok(Identification {
        robot: info.name.to_owned(),
        base_parameters: BaseParameter::all(&prepared.columns, &prepared.base, dataset.true_values),
        without_effect: prepared.without_effect(),
        runs: prepared.runs,
        warnings,
        assumptions: [
            not_tested(settings.checks),
            assumptions(
                model,
                &prepared.columns,
                &models,
                found,
                sessions,
                &settings.prior,
            ),
        ]
        .concat(),
        unseen,
        verdicts,
        checks,
        thresholds: Thresholds::default(),
        calibration: None,
        gravity: None,
        gains: Vec::new(),
        gain_parameters: Vec::new(),
        gear_friction: Vec::new(),
        stribeck_velocities: Vec::new(),
        motors: Vec::new(),
        functions_base: Vec::new(),
        tracking: Vec::new(),
        timings: Vec::new(),
        online,
        settings: settings.clone(),
        figures,
        estimates: estimates.into_iter().chain(alternatives).collect(),
        consistent: consistent.into_iter().map(|(_, own)| own).collect(),
        cross_validation,
        errors_in_regressor,
    })
}

/// Base parameters of the first model over time, if requested.
fn replay(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    prepared: &PreparedSystem,
    estimates: &[(usize, Estimate)],
    settings: &Settings,
) -> Result<Vec<OnlineEstimate>, Error> {
    let (Some(online), Some((projection, estimate))) = (&settings.online, estimates.first()) else {
        return Ok(Vec::new());
    };
    Replay {
        model,
        columns: &prepared.columns,
        base: &prepared.base.columns,
        projection: &prepared.projections[*projection],
        estimate,
        settings,
        online,
    }
    .run(dataset.runs)
}

/// Estimates of prepared systems, by weighted, then by ordinary least squares.
pub(crate) fn estimates_of(
    prepared: &PreparedSystem,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
    warnings: &mut Vec<String>,
) -> Result<Vec<Estimate>, Error> {
    warnings.extend(prepared_warnings(prepared, &[]));
    let outcomes = estimate_all(prepared, settings, None, progress);
    let (_, alternatives) = regressor_errors(&outcomes);
    let own = estimates(outcomes, &prepared.projections, warnings)?;
    let own = own.into_iter().map(|(_, one)| one);
    Ok(own.chain(alternatives).collect())
}

/// Position ranges and speeds of the actuators in all runs.
pub(super) fn position_ranges(watched: &[RunMonitor]) -> Vec<PositionRange> {
    let of_run = |one: &RunMonitor| -> Vec<PositionRange> {
        let bounds = one.monitor.bounds().into_iter();
        let speeds = one.monitor.speeds();
        bounds
            .zip(speeds)
            .map(|((low, high), speed)| PositionRange { low, high, speed })
            .collect()
    };
    let all = watched.iter().map(of_run);
    let united =
        all.reduce(|all, own| all.into_iter().zip(own).map(|(a, b)| a.united(b)).collect());
    united.unwrap_or_default()
}

/// Regressor errors, and the estimates by other methods.
fn regressor_errors(
    outcomes: &[Result<ProjectionEstimates, Error>],
) -> (Vec<ErrorsInRegressor>, Vec<Estimate>) {
    let own = || outcomes.iter().filter_map(|outcome| outcome.as_ref().ok());
    let comparisons = own().map(|outcome| outcome.errors_in_regressor.clone());
    let others = own().flat_map(|one| one.ordinary.iter().chain(&one.instrumental));
    (comparisons.collect(), others.cloned().collect())
}

/// Estimates, each with the number of its projection.
///
/// A failed actuator projection is a warning; any other failure is an error.
fn estimates(
    outcomes: Vec<Result<ProjectionEstimates, Error>>,
    projections: &[Projection],
    warnings: &mut Vec<String>,
) -> Result<Vec<(usize, Estimate)>, Error> {
    let mut estimates = Vec::new();
    for (number, (outcome, projection)) in outcomes.into_iter().zip(projections).enumerate() {
        match outcome {
            Ok(outcome) => {
                warnings.extend(outcome.warnings);
                estimates.extend(
                    [outcome.base, outcome.recommended, outcome.essential].map(|one| (number, one)),
                );
            }
            Err(error) if matches!(projection, Projection::Actuators(_)) => {
                warnings.push(format!("the actuator projection is left out: {error}"));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(estimates)
}
