//! Tests whether the measured positions close the loops within resolution and noise.
//!
//! Each encoder is wrong by at most half its resolution, plus noise. The closure residual is a
//! projection of these errors, so its largest component is at most their norm. The noise is
//! estimated from third differences of the positions.
//!
//! A wrong length that is a fraction of the motion's range shifts parameters by about the same
//! fraction. A residual that is small compared with the range times the smallest relative standard
//! deviation is therefore harmless.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::{
            Context, RunMonitor,
            level::{FALSE_ALARMS, level},
        },
        evidence::{Axis, Curve, Evidence},
        hypotheses::is_quasi_static,
        positions,
    },
    estimation::intervals::distributions::student_quantile,
    kinematics::conditioning::couples,
    result::Stage,
};
use overact_logs::{Error, significant};

/// Factor for the ringing of the position filter at steps.
const RINGING: f64 = 1.5;

/// Harmless residual, by range (or distances, in quasi-static runs) and smallest relative standard deviation of a parameter.
const HARMLESS: f64 = 0.3;

/// Checks all runs of a robot with more actuators than degrees of freedom.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let sizes = context.model.info().sizes;
    let mut checks = Vec::new();
    if sizes.actuators <= sizes.dof || !couples(context.model) {
        return Ok(checks);
    }
    for (number, (log, watched)) in context.runs().enumerate() {
        let (limit, noise) = limit(watched, log.samples());
        let ranges = watched.monitor.ranges();
        let range = ranges.into_iter().fold(0.0, f64::max);
        // In a quasi-static run positions only determine the directions of forces, which depend on
        // distances of the robot and not on the range of the motion.
        let is_slow = context
            .scores
            .is_some_and(|scores| is_quasi_static(&context.paces(scores)));
        let distances = watched.monitor.magnitudes().into_iter();
        let scale = distances.fold(range, if is_slow { f64::max } else { |range, _| range });
        let closing = ClosureResidual {
            filtered: watched.closure_residual,
            as_logged: if watched.closure_residual > limit {
                positions::unfiltered_miss(context.model, log)?
            } else {
                None
            },
            limit,
            harmless: HARMLESS * scale * smallest_relative_deviation(context),
            range,
        };
        let tolerance = limit.max(closing.harmless);
        let explained = positions::explanation(context.model, log, tolerance)?;
        let check = Check::new(CheckKind::Closure, About::Model, closing.words())
            .in_run(log.name())
            .measured(closing.filtered, "m or rad")
            .against(
                limit,
                format!(
                    "half of the encoders' resolution plus noise of {} m or rad, at a false alarm in {} % of reports",
                    significant(noise, 2),
                    100.0 * FALSE_ALARMS
                ),
            );
        let check = if number == 0 {
            check.shown_by(evidence(context))
        } else {
            check
        };
        checks.extend(explained.filter(|_| closing.is_violated()));
        checks.push(if !closing.is_violated() {
            check
        } else if closing.filtered > closing.harmless {
            check.with_grade(Grade::DoNotUse)
        } else {
            check.found()
        });
    }
    Ok(checks)
}

/// Closure residual of a run and its limits (m, rad).
struct ClosureResidual {
    /// Largest residual of the filtered positions.
    filtered: f64,
    /// Largest residual of the unfiltered positions; `None` if not computed or without poses.
    ///
    /// A filter removes fast motion of each encoder separately. Since the closure is nonlinear,
    /// positions that vibrate near the cutoff violate it after filtering even if the lengths are
    /// right.
    as_logged: Option<f64>,
    /// Largest residual that resolution and noise explain.
    limit: f64,
    /// Largest harmless residual.
    harmless: f64,
    /// Range of the motion.
    range: f64,
}

impl ClosureResidual {
    /// Whether the positions violate the closure.
    fn is_violated(&self) -> bool {
        self.filtered > self.limit && self.as_logged.is_none_or(|miss| miss > self.limit)
    }

    fn words(&self) -> String {
        let part = significant(100.0 * self.filtered / self.range, 2);
        let number = |value: f64| significant(value, 2);
        match self.as_logged {
            _ if self.filtered <= self.limit => format!(
                "the positions close the loops to {} m or rad, consistent with the encoders' resolution and noise",
                number(self.filtered)
            ),
            Some(miss) if !self.is_violated() => format!(
                "the positions close the loops to {} m or rad, consistent with the encoders' resolution and noise; filtered positions miss by up to {}, since they vibrate near the cutoff",
                number(miss),
                number(self.filtered)
            ),
            _ if self.filtered <= self.harmless => format!(
                "the positions miss the closure of the loops by up to {} m or rad, more than resolution and noise explain, but only {part} % of the range of the motion",
                number(self.filtered)
            ),
            _ => format!(
                "the positions miss the closure of the loops by up to {} m or rad, {part} % of the range of the motion, where resolution and noise explain {}; lengths of the description or offsets of encoders are wrong: `overact identify --calibrate` estimates them",
                number(self.filtered),
                number(self.limit)
            ),
        }
    }
}

/// Largest residual that resolution and noise explain, and the noise (m, rad).
fn limit(watched: &RunMonitor, samples: usize) -> (f64, f64) {
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

/// Smallest relative standard deviation of a recommended parameter.
fn smallest_relative_deviation(context: &Context<'_>) -> f64 {
    let estimates = context.estimates_of(Stage::Recommended);
    let all = estimates.flat_map(|one| &one.parameters);
    let relative = all.map(|one| {
        let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
        half / one.value.abs()
    });
    let smallest_relative_deviation = relative.fold(f64::INFINITY, f64::min);
    if smallest_relative_deviation.is_finite() {
        smallest_relative_deviation
    } else {
        0.0
    }
}

/// Plot of each run's closure residual and its limit.
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

#[cfg(test)]
mod tests {
    use super::ClosureResidual;

    const RINGING: ClosureResidual = ClosureResidual {
        filtered: 1.4e-4,
        as_logged: Some(1e-5),
        limit: 5e-5,
        harmless: 2e-5,
        range: 0.6,
    };

    #[test]
    fn positions_that_close_before_filtering_pass() {
        assert!(!RINGING.is_violated());
        assert!(RINGING.words().contains("near the cutoff"));
    }

    #[test]
    fn positions_that_violate_the_closure_fail() {
        for as_logged in [Some(1.5e-4), None] {
            let wrong = ClosureResidual {
                as_logged,
                ..RINGING
            };
            assert!(wrong.is_violated());
            assert!(wrong.words().contains("--calibrate"));
        }
        let close = ClosureResidual {
            filtered: 4e-5,
            as_logged: None,
            ..RINGING
        };
        assert!(!close.is_violated());
    }
}
