//! Whether torques and motion have been smoothed alike.
//!
//! A symmetric filter with the weights w(t) makes τ + s τ̈ of a torque τ that is slow for it, with s = ½ Σ w t²: so does a
//! filter that was run forth and back, a mean over some time (T²/24), or interpolation between samples that are T apart
//! (T²/12 in the mean). A filter that also delays is seen as a delay.

use super::{
    Context,
    half_band::confirms,
    level::{level, origin},
    suspected::{Tested, dry_friction, harm, only, parabola},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind},
        suspects::Suspect,
    },
    error::Error,
    significant,
};

/// The mean over this part of a sampling interval is no smoothing: a drive holds its torque between samples.
const HARMLESS: f64 = 2.0;

/// s of a mean over T is T² by this.
pub(in crate::assessment) const OF_MEAN: f64 = 24.0;

/// The unit of s.
pub(in crate::assessment) const UNIT: &str = "s²";

/// s of a smoothing that is none.
pub(super) fn harmless(context: &Context<'_>) -> f64 {
    let intervals = context.dataset.runs.iter();
    let intervals = intervals.map(|run| HARMLESS / run.sampling_frequency());
    intervals.fold(0.0, f64::max).powi(2) / OF_MEAN
}

/// Looks for torques that are smoother than the motion, or a motion that is smoother than the torques.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let Some(one) = only(scores, Suspect::Smoothing) else {
        return Ok(Vec::new());
    };
    // What it does to the parameters, dry friction among them, if it is as large as the other tells.
    let whole = only(scores, Suspect::Rounding).map(|whole| Tested {
        size: Some(one.accused.size()),
        ..whole
    });
    let whole = whole.as_ref().unwrap_or(&one);
    let level = level(1);
    let harmless = harmless(context);
    let accused = &one.accused;
    // The time over which a mean would smooth as much, ms.
    let time = |size: f64| significant(1e3 * (OF_MEAN * size.abs()).sqrt(), 2);
    let beyond = (accused.size().abs() - harmless).max(0.0);
    let visible = harmless + accused.visible(level);
    let check = |words: String| {
        Check::new(CheckKind::Filters, About::Model, words)
            .measured(beyond / accused.deviation, "standard deviations")
            .against(
                accused.quantile(level),
                format!(
                    "{}, of what exceeds a mean over {HARMLESS} sampling intervals",
                    origin(1)
                ),
            )
            .detecting(vec![whole.detectable(
                (context, scores),
                (String::new(), UNIT),
                visible,
            )])
            .shown_by(parabola(
                accused,
                "Residual for torques that are smoothed",
                ("half of the mean square of the filter's time", "ms²", 1e6),
            ))
    };
    if accused.probability_beyond(harmless) >= level {
        return Ok(vec![check(format!(
            "torques and motion are smoothed alike; a mean of the torques over {} ms would have been seen",
            time(visible)
        ))]);
    }
    if !confirms(context, Suspect::Smoothing, accused.size())? {
        return Ok(vec![check(format!(
            "torques and motion are smoothed alike: what looks like a mean over {} ms is not there in half of the band, as where errors of the encoders make it",
            time(accused.size())
        ))]);
    }
    let mut harm = harm(context, scores, whole);
    harm.explained = accused.explained;
    // Reversals, which were left out of what it was found by, are rounded off, too.
    harm.spoil(dry_friction(context));
    let (what, beside) = if accused.size() > 0.0 {
        ("the torques are", "the motion")
    } else {
        ("the motion is", "the torques")
    };
    let words = format!(
        "{what} smoother than {beside}, as by a mean over {} ms; {}, and rounds off dry friction at reversals. Look for a filter of the drive or of the log that one of the two has passed, or for samples that were interpolated: log both without",
        time(accused.size()),
        harm.words()
    );
    Ok(vec![check(words).because(&harm)])
}
