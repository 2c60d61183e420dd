//! Whether the measured positions close the loops, as well as encoders of their resolution and noise
//! can.
//!
//! Each encoder is off by half of its resolution at most, and by its noise. The miss of the closure is a
//! projection of these errors, so its largest component is no larger than their norm. Noise is told from
//! the positions themselves, by third differences. Geometry that is wrong by a part of the motion's range
//! makes parameters wrong by about the same part, so a miss that is small beside the range and the
//! deviations of all parameters does no harm.

use super::{
    Context, Watched,
    level::{FALSE_ALARMS, level},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        evidence::{Axis, Curve, Evidence},
        positions,
    },
    error::Error,
    estimation::intervals::distributions::student_quantile,
    kinematics::conditioning::couples,
    result::Stage,
    significant,
};

/// Positions are filtered, which rings a little at steps.
const RINGING: f64 = 1.5;

/// Miss by the range of the motion that does no harm, by the smallest relative deviation of a parameter.
const HARMLESS: f64 = 0.3;

/// Looks at all runs of a robot whose actuators are more than its degrees of freedom.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let sizes = context.model.info().sizes;
    let mut checks = Vec::new();
    if sizes.actuators <= sizes.dof || !couples(context.model) {
        return Ok(checks);
    }
    for (number, (log, watched)) in context.runs().enumerate() {
        let residual = watched.closure_residual;
        let (limit, noise) = limit(watched, log.samples());
        let ranges = watched.monitor.ranges();
        let range = ranges.into_iter().fold(0.0, f64::max);
        let harmless = HARMLESS * range * finest(context);
        let explained = positions::explanation(context.model, log, limit.max(harmless))?;
        let misses = residual > limit;
        let part = significant(100.0 * residual / range, 2);
        let words = if !misses {
            format!(
                "the positions close the loops to {} m or rad, as encoders of this resolution and noise do",
                significant(residual, 2)
            )
        } else if residual <= harmless {
            format!(
                "the positions miss the closure of the loops by up to {} m or rad, more than resolution and noise explain, but only {part} % of the range of the motion",
                significant(residual, 2)
            )
        } else {
            format!(
                "the positions miss the closure of the loops by up to {} m or rad, {part} % of the range of the motion, where resolution and noise explain {}; lengths of the description or offsets of encoders are wrong: `overact identify --calibrate` estimates them",
                significant(residual, 2),
                significant(limit, 2)
            )
        };
        let check = Check::new(CheckKind::Closure, About::Model, words)
            .in_run(log.name())
            .measured(residual, "m or rad")
            .against(
                limit,
                format!(
                    "half of the encoders' resolution, and noise of {} m or rad at a false alarm in {} % of reports",
                    significant(noise, 2),
                    100.0 * FALSE_ALARMS
                ),
            );
        let check = if number == 0 {
            check.shown_by(evidence(context))
        } else {
            check
        };
        checks.extend(explained.filter(|_| misses));
        checks.push(if misses && residual > harmless {
            check.allowing(Grade::DoNotUse)
        } else if misses {
            check.found()
        } else {
            check
        });
    }
    Ok(checks)
}

/// The largest miss that resolution and noise explain, and the noise (m, rad).
fn limit(watched: &Watched, samples: usize) -> (f64, f64) {
    let [variances, _] = watched.monitor.noise();
    let resolutions = watched.monitor.resolutions();
    let tests = samples * variances.len().max(1);
    let quantile = student_quantile(level(tests), f64::INFINITY);
    let noise = variances.iter().sum::<f64>().sqrt();
    let squares = variances
        .iter()
        .zip(resolutions)
        .map(|(variance, resolution)| (0.5 * resolution).max(quantile * variance.sqrt()).powi(2));
    (RINGING * squares.sum::<f64>().sqrt(), noise)
}

/// The smallest relative deviation of a recommended parameter.
fn finest(context: &Context<'_>) -> f64 {
    let estimates = context.estimates_of(Stage::Recommended);
    let all = estimates.flat_map(|one| &one.parameters);
    let relative = all.map(|one| {
        let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
        half / one.value.abs()
    });
    let finest = relative.fold(f64::INFINITY, f64::min);
    if finest.is_finite() { finest } else { 0.0 }
}

/// The miss of each run and what resolution and noise explain of it.
fn evidence(context: &Context<'_>) -> Evidence {
    let mut curves =
        ["miss", "explained by resolution and noise"].map(|name| Curve::new(name, &[], &[]));
    for (number, (log, watched)) in context.runs().enumerate() {
        let values = [watched.closure_residual, limit(watched, log.samples()).0];
        for (curve, value) in curves.iter_mut().zip(values) {
            curve.x.push((number + 1) as f64);
            curve.y.push(value);
        }
    }
    Evidence {
        title: String::from("Closure of the loops"),
        x: Axis::new("number of the run", ""),
        y: Axis::new("miss", "m or rad"),
        points: curves.into_iter().collect(),
        ..Evidence::default()
    }
}
