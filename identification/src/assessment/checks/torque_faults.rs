//! Whether one fault of a drive, a label or a column explains torques that the model does not.

use super::Context;
use crate::{
    assessment::{check::Check, torques},
    data::Log,
    error::Error,
    result::Stage,
};

/// Relative error of the base parameters (percent) above which faults of the data are looked for.
const SUSPICIOUS_PERCENT: f64 = 5.0;

/// Beginning of each run in which they are looked for, s.
const BEGINNING_SECONDS: f64 = 5.0;

/// Looks for one fault.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
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
    Ok(found.into_iter().collect())
}
