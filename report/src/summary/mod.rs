//! Terminal summary of an identification: verdicts, reasons, recommended parameters and next steps.
//!
//! All tables are in `terminal`.

mod errors;
mod parameters;

use crate::{
    choice::{answers, of, projection, stage_name},
    intervals::{excludes_zero, half_width_percent},
    judgement::{grade_words, other_warnings, passed},
    layout::{line, paragraph},
    line_errors::{base_words, is_mixed, relative, relative_words, validation_words},
    online::online,
    terminal::{calibration, gains, gears, gravity, motors, stribeck},
};
use overact_identification::{
    Estimate, Estimator, Grade, Identification, ParameterEstimate, Stage, Verdict, failed_checks,
    significant,
};

/// Lines of a short summary, as a terminal shows at once.
const LINES: usize = 50;

/// Smallest number of parameters in a short summary.
const FEWEST: usize = 10;

/// Up to this many more parameters are shown instead of a line about them.
const SPARED: usize = 3;

/// Largest number of names in a list of a short summary.
const NAMES: usize = 24;

/// Extent of a summary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// The essentials, in 50 lines if verdicts, warnings and ten parameters leave room.
    ///
    /// Usable and best-known parameters are shown first.
    Short,
    /// Everything.
    Whole,
}

/// Summary; `page` is the path of the page with all evidence.
#[must_use]
pub fn summary(identification: &Identification, page: Option<&str>, extent: Extent) -> String {
    let mut above = String::new();
    paragraph(&mut above, "", &headline(identification));
    if let Some(calibration) = &identification.calibration {
        above.push_str(&calibration::calibration(calibration));
    }
    above.push_str(&gravity::gravity(identification.gravity.as_ref()));
    above.push_str(&gains::gains(&identification.gains));
    above.push_str(&gears::gears(&identification.gear_friction));
    above.push_str(&stribeck::stribeck(&identification.stribeck_velocities));
    let mut reported = Vec::new();
    for estimate in answers(identification) {
        above.push('\n');
        above.push_str(&model(identification, estimate, extent, &mut reported));
    }
    above.push_str(&errors::errors(identification));
    above.push_str(&online(identification));
    let below = consistent(identification) + &unseen(identification) + &next(identification, page);
    let rows = parameters::rows(identification);
    let motors = motors::motors(&identification.motors);
    let whole = rows.table(rows.count()) + &motors;
    let room = LINES.saturating_sub(above.lines().count() + below.lines().count());
    let is_nearly_whole = rows.count() <= FEWEST + SPARED;
    if extent == Extent::Whole || is_nearly_whole || whole.lines().count() <= room {
        return above + &whole + &below;
    }
    let mut motors = String::new();
    if !identification.motors.is_empty() {
        line(
            &mut motors,
            "--all also prints the parameters of the drives on the motor side.",
        );
    }
    let room = room.saturating_sub(motors.lines().count());
    let fits = |count: &usize| rows.table(*count).lines().count() <= room;
    let count = (FEWEST..rows.count()).rev().find(fits);
    above + &rows.table(count.unwrap_or(FEWEST)) + &motors + &below
}

/// Headline: identified quantities and data.
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
        count => format!(", {count} equations skipped at standstill"),
    };
    format!(
        "{}: {runs} training run{}, {} s{left_out}",
        identification.robot,
        if runs == 1 { "" } else { "s" },
        significant(seconds, 3)
    )
}

/// Cost of physical consistency.
fn consistent(identification: &Identification) -> String {
    let mut text = String::new();
    if let Some(one) = identification.consistent.first() {
        let words = format!(
            "Physically consistent standard parameters: relative residual {} (base parameters {}); --parameters FILE writes them for controllers and simulators.",
            relative_words(&one.lines, one.relative_error_percent, 4),
            base_words(identification, one)
        );
        text.push('\n');
        paragraph(&mut text, "", &words);
    }
    text
}

/// Assumptions: the undetectable faults with the largest effect.
fn unseen(identification: &Identification) -> String {
    let mut text = String::new();
    if !identification.unseen.is_empty() {
        text.push('\n');
        line(
            &mut text,
            "Faults that these data would not show, and what they would shift (--report lists all assumptions):",
        );
        for one in &identification.unseen {
            paragraph(&mut text, "  - ", one);
        }
    }
    text
}

/// Verdict on one model with its reasons; `reported` are the checks that models above reported.
fn model(
    identification: &Identification,
    estimate: &Estimate,
    extent: Extent,
    reported: &mut Vec<usize>,
) -> String {
    let mut text = String::new();
    let mut verdicts = identification.verdicts.iter();
    let verdict = verdicts.find(|one| one.model == estimate.model);
    let grade = verdict.map_or_else(String::new, |one| {
        format!(": {}", grade_words(one.grade).to_uppercase())
    });
    paragraph(
        &mut text,
        "",
        &format!(
            "{} ({}){grade}",
            estimate.model.label(),
            projection(estimate)
        ),
    );
    let validation = validation_words(identification, estimate);
    let validation = validation.map_or_else(String::new, |words| format!(", {words}"));
    let count = estimate.parameters.len();
    let own = match estimate.stage {
        Stage::Base => format!("All {count} base parameters"),
        stage => format!("{count} {}", stage_name(stage)),
    };
    paragraph(
        &mut text,
        "  ",
        &format!(
            "{own}: relative residual {} (training){validation}.{}",
            training_words(estimate),
            sureness(estimate)
        ),
    );
    if let Some(others) = other_stages(identification, estimate) {
        paragraph(&mut text, "  ", &others);
    }
    if let Some(verdict) = verdict {
        text.push_str(&reasons(identification, verdict, extent, reported));
    }
    text
}

/// Line on all base parameters (weighted and ordinary least squares) and on the essential ones.
fn other_stages(identification: &Identification, shown: &Estimate) -> Option<String> {
    let percent = |one: &Estimate| relative_words(&one.lines, one.relative_error_percent, 4);
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
        format!("; {count} by the r_sigma rule: {}", percent(one))
    });
    Some(format!(
        "{all} base parameters: {errors}{}.",
        rule.unwrap_or_default()
    ))
}

/// Relative residual of the training runs, with four decimals.
fn training_words(estimate: &Estimate) -> String {
    let percent = relative(&estimate.lines, estimate.relative_error_percent);
    if is_mixed(&estimate.lines) {
        format!("at most {percent:.4} % of each torque")
    } else {
        format!("{percent:.4} %")
    }
}

/// Precision of the parameters, if some are poorly known.
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
                0 => String::from("None is"),
                1 => String::from("1 is"),
                more => format!("{more} are"),
            };
            format!(" {known} known to 10 % or better; the sign of {unsure} is unknown.")
        }
    }
}

/// Names separated by commas; a short summary lists the first ones only.
fn list(names: &[&str], extent: Extent) -> String {
    match (extent, names.get(..NAMES)) {
        (Extent::Short, Some(first)) if names.len() > NAMES + 1 => {
            format!("{} and {} more", first.join(", "), names.len() - NAMES)
        }
        _ => names.join(", "),
    }
}

/// Failed checks of an estimate, or that there are none.
///
/// Checks in `reported` were reported above and are only named.
fn reasons(
    identification: &Identification,
    verdict: &Verdict,
    extent: Extent,
    reported: &mut Vec<usize>,
) -> String {
    let mut text = String::new();
    if verdict.grade == Grade::UseListed {
        let listed: Vec<&str> = verdict.listed.iter().map(String::as_str).collect();
        let sentence = format!("Usable: {}.", list(&listed, extent));
        paragraph(&mut text, "  ", &sentence);
        let estimate = of(identification, verdict.model, verdict.stage);
        let names = estimate.iter().flat_map(|one| &one.parameters);
        let names = names.map(|one| one.name.as_str());
        let others: Vec<&str> = names.filter(|name| !listed.contains(name)).collect();
        if !others.is_empty() {
            let sentence = format!("Do not use: {}.", list(&others, extent));
            paragraph(&mut text, "  ", &sentence);
        }
    }
    let found = failed_checks(&identification.checks, verdict.model, verdict.stage);
    let all = found.reported.iter().copied();
    let (again, new): (Vec<_>, Vec<_>) = all.partition(|(number, _)| reported.contains(number));
    for (number, check) in new {
        reported.push(number);
        paragraph(&mut text, "  - ", &check.located());
    }
    if !again.is_empty() {
        let mut names: Vec<&str> = again.iter().map(|(_, check)| check.kind.name()).collect();
        names.dedup();
        let words = format!("as reported above: {}", names.join(", "));
        paragraph(&mut text, "  - ", &words);
    }
    if let Some(rest) = found.rest() {
        paragraph(&mut text, "  - ", &rest);
    }
    let count = passed(identification, verdict.model, verdict.stage);
    if found.reported.is_empty() && count > 0 {
        let s = if count == 1 { "" } else { "s" };
        line(&mut text, &format!("  {count} check{s} passed."));
    }
    if let Some(words) = &verdict.rests_on {
        paragraph(&mut text, "  ", words);
    }
    text
}

/// Warnings that belong to no check, and next steps.
fn next(identification: &Identification, page: Option<&str>) -> String {
    let mut text = String::new();
    for warning in other_warnings(identification) {
        text.push('\n');
        paragraph(&mut text, "", &format!("warning: {warning}"));
    }
    text.push('\n');
    if identification.cross_validation.is_empty() {
        line(
            &mut text,
            "There are no validation data: add a run with --cross-validate to test the prediction.",
        );
    }
    line(
        &mut text,
        &match page {
            Some(page) => format!("Evidence and plots: {page}"),
            None => String::from(
                "--report report.html writes the evidence with plots; --tables prints all tables.",
            ),
        },
    );
    text
}
