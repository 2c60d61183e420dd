//! The whole identification: runs in, parameters with their quality out.
//!
//! [`identify`] estimates case 1 and case 2 of a redundant robot, or the joint model of one without
//! redundancy; each in base parameters, then in essential ones. [`prepare`] and
//! [`estimate_projection`] are its two halves, for studies that estimate many projections from the
//! same motion.

pub mod figures;
mod result;
mod stages;
pub mod verdict;

use std::collections::BTreeMap;

use overact::Model;

pub use result::{
    BaseParameter, CrossValidation, Estimate, Identification, ParameterEstimate, Regrouping, Run,
    Stage,
};
pub use stages::{Outcome, estimate_projection};

use crate::{
    base::{BaseParameters, PayloadUse, base_parameters},
    columns::ColumnSet,
    data::Log,
    error::{Error, Problem},
    kinematics::{Motion, motion},
    regression::{Projection, equations},
    settings::Settings,
    validation::validate_equations,
};

/// A closure residual (m, rad) above this speaks of wrong geometry or offsets.
const LARGEST_CLOSURE_RESIDUAL: f64 = 0.01;

/// What an identification is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// Filters a run and solves its forward kinematics: samples done, of how many.
    Kinematics {
        /// Name of the run.
        run: &'a str,
        /// Samples done.
        done: usize,
        /// Samples of the run.
        samples: usize,
    },
    /// Finds the base parameters.
    Base,
    /// Evaluates and decimates the columns of a run.
    Equations {
        /// `platform`, `actuators` or `joints`.
        model: &'static str,
        /// Name of the run.
        run: &'a str,
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

/// What all projections share: the motion of the runs, the columns and the base parameters.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The columns of the model.
    pub columns: ColumnSet,
    /// The base parameters.
    pub base: BaseParameters,
    /// The motion of each run.
    pub motions: Vec<Motion>,
    /// How the payload takes part.
    pub payload: PayloadUse,
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

/// Filters the runs, computes their motion and finds the base parameters.
///
/// # Errors
/// Settings that are not possible, no run, runs that do not fit the robot (the problems of all runs
/// together), a sample outside the workspace.
pub fn prepare(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Prepared, Error> {
    settings.check(&model.info())?;
    let payload = payload_use(model, runs)?;
    let motions = motions(model, runs, settings, progress)?;
    progress(Progress::Base);
    let columns = ColumnSet::new(
        model,
        payload != PayloadUse::Absent,
        settings.asymmetric_friction,
        settings.seed,
    )?;
    let base = base_parameters(model, &columns, payload, settings.seed)?;
    Ok(Prepared {
        columns,
        base,
        motions,
        payload,
    })
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
    let prepared = prepare(model, experiment.runs, settings, progress)?;
    // A cross-validation run that can't be used is better known before the long work.
    let others = motions(model, experiment.validation, settings, progress)?;
    let mut warnings = prepared_warnings(&prepared, &others);
    let mut estimates = Vec::new();
    let mut cross_validation = Vec::new();
    for projection in &projections(model, settings) {
        let outcome = estimate_projection(
            model,
            &prepared,
            projection,
            settings,
            experiment.true_values,
            progress,
        );
        let outcome = match (outcome, projection) {
            (Err(error), Projection::Actuators(_)) => {
                warnings.push(format!("case 2 is left out: {error}"));
                continue;
            }
            (outcome, _) => outcome?,
        };
        warnings.extend(outcome.warnings);
        let pair = [outcome.base, outcome.essential];
        for other in &others {
            progress(Progress::Validation { run: &other.run });
            match cross_validate(model, &prepared, projection, other, &pair, settings) {
                Ok(validations) => cross_validation.extend(validations),
                Err(error) => warnings.push(format!("no cross-validation: {error}")),
            }
        }
        estimates.extend(pair);
    }
    Ok(Identification {
        robot: info.name.to_owned(),
        runs: prepared.motions.iter().map(Run::new).collect(),
        base_parameters: BaseParameter::all(
            &prepared.columns,
            &prepared.base,
            experiment.true_values,
        ),
        without_effect: prepared.without_effect(),
        estimates,
        cross_validation,
        warnings,
        findings: Vec::new(),
        verdicts: Vec::new(),
        thresholds: verdict::Thresholds::default(),
        tracking: Vec::new(),
        settings: settings.clone(),
        figures: figures::Figures::default(),
    })
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

/// Compares one run with the predictions of several estimates of a projection.
fn cross_validate(
    model: &dyn Model,
    prepared: &Prepared,
    projection: &Projection,
    motion: &Motion,
    estimates: &[Estimate],
    settings: &Settings,
) -> Result<Vec<CrossValidation>, Error> {
    let columns = &prepared.columns;
    let equations = equations(model, columns, projection, motion, settings)?;
    estimates
        .iter()
        .map(|estimate| {
            let (selected, values) = (estimate.columns(), estimate.values());
            let parameters = (selected.as_slice(), values.as_slice());
            validate_equations(
                model, columns, projection, motion, &equations, parameters, settings,
            )
            .map(|validation| CrossValidation::new(estimate, motion.payload, validation))
        })
        .collect()
}

/// The motion of several runs; the problems of all of them are collected.
fn motions(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Vec<Motion>, Error> {
    let mut motions = Vec::new();
    let mut problems = Vec::new();
    for log in runs {
        let run = log.name();
        let report = |done, samples| progress(Progress::Kinematics { run, done, samples });
        match motion(model, log, settings, &report) {
            Ok(motion) => motions.push(motion),
            Err(error) => problems.extend(error.problems),
        }
    }
    Error::check(problems)?;
    Ok(motions)
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
fn prepared_warnings(prepared: &Prepared, others: &[Motion]) -> Vec<String> {
    let mut warnings = Vec::new();
    if prepared.payload == PayloadUse::Regrouped {
        warnings.push(String::from(
            "the payload's parameters are not identifiable without unloaded runs: they are regrouped into the platform's",
        ));
    }
    for motion in prepared.motions.iter().chain(others) {
        if motion.closure_residual > LARGEST_CLOSURE_RESIDUAL {
            warnings.push(format!(
                "{}: the actuator positions miss the closure of the loops by up to {:.3} m or rad; check the geometry and the offsets of the encoders",
                motion.run, motion.closure_residual
            ));
        }
    }
    for other in others {
        let known = match prepared.payload {
            PayloadUse::Absent => !other.payload,
            PayloadUse::Regrouped => other.payload,
            PayloadUse::Separate => true,
        };
        if !known {
            warnings.push(format!(
                "{}: the cross-validation run {} the payload, unlike the runs identified from",
                other.run,
                if other.payload {
                    "carries"
                } else {
                    "does not carry"
                }
            ));
        }
    }
    warnings
}
