//! Section on the elimination from base parameters to smaller models.
//!
//! It shows where the recommended model and the r_σ rule stop.

use std::fmt::Write;

use crate::{
    choice::{case_heading, of, of_stage},
    page::{
        Contents,
        elements::{
            markup::{Section, details, figure, key, paragraph},
            table::{Cell, Table},
        },
    },
    plot::{Axis, Chart, Line, Look, Rule},
    text::escape,
};
use overact_identification::{Estimate, Identification, Removal, Stage, significant};

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    for estimate in of_stage(identification, Stage::Essential) {
        if estimate.removals.is_empty() && estimate.stop.is_none() {
            continue;
        }
        let recommended = of(identification, estimate.model, Stage::Recommended);
        let _ = writeln!(body, "<h3>{}</h3>", case_heading(estimate.model));
        body.push_str(&paragraph(&sentence(estimate, recommended)));
        if !estimate.removals.is_empty() {
            body.push_str(&path(identification, estimate, recommended));
            body.push_str(&details(
                &format!("{}: every step", case_heading(estimate.model)),
                &steps(estimate),
            ));
        }
    }
    if !body.is_empty() {
        let introduction = "Parameters are eliminated one after the other, each time the one with the largest relative standard deviation. The recommended model is the last one that the data do not refute. The r_σ rule continues until the standard deviations are similar.";
        body = paragraph(introduction) + &body;
    }
    Section {
        id: "elimination",
        title: "Elimination of parameters",
        body,
    }
}

/// Elimination in words.
fn sentence(estimate: &Estimate, recommended: Option<&Estimate>) -> String {
    let mut text = String::new();
    if let Some(one) = recommended {
        let _ = write!(
            text,
            "The recommended model has {} parameters{}. ",
            one.parameters.len(),
            because(one)
        );
    }
    let taken = estimate.removals.iter().filter(|one| one.accepted).count();
    let _ = write!(
        text,
        "The r_σ rule eliminates {taken} and leaves {}{}.",
        estimate.parameters.len(),
        because(estimate)
    );
    text
}

/// Clause on why the elimination stopped.
fn because(estimate: &Estimate) -> String {
    let stop = estimate.stop.as_deref().unwrap_or_default();
    match stop.trim_end_matches('.') {
        "" => String::new(),
        stop => format!(". It stopped because {stop}"),
    }
}

/// Plots of the elimination: errors, and the ratio of the stopping rule.
fn path(
    identification: &Identification,
    estimate: &Estimate,
    recommended: Option<&Estimate>,
) -> String {
    let base = of(identification, estimate.model, Stage::Base);
    let end = recommended
        .zip(base)
        .map(|(one, base)| base.parameters.len().saturating_sub(one.parameters.len()));
    let errors = errors(estimate, end);
    let mut entries = vec![("first", "training runs")];
    if errors.lines.len() > 1 {
        entries.push(("second", "validation parts"));
    }
    let r_sigma = identification.settings.r_sigma;
    let caption = "Left: the relative error hardly changes while needless parameters are eliminated. It grows from the first one that the data need, where the recommended model stops. Right: the ratio that the r_σ rule tests; the rule stops below the dashed line.";
    figure(
        &format!("figure-elimination-{}", estimate.model),
        &[errors.svg(), ratio(estimate, r_sigma, end).svg()],
        &key(&entries),
        &escape(caption),
    )
}

/// Mark of the recommended model.
fn mark(end: Option<usize>) -> Vec<Rule> {
    let mark = end.map(|end| Rule::vertical(end as f64, "recommended"));
    mark.into_iter().collect()
}

/// Horizontal axis of both plots.
fn eliminated() -> Axis {
    Axis::linear("parameters eliminated").including(&[0.0])
}

/// Relative errors along the elimination, for training runs and for validation parts if there are
/// any.
fn errors(estimate: &Estimate, end: Option<usize>) -> Chart {
    let own = "on the training runs";
    let own = errors_line(&estimate.removals, own, Look::First, |one| {
        (
            Some(one.relative_error_before_percent),
            Some(one.relative_error_after_percent),
        )
    });
    let others = "on validation parts";
    let others = errors_line(&estimate.removals, others, Look::Second, |one| {
        (one.held_out_before_percent, one.held_out_after_percent)
    });
    let mut lines = vec![own, others];
    lines.retain(|line| !line.points.is_empty());
    let case = case_heading(estimate.model);
    Chart {
        title: String::from("Relative error"),
        description: format!("{case}: relative error after each eliminated parameter"),
        x: eliminated(),
        y: Axis::logarithmic("%"),
        lines,
        rules: mark(end),
    }
}

/// Ratio of the largest to the smallest relative standard deviation, with the stopping rule.
fn ratio(estimate: &Estimate, r_sigma: f64, end: Option<usize>) -> Chart {
    let removals = &estimate.removals;
    let steps: Vec<f64> = (0..removals.len()).map(|step| step as f64).collect();
    let ratios: Vec<f64> = removals.iter().map(|one| one.deviation_ratio).collect();
    let mut line = Line::new(Look::First, "largest by smallest σ", &steps, &ratios);
    if removals.iter().all(|one| one.accepted) {
        let end = (removals.len() as f64, last_ratio(estimate));
        line.points.push(end);
    }
    let case = case_heading(estimate.model);
    Chart {
        title: String::from("Largest by smallest relative σ"),
        description: format!(
            "{case}: ratio of relative standard deviations after each eliminated parameter"
        ),
        x: eliminated(),
        y: Axis::logarithmic(""),
        lines: vec![line.with_dots()],
        rules: [
            vec![Rule::horizontal(
                r_sigma,
                format!("r_σ = {}", significant(r_sigma, 3)),
            )],
            mark(end),
        ]
        .concat(),
    }
}

/// Error before the first and after each step.
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

/// Ratio of relative standard deviations of the remaining parameters.
fn last_ratio(estimate: &Estimate) -> f64 {
    let deviations = estimate
        .parameters
        .iter()
        .map(|one| one.relative_standard_deviation_percent);
    let largest = deviations.clone().fold(0.0, f64::max);
    let smallest = deviations.fold(f64::INFINITY, f64::min);
    largest / smallest
}

/// Table of all steps with their assessment.
fn steps(estimate: &Estimate) -> String {
    let rows = estimate.removals.iter().map(|one| {
        vec![
            Cell::text(&one.name),
            Cell::digits(Some(one.relative_standard_deviation_percent), 3),
            Cell::digits(Some(one.deviation_ratio), 3),
            Cell::digits(Some(one.f_statistic), 3),
            Cell::digits(Some(one.relative_error_after_percent), 4),
            Cell::digits(one.held_out_after_percent, 4),
            drift(one),
            Cell::text(if one.accepted { "eliminated" } else { "kept" }),
            Cell::prose(&one.reason),
        ]
    });
    let titles = [
        ("parameter", ""),
        ("% σ", "n"),
        ("largest by smallest % σ", "n"),
        ("F", "n"),
        ("error after (%)", "n"),
        ("validation error after (%)", "n"),
        ("largest shift", ""),
        ("step", ""),
        ("why", ""),
    ];
    Table {
        caption: format!(
            "{}: the steps of the r_σ rule",
            case_heading(estimate.model)
        ),
        header: vec![
            titles
                .iter()
                .map(|(title, class)| Cell::text(title).class(class))
                .collect(),
        ],
        rows: rows.collect(),
    }
    .html()
}

/// Parameter that a step changes most.
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
