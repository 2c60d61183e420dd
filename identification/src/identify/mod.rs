//! The whole identification: runs in, parameters with their quality out.
//!
//! [`identify`] estimates case 1 and case 2 of a redundant robot, or the joint model of one without
//! redundancy; each in base parameters, then in essential ones. [`study()`] compares case 2 for many
//! choices of kept actuators. [`prepare`] and [`estimate_projection`] are what both are made of: one
//! pass over the data for all projections, then the estimates.

pub mod figures;
mod judgement;
mod plots;
mod result;
mod stages;
mod study;
pub mod verdict;

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use overact::Model;
use rayon::prelude::*;

pub use result::{
    BaseParameter, CrossValidation, Estimate, Identification, ParameterEstimate, Regrouping, Run,
    Stage,
};
pub use stages::{Outcome, estimate_projection};
pub use study::{Choice, Study, study};

use crate::{
    base::{BaseParameters, PayloadUse, base_parameters},
    checks,
    columns::ColumnSet,
    data::Log,
    error::{Error, Problem},
    kinematics,
    observation::{Observer, Seen},
    regression::{Projection, System},
    settings::Settings,
    validation::{Candidate, validate},
};

/// Values of all runs and projections that are kept as successive equations (64 MB).
const LARGEST_STRETCHES: usize = 1 << 23;

/// What an identification is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// Finds the base parameters.
    Base,
    /// Goes through a run: motion, columns, decimation.
    Run {
        /// Name of the run.
        run: &'a str,
        /// Samples done.
        done: usize,
        /// Samples of the run.
        samples: usize,
    },
    /// Estimates and eliminates parameters.
    Estimation {
        /// `platform`, `actuators` or `joints`.
        model: &'static str,
    },
    /// Compares predictions with a run that was not identified from.
    Validation {
        /// Name of the run.
        run: &'a str,
        /// Samples done.
        done: usize,
        /// Samples of the run.
        samples: usize,
    },
}

/// The data of an identification.
#[derive(Debug, Clone, Copy)]
pub struct Experiment<'a> {
    /// Runs to identify from.
    pub runs: &'a [Log],
    /// Runs to cross-validate on.
    pub validation: &'a [Log],
    /// Values of the standard parameters by name, where they are known (virtual runs, weighed
    /// payloads). Names that the robot does not have are ignored.
    pub true_values: Option<&'a BTreeMap<String, f64>>,
}

/// The data as the projections see them: their systems, the columns and the base parameters.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The columns of the model.
    pub columns: ColumnSet,
    /// The base parameters.
    pub base: BaseParameters,
    /// How the payload takes part.
    pub payload: PayloadUse,
    /// The projections.
    pub projections: Vec<Projection>,
    /// For each projection, its system in the base parameters, or why it has none.
    pub systems: Vec<Result<System, Error>>,
    /// The runs.
    pub runs: Vec<Run>,
    /// What is told of the runs beside their equations.
    pub(crate) seen: Vec<Seen>,
    /// For each run and projection, the equations of each line at the points of the plots.
    pub(crate) points: Vec<Vec<Vec<DMatrix<f64>>>>,
}

impl Prepared {
    /// Names of the standard parameters that have no effect on the model.
    #[must_use]
    pub fn without_effect(&self) -> Vec<String> {
        let columns = self.columns.as_slice();
        let named = self
            .base
            .without_effect
            .iter()
            .filter_map(|&index| columns.get(index));
        named.map(|column| column.name.clone()).collect()
    }
}

/// Finds the base parameters and goes through the runs, once for all projections.
///
/// # Errors
/// Settings that are not possible, no run, runs that do not fit the robot or leave its workspace (the
/// problems of all runs together), projections that are not possible. Kept actuators that are singular
/// at a sample are an error of their system.
pub fn prepare(
    model: &dyn Model,
    runs: &[Log],
    projections: &[Projection],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Prepared, Error> {
    let info = model.info();
    settings.check(&info)?;
    check_projections(projections, model)?;
    let payload = payload_use(model, runs)?;
    check_runs(model, runs, settings)?;
    progress(Progress::Base);
    let columns = ColumnSet::new(
        model,
        payload != PayloadUse::Absent,
        settings.asymmetric_friction,
        settings.seed,
    )?;
    let base = base_parameters(model, &columns, payload, settings.seed)?;
    // Relations between columns are those of the model; reversals are those of the data.
    let columns = columns.with_reversals(model, settings)?;
    let observer = Observer {
        model,
        columns: &columns,
        base: &base.columns,
        projections,
        settings,
    };
    let new =
        |projection: &Projection| Ok(System::new(projection.clone(), &info, base.columns.len()));
    let mut systems: Vec<Result<System, Error>> = projections.iter().map(new).collect();
    let (mut seen, mut points, mut problems) = (Vec::new(), Vec::new(), Vec::new());
    for (number, log) in runs.iter().enumerate() {
        let run = log.name();
        let report = |done, samples| progress(Progress::Run { run, done, samples });
        match observer.run(number, log, LARGEST_STRETCHES / runs.len(), &report) {
            Ok((observed, told)) => {
                seen.push(told);
                points.push(add(&mut systems, observed));
            }
            Err(error) => problems.extend(checks::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    let runs = runs.iter().zip(&seen);
    Ok(Prepared {
        runs: runs.map(|(log, seen)| Run::new(log, seen)).collect(),
        projections: projections.to_vec(),
        columns,
        base,
        payload,
        systems,
        seen,
        points,
    })
}

/// Adds what a run holds to the systems, and gives back the equations at the points of the plots.
fn add(
    systems: &mut [Result<System, Error>],
    observed: Vec<Result<crate::regression::Observed, Error>>,
) -> Vec<Vec<DMatrix<f64>>> {
    let mut points = Vec::new();
    for (system, observed) in systems.iter_mut().zip(observed) {
        match (system.as_mut(), observed) {
            (Ok(own), Ok(mut observed)) => {
                points.push(std::mem::take(&mut observed.points));
                own.extend(observed);
            }
            (Ok(_), Err(error)) => {
                points.push(Vec::new());
                *system = Err(error);
            }
            (Err(_), _) => points.push(Vec::new()),
        }
    }
    points
}

/// Checks the kept actuators of all projections.
fn check_projections(projections: &[Projection], model: &dyn Model) -> Result<(), Error> {
    let problem = |projection: &Projection| match projection {
        Projection::Actuators(kept) => crate::settings::check_partition(kept, &model.info()),
        _ => None,
    };
    Error::check(projections.iter().filter_map(problem).collect())
}

/// Checks whether runs fit the robot and the settings, before the long work.
fn check_runs(model: &dyn Model, runs: &[Log], settings: &Settings) -> Result<(), Error> {
    let check = |log: &Log| kinematics::check(model, log, settings).err();
    let errors = runs.iter().filter_map(check);
    Error::check(errors.flat_map(|error| error.problems).collect())
}

/// Identifies a robot from the runs of an experiment and cross-validates the estimates.
///
/// # Errors
/// As [`prepare`], or data that determine no parameter. What only harms case 2 is a warning.
pub fn identify(
    model: &dyn Model,
    experiment: &Experiment<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Identification, Error> {
    let info = model.info();
    // A cross-validation run that can't be used is better known before the long work.
    check_runs(model, experiment.validation, settings)?;
    let projections = projections(model, settings);
    let prepared = prepare(model, experiment.runs, &projections, settings, progress)?;
    let mut warnings = prepared_warnings(&prepared, experiment.validation);
    let mut estimates = Vec::new();
    let outcomes = estimate_all(&prepared, settings, experiment.true_values, progress);
    for (number, (outcome, projection)) in outcomes.into_iter().zip(&projections).enumerate() {
        match outcome {
            Ok(outcome) => {
                warnings.extend(outcome.warnings);
                estimates.extend([outcome.base, outcome.essential].map(|one| (number, one)));
            }
            Err(error) if matches!(projection, Projection::Actuators(_)) => {
                warnings.push(format!("case 2 is left out: {error}"));
            }
            Err(error) => return Err(error),
        }
    }
    let held_out = cross_validate(
        model,
        &prepared,
        experiment.validation,
        &estimates,
        settings,
        progress,
    )?;
    warnings.extend(held_out.warnings);
    let cross_validation = held_out.validations;
    let own = prepared.seen.iter().flat_map(|seen| seen.findings.clone());
    let mut findings: Vec<verdict::Finding> = own.chain(held_out.findings).collect();
    findings.extend(judgement::findings(
        model, experiment, &prepared, &estimates, settings,
    )?);
    warnings.extend(findings.iter().map(judgement::located));
    let thresholds = verdict::Thresholds::default();
    let figures = plots::figures(
        model,
        &prepared,
        &estimates,
        &cross_validation,
        held_out.motions,
        settings,
    )?;
    Ok(Identification {
        robot: info.name.to_owned(),
        base_parameters: BaseParameter::all(
            &prepared.columns,
            &prepared.base,
            experiment.true_values,
        ),
        without_effect: prepared.without_effect(),
        runs: prepared.runs,
        warnings,
        verdicts: judgement::verdicts(&estimates, &cross_validation, &findings, &thresholds),
        findings,
        thresholds,
        tracking: Vec::new(),
        settings: settings.clone(),
        figures,
        estimates: estimates
            .into_iter()
            .map(|(_, estimate)| estimate)
            .collect(),
        cross_validation,
    })
}

/// Estimates all prepared projections, in parallel.
fn estimate_all(
    prepared: &Prepared,
    settings: &Settings,
    true_values: Option<&BTreeMap<String, f64>>,
    progress: &dyn Fn(Progress<'_>),
) -> Vec<Result<Outcome, Error>> {
    for projection in &prepared.projections {
        let model = projection.name();
        progress(Progress::Estimation { model });
    }
    (0..prepared.projections.len())
        .into_par_iter()
        .map(|number| estimate_projection(prepared, number, settings, true_values))
        .collect()
}

/// The projections of a robot: case 1 and case 2, or its joints without redundancy.
fn projections(model: &dyn Model, settings: &Settings) -> Vec<Projection> {
    let sizes = model.info().sizes;
    if sizes.actuators > sizes.dof {
        let kept = settings.kept_actuators.clone();
        vec![Projection::Platform, Projection::Actuators(kept)]
    } else {
        vec![Projection::Joints]
    }
}

/// What the runs of the cross-validation tell.
#[derive(Default)]
struct HeldOut {
    validations: Vec<CrossValidation>,
    /// The number of the projection of each.
    owners: Vec<usize>,
    motions: Vec<figures::RunFigures>,
    findings: Vec<verdict::Finding>,
    warnings: Vec<String>,
}

/// Compares the runs of the cross-validation with the predictions of all estimates, of which each comes
/// with the number of its projection.
fn cross_validate(
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
                held_out.findings.extend(validated.findings);
            }
            Err(error) => problems.extend(checks::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    // In the order of the estimates, each on all runs.
    for (index, (projection, estimate)) in estimates.iter().enumerate() {
        for (payload, validations) in &all {
            match &validations[index] {
                Ok(validation) => {
                    let validation = CrossValidation::new(estimate, *payload, validation.clone());
                    held_out.validations.push(validation);
                    held_out.owners.push(*projection);
                }
                Err(error) if estimate.stage == Stage::Base => {
                    let warning = format!("no cross-validation: {error}");
                    held_out.warnings.push(warning);
                }
                Err(_) => {}
            }
        }
    }
    Ok(held_out)
}

/// How the payload takes part in the runs.
fn payload_use(model: &dyn Model, runs: &[Log]) -> Result<PayloadUse, Error> {
    let info = model.info();
    if runs.is_empty() {
        return Err(Problem::new("there is no run to identify from")
            .help("give at least one log")
            .into());
    }
    let loaded: Vec<&Log> = runs.iter().filter(|log| log.payload()).collect();
    if info.payload_parameters.is_empty() {
        Error::check(
            loaded
                .iter()
                .map(|log| {
                    Problem::new(format!(
                        "the run carries a payload, but the description of `{}` has none",
                        info.name
                    ))
                    .file(log.name())
                    .help("add a payload to the description, or declare the run unloaded")
                })
                .collect(),
        )?;
    }
    Ok(match loaded.len() {
        0 => PayloadUse::Absent,
        count if count == runs.len() => PayloadUse::Regrouped,
        _ => PayloadUse::Separate,
    })
}

/// What the user should know before any estimate.
fn prepared_warnings(prepared: &Prepared, others: &[Log]) -> Vec<String> {
    let mut warnings = Vec::new();
    if prepared.payload == PayloadUse::Regrouped {
        warnings.push(String::from(
            "the payload's parameters are not identifiable without unloaded runs: they are regrouped into the platform's",
        ));
    }
    for other in others {
        let known = match prepared.payload {
            PayloadUse::Absent => !other.payload(),
            PayloadUse::Regrouped => other.payload(),
            PayloadUse::Separate => true,
        };
        if !known {
            warnings.push(format!(
                "{}: the cross-validation run {} the payload, unlike the runs identified from",
                other.name(),
                if other.payload() {
                    "carries"
                } else {
                    "does not carry"
                }
            ));
        }
    }
    warnings
}
