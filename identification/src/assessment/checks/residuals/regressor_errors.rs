//! Tests whether position errors bias least squares, with the Durbin-Wu-Hausman test.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    estimation::instruments::regressor::{Agreement, ErrorsInRegressor, RepeatedRun},
    settings::Instruments,
};
use overact_logs::{Error, significant};

/// Checks all models.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    Ok(context.errors_in_regressor.iter().map(of_model).collect())
}

fn of_model(comparison: &ErrorsInRegressor) -> Check {
    let new = |words: String| {
        Check::new(CheckKind::RegressorErrors, About::Model, words).of_model(comparison.model)
    };
    let Some(agreement) = &comparison.agreement else {
        return new(untested(comparison));
    };
    let check = |words: String| {
        new(words)
            .measured(agreement.probability, "probability")
            .against(
                agreement.level,
                format!(
                    "false alarms in {} % of all reports",
                    significant(100.0 * agreement.level, 2)
                ),
            )
    };
    if comparison.is_weak() {
        return check(format!(
            "the instruments ({}) are too weak to test the positions' errors: F = {} is below {}, the rule of Staiger and Stock; do not use the estimate by instruments",
            source(comparison),
            significant(agreement.weakest, 3),
            agreement.weak_below,
        ))
        .found();
    }
    let words = outcome(comparison, agreement) + &repeated_errors(&comparison.runs);
    let spoiled: Vec<String> = comparison
        .parameters
        .iter()
        .filter(|one| agreement.differs && one.spoiled)
        .map(|one| one.name.clone())
        .collect();
    let check = check(words);
    if spoiled.is_empty() {
        // A difference is reported even if no parameter shifts by more than its standard deviation.
        if agreement.differs {
            check.found()
        } else {
            check
        }
    } else {
        check
            .with_grade(Grade::UseListed)
            .with_unusable_parameters(spoiled)
    }
}

/// Why there is no test, in words.
fn untested(comparison: &ErrorsInRegressor) -> String {
    let start = "not tested whether position errors bias the estimates: ";
    let why = match (&comparison.missing, comparison.instruments) {
        (Some(why), _) => why.clone(),
        (None, Instruments::None) => String::from("`instruments` is \"none\""),
        (None, _) => String::from("there are no instruments"),
    };
    format!("{start}{why}")
}

/// Source of the instruments, in words.
fn source(comparison: &ErrorsInRegressor) -> String {
    match comparison.instruments {
        Instruments::Simulated => return String::from("the motion of the simulated robot"),
        Instruments::None => return String::from("none"),
        Instruments::Periods => {}
    }
    let one = |run: &RepeatedRun| {
        format!(
            "{} of {} s in {}{}",
            run.periods,
            significant(run.period_s, 6),
            run.run,
            if run.found { ", found" } else { "" }
        )
    };
    let runs: Vec<String> = comparison.runs.iter().map(one).collect();
    format!("the other periods: {}", runs.join("; "))
}

/// Result of the comparison, in words.
fn outcome(comparison: &ErrorsInRegressor, agreement: &Agreement) -> String {
    let [k, rest] = agreement.degrees_of_freedom;
    let whose = if agreement.together {
        "which chance exceeds"
    } else {
        "for the parameter that differs most, which chance exceeds for one of them"
    };
    let test = format!(
        "Durbin, Wu and Hausman: F = {} on {k:.0} and {rest:.0} degrees of freedom, {whose} with a probability of {}",
        significant(agreement.statistic, 3),
        significant(agreement.probability, 2),
    );
    if !agreement.differs {
        return format!(
            "least squares and instruments ({}) agree ({test})",
            source(comparison)
        );
    }
    let spoiled = comparison.parameters.iter().filter(|one| one.spoiled);
    let spoiled: Vec<String> = spoiled
        .map(|one| {
            format!(
                "`{}` {} by least squares, {} {} by instruments",
                one.name,
                significant(one.least_squares, 4),
                significant(one.instruments, 4),
                one.unit
            )
        })
        .collect();
    if spoiled.is_empty() {
        return format!(
            "position errors bias no parameter by more than its standard deviation, although least squares and instruments ({}) differ significantly ({test})",
            source(comparison)
        );
    }
    format!(
        "position errors bias least squares, according to instruments ({}; {test}): {}; use the estimate by instruments for these",
        source(comparison),
        spoiled.join(", ")
    )
}

/// Remark on position errors that repeat with the motion.
fn repeated_errors(runs: &[RepeatedRun]) -> String {
    let worst = runs
        .iter()
        .filter(|run| run.errors_return())
        .filter_map(|run| Some((run, run.error_correlation?)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    worst.map_or_else(String::new, |(run, correlation)| {
        format!(
            "; in {} position errors repeat with the motion (correlation {} between periods), like the steps of an encoder. Instruments from other periods contain the same errors and cannot remove them; vary the motion from period to period, or describe the controller for simulated instruments",
            run.run,
            significant(correlation, 2)
        )
    })
}
