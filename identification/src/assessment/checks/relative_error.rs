//! How much of the inputs an estimate leaves unexplained, beside the noise of the torques.

use super::Context;
use crate::{
    assessment::check::{About, Check, CheckKind, Grade},
    error::Error,
    result::{Estimate, Stage},
    significant,
};

/// Percent of the inputs that may be left unexplained beyond noise. Published identifications leave 2 to
/// 12 % (Briot, Krut, Gautier 2015; Janot, Gautier, Brunot 2019), noise among it.
const LARGEST_PERCENT: f64 = 20.0;

/// The part of the power of white noise that decimation by one sample in d leaves, times d: its cutoff
/// lies at this part of the new Nyquist frequency.
const PASSED: f64 = 0.8;

/// How many times its noise the residual may be where nothing explains it. Virtual robots without a fault leave 0.99 to
/// 1.3 times the noise, with encoders ten times as coarse up to twice.
const SILENT: f64 = 4.0;

/// The part of the residual's square that a fault explains, at least, which it is said to come from.
const MOST: f64 = 0.5;

/// Percent of the inputs that may stay unexplained where a fault is named that explains less than that. Measured robots
/// have friction that no column tells: beside what is found, those of `docs/measured.md` leave 3 to 5 %.
const ORDINARY_PERCENT: f64 = 5.0;

/// Says that a residual is far beyond the noise where no check has found why: something is wrong, and what it does to
/// the parameters nobody knows.
pub(super) fn silent(context: &Context<'_>, all: &[Check]) -> Option<Check> {
    let found = || all.iter().filter(|check| !check.passed);
    if found().any(is_cause) {
        return None;
    }
    let base = context.estimates_of(Stage::Base).next()?;
    let part = found().filter_map(|check| check.explained);
    let part = part.fold(0.0, f64::max);
    let rest = (1.0 - part).max(0.0).sqrt();
    let (error, ratio) = (base.relative_error_percent, times_the_noise(context));
    let is_named = found().any(|check| check.grade != Grade::Use);
    let left = beyond(rest * error, noise_percent(context));
    if is_named && left <= ORDINARY_PERCENT {
        return None;
    }
    let why = match part {
        0.0 => String::from("and nothing that was looked for explains it"),
        _ => format!(
            "and what was found explains {} % of its square",
            significant(100.0 * part, 2)
        ),
    };
    let words = format!(
        "what is left unexplained, {} % of the inputs, is {} times the noise of the torques, {why}. Intervals tell chance alone, and what the parameters have taken up of the error is not in them. Look for filters that torques and positions have passed, for play, flexible parts and friction of another kind, or for encoders that are coarse for the motion",
        significant(error, 3),
        significant(ratio, 2)
    );
    let ratio = rest * ratio;
    let check = Check::new(CheckKind::RelativeError, About::Fit, words)
        .measured(ratio, "times the noise")
        .against(
            SILENT,
            "faultless virtual robots leave 1 to 1.3 times the noise",
        );
    (ratio.is_finite() && ratio > SILENT).then(|| check.allowing(Grade::DoNotUse))
}

/// Whether a check that found something forbids the use by itself, says what most of the residual comes from, or speaks
/// of numbers that are wrong by an unknown part. That residuals hang together explains none of them.
fn is_cause(check: &Check) -> bool {
    match (check.grade, check.explained) {
        (Grade::DoNotUse, _) => true,
        (_, Some(part)) => part >= MOST,
        (Grade::Use, None) => check.kind != CheckKind::ResidualCorrelation,
        (Grade::UseListed, None) => check.about == About::Data,
    }
}

/// What of an error is beyond noise.
fn beyond(error: f64, noise: f64) -> f64 {
    (error.powi(2) - noise.powi(2)).max(0.0).sqrt()
}

/// Looks at all estimates.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let noise = noise_percent(context);
    let of_estimate = |estimate: &Estimate| {
        let error = estimate.relative_error_percent;
        // Case 2 weighs the actuators otherwise; its noise is known no better than to a factor.
        let beyond = beyond(error, noise);
        let good = beyond <= LARGEST_PERCENT;
        let words = format!(
            "{} {} parameters leave {} % of the inputs unexplained; noise of the torques, told from neighbouring samples, is {} %{}",
            estimate.parameters.len(),
            estimate.stage.name(),
            significant(error, 3),
            significant(noise, 2),
            if good {
                ""
            } else {
                ": the model does not explain the torques. Check signs, units, gains and labels"
            }
        );
        Check::new(CheckKind::RelativeError, About::Fit, words)
            .of_model(estimate.model)
            .of_stage(estimate.stage)
            .measured(beyond, "%")
            .against(
                LARGEST_PERCENT,
                "published identifications leave 2 to 12 %, noise among it",
            )
            .allowing(if good { Grade::Use } else { Grade::DoNotUse })
    };
    Ok(context.least_squares().map(of_estimate).collect())
}

/// How many times the noise of the torques the residual of the base parameters is.
pub(super) fn times_the_noise(context: &Context<'_>) -> f64 {
    let base = context.estimates_of(Stage::Base).next();
    base.map_or(f64::NAN, |base| {
        base.relative_error_percent / noise_percent(context)
    })
}

/// The noise of the torques in percent of the inputs of the first model.
fn noise_percent(context: &Context<'_>) -> f64 {
    let (Some(scores), Some(base)) = (context.scores, context.estimates_of(Stage::Base).next())
    else {
        return 0.0;
    };
    let runs = context.dataset.runs.len();
    let variances: Vec<Vec<f64>> = context
        .watched
        .iter()
        .take(runs)
        .map(|watched| {
            let [_, torques] = watched.monitor.noise();
            torques
        })
        .collect();
    let passed = match context.settings.decimation {
        0 | 1 => 1.0,
        factor => PASSED / factor as f64,
    };
    let part = scores.noise(&variances, passed) / base.residual_deviation.powi(2);
    let part = if part.is_finite() { part.min(1.0) } else { 1.0 };
    base.relative_error_percent * part.sqrt()
}
