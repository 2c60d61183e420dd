//! Estimation from factors.

use overact::Model;
use serde::Serialize;

use super::{excluded_run::ExcludedRun, gather::CollectedRuns, restore::restored, run::RunFactors};
use crate::{
    identify::{BaseParameter, Progress, estimates_of},
    result::{Estimate, RunSummary},
    settings::{Instruments, Settings},
};
use overact_logs::Error;

/// Result of an estimation from the factors of runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FactorEstimation {
    /// Name of the robot.
    pub robot: String,
    /// Runs.
    pub runs: Vec<RunSummary>,
    /// Base parameters and their regroupings.
    pub base_parameters: Vec<BaseParameter>,
    /// Estimates of each model: base, recommended and essential parameters.
    ///
    /// First by weighted, then by ordinary least squares.
    pub estimates: Vec<Estimate>,
    /// Origin of standard deviations for correlated residuals, and of intervals.
    pub deviations: Deviations,
    /// Runs and files that were left out.
    pub left_out: Vec<ExcludedRun>,
    /// Warnings before using the result.
    pub warnings: Vec<String>,
    /// The settings used.
    pub settings: Settings,
}

/// Origin of standard deviations for correlated residuals, and of intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Deviations {
    /// Successive equations, as with the logs themselves.
    Equations,
    /// Sums over parts of the runs.
    Parts,
}

/// Estimates parameters from the factors of runs.
///
/// # Errors
/// Factors that do not fit the model, or data that determine no parameter. Without `skip_bad`, also
/// runs that lack a model other than the actuator projection.
pub fn identify_factors(
    model: &dyn Model,
    collected: &CollectedRuns,
    settings: &Settings,
    skip_bad: bool,
    progress: &dyn Fn(Progress<'_>),
) -> Result<FactorEstimation, Error> {
    settings.check(&model.info())?;
    let has_equations = |run: &RunFactors| {
        let mut usable = run.models.iter().filter(|own| own.parts.is_ok());
        usable.all(|own| !own.stretches.is_empty())
    };
    let mut runs = collected.runs.clone();
    let deviations = if runs.iter().all(has_equations) {
        Deviations::Equations
    } else {
        Deviations::Parts
    };
    // Use the stretches of all runs or of none.
    if deviations == Deviations::Parts {
        let models = runs.iter_mut().flat_map(|run| &mut run.models);
        models.for_each(|own| own.stretches.clear());
    }
    let settings = Settings {
        instruments: Instruments::None,
        ..settings.clone()
    };
    progress(Progress::Base);
    let (prepared, missing) = restored(model, &runs, &settings, skip_bad)?;
    let mut warnings: Vec<String> = runs.iter().flat_map(|run| run.flags.clone()).collect();
    let estimates = estimates_of(&prepared, &settings, progress, &mut warnings)?;
    Ok(FactorEstimation {
        robot: model.info().name.to_owned(),
        base_parameters: BaseParameter::all(&prepared.columns, &prepared.base, None),
        runs: prepared.runs,
        estimates,
        deviations,
        left_out: [&collected.left_out[..], &missing].concat(),
        warnings,
        settings,
    })
}
