//! Tests for a delay between torques and motion.

use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{self, TestedHypothesis, only, parabola, tested, worst_harm},
        level::{level, origin},
    },
    detectable::Detectable,
    hypotheses::{FaultHypothesis, Group, Scores},
};
use overact_logs::{Error, significant};

/// Harmless delay, in sampling intervals.
///
/// The drive's zero-order hold and encoder noise in the controller shift torques against motion by
/// less than this.
const HARMLESS: f64 = 0.1;

/// Largest delay that is reported with a number, by the period of the fastest motion.
///
/// The first-order test is invalid beyond it.
const LARGEST: f64 = 0.2;

/// Tests one delay common to all torques, and one for each drive.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let is_delay = |hypothesis: FaultHypothesis| {
        matches!(
            hypothesis,
            FaultHypothesis::Delay | FaultHypothesis::DriveDelay(_)
        )
    };
    let found = tested(scores, Group::hypotheses(scores, is_delay));
    let level = level(found.len());
    let intervals = context.dataset.runs.iter();
    let intervals = intervals.map(|run| HARMLESS / run.sampling_frequency());
    let harmless = intervals.fold(0.0, f64::max);
    let beyond = |one: &&TestedHypothesis| one.wald.probability_beyond(harmless) < level;
    let most_significant = found.iter().filter(beyond);
    let most_significant =
        most_significant.max_by(|a, b| a.wald.explained.total_cmp(&b.wald.explained));
    let Some(shown) = most_significant.or(found.first()) else {
        return Ok(Vec::new());
    };
    let drive = |one: &TestedHypothesis| match one.hypothesis(scores) {
        FaultHypothesis::DriveDelay(actuator) => {
            context.model.info().actuators.get(actuator).copied()
        }
        _ => None,
    };
    let limits = TestLimits {
        tests: found.len(),
        level,
        harmless,
    };
    let detectable = found.iter().map(|one| Detectable {
        name: drive(one).unwrap_or_default().to_owned(),
        ..one.detectable(context, scores, "s", harmless + one.wald.visible(level))
    });
    let check = limits.check(shown).detecting(detectable.collect());
    let wald = &shown.wald;
    let [size, deviation] = [wald.size(), wald.deviation].map(|s| 1e3 * s);
    let number = |value: f64| significant(value, 3);
    if most_significant.is_none() {
        let words = format!(
            "torques and motion are synchronous: delay {} ± {} ms; the detection limit is {} ms",
            number(size),
            number(deviation),
            number(1e3 * (harmless + wald.visible(level)))
        );
        return Ok(vec![Check { words, ..check }]);
    }
    let name = drive(shown);
    let mut harm = worst_harm(context, scores, &found, shown, level);
    if let (None, Some(second)) = (name, second_order(scores, wald.size())) {
        harm.with(context, &fault_hypotheses::harm(context, scores, &second));
    }
    let whose = name.map_or_else(
        || String::from("the torques are"),
        |name| format!("only the torque of `{name}` is"),
    );
    let paces = context.paces(scores);
    let fastest = paces.iter().flatten().map(|pace| pace.frequency);
    let is_far = wald.size().abs() * fastest.fold(0.0, f64::max) > LARGEST;
    let by = if is_far {
        String::from("far")
    } else {
        format!("{} ms", number(size.abs()))
    };
    let words = format!(
        "{whose} {by} {} the motion (standard deviation {} ms); {}. Look for a filter or a bus cycle between drive and encoder; no TOML key shifts them: {}or log the two with their own times in two files",
        if size > 0.0 { "behind" } else { "before" },
        number(deviation),
        harm.words(),
        if is_far {
            String::new()
        } else {
            format!("{}, ", shifted(size, context))
        }
    );
    let check = Check { words, ..check }.with_harm(&harm);
    Ok(vec![match name {
        Some(name) => check.of_actuator(name),
        None => check,
    }])
}

/// Second term of the delayed torques τ(t - δ) = τ - δ τ' + ½ δ² τ'' - …: that of a filter with s =
/// ½ δ².
///
/// It shifts parameters such as dry friction, whose shift by the first term is small.
fn second_order(scores: &Scores, delay: f64) -> Option<TestedHypothesis> {
    let filter = only(scores, FaultHypothesis::SmoothingWithFriction)?;
    Some(TestedHypothesis {
        size: Some(0.5 * delay * delay),
        ..filter
    })
}

/// Advice on shifting the torque columns against a delay in ms.
fn shifted(delay: f64, context: &Context<'_>) -> String {
    let rate = context
        .dataset
        .runs
        .first()
        .map_or(0.0, overact_logs::Log::sampling_frequency);
    let samples = (1e-3 * delay.abs() * rate).round();
    let direction = if delay > 0.0 { "up" } else { "down" };
    if samples >= 1.0 {
        format!(
            "move the torques' columns of the log {direction} by {samples} {} before it is read",
            if samples == 1.0 { "line" } else { "lines" }
        )
    } else {
        String::from(
            "interpolate the torques' columns of the log at earlier or later times before it is read",
        )
    }
}

/// Number of tests, level and threshold of the delay tests.
struct TestLimits {
    tests: usize,
    level: f64,
    /// Harmless delay, s.
    harmless: f64,
}

impl TestLimits {
    /// The check of one delay, without words.
    fn check(&self, one: &TestedHypothesis) -> Check {
        let wald = &one.wald;
        let [size, deviation] = [wald.size(), wald.deviation].map(|s| 1e3 * s);
        let beyond = (size.abs() - 1e3 * self.harmless).max(0.0);
        Check::new(CheckKind::Delay, About::Model, "")
            .measured(beyond / deviation, "standard deviations")
            .against(
                wald.quantile(self.level),
                format!(
                    "{}, of what exceeds {HARMLESS} sampling intervals",
                    origin(self.tests)
                ),
            )
            .shown_by(parabola(
                wald,
                "Residual for torques that are shifted in time",
                "delay of the torques",
                "ms",
                1e3,
            ))
    }
}
