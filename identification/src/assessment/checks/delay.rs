//! Whether torques and motion are of the same time.

use super::{
    Context,
    level::{level, origin},
    suspected::{harm, parabola, tested},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Detectable},
        suspects::{Group, Suspect},
    },
    error::Error,
    significant,
};

/// Part of a sampling interval that is no delay: how a drive holds its torque between samples and what
/// encoder noise does to it through the controller shift torques against motion by less.
const HARMLESS: f64 = 0.1;

/// Looks for one delay of all torques.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let place = scores
        .suspects
        .iter()
        .position(|one| *one == Suspect::Delay);
    let found = tested(scores, place.into_iter().map(Group::suspect));
    let level = level(1);
    let intervals = context.dataset.runs.iter();
    let intervals = intervals.map(|run| HARMLESS / run.sampling_frequency());
    let harmless = intervals.fold(0.0, f64::max);
    let checks = found.iter().map(|one| {
        let accused = &one.accused;
        let [size, deviation] = [accused.size(), accused.deviation].map(|s| 1e3 * s);
        let number = |value: f64| significant(value, 3);
        let visible = 1e3 * (harmless + accused.visible(level));
        let beyond = (size.abs() - 1e3 * harmless).max(0.0);
        let check = Check::new(CheckKind::Delay, About::Model, "")
            .measured(beyond / deviation, "standard deviations")
            .against(
                accused.quantile(level),
                format!("{}, of what exceeds {HARMLESS} sampling intervals", origin(1)),
            )
            .detecting(vec![Detectable {
                size: harmless + accused.visible(level),
                ..one.detectable(String::new(), "s", level)
            }])
            .shown_by(parabola(
                accused,
                "Residual for torques that are shifted in time",
                ("delay of the torques", "ms", 1e3),
            ));
        if accused.probability_beyond(harmless) >= level {
            let words = format!(
                "torques and motion are of the same time: {} ± {} ms; a delay of {} ms would have been seen",
                number(size),
                number(deviation),
                number(visible)
            );
            return Check { words, ..check };
        }
        let harm = harm(context, scores, one);
        let words = format!(
            "the torques come {} ms {} the motion (standard deviation {} ms); {}. Look for a filter or a bus cycle between drive and encoder, and shift the columns against each other",
            number(size.abs()),
            if size > 0.0 { "behind" } else { "before" },
            number(deviation),
            harm.words()
        );
        Check { words, ..check }
            .because(&harm)
    });
    Ok(checks.collect())
}
