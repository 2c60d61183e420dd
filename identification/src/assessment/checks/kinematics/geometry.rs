//! Tests encoder errors and lengths with the torques.
//!
//! If there are more encoders than degrees of freedom, the closure determines them far better.

use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{
            TestedHypothesis, harm, most_significant, parabola, tested, worst_harm,
        },
        level::{level, origin},
    },
    detectable::{Detectable, FaultKind, HARMFUL},
    hypotheses::{FaultHypothesis, Group, Misreading, Scores},
};
use overact_logs::{Error, significant};

/// Tests offset, scale, eccentricity and play of each encoder, and each requested length.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let is_geometric = |hypothesis: FaultHypothesis| {
        matches!(
            hypothesis,
            FaultHypothesis::Offset(_)
                | FaultHypothesis::Scale(_)
                | FaultHypothesis::Scales
                | FaultHypothesis::Gear(_)
                | FaultHypothesis::Eccentric(..)
                | FaultHypothesis::Play(_)
                | FaultHypothesis::Length(_)
        )
    };
    let mut found = tested(scores, Group::hypotheses(scores, is_geometric));
    let tests = found.len();
    let level = level(tests);
    let limits = detection_limits(context, scores, &found, level);
    // Friction errors at reversals repeat with each period, and the standard deviation ignores
    // that. They look like a slightly eccentric encoder, which is therefore reported only if
    // harmful.
    found.retain(|one| {
        !matches!(one.hypothesis(scores), FaultHypothesis::Eccentric(..))
            || harm(context, scores, one).worst > HARMFUL
    });
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let Some(worst) = most_significant(&found, level) else {
        return Ok(vec![passed_check(&found, limits, tests, level)]);
    };
    let hypothesis = worst.hypothesis(scores);
    let harm = worst_harm(context, scores, &found, worst, level);
    let (name, unit) = (name(context, hypothesis), unit(context, hypothesis));
    let size = significant(worst.wald.size().abs(), 3);
    let deviation = significant(worst.wald.deviation, 2);
    let spread = format!("(standard deviation {deviation} {unit}); {}", harm.words());
    let zero = match hypothesis {
        FaultHypothesis::Eccentric(..) => {
            "Its disc may be out of centre, or its scale wrong: check its mounting and its gear"
        }
        FaultHypothesis::Gear(_) => "Check the number of teeth, or the lead of its screw",
        FaultHypothesis::Scale(_) | FaultHypothesis::Scales => {
            "Check the ratio of its gear or the lead of its screw, its increments, and its zero"
        }
        _ => "Check its zero and its mounting, or the lengths of the description",
    };
    let (kind, words, title, axis) = match hypothesis {
        FaultHypothesis::Length(_) => {
            let sense = if worst.wald.size() > 0.0 {
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
        FaultHypothesis::Scale(_) | FaultHypothesis::Scales | FaultHypothesis::Gear(_) => {
            let whose = match hypothesis {
                FaultHypothesis::Scales => String::from("all drives"),
                _ => format!("`{name}`"),
            };
            let torques = match hypothesis {
                FaultHypothesis::Gear(_) => ", and torques wrong by the inverse factor",
                _ => "",
            };
            let [size, deviation] = [worst.wald.size(), worst.wald.deviation]
                .map(|part| significant(100.0 * part.abs(), 3));
            let sense = if worst.wald.size() > 0.0 {
                "large"
            } else {
                "small"
            };
            let words = format!(
                "the torques indicate that positions of {whose} are {size} % too {sense} (standard deviation {deviation} %){torques}; {}. {zero}",
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
            let what = match hypothesis {
                FaultHypothesis::Play(_) => "play of about twice",
                FaultHypothesis::Eccentric(_, Misreading::Sine) => {
                    "an error with the sine of the position, of"
                }
                FaultHypothesis::Eccentric(..) => "an error with the cosine of the position, of",
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
        .against(worst.wald.quantile(level), origin(tests))
        .shown_by(parabola(&worst.wald, &title, axis, unit, 1.0))
        .with_harm(&harm);
    let check = check.detecting(limits);
    Ok(vec![match hypothesis {
        FaultHypothesis::Length(_) | FaultHypothesis::Scales => check,
        _ => check.of_actuator(&name),
    }])
}

/// The passed check, with its detection limits.
fn passed_check(
    found: &[TestedHypothesis],
    limits: Vec<Detectable>,
    tests: usize,
    level: f64,
) -> Check {
    let visible = |kind: FaultKind| -> String {
        let own = limits.iter().filter(|one| one.fault == kind);
        let each = own.map(|one| {
            let size = significant(one.size, 2);
            format!("`{}` {size} {}", one.name, one.unit)
        });
        each.collect::<Vec<_>>().join(", ")
    };
    let offsets = visible(FaultKind::EncoderOffset);
    let lengths = visible(FaultKind::Length);
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
    let first = found.first();
    let threshold = first.map_or(f64::NAN, |one| one.wald.quantile(level));
    Check::new(CheckKind::EncoderOffset, About::Model, words.join("; "))
        .measured(largest, "standard deviations")
        .against(threshold, origin(tests))
        .detecting(limits)
}

/// Detection limit of each geometric fault.
fn detection_limits(
    context: &Context<'_>,
    scores: &Scores,
    found: &[TestedHypothesis],
    level: f64,
) -> Vec<Detectable> {
    let limit = |one: &TestedHypothesis| {
        let hypothesis = one.hypothesis(scores);
        let (unit, visible) = (unit(context, hypothesis), one.wald.visible(level));
        Detectable {
            name: name(context, hypothesis),
            ..one.detectable(context, scores, unit, visible)
        }
    };
    found.iter().map(limit).collect()
}

fn ratio(one: &TestedHypothesis) -> f64 {
    one.wald.size().abs() / one.wald.deviation
}

/// Name of the actuator or the length.
fn name(context: &Context<'_>, hypothesis: FaultHypothesis) -> String {
    let name = match hypothesis {
        FaultHypothesis::Offset(at)
        | FaultHypothesis::Scale(at)
        | FaultHypothesis::Gear(at)
        | FaultHypothesis::Eccentric(at, _)
        | FaultHypothesis::Play(at) => context.model.info().actuators.get(at).copied(),
        FaultHypothesis::Length(at) => context.dataset.variants.get(at).map(|one| one.length),
        _ => None,
    };
    name.unwrap_or_default().to_owned()
}

/// Unit of the fault's size: of an actuator's position, or of a length.
fn unit(context: &Context<'_>, hypothesis: FaultHypothesis) -> &'static str {
    match hypothesis {
        FaultHypothesis::Scale(_) | FaultHypothesis::Scales | FaultHypothesis::Gear(_) => "",
        FaultHypothesis::Offset(at)
        | FaultHypothesis::Eccentric(at, _)
        | FaultHypothesis::Play(at)
            if context.model.info().actuator_is_revolute.get(at) == Some(&true) =>
        {
            "rad"
        }
        _ => "m",
    }
}
