//! What a person who has just identified a robot reads in the terminal: what may be used, why, the
//! recommended parameters, and what to do next. All tables are in `terminal`.

use crate::{
    choice::{answers, of, projection, stage_name},
    intervals::{excludes_zero, half_width_percent, is_outside},
    judgement::{grade_words, passed},
    layout::{line, table},
    terminal::{calibration, gains, gravity, motors},
    text::{fitted, visible},
};
use overact_identification::{
    Estimate, Estimator, Grade, Identification, ParameterEstimate, Stage, Verdict, objections,
    significant,
};

/// Characters of a line of prose.
const WIDTH: usize = 100;

/// The summary; `page` is where the page with all evidence has been written.
#[must_use]
pub fn summary(identification: &Identification, page: Option<&str>) -> String {
    let mut text = String::new();
    paragraph(&mut text, "", &headline(identification));
    if let Some(calibration) = &identification.calibration {
        for told in calibration::calibration(calibration).lines() {
            line(&mut text, told);
        }
    }
    for told in gravity::gravity(identification.gravity.as_ref()).lines() {
        line(&mut text, told);
    }
    for told in gains::gains(&identification.gains).lines() {
        line(&mut text, told);
    }
    for estimate in answers(identification) {
        text.push('\n');
        text.push_str(&model(identification, estimate));
    }
    text.push_str(&parameters(identification));
    for told in motors::motors(&identification.motors).lines() {
        line(&mut text, told);
    }
    text.push_str(&consistent(identification));
    text.push_str(&next(identification, page));
    text
}

/// What was identified from what.
fn headline(identification: &Identification) -> String {
    let seconds = identification
        .runs
        .iter()
        .map(|run| run.samples as f64 / run.sampling_frequency);
    let seconds: f64 = seconds.sum();
    let runs = identification.runs.len();
    let still = identification.runs.iter();
    let still: usize = still.flat_map(|run| &run.standstill_equations).sum();
    let left_out = match still {
        0 => String::new(),
        count => format!(", {count} equations left out at standstill"),
    };
    format!(
        "{}: identified from {runs} run{}, {} s{left_out}",
        identification.robot,
        if runs == 1 { "" } else { "s" },
        significant(seconds, 3)
    )
}

/// What it costs to ask for parameters that a robot can have.
fn consistent(identification: &Identification) -> String {
    let mut text = String::new();
    if let Some(one) = identification.consistent.first() {
        let words = format!(
            "Physically consistent standard parameters leave {} % of the torques unexplained, the base parameters {} %; --parameters FILE writes them for controllers and simulators.",
            significant(one.relative_error_percent, 4),
            significant(one.base_relative_error_percent, 4)
        );
        text.push('\n');
        paragraph(&mut text, "", &words);
    }
    text
}

/// The verdict on one model and its reasons.
fn model(identification: &Identification, estimate: &Estimate) -> String {
    let mut text = String::new();
    let mut verdicts = identification.verdicts.iter();
    let verdict = verdicts.find(|one| one.model == estimate.model);
    let grade = verdict.map_or_else(String::new, |one| {
        format!(": {}", grade_words(one.grade).to_uppercase())
    });
    line(
        &mut text,
        &format!(
            "{} ({}){grade}",
            estimate.model.case(),
            projection(estimate)
        ),
    );
    paragraph(
        &mut text,
        "  ",
        &format!(
            "{} {} leave {:.4} % of the torques unexplained.{}{}",
            estimate.parameters.len(),
            stage_name(estimate.stage),
            estimate.relative_error_percent,
            held_out(identification, estimate),
            sureness(estimate)
        ),
    );
    if let Some(others) = other_stages(identification, estimate) {
        paragraph(&mut text, "  ", &others);
    }
    if let Some(verdict) = verdict {
        text.push_str(&reasons(identification, verdict));
    }
    text
}

/// What all base parameters leave, by weighted and by ordinary least squares, and those that the rule of r_σ
/// leaves: one line.
fn other_stages(identification: &Identification, shown: &Estimate) -> Option<String> {
    let percent = |one: &Estimate| format!("{} %", significant(one.relative_error_percent, 4));
    let base = of(identification, shown.model, Stage::Base)?;
    if base.stage == shown.stage {
        return None;
    }
    let mut ordinary = identification
        .estimates
        .iter()
        .filter(|one| one.estimator == Estimator::OrdinaryLeastSquares && one.model == shown.model);
    let errors = match ordinary.next() {
        Some(ordinary) => format!(
            "{} (weighted), {} (ordinary)",
            percent(base),
            percent(ordinary)
        ),
        None => percent(base),
    };
    let all = base.parameters.len();
    let rule = of(identification, shown.model, Stage::Essential).map(|one| {
        let count = one.parameters.len();
        format!("; {count} by the r_sigma rule leave {}", percent(one))
    });
    Some(format!(
        "{all} base parameters leave {errors}{}.",
        rule.unwrap_or_default()
    ))
}

/// How well held-out runs are predicted.
fn held_out(identification: &Identification, estimate: &Estimate) -> String {
    let errors = identification
        .cross_validation
        .iter()
        .filter(|one| one.model == estimate.model && one.stage == estimate.stage)
        .map(|one| one.relative_error_percent);
    errors.reduce(f64::max).map_or_else(String::new, |worst| {
        format!(
            " Of the runs that were held out they leave at most {} %.",
            significant(worst, 3)
        )
    })
}

/// How well the parameters are known, where some are hardly known at all.
fn sureness(estimate: &Estimate) -> String {
    let all = estimate.parameters.len();
    let count = |most: f64| {
        let known = |one: &&ParameterEstimate| half_width_percent(one).is_some_and(|x| x <= most);
        estimate.parameters.iter().filter(known).count()
    };
    let signs = estimate.parameters.iter().filter(|one| excludes_zero(one));
    match all - signs.count() {
        0 => String::new(),
        unsure => {
            let known = match count(10.0) {
                0 => String::from("None of them is"),
                1 => String::from("1 of them is"),
                more => format!("{more} of them are"),
            };
            format!(" {known} known to 10 % or better; of {unsure} not even the sign is known.")
        }
    }
}

/// What speaks against an estimate, or that nothing does.
fn reasons(identification: &Identification, verdict: &Verdict) -> String {
    let mut text = String::new();
    if verdict.grade == Grade::UseListed {
        paragraph(
            &mut text,
            "  ",
            &format!("To be used: {}.", verdict.listed.join(", ")),
        );
        let estimate = of(identification, verdict.model, verdict.stage);
        let names = estimate.iter().flat_map(|one| &one.parameters);
        let names = names.map(|one| one.name.as_str());
        let others: Vec<&str> = names
            .filter(|name| !verdict.listed.iter().any(|own| own == name))
            .collect();
        if !others.is_empty() {
            paragraph(
                &mut text,
                "  ",
                &format!("Not to be used: {}.", others.join(", ")),
            );
        }
    }
    let found = objections(&identification.checks, verdict.model, verdict.stage);
    for (_, check) in &found.told {
        paragraph(&mut text, "  - ", &check.located());
    }
    if let Some(rest) = found.rest() {
        paragraph(&mut text, "  - ", &rest);
    }
    let count = passed(identification, verdict.model, verdict.stage);
    if found.told.is_empty() && count > 0 {
        let s = if count == 1 { "" } else { "s" };
        line(&mut text, &format!("  {count} check{s} found nothing."));
    }
    text
}

/// The parameters of all answers side by side.
fn parameters(identification: &Identification) -> String {
    let answers = answers(identification);
    let Some(first) = answers.first() else {
        return String::new();
    };
    let all = || answers.iter().flat_map(|one| &one.parameters);
    let truth = all().any(|one| one.true_value.is_some());
    let mut names: Vec<&str> = Vec::new();
    for one in all() {
        if !names.contains(&one.name.as_str()) {
            names.push(&one.name);
        }
    }
    let base = &identification.base_parameters;
    names.sort_by_key(|name| base.iter().position(|one| one.name == *name));
    // Two answers side by side have to fit into a line.
    let value_digits = if answers.len() > 1 { 5 } else { 6 };
    let mut header = vec!["parameter"];
    if truth {
        header.push("true value");
    }
    for answer in &answers {
        header.extend([answer.model.case(), "95 % interval"]);
    }
    header.push("unit");
    let rows = names.iter().map(|name| {
        let find = |estimate: &&Estimate| -> Option<ParameterEstimate> {
            estimate
                .parameters
                .iter()
                .find(|one| one.name == *name)
                .cloned()
        };
        let some = answers.iter().find_map(find);
        let mut row = vec![(*name).to_owned()];
        let number = |value: Option<f64>, digits| {
            value.map_or_else(|| String::from("-"), |value| significant(value, digits))
        };
        if truth {
            row.push(number(some.as_ref().and_then(|one| one.true_value), 6));
        }
        for answer in &answers {
            let own = find(answer);
            row.push(number(own.as_ref().map(|one| one.value), value_digits));
            row.push(own.as_ref().map_or_else(|| String::from("-"), interval));
        }
        row.push(some.map_or_else(String::new, |one| one.unit));
        row
    });
    let title = match stage_name(first.stage).split_at_checked(1) {
        Some((letter, rest)) => letter.to_uppercase() + rest,
        None => String::new(),
    };
    let mut text = format!("\n{title}\n{}", table(&header, rows.collect()));
    if all().any(is_outside) {
        paragraph(
            &mut text,
            "",
            "* outside of its own interval: cancelling other parameters has moved this estimate to where the data speak against it",
        );
    }
    text
}

/// The ends of an interval, marked where the estimate lies outside.
fn interval(one: &ParameterEstimate) -> String {
    let [low, high] = one.interval_95;
    let digits = digits(one);
    let mark = if is_outside(one) { " *" } else { "" };
    format!(
        "{} .. {}{mark}",
        significant(low, digits),
        significant(high, digits)
    )
}

/// Digits at which the ends of an interval differ.
fn digits(one: &ParameterEstimate) -> usize {
    let [low, high] = one.interval_95;
    let ratio = low.abs().max(high.abs()) / (high - low).abs();
    match ratio.is_finite() && ratio > 1.0 {
        true => (ratio.log10().ceil() as usize + 1).min(7),
        false => 2,
    }
}

/// Warnings that no check tells of, and what to do next.
fn next(identification: &Identification, page: Option<&str>) -> String {
    let mut text = String::new();
    let told: Vec<&str> = identification
        .checks
        .iter()
        .filter(|check| !check.passed)
        .map(|check| check.words.as_str())
        .collect();
    let is_told = |warning: &&String| told.iter().any(|words| warning.contains(words));
    for warning in identification.warnings.iter().filter(|one| !is_told(one)) {
        text.push('\n');
        paragraph(&mut text, "", &format!("warning: {warning}"));
    }
    text.push('\n');
    if identification.cross_validation.is_empty() {
        line(
            &mut text,
            "No run was held out: --cross-validate holds them out in turn, and the verdict knows more.",
        );
    }
    line(
        &mut text,
        &match page {
            Some(page) => format!("The evidence behind each line, with plots: {page}"),
            None => String::from(
                "--report report.html writes the evidence behind each line, with plots; --tables prints all tables.",
            ),
        },
    );
    text
}

/// A paragraph of lines that are not too long, behind `lead` and indented like it.
fn paragraph(text: &mut String, lead: &str, words: &str) {
    let indent = " ".repeat(lead.chars().count());
    let mut current = lead.to_owned();
    let mut is_empty = true;
    // A number keeps its percent sign beside it.
    let words = visible(words).replace(" %", "\u{a0}%");
    for word in words.split(' ').filter(|word| !word.is_empty()) {
        let word = fitted(&word.replace('\u{a0}', " "), WIDTH);
        if !is_empty && current.chars().count() + 1 + word.chars().count() > WIDTH {
            line(text, &current);
            current.clone_from(&indent);
            is_empty = true;
        }
        if !is_empty {
            current.push(' ');
        }
        current.push_str(&word);
        is_empty = false;
    }
    line(text, &current);
}

#[cfg(test)]
mod tests {
    use super::paragraph;

    #[test]
    fn a_paragraph_is_broken_between_words_and_loses_none() {
        let words = "one two three ".repeat(30);
        let mut text = String::new();
        paragraph(&mut text, "  - ", &words);
        assert!(text.lines().count() > 3);
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= super::WIDTH)
        );
        assert!(text.lines().skip(1).all(|line| line.starts_with("    ")));
        let told: Vec<&str> = text.split_whitespace().skip(1).collect();
        assert_eq!(told, words.split_whitespace().collect::<Vec<_>>());
    }
}
