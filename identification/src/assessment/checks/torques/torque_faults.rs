//! Looks for one fault of a drive, label or column that explains a large residual.

use crate::{
    assessment::{check::Check, checks::Context, hypotheses::is_quasi_static, torques},
    result::Stage,
};
use overact_logs::{Error, Log};

/// Relative residual of the base parameters (percent) above which faults are looked for.
const SUSPICIOUS_PERCENT: f64 = 3.0;

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
    // A few seconds of a quasi-static run show hardly any change.
    let is_slow = context
        .scores
        .is_some_and(|scores| is_quasi_static(&context.paces(scores)));
    let start = if is_slow {
        LONGEST_SECONDS
    } else {
        BEGINNING_SECONDS
    };
    let beginnings = |seconds: f64| -> Result<Vec<Log>, Error> {
        let beginning = |log: &Log| {
            let samples = (seconds * log.sampling_frequency()) as usize;
            log.beginning(samples.max(context.settings.samples_needed()))
        };
        context.dataset.runs.iter().map(beginning).collect()
    };
    let (model, settings) = (context.model, context.settings);
    let missing = || -> Result<Option<Check>, Error> {
        torques::missing_torques(model, &beginnings(LONGEST_SECONDS)?, settings)
    };
    let single = || -> Result<Option<Check>, Error> {
        torques::explanation(model, &beginnings(start)?, settings)
    };
    // Tensions that hardly change satisfy the equations with any gain, so that gains explain
    // friction and drift of cables, too.
    let found = if model.pulls().is_empty() {
        single()?.map_or_else(missing, |found| Ok(Some(found)))?
    } else {
        missing()?.map_or_else(single, |found| Ok(Some(found)))?
    };
    Ok(found.into_iter().collect())
}
