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

/// Relative residual, in percent, above which the torques contain almost no trace of the robot.
///
/// The model then explains less than a fifth of their square. Torques that were not recorded, and
/// have noise only, leave 97 % and more.
const ONLY_NOISE_PERCENT: f64 = 90.0;

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
    let (error, ratio) = (base.relative_error_percent, times_the_noise(context)?);
    let is_named = found().any(|check| check.grade != Grade::Use);
    let left = beyond(rest * error, noise_percent(context).unwrap_or(0.0));
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
        "the relative residual, {} %, is {} times the noise of the torques, {why}. Intervals cover noise only, not the bias by such an error. {}Look for filters of torques or positions, for play, flexible parts and other friction, or for encoders that are coarse for the motion",
        significant(error, 3),
        significant(ratio, 2),
        kept_transients(context)
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

/// Sentence on transients of the position filter that the settings keep; empty if there are none.
fn kept_transients(context: &Context<'_>) -> String {
    let Some(run) = context.dataset.runs.first() else {
        return String::new();
    };
    let own = context.settings;
    let trimmed = own.clone().trimmed(run.sampling_frequency());
    let ends = [
        ("skip_start", "start", own.skip_start, trimmed.skip_start),
        ("skip_end", "end", own.skip_end, trimmed.skip_end),
    ];
    let kept = ends.into_iter().filter(|(.., own, trimmed)| own < trimmed);
    let sentence = |(key, end, own, trimmed): (&str, &str, usize, usize)| {
        format!(
            "The transient of the position filter at the {end} of each run is kept (`{key} = {own}`); set `{key} = {trimmed}` to leave it out. "
        )
    };
    kept.map(sentence).collect()
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
        let beyond = beyond(error, noise.unwrap_or(0.0));
        let is_noise = beyond <= LARGEST_PERCENT && error > ONLY_NOISE_PERCENT;
        let good = beyond <= LARGEST_PERCENT && !is_noise;
        let noise_words = noise.map_or_else(String::new, |noise| {
            let noise = significant(noise, 2);
            format!("; noise of the torques, estimated from neighbouring samples, {noise} %")
        });
        let cause = match (good, is_noise, noise) {
            (true, ..) => "",
            (_, true, _) => {
                ": the torques are almost only noise. Check that they were recorded, and their columns in [data]"
            }
            (.., Some(_)) => {
                ": the model does not explain the torques. Check signs, units, gains and labels, the direction of `gravity`, and for bodies, springs or payloads that are missing"
            }
            (.., None) => {
                ": the torques have much noise, or the model does not explain them. The complete checks, `--checks all`, distinguish these causes"
            }
        };
        let words = format!(
            "{} {} parameters: relative residual {} %{noise_words}{cause}",
            estimate.parameters.len(),
            estimate.stage.name(),
            significant(error, 3),
        );
        let check = Check::new(CheckKind::RelativeError, About::Fit, words)
            .of_model(estimate.model)
            .of_stage(estimate.stage)
            .with_grade(if good { Grade::Use } else { Grade::DoNotUse });
        if is_noise {
            let origin = "the model then explains less than a fifth of the torques' square";
            check
                .measured(error, "%")
                .against(ONLY_NOISE_PERCENT, origin)
        } else {
            let origin = "published identifications have 2 to 12 %, including noise";
            check.measured(beyond, "%").against(LARGEST_PERCENT, origin)
        }
    };
    Ok(context.least_squares().map(of_estimate).collect())
}

/// Residual of the base parameters divided by the torque noise; `None` if the noise is unknown.
pub(crate) fn times_the_noise(context: &Context<'_>) -> Option<f64> {
    let base = context.estimates_of(Stage::Base).next()?;
    Some(base.relative_error_percent / noise_percent(context)?)
}

/// Torque noise in percent of the inputs of the first model; `None` without scores.
fn noise_percent(context: &Context<'_>) -> Option<f64> {
    let (scores, base) = (context.scores?, context.estimates_of(Stage::Base).next()?);
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
    Some(base.relative_error_percent * part.sqrt())
}
