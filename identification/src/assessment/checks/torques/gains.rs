//! Tests whether the gains of the drives agree with each other.

use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{Harm, TestedHypothesis, most_significant, only, parabola, worst_harm},
        level::{level, origin},
    },
    detectable::Detectable,
    hypotheses::FaultHypothesis,
};
use overact_logs::{Error, significant};

/// Larger relative errors are reported without a number.
const LARGEST: f64 = 0.5;

/// Tests the gain of each actuator separately.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let names = context.model.info().actuators;
    let name = |actuator: usize| names.get(actuator).copied().unwrap_or_default();
    let (mut found, mut inseparable) = (Vec::new(), Vec::new());
    for hypothesis in &scores.hypotheses {
        let FaultHypothesis::Gain(actuator) = *hypothesis else {
            continue;
        };
        match only(scores, *hypothesis) {
            Some(one) => found.push(one),
            None => inseparable.push(actuator),
        }
    }
    if found.is_empty() {
        return Ok(none_separable(names).into_iter().collect());
    }
    let count = found.len() + inseparable.len();
    let level = level(count);
    let drive = |one: &TestedHypothesis| match one.hypothesis(scores) {
        FaultHypothesis::Gain(actuator) => name(actuator),
        _ => "",
    };
    let limits = found.iter().map(|one| Detectable {
        name: drive(one).to_owned(),
        ..one.detectable(context, scores, "", one.wald.visible(level))
    });
    let hidden = inseparable
        .iter()
        .map(|actuator| Detectable::undetectable_gain(*actuator, name(*actuator)));
    let detectable: Vec<Detectable> = limits.chain(hidden).collect();
    let worst = most_significant(&found, level);
    let check = worst.map_or_else(
        || passed_check(&found, &detectable),
        |worst| {
            let harm = worst_harm(context, scores, &found, worst, level);
            failed_check(worst, &harm, drive(worst))
        },
    );
    let limit = worst.or(found.first()).map(|one| one.wald.quantile(level));
    Ok(vec![
        check
            .against(limit.unwrap_or_default(), origin(count))
            .detecting(detectable),
    ])
}

/// A fraction in percent.
fn percent(value: f64) -> String {
    significant(100.0 * value, 3)
}

/// The passed check, with its detection limits.
fn passed_check(found: &[TestedHypothesis], detectable: &[Detectable]) -> Check {
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
        .map(|one| one.wald.size().abs() / one.wald.deviation)
        .fold(0.0, f64::max);
    Check::new(CheckKind::WrongGain, About::Model, words).measured(largest, "standard deviations")
}

/// The failed check of one drive.
fn failed_check(worst: &TestedHypothesis, harm: &Harm, actuator: &str) -> Check {
    let size = worst.wald.size();
    let others = "those of the other drives";
    let by = if size.abs() > LARGEST {
        // The first-order test has no valid size for large errors.
        format!("differently from {others}, by an undetermined factor")
    } else {
        let direction = if size < 0.0 { "small" } else { "large" };
        let [size, deviation] = [size.abs(), worst.wald.deviation].map(percent);
        format!(
            "{size} % too {direction} compared with {others} (standard deviation {deviation} %)"
        )
    };
    let words = format!(
        "the torque of `{actuator}` is measured {by}; {}. Check its gain, its motor constant, its gear ratio and whether it is filtered differently from the others",
        harm.words()
    );
    Check::new(CheckKind::WrongGain, About::Model, words)
        .of_actuator(actuator)
        .measured(size.abs() / worst.wald.deviation, "standard deviations")
        .with_harm(harm)
        .shown_by(parabola(
            &worst.wald,
            &format!("Residual for other gains of {actuator}"),
            "error of the gain",
            "%",
            100.0,
        ))
}

/// The check if no gain can be separated from the drive's own parameters.
///
/// A single drive has only a common gain, so there is no check.
fn none_separable(names: &[&str]) -> Option<Check> {
    let words = "these data cannot test whether the gain of one drive differs from the others'";
    let check = || Check::new(CheckKind::WrongGain, About::Model, words);
    let gain = |(actuator, name): (usize, &&str)| Detectable::undetectable_gain(actuator, name);
    let never = names.iter().enumerate().map(gain).collect();
    (names.len() > 1).then(|| check().detecting(never))
}
