//! The way from the base parameters to the essential ones, and why it ended where it did.

use std::fmt::Write;

use super::{
    Contents,
    markup::{Cell, Section, Table, details, figure, key, paragraph},
    select::{case_heading, finals},
};
use crate::{
    escape::escape,
    plot::{Axis, Chart, Line, Look, Rule},
};
use overact_identification::{Estimate, Removal, significant};

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let settings = &contents.identification.settings;
    let mut body = String::new();
    for estimate in finals(contents.identification) {
        if estimate.removals.is_empty() && estimate.stop.is_none() {
            continue;
        }
        let _ = writeln!(body, "<h3>{}</h3>", case_heading(estimate.model));
        body.push_str(&paragraph(&told(estimate)));
        if !estimate.removals.is_empty() {
            body.push_str(&path(estimate, settings.r_sigma));
            body.push_str(&details("Every step", &steps(estimate)));
        }
    }
    if !body.is_empty() {
        let introduction = "Base parameters of the largest relative deviation are cancelled one after the other, until the largest deviation is less than r_σ times the smallest one. That rule alone can walk past the right model, so every step is also judged by a test of significance and by data that were held out.";
        body = paragraph(introduction) + &body;
    }
    Section {
        id: "elimination",
        title: "How the essential parameters were found",
        body,
    }
}

/// The way in words.
fn told(estimate: &Estimate) -> String {
    let taken = estimate.removals.iter().filter(|one| one.accepted).count();
    let mut text = format!(
        "{taken} parameter{} cancelled, {} left.",
        if taken == 1 { " was" } else { "s were" },
        estimate.parameters.len()
    );
    if let Some(stop) = estimate.stop.as_deref().filter(|stop| !stop.is_empty()) {
        let _ = write!(
            text,
            " The elimination ended because {}.",
            stop_reason(stop)
        );
    }
    text
}

/// The reason as a clause.
fn stop_reason(stop: &str) -> String {
    stop.trim_end_matches('.').to_owned()
}

/// The plots of the way: errors, and the rule of the stop.
fn path(estimate: &Estimate, r_sigma: f64) -> String {
    let errors = errors(estimate);
    let mut entries = vec![("first", "runs identified from")];
    if errors.lines.len() > 1 {
        entries.push(("second", "held-out parts"));
    }
    let caption = "Left: the error hardly changes while needless parameters go, and jumps when one goes that is needed. Right: the rule of the stop; the way ends below the dashed line, or earlier where the second opinion refuses a step.";
    figure(
        &format!("figure-elimination-{}", estimate.model),
        &[errors.svg(), ratio(estimate, r_sigma).svg()],
        &key(&entries),
        &escape(caption),
    )
}

/// The axis of both plots.
fn cancelled() -> Axis {
    Axis::linear("parameters cancelled").including(&[0.0])
}

/// The relative errors along the way, on the runs identified from and, where there are any, on
/// held-out parts.
fn errors(estimate: &Estimate) -> Chart {
    let own = "on the runs identified from";
    let own = errors_line(&estimate.removals, own, Look::First, |one| {
        (
            Some(one.relative_error_before_percent),
            Some(one.relative_error_after_percent),
        )
    });
    let others = "on held-out parts";
    let others = errors_line(&estimate.removals, others, Look::Second, |one| {
        (one.held_out_before_percent, one.held_out_after_percent)
    });
    let mut lines = vec![own, others];
    lines.retain(|line| !line.points.is_empty());
    let case = case_heading(estimate.model);
    Chart {
        title: String::from("Relative error"),
        description: format!("{case}: relative error after each cancelled parameter"),
        x: cancelled(),
        y: Axis::linear("%"),
        lines,
        rules: Vec::new(),
    }
}

/// The ratio of the largest to the smallest relative deviation along the way, with the rule of the stop.
fn ratio(estimate: &Estimate, r_sigma: f64) -> Chart {
    let removals = &estimate.removals;
    let steps: Vec<f64> = (0..removals.len()).map(|step| step as f64).collect();
    let ratios: Vec<f64> = removals.iter().map(|one| one.deviation_ratio).collect();
    let mut line = Line::new(
        Look::First,
        "largest by smallest deviation",
        &steps,
        &ratios,
    );
    if removals.iter().all(|one| one.accepted) {
        let end = (removals.len() as f64, last_ratio(estimate));
        line.points.push(end);
    }
    let case = case_heading(estimate.model);
    Chart {
        title: String::from("Largest by smallest relative deviation"),
        description: format!("{case}: ratio of relative deviations after each cancelled parameter"),
        x: cancelled(),
        y: Axis::logarithmic(""),
        lines: vec![line.with_dots()],
        rules: vec![Rule {
            value: r_sigma,
            label: format!("r_σ = {}", significant(r_sigma, 3)),
        }],
    }
}

/// An error before the first and after each step.
fn errors_line(
    removals: &[Removal],
    label: &str,
    look: Look,
    of: impl Fn(&Removal) -> (Option<f64>, Option<f64>),
) -> Line {
    let mut line = Line::new(look, label, &[], &[]).with_dots();
    let before = removals.first().and_then(|one| of(one).0);
    line.points.extend(before.map(|value| (0.0, value)));
    for (step, removal) in removals.iter().enumerate() {
        let after = of(removal).1;
        line.points
            .extend(after.map(|value| (step as f64 + 1.0, value)));
    }
    line
}

/// The ratio of relative deviations of what is left.
fn last_ratio(estimate: &Estimate) -> f64 {
    let deviations = estimate
        .parameters
        .iter()
        .map(|one| one.relative_standard_deviation_percent);
    let largest = deviations.clone().fold(0.0, f64::max);
    let smallest = deviations.fold(f64::INFINITY, f64::min);
    largest / smallest
}

/// Every step with its judgement.
fn steps(estimate: &Estimate) -> String {
    let rows = estimate.removals.iter().map(|one| {
        vec![
            Cell::text(&one.name),
            Cell::digits(Some(one.relative_standard_deviation_percent), 3),
            Cell::digits(Some(one.deviation_ratio), 3),
            Cell::digits(Some(one.f_statistic), 3),
            Cell::digits(Some(one.relative_error_before_percent), 5),
            Cell::digits(Some(one.relative_error_after_percent), 5),
            Cell::digits(one.held_out_before_percent, 5),
            Cell::digits(one.held_out_after_percent, 5),
            drift(one),
            Cell::text(if one.accepted { "cancelled" } else { "kept" }),
            Cell::text(&one.reason).class("prose"),
        ]
    });
    let titles = [
        "parameter",
        "% σ",
        "max/min",
        "F",
        "error % before",
        "after",
        "held out % before",
        "after",
        "moves most",
        "step",
        "why",
    ];
    Table {
        caption: format!(
            "{}: the steps of the elimination",
            case_heading(estimate.model)
        ),
        header: vec![titles.iter().map(|title| Cell::text(title)).collect()],
        rows: rows.collect(),
    }
    .html()
}

/// The parameter that a step moves most.
fn drift(removal: &Removal) -> Cell {
    removal.drift.as_ref().map_or_else(Cell::nothing, |drift| {
        Cell::text(&format!(
            "{}: {} %, {} σ",
            drift.parameter,
            significant(drift.percent, 2),
            significant(drift.deviations, 2)
        ))
    })
}
