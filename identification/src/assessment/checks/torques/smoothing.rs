//! Tests whether torques and motion passed the same smoothing.
//!
//! A symmetric filter with weights w(t) changes a slow torque τ to τ + s τ̈, with s = ½ Σ w t².
//! Examples are:
//!
//! - zero-phase filters;
//! - a moving average over T: s = T²/24;
//! - linear interpolation between samples T apart: s = T²/12 on average.
//!
//! A filter that also delays is found as a delay.

use super::half_band::confirms;
use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{TestedHypothesis, dry_friction, harm, only, parabola},
        level::{level, origin},
        motion::filters::{equal_bands, torque_band},
    },
    detectable::{OF_MEAN, UNIT_OF_SMOOTHING},
    hypotheses::FaultHypothesis,
};
use overact_logs::{Error, significant};

/// Harmless length of a moving average, in sampling intervals; drives hold their torque.
const HARMLESS: f64 = 2.0;

/// Harmless s.
pub(crate) fn harmless(context: &Context<'_>) -> f64 {
    let intervals = context.dataset.runs.iter();
    let intervals = intervals.map(|run| HARMLESS / run.sampling_frequency());
    intervals.fold(0.0, f64::max).powi(2) / OF_MEAN
}

/// Tests for torques smoother than the motion, or a motion smoother than the torques.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let Some(one) = only(scores, FaultHypothesis::Smoothing) else {
        return Ok(Vec::new());
    };
    // Effect on all parameters, including dry friction, at the size found without dry friction.
    let whole =
        only(scores, FaultHypothesis::SmoothingWithFriction).map(|whole| TestedHypothesis {
            size: Some(one.wald.size()),
            ..whole
        });
    let whole = whole.as_ref().unwrap_or(&one);
    let level = level(1);
    let harmless = harmless(context);
    let wald = &one.wald;
    // Length of the moving average with the same smoothing, ms.
    let time = |size: f64| significant(1e3 * (OF_MEAN * size.abs()).sqrt(), 2);
    let beyond = (wald.size().abs() - harmless).max(0.0);
    let visible = harmless + wald.visible(level);
    let check = |words: String| {
        Check::new(CheckKind::Filters, About::Model, words)
            .measured(beyond / wald.deviation, "standard deviations")
            .against(
                wald.quantile(level),
                format!(
                    "{}, of what exceeds a mean over {HARMLESS} sampling intervals",
                    origin(1)
                ),
            )
            .detecting(vec![whole.detectable(
                context,
                scores,
                UNIT_OF_SMOOTHING,
                visible,
            )])
            .shown_by(parabola(
                wald,
                "Residual for smoothed torques",
                "half of the filter's mean square delay",
                "ms²",
                1e6,
            ))
    };
    if wald.probability_beyond(harmless) >= level {
        return Ok(vec![check(format!(
            "torques and motion are equally smooth; the detection limit is a mean of the torques over {} ms",
            time(visible)
        ))]);
    }
    if !confirms(context, FaultHypothesis::Smoothing, wald.size())? {
        return Ok(vec![check(format!(
            "torques and motion are equally smooth: an apparent mean over {} ms is absent in half of the band, which indicates encoder errors",
            time(wald.size())
        ))]);
    }
    let mut harm = harm(context, scores, whole);
    harm.explained = wald.explained;
    // The test omits reversals, but the filter rounds them, too.
    harm.spoil(dry_friction(context));
    let band = torque_band(context);
    let what = match band {
        Some(_) => "torques and motion pass different filters",
        None if wald.size() > 0.0 => "the torques are smoother than the motion",
        None => "the motion is smoother than the torques",
    };
    let remedy = band.map_or_else(
        || String::from("Look for a filter of the drive or of the log on one of the two, or for interpolated samples: log both without them"),
        |band| equal_bands(context, band),
    );
    let words = format!(
        "{what}, as by a mean over {} ms; {}, and rounds off dry friction at reversals. {remedy}",
        time(wald.size()),
        harm.words()
    );
    Ok(vec![check(words).with_harm(&harm)])
}
