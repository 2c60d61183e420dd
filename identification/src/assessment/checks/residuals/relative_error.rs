//! Compares the relative residual of each estimate with the torque noise.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    result::{Estimate, Stage},
};
use overact_logs::{Error, significant};

/// Largest relative residual beyond noise, in percent.
///
/// Published identifications have 2 to 12 %, including noise (Briot, Krut, Gautier 2015; Janot,
/// Gautier, Brunot 2019).
const LARGEST_PERCENT: f64 = 20.0;

/// Fraction of white noise power that passes decimation by d, times d.
///
/// The cutoff of the filter is this fraction of the new Nyquist frequency.
const PASSED: f64 = 0.8;

/// Largest ratio of residual to noise that needs no explanation.
///
/// Virtual robots without a fault reach 1.3, and 2 with ten times coarser encoders.
const SILENT: f64 = 4.0;

/// Smallest fraction of the squared residual that makes a fault its cause.
const MOST: f64 = 0.5;

/// Relative residual (percent) that may remain if the named faults explain only part of it.
///
/// Measured robots have friction that the model lacks: those of `docs/measured.md` keep 3 to 5 %.
const ORDINARY_PERCENT: f64 = 5.0;

/// Fails if the residual far exceeds the noise and no check explains it.
///
/// The effect of the unknown cause on the parameters is unknown.
pub(crate) fn silent(context: &Context<'_>, all: &[Check]) -> Option<Check> {
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
        0.0 => String::from("and no tested fault explains it"),
        _ => format!(
            "and the faults found explain {} % of its square",
            significant(100.0 * part, 2)
        ),
    };
    let words = format!(
        "the relative residual, {} %, is {} times the noise of the torques, {why}. Intervals cover noise only, not the bias by such an error. Look for filters of torques or positions, for play, flexible parts and other friction, or for encoders that are coarse for the motion",
        significant(error, 3),
        significant(ratio, 2)
    );
    let ratio = rest * ratio;
    let check = Check::new(CheckKind::RelativeError, About::Fit, words)
        .measured(ratio, "times the noise")
        .against(
            SILENT,
            "simulated robots without faults have 1 to 1.3 times the noise",
        );
    (ratio.is_finite() && ratio > SILENT).then(|| check.with_grade(Grade::DoNotUse))
}

/// Whether a failed check accounts for the residual.
///
/// It forbids use, or explains most of the residual, or concerns data of unknown error. Correlated
/// residuals explain nothing.
fn is_cause(check: &Check) -> bool {
    match (check.grade, check.explained) {
        (Grade::DoNotUse, _) => true,
        (_, Some(part)) => part >= MOST,
        (Grade::Use, None) => check.kind != CheckKind::ResidualCorrelation,
        (Grade::UseListed, None) => check.about == About::Data,
    }
}

/// The error beyond noise, √(error² - noise²).
fn beyond(error: f64, noise: f64) -> f64 {
    (error.powi(2) - noise.powi(2)).max(0.0).sqrt()
}

/// Checks all estimates.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let noise = noise_percent(context);
    let of_estimate = |estimate: &Estimate| {
        let error = estimate.relative_error_percent;
        // The actuator projection weights actuators differently; its noise is only approximate.
        let beyond = beyond(error, noise);
        let good = beyond <= LARGEST_PERCENT;
        let words = format!(
            "{} {} parameters: relative residual {} %; noise of the torques, estimated from neighbouring samples, {} %{}",
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
                "published identifications have 2 to 12 %, including noise",
            )
            .with_grade(if good { Grade::Use } else { Grade::DoNotUse })
    };
    Ok(context.least_squares().map(of_estimate).collect())
}

/// Residual of the base parameters divided by the torque noise.
pub(crate) fn times_the_noise(context: &Context<'_>) -> f64 {
    let base = context.estimates_of(Stage::Base).next();
    base.map_or(f64::NAN, |base| {
        base.relative_error_percent / noise_percent(context)
    })
}

/// Torque noise in percent of the inputs of the first model.
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
