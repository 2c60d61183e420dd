//! Tests whether the gains of the drives agree with each other.

use super::{
    Context,
    level::{level, origin},
    suspected::{Tested, guilty, parabola, tested, worst_harm},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Detectable},
        suspects::{Group, Scores, Suspect},
    },
    error::Error,
    significant,
};

/// Larger relative errors are reported without a number.
const LARGEST: f64 = 0.5;

/// Tests the gain of each actuator separately.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let names = context.model.info().actuators;
    let name = |actuator: usize| names.get(actuator).copied().unwrap_or_default();
    let (mut actuators, mut found, mut untold) = (Vec::new(), Vec::new(), Vec::new());
    for (place, suspect) in scores.suspects.iter().enumerate() {
        let Suspect::Gain(actuator) = *suspect else {
            continue;
        };
        match tested(scores, std::iter::once(Group::suspect(place))).pop() {
            Some(one) => {
                actuators.push(actuator);
                found.push(one);
            }
            None => untold.push(actuator),
        }
    }
    if found.is_empty() {
        return Ok(none_told(names).into_iter().collect());
    }
    let level = level(found.len() + untold.len());
    let told = actuators.iter().zip(&found).map(|(actuator, one)| {
        let own = (name(*actuator).to_owned(), "");
        one.detectable((context, scores), own, one.accused.visible(level))
    });
    let hidden = untold
        .iter()
        .map(|actuator| Detectable::never(name(*actuator)));
    let detectable: Vec<Detectable> = told.chain(hidden).collect();
    let worst = guilty(&found, level);
    let said = worst.map_or_else(
        || innocent(&found, &detectable),
        |worst| {
            let place = found.iter().position(|one| std::ptr::eq(one, worst));
            let actuator = place.map_or("", |place| name(actuators[place]));
            unlike((context, scores), (&found, worst), actuator, level)
        },
    );
    let limit = worst
        .or(found.first())
        .map(|one| one.accused.quantile(level));
    let count = found.len() + untold.len();
    Ok(vec![
        said.against(limit.unwrap_or_default(), origin(count))
            .detecting(detectable),
    ])
}

/// A fraction in percent.
fn percent(value: f64) -> String {
    significant(100.0 * value, 3)
}

/// The passed check, with its detection limits.
fn innocent(found: &[Tested], detectable: &[Detectable]) -> Check {
    let visible: Vec<String> = detectable
        .iter()
        .map(|one| {
            if one.size.is_finite() {
                format!("`{}` {} %", one.name, percent(one.size))
            } else {
                format!("`{}` not at all", one.name)
            }
        })
        .collect();
    let which = if detectable.iter().all(|one| one.size.is_finite()) {
        "no drive"
    } else {
        "no testable drive"
    };
    let words = format!(
        "{which} has a gain that differs from the others'; detection limits of an error of one drive: {}",
        visible.join(", ")
    );
    let largest = found
        .iter()
        .map(|one| one.accused.size().abs() / one.accused.deviation)
        .fold(0.0, f64::max);
    Check::new(CheckKind::WrongGain, About::Model, words).measured(largest, "standard deviations")
}

/// The failed check of one drive.
fn unlike(
    (context, scores): (&Context<'_>, &Scores),
    (found, worst): (&[Tested], &Tested),
    actuator: &str,
    level: f64,
) -> Check {
    let harm = worst_harm(context, scores, (found, worst), level);
    let size = worst.accused.size();
    let by = match size {
        // The first-order test has no valid size for large errors.
        size if size.abs() > LARGEST => String::from("differently from"),
        size if size < 0.0 => format!("{} % too small compared with", percent(-size)),
        size => format!("{} % too large compared with", percent(size)),
    };
    let words = format!(
        "the torque of `{actuator}` is measured {by} those of the other drives (standard deviation {} %); {}. Check its gain, its motor constant, its gear ratio and whether it is filtered differently from the others",
        percent(worst.accused.deviation),
        harm.words()
    );
    Check::new(CheckKind::WrongGain, About::Model, words)
        .of_actuator(actuator)
        .measured(size.abs() / worst.accused.deviation, "standard deviations")
        .because(&harm)
        .shown_by(parabola(
            &worst.accused,
            &format!("Residual for other gains of {actuator}"),
            ("error of the gain", "%", 100.0),
        ))
}

/// The check if no gain can be separated from the drive's own parameters.
///
/// A single drive has only a common gain, so there is no check.
fn none_told(names: &[&str]) -> Option<Check> {
    let words = "these data cannot test whether the gain of one drive differs from the others'";
    let check = || Check::new(CheckKind::WrongGain, About::Model, words);
    let never = names.iter().map(|name| Detectable::never(name)).collect();
    (names.len() > 1).then(|| check().detecting(never))
}
