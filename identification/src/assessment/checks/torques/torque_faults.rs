//! Looks for one fault of a drive, label or column that explains a large residual.

use crate::{
    assessment::{check::Check, checks::Context, torques},
    result::Stage,
};
use overact_logs::{Error, Log};

/// Relative residual of the base parameters (percent) above which faults are looked for.
const SUSPICIOUS_PERCENT: f64 = 5.0;

/// Time from the start of each run that is used, s.
const BEGINNING_SECONDS: f64 = 5.0;

/// Longest time of each run that is used to look for dry friction, s.
const LONGEST_SECONDS: f64 = 60.0;

/// Looks for one fault.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let mut base = context.estimates_of(Stage::Base);
    if base
        .next()
        .is_none_or(|first| first.relative_error_percent <= SUSPICIOUS_PERCENT)
    {
        return Ok(Vec::new());
    }
    let beginning = |log: &Log| {
        let samples = (BEGINNING_SECONDS * log.sampling_frequency()) as usize;
        log.beginning(samples.max(context.settings.samples_needed()))
    };
    let runs: Vec<Log> = context
        .dataset
        .runs
        .iter()
        .map(beginning)
        .collect::<Result<_, _>>()?;
    let found = torques::explanation(context.model, &runs, context.settings)?;
    if found.is_some() {
        return Ok(found.into_iter().collect());
    }
    let whole = |log: &Log| {
        let samples = (LONGEST_SECONDS * log.sampling_frequency()) as usize;
        log.beginning(samples.max(context.settings.samples_needed()))
    };
    let all = context.dataset.runs.iter();
    let runs: Vec<Log> = all.map(whole).collect::<Result<_, _>>()?;
    let found = torques::missing_friction(context.model, &runs, context.settings)?;
    Ok(found.into_iter().collect())
}
