//! Whether encoders have offsets or play, as far as the torques tell. Where there are more encoders than
//! degrees of freedom the closure of the loops tells much more.

use super::{
    Context,
    level::{level, origin},
    suspected::{Tested, guilty, parabola, tested, worst_harm},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind},
        suspects::{Group, Suspect},
    },
    error::Error,
    significant,
};

/// Tests an offset and a play of each actuator's position.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let mut suspects: Vec<(Suspect, usize)> = Vec::new();
    let mut found: Vec<Tested> = Vec::new();
    for (place, suspect) in scores.suspects.iter().enumerate() {
        if let Suspect::Offset(actuator) | Suspect::Play(actuator) = *suspect {
            for one in tested(scores, std::iter::once(Group::suspect(place))) {
                suspects.push((*suspect, actuator));
                found.push(one);
            }
        }
    }
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let (tests, level) = (found.len(), level(found.len()));
    let info = context.model.info();
    let name = |actuator: usize| info.actuators.get(actuator).copied().unwrap_or_default();
    let ratio = |one: &Tested| one.accused.size().abs() / one.accused.deviation;
    let check = Check::new(CheckKind::EncoderOffset, About::Model, "");
    let Some(worst) = guilty(&found, level) else {
        let visible: Vec<String> = suspects
            .iter()
            .zip(&found)
            .filter(|((suspect, _), _)| matches!(suspect, Suspect::Offset(_)))
            .map(|((_, actuator), one)| {
                let visible = significant(one.accused.visible(level), 2);
                format!("`{}` {visible} {}", name(*actuator), unit(&info, *actuator))
            })
            .collect();
        let words = format!(
            "the torques speak of no offset and no play of an encoder; an offset would have been seen from so much on: {}",
            visible.join(", ")
        );
        let largest = found.iter().map(ratio).fold(0.0, f64::max);
        return Ok(vec![
            Check { words, ..check }
                .measured(largest, "standard deviations")
                .against(found[0].accused.quantile(level), origin(tests)),
        ]);
    };
    let place = found
        .iter()
        .position(|one| std::ptr::eq(one, worst))
        .unwrap_or(0);
    let (suspect, actuator) = suspects[place];
    let what = match suspect {
        Suspect::Play(_) => "play of about twice",
        _ => "an offset of",
    };
    let harm = worst_harm(context, scores, (&found, worst), level);
    let unit = unit(&info, actuator);
    let words = format!(
        "the torques speak of {what} {} {unit} at the encoder of `{}` (standard deviation {} {unit}); {}. Check its zero and its mounting, or the lengths of the description",
        significant(worst.accused.size().abs(), 3),
        name(actuator),
        significant(worst.accused.deviation, 2),
        harm.words()
    );
    let title = format!("Residual for other offsets of {}", name(actuator));
    Ok(vec![
        Check { words, ..check }
            .of_actuator(name(actuator))
            .measured(ratio(worst), "standard deviations")
            .against(worst.accused.quantile(level), origin(tests))
            .shown_by(parabola(
                &worst.accused,
                &title,
                ("offset or half of the play", unit, 1.0),
            ))
            .because(&harm),
    ])
}

/// The unit of an actuator's position.
fn unit(info: &overact::Info<'_>, actuator: usize) -> &'static str {
    match info.actuator_is_revolute.get(actuator) {
        Some(true) => "rad",
        _ => "m",
    }
}
