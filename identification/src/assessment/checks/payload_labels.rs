//! Tests whether each run carries the payload of its label.

use overact::StandardParameter;

use super::{
    Context,
    fault_hypotheses::{TestedHypothesis, harm, tested},
    level::{level, origin},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        hypotheses::{Group, Scores},
    },
    data::Log,
    error::Error,
    result::{ParameterEstimate, Stage},
    significant,
};

/// Fraction of a run's squared residual explained by another payload that makes its label wrong.
const WRONG: f64 = 0.1;

/// Tests the payload parameters in each run separately.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let runs = context.dataset.runs;
    if scores.payload.is_empty() || runs.len() < 2 {
        return Ok(Vec::new());
    }
    let level = level(runs.len());
    let mut checks: Vec<Check> = nothing_carried(context).into_iter().collect();
    for (number, log) in runs.iter().enumerate() {
        let group = Group::payload(scores, number);
        for one in tested(scores, std::iter::once(group)) {
            checks.push(of_run(context, scores, log, &one, level));
        }
    }
    Ok(checks)
}

/// The check if the labelled payload may be absent or has a negative mass.
fn nothing_carried(context: &Context<'_>) -> Option<Check> {
    let loads = context.columns.indices(true);
    let base = context.estimates_of(Stage::Base).next()?;
    let is_load = |one: &&ParameterEstimate| {
        let column = context.base.columns.get(one.column);
        column.is_some_and(|column| loads.contains(column))
    };
    let of_load: Vec<&ParameterEstimate> = base.parameters.iter().filter(is_load).collect();
    let holds_zero = |one: &&ParameterEstimate| {
        let [low, high] = one.interval_95;
        low <= 0.0 && 0.0 <= high
    };
    let is_mass = |one: &&&ParameterEstimate| {
        let column = context.base.columns.get(one.column);
        let column = column.and_then(|&column| context.columns.as_slice().get(column));
        column.is_some_and(|column| column.symbol == StandardParameter::M)
    };
    let negative = of_load
        .iter()
        .filter(is_mass)
        .find(|one| one.interval_95[1] < 0.0);
    if let Some(mass) = negative {
        let words = format!(
            "the payload's mass is negative (`{}` = {} {}), as if the labels of runs with and without payload were exchanged: check them",
            mass.name,
            significant(mass.value, 3),
            mass.unit
        );
        let check = Check::new(CheckKind::PayloadLabel, About::Model, words);
        return Some(check.found().with_grade(Grade::DoNotUse));
    }
    if of_load.is_empty() || !of_load.iter().all(holds_zero) {
        return None;
    }
    let told = of_load.iter().map(|one| {
        let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
        let (value, half) = (significant(one.value, 2), significant(half, 2));
        format!("`{}` = {value} ± {half} {}", one.name, one.unit)
    });
    let words = format!(
        "no parameter of the payload differs from zero ({}): check that it was mounted in the runs with this label",
        told.collect::<Vec<_>>().join(", ")
    );
    Some(Check::new(CheckKind::PayloadLabel, About::Model, words).found())
}

/// The check of one run.
fn of_run(
    context: &Context<'_>,
    scores: &Scores,
    log: &Log,
    one: &TestedHypothesis,
    level: f64,
) -> Check {
    let wald = &one.wald;
    let check = Check::new(CheckKind::PayloadLabel, About::Model, "")
        .in_run(log.name())
        .measured(wald.probability, "probability")
        .against(level, origin(context.dataset.runs.len()));
    let label = if log.payload() { "with" } else { "without" };
    if wald.probability >= level {
        let words = format!("the run is one {label} the payload, as labelled");
        return Check { words, ..check };
    }
    let harm = harm(context, scores, one);
    let differences: Vec<String> = wald
        .sizes
        .iter()
        .filter_map(|(place, size)| {
            let name = scores.payload.get(*place)?;
            Some(format!("{name} {}", significant(*size, 3)))
        })
        .collect();
    let words = format!(
        "the run does not carry what the other runs {label} the payload carry (differences of the payload in SI units: {}); {}. Check the label, and what was mounted",
        differences.join(", "),
        harm.words()
    );
    let check = Check { words, ..check }.with_harm(&harm);
    if wald.explained > WRONG {
        return check.found().with_grade(Grade::DoNotUse);
    }
    check
}
