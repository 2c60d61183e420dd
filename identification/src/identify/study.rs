//! Compares the actuator projection for all partitions on the same data.
//!
//! The paper leaves this study open in section 3.1.2. All partitions estimate the same base
//! parameters from the same runs. They are ranked by conditioning along the path, by standard
//! deviations relative to the platform projection, and by prediction of folds. All predictions use
//! the equations of the platform projection, so no partition judges itself.

use overact::Model;
use serde::Serialize;

use super::{
    cross_validation::{Predictor, cross_validate},
    estimates::{ProjectionEstimates, estimate_all},
    prepare::{PreparedSystem, prepare},
    progress::Progress,
};
use crate::{
    estimation::essential::CrossValidationFolds,
    regression::{projection::Projection, system::PartitionCondition},
    result::{CrossValidation, Estimate, ParameterEstimate, Stage},
    settings::{Instruments, Settings},
    thresholds::Thresholds,
};
use overact_logs::{Dataset, Error, significant};

/// Comparison of the platform projection and all actuator projections.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Study {
    /// Name of the robot.
    pub robot: String,
    /// Platform projection.
    pub platform: RankedProjection,
    /// Actuator projections, best first; unreliable ones come last.
    pub partitions: Vec<RankedProjection>,
    /// Warnings to the user.
    pub warnings: Vec<String>,
}

/// Quality of one projection.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct RankedProjection {
    /// Names of the kept actuators; empty for the platform projection.
    pub kept_actuators: Vec<String>,
    /// Whether the partition avoids its singularities.
    pub trusted: bool,
    /// Largest condition number of the kept actuators' Jacobian in all runs, with its place.
    pub partition: Option<PartitionCondition>,
    /// The condition number itself.
    pub partition_condition: Option<f64>,
    /// Geometric mean of σ by that of the platform projection over the base parameters.
    ///
    /// For correlated residuals; below 1 the partition determines the parameters better.
    pub deviation_ratio: Option<f64>,
    /// Sum of the relative standard deviations of the essential parameters, percent.
    pub deviation_sum_percent: Option<f64>,
    /// Sum of the magnitudes of their errors, percent, if the truth is known.
    pub error_sum_percent: Option<f64>,
    /// Cross-validated relative error of the platform projection's inputs, percent.
    pub held_out_percent: Option<f64>,
    /// Mean relative torque error of the actuators on validation runs, percent.
    pub torque_percent: Option<f64>,
    /// Relative residual of its own equations, percent; not used for ranking.
    pub relative_error_percent: Option<f64>,
    /// Condition number of W, in base parameters.
    pub condition_number: Option<f64>,
    /// Number of essential parameters.
    pub essential_parameters: Option<usize>,
    /// Ranks by conditioning, parameter quality and prediction, counted from 1.
    pub ranks: Option<[usize; 3]>,
    /// Reason for a missing estimate.
    pub error: Option<String>,
}

/// Compares the actuator projection for the partitions `choices` with the platform projection.
///
/// # Errors
/// As [`prepare`], or data from which the platform projection determines nothing.
pub fn study(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    choices: &[Vec<usize>],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Study, Error> {
    let mut projections = vec![Projection::Platform];
    projections.extend(choices.iter().cloned().map(Projection::Actuators));
    // Instruments are not used to compare partitions.
    let settings = &Settings {
        instruments: Instruments::None,
        ..settings.clone()
    };
    let prepared = prepare(model, dataset.runs, &projections, settings, progress)?;
    let outcomes = estimate_all(&prepared, settings, dataset.true_values, progress);
    let reference = outcomes[0].as_ref().map_err(Clone::clone)?.clone();
    let predictors: Vec<Predictor> = outcomes
        .iter()
        .enumerate()
        .filter_map(|(number, outcome)| {
            let outcome = outcome.as_ref().ok()?;
            Some(Predictor::of_estimate(number, &outcome.essential))
        })
        .collect();
    let held_out = cross_validate(
        model,
        &prepared,
        dataset.validation,
        &predictors,
        settings,
        progress,
    )?;
    let mut rows: Vec<RankedProjection> = Vec::new();
    for (number, outcome) in outcomes.iter().enumerate() {
        let info = model.info();
        let names = match &projections[number] {
            Projection::Platform => Vec::new(),
            projection => projection.line_names(&info),
        };
        let row = match outcome {
            Ok(outcome) => {
                let torques = held_out.validations.iter();
                let own: Vec<&CrossValidation> = torques
                    .zip(held_out.owners.iter())
                    .filter(|(_, owner)| **owner == number)
                    .map(|(one, _)| one)
                    .collect();
                ranked(&prepared, number, outcome, &reference, &own)
            }
            Err(error) => RankedProjection {
                error: Some(error.to_string()),
                ..RankedProjection::default()
            },
        };
        rows.push(RankedProjection {
            kept_actuators: names,
            ..row
        });
    }
    let platform = rows.remove(0);
    rank(&mut rows);
    let key = |row: &RankedProjection| (!row.trusted, row.deviation_ratio.unwrap_or(f64::INFINITY));
    rows.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    Ok(Study {
        robot: model.info().name.to_owned(),
        warnings: rows
            .iter()
            .filter_map(|row| warning(row, &platform))
            .collect(),
        platform,
        partitions: rows,
    })
}

/// Quality of one projection compared with a reference, without the names of its actuators.
fn ranked(
    prepared: &PreparedSystem,
    number: usize,
    outcome: &ProjectionEstimates,
    reference: &ProjectionEstimates,
    torques: &[&CrossValidation],
) -> RankedProjection {
    let (base, essential) = (&outcome.base, &outcome.essential);
    let partition = base.partition.clone();
    let limit = Thresholds::default().partition_condition;
    let sum = |of: &dyn Fn(&ParameterEstimate) -> Option<f64>| -> Option<f64> {
        essential.parameters.iter().map(of).sum()
    };
    let errors: Vec<f64> = torques
        .iter()
        .flat_map(|one| &one.torques)
        .map(|error| error.relative_error_percent)
        .collect();
    RankedProjection {
        kept_actuators: Vec::new(),
        trusted: partition
            .as_ref()
            .is_none_or(|one| one.crossings == 0 && one.largest <= limit),
        partition_condition: partition.as_ref().map(|one| one.largest),
        partition,
        deviation_ratio: deviation_ratio(base, &reference.base),
        deviation_sum_percent: sum(&|one| {
            Some(100.0 * one.correlated_standard_deviation / one.value.abs())
        }),
        error_sum_percent: sum(&|one| one.error_percent.map(f64::abs)),
        held_out_percent: held_out(prepared, number, base),
        torque_percent: (!errors.is_empty())
            .then(|| errors.iter().sum::<f64>() / errors.len() as f64),
        relative_error_percent: Some(base.relative_error_percent),
        condition_number: Some(base.condition_number),
        essential_parameters: Some(essential.parameters.len()),
        ranks: None,
        error: None,
    }
}

/// Geometric mean ratio of the standard deviations of common parameters; `None` without any.
fn deviation_ratio(own: &Estimate, reference: &Estimate) -> Option<f64> {
    debug_assert_eq!((own.stage, reference.stage), (Stage::Base, Stage::Base));
    let logarithms: Vec<f64> = own
        .parameters
        .iter()
        .filter_map(|one| {
            let mut others = reference.parameters.iter();
            let other = others.find(|other| other.column == one.column)?;
            let ratio = one.correlated_standard_deviation / other.correlated_standard_deviation;
            Some(ratio.ln())
        })
        .filter(|logarithm| logarithm.is_finite())
        .collect();
    let count = logarithms.len() as f64;
    (count > 0.0).then(|| (logarithms.iter().sum::<f64>() / count).exp())
}

/// Cross-validated relative error of the platform's equations, percent.
///
/// The parameters are estimated from other folds of this projection.
fn held_out(prepared: &PreparedSystem, number: usize, base: &Estimate) -> Option<f64> {
    let selected = base.columns();
    let system = |number: usize| prepared.systems.get(number)?.as_ref().ok();
    let (system, platform) = (system(number)?, system(0)?);
    let own = CrossValidationFolds::new(system, &selected, &base.weights)?;
    // The test equations are not weighted.
    let platform =
        CrossValidationFolds::new(platform, &selected, &vec![1.0; platform.lines.len()])?;
    own.error_percent_in(&platform, &selected)
}

/// Ranks all partitions that have an estimate.
fn rank(rows: &mut [RankedProjection]) {
    let placed =
        |of: fn(&RankedProjection) -> Option<f64>, rows: &[RankedProjection]| -> Vec<usize> {
            let value = |row: &RankedProjection| of(row).unwrap_or(f64::INFINITY);
            let better = |row: &RankedProjection| {
                rows.iter()
                    .filter(|other| value(other) < value(row))
                    .count()
            };
            rows.iter().map(|row| 1 + better(row)).collect()
        };
    let conditions = placed(|row| row.partition_condition, rows);
    let qualities = placed(|row| row.deviation_ratio, rows);
    let predictions = placed(|row| row.torque_percent.or(row.held_out_percent), rows);
    for (index, row) in rows.iter_mut().enumerate() {
        if row.error.is_none() {
            row.ranks = Some([conditions[index], qualities[index], predictions[index]]);
        }
    }
}

/// Warning about an unreliable partition.
fn warning(row: &RankedProjection, platform: &RankedProjection) -> Option<String> {
    let names = row.kept_actuators.join(", ");
    if let Some(error) = &row.error {
        return Some(format!("{names}: {error}"));
    }
    let partition = row.partition.as_ref().filter(|_| !row.trusted)?;
    let mut text = if partition.crossings > 0 {
        format!(
            "{names}: the trajectories cross a singularity of this choice {} times, first or worst in {} at t = {:.3} s",
            partition.crossings, partition.run, partition.time
        )
    } else {
        format!(
            "{names}: the condition number reaches {} ({}, t = {:.3} s), above {}",
            significant(partition.largest, 3),
            partition.run,
            partition.time,
            Thresholds::default().partition_condition
        )
    };
    if row.relative_error_percent < platform.relative_error_percent {
        text.push_str(
            "; its relative error below that of the platform projection is no reason to use it",
        );
    }
    Some(text)
}
