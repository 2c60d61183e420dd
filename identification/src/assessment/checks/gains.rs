//! Whether the gain of each drive is that of the others.

use super::{
    Context,
    level::{level, origin},
    suspected::{Tested, guilty, parabola, tested, worst_harm},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Detectable},
        suspects::{Group, Suspect},
    },
    error::Error,
    significant,
};

/// Errors of a gain that are larger are told without a number.
const LARGEST: f64 = 0.5;

/// Tests the gain of each actuator on its own.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let names = context.model.info().actuators;
    let gains = scores.suspects.iter().enumerate();
    let gains: Vec<(usize, usize)> = gains
        .filter_map(|(place, one)| match one {
            Suspect::Gain(actuator) => Some((place, *actuator)),
            _ => None,
        })
        .collect();
    let level = level(gains.len());
    let mut found: Vec<(usize, Tested)> = Vec::new();
    for (place, actuator) in &gains {
        let own = tested(scores, std::iter::once(Group::suspect(*place)));
        found.extend(own.into_iter().map(|one| (*actuator, one)));
    }
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let percent = |value: f64| significant(100.0 * value, 3);
    let name = |actuator: usize| names.get(actuator).copied().unwrap_or_default();
    let (actuators, found): (Vec<usize>, Vec<Tested>) = found.into_iter().unzip();
    let detectable: Vec<Detectable> = actuators
        .iter()
        .zip(&found)
        .map(|(actuator, one)| {
            let own = (name(*actuator).to_owned(), "");
            one.detectable((context, scores), own, one.accused.visible(level))
        })
        .collect();
    let Some(worst) = guilty(&found, level) else {
        let visible: Vec<String> = detectable
            .iter()
            .map(|one| format!("`{}` {} %", one.name, percent(one.size)))
            .collect();
        let words = format!(
            "no drive has a gain unlike the others'; an error of one drive would have been seen from so much on: {}",
            visible.join(", ")
        );
        let largest = found
            .iter()
            .map(|one| one.accused.size().abs() / one.accused.deviation)
            .fold(0.0, f64::max);
        return Ok(vec![
            Check::new(CheckKind::WrongGain, About::Model, words)
                .measured(largest, "standard deviations")
                .against(found[0].accused.quantile(level), origin(gains.len()))
                .detecting(detectable),
        ]);
    };
    let place = found.iter().position(|one| std::ptr::eq(one, worst));
    let actuator = place.map_or("", |place| name(actuators[place]));
    let harm = worst_harm(context, scores, (&found, worst), level);
    let size = worst.accused.size();
    let by = match size {
        // Far from the others the first order, in which it was looked for, tells no size.
        size if size.abs() > LARGEST => String::from("unlike"),
        size if size < 0.0 => format!("{} % too small beside", percent(-size)),
        size => format!("{} % too large beside", percent(size)),
    };
    let words = format!(
        "the torque of `{actuator}` is measured {by} those of the other drives (standard deviation {} %); {}. Check its gain, its motor constant and its gear ratio",
        percent(worst.accused.deviation),
        harm.words()
    );
    Ok(vec![
        Check::new(CheckKind::WrongGain, About::Model, words)
            .of_actuator(actuator)
            .measured(size.abs() / worst.accused.deviation, "standard deviations")
            .against(worst.accused.quantile(level), origin(gains.len()))
            .because(&harm)
            .shown_by(parabola(
                &worst.accused,
                &format!("Residual for other gains of {actuator}"),
                ("error of the gain", "%", 100.0),
            ))
            .detecting(detectable),
    ])
}
