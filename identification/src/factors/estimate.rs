//! The estimates from factors.

use overact::Model;
use serde::Serialize;

use super::{left_out::LeftOut, restore::restored, run::RunFactors};
use crate::{
    error::Error,
    identify::{BaseParameter, Progress, estimates_of},
    result::{Estimate, RunSummary},
    settings::{Instruments, Settings},
};

/// What the factors of runs tell.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FromFactors {
    /// Name of the robot.
    pub robot: String,
    /// The runs.
    pub runs: Vec<RunSummary>,
    /// The base parameters and what is regrouped into them.
    pub base_parameters: Vec<BaseParameter>,
    /// The estimates: for each model base, recommended and essential by least squares, then by ordinary ones.
    pub estimates: Vec<Estimate>,
    /// Where deviations under correlated residuals and intervals come from.
    pub deviations: Deviations,
    /// What was left out.
    pub left_out: Vec<LeftOut>,
    /// What the user should know before trusting the numbers.
    pub warnings: Vec<String>,
    /// The settings used.
    pub settings: Settings,
}

/// Where deviations under correlated residuals and intervals come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Deviations {
    /// From successive equations, as in one pass over the logs.
    Equations,
    /// From the sums of parts of the runs.
    Parts,
}

/// Estimates parameters from the factors of runs. `left_out` is what was left out before.
///
/// # Errors
/// Factors that do not fit the model, data that determine no parameter; without `skip_bad` runs that lack a
/// model other than case 2.
pub fn identify_factors(
    model: &dyn Model,
    (runs, left_out): (&[RunFactors], &[LeftOut]),
    settings: &Settings,
    skip_bad: bool,
    progress: &dyn Fn(Progress<'_>),
) -> Result<FromFactors, Error> {
    settings.check(&model.info())?;
    let has_equations = |run: &RunFactors| {
        let mut usable = run.models.iter().filter(|own| own.parts.is_ok());
        usable.all(|own| !own.stretches.is_empty())
    };
    let deviations = match runs.iter().all(has_equations) {
        true => Deviations::Equations,
        false => Deviations::Parts,
    };
    // Stretches of some runs would speak for the others.
    let mut runs = runs.to_vec();
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
    Ok(FromFactors {
        robot: model.info().name.to_owned(),
        base_parameters: BaseParameter::all(&prepared.columns, &prepared.base, None),
        runs: prepared.runs,
        estimates,
        deviations,
        left_out: [left_out, &missing].concat(),
        warnings,
        settings,
    })
}
