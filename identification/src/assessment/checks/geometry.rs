//! Tests encoder errors and lengths with the torques.
//!
//! If there are more encoders than degrees of freedom, the closure determines them far better.

use super::{
    Context,
    level::{level, origin},
    suspected::{HARMFUL, Tested, guilty, harm, parabola, tested, worst_harm},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Detectable},
        suspects::{Group, Misreading, Scores, Suspect},
    },
    error::Error,
    significant,
};

/// Tests offset, scale, eccentricity and play of each encoder, and each requested length.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let mut suspects: Vec<Suspect> = Vec::new();
    let mut found: Vec<Tested> = Vec::new();
    let mut tests = 0;
    for (place, suspect) in scores.suspects.iter().enumerate() {
        if let Suspect::Offset(_)
        | Suspect::Scale(_)
        | Suspect::Scales
        | Suspect::Eccentric(..)
        | Suspect::Play(_)
        | Suspect::Length(_) = *suspect
        {
            for one in tested(scores, std::iter::once(Group::suspect(place))) {
                tests += 1;
                // Friction errors at reversals repeat with each period, and the standard deviation
                // ignores that. They look like a slightly eccentric encoder, which is therefore
                // reported only if harmful.
                let is_small = matches!(suspect, Suspect::Eccentric(..))
                    && harm(context, scores, &one).worst <= HARMFUL;
                if is_small {
                    continue;
                }
                suspects.push(*suspect);
                found.push(one);
            }
        }
    }
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let level = level(tests);
    let Some(worst) = guilty(&found, level) else {
        return Ok(vec![nothing((context, scores), (&suspects, &found), level)]);
    };
    let place = found
        .iter()
        .position(|one| std::ptr::eq(one, worst))
        .unwrap_or(0);
    let suspect = suspects[place];
    let harm = worst_harm(context, scores, (&found, worst), level);
    let (name, unit) = (name(context, suspect), unit(context, suspect));
    let size = significant(worst.accused.size().abs(), 3);
    let deviation = significant(worst.accused.deviation, 2);
    let spread = format!("(standard deviation {deviation} {unit}); {}", harm.words());
    let zero = match suspect {
        Suspect::Eccentric(..) => {
            "Its disc may be out of centre, or its scale wrong: check its mounting and its gear"
        }
        Suspect::Scale(_) | Suspect::Scales => {
            "Check the ratio of its gear or the lead of its screw, its increments, and its zero"
        }
        _ => "Check its zero and its mounting, or the lengths of the description",
    };
    let (kind, words, title, axis) = match suspect {
        Suspect::Length(_) => {
            let sense = if worst.accused.size() > 0.0 {
                "large"
            } else {
                "small"
            };
            let words = format!(
                "the torques indicate that the length `{name}` is described {size} {unit} too {sense} {spread}. Measure it, or check the zeros of the encoders"
            );
            let title = format!("Residual for other lengths {name}");
            (
                CheckKind::Length,
                words,
                title,
                "excess of the described value",
            )
        }
        Suspect::Scale(_) | Suspect::Scales => {
            let whose = match suspect {
                Suspect::Scales => String::from("all drives"),
                _ => format!("`{name}`"),
            };
            let [size, deviation] = [worst.accused.size(), worst.accused.deviation]
                .map(|part| significant(100.0 * part.abs(), 3));
            let sense = if worst.accused.size() > 0.0 {
                "large"
            } else {
                "small"
            };
            let words = format!(
                "the torques indicate that positions of {whose} are {size} % too {sense} (standard deviation {deviation} %); {}. {zero}",
                harm.words()
            );
            let title = format!("Residual for other scales of the positions of {whose}");
            (
                CheckKind::EncoderOffset,
                words,
                title,
                "relative excess of the positions",
            )
        }
        _ => {
            let what = match suspect {
                Suspect::Play(_) => "play of about twice",
                Suspect::Eccentric(_, Misreading::Sine) => {
                    "an error with the sine of the position, of"
                }
                Suspect::Eccentric(..) => "an error with the cosine of the position, of",
                _ => "an offset of",
            };
            let words = format!(
                "the torques indicate {what} {size} {unit} at the encoder of `{name}` {spread}. {zero}"
            );
            let title = format!("Residual for other offsets of {name}");
            let axis = "offset or half of the play";
            (CheckKind::EncoderOffset, words, title, axis)
        }
    };
    let check = Check::new(kind, About::Model, words)
        .measured(ratio(worst), "standard deviations")
        .against(worst.accused.quantile(level), origin(tests))
        .shown_by(parabola(&worst.accused, &title, (axis, unit, 1.0)))
        .because(&harm);
    let detectable = detectable((context, scores), (&suspects, &found), level).into_iter();
    let check = check.detecting(detectable.map(|(_, one)| one).collect());
    Ok(vec![match suspect {
        Suspect::Length(_) | Suspect::Scales => check,
        _ => check.of_actuator(&name),
    }])
}

/// The passed check, with its detection limits.
fn nothing(
    (context, scores): (&Context<'_>, &Scores),
    (suspects, found): (&[Suspect], &[Tested]),
    level: f64,
) -> Check {
    let detectable = detectable((context, scores), (suspects, found), level);
    let visible = |of: fn(&Suspect) -> bool| -> String {
        let own = detectable.iter().filter(|(suspect, _)| of(suspect));
        let each = own.map(|(_, one)| {
            let size = significant(one.size, 2);
            format!("`{}` {size} {}", one.name, one.unit)
        });
        each.collect::<Vec<_>>().join(", ")
    };
    let offsets = visible(|suspect| matches!(suspect, Suspect::Offset(_)));
    let lengths = visible(|suspect| matches!(suspect, Suspect::Length(_)));
    let mut words = Vec::new();
    if !offsets.is_empty() {
        words.push(format!(
            "the torques indicate no offset and no play of an encoder; detection limits of an offset: {offsets}"
        ));
    }
    if !lengths.is_empty() {
        words.push(format!(
            "the torques indicate no wrong length; detection limits: {lengths}"
        ));
    }
    let largest = found.iter().map(ratio).fold(0.0, f64::max);
    let threshold = found
        .first()
        .map_or(f64::NAN, |one| one.accused.quantile(level));
    Check::new(CheckKind::EncoderOffset, About::Model, words.join("; "))
        .measured(largest, "standard deviations")
        .against(threshold, origin(found.len()))
        .detecting(detectable.into_iter().map(|(_, one)| one).collect())
}

/// Detection limit of each offset, scale and length.
fn detectable(
    (context, scores): (&Context<'_>, &Scores),
    (suspects, found): (&[Suspect], &[Tested]),
    level: f64,
) -> Vec<(Suspect, Detectable)> {
    let both = suspects.iter().zip(found);
    let sizes =
        both.filter(|(suspect, _)| !matches!(suspect, Suspect::Play(_) | Suspect::Eccentric(..)));
    let one = |(&suspect, one): (&Suspect, &Tested)| {
        let (name, unit) = (name(context, suspect), unit(context, suspect));
        let visible = one.accused.visible(level);
        let own = one.detectable((context, scores), (name, unit), visible);
        let is_length = matches!(suspect, Suspect::Length(_));
        (suspect, Detectable { is_length, ..own })
    };
    sizes.map(one).collect()
}

fn ratio(one: &Tested) -> f64 {
    one.accused.size().abs() / one.accused.deviation
}

/// Name of the actuator or the length.
fn name(context: &Context<'_>, suspect: Suspect) -> String {
    let name = match suspect {
        Suspect::Offset(at)
        | Suspect::Scale(at)
        | Suspect::Eccentric(at, _)
        | Suspect::Play(at) => context.model.info().actuators.get(at).copied(),
        Suspect::Length(at) => context.dataset.variants.get(at).map(|one| one.length),
        _ => None,
    };
    name.unwrap_or_default().to_owned()
}

/// Unit of the fault's size: of an actuator's position, or of a length.
fn unit(context: &Context<'_>, suspect: Suspect) -> &'static str {
    match suspect {
        Suspect::Scale(_) | Suspect::Scales => "",
        Suspect::Offset(at) | Suspect::Eccentric(at, _) | Suspect::Play(at)
            if context.model.info().actuator_is_revolute.get(at) == Some(&true) =>
        {
            "rad"
        }
        _ => "m",
    }
}
