//! Section on the checks behind the verdict.
//!
//! Each check has its statistic, threshold, source of the threshold, and plot. Passed checks are
//! collapsed.

use std::fmt::Write;

use super::{
    Contents,
    elements::{
        markup::{Section, capital, details, figure, key, paragraph, prose},
        table::{Cell, Table},
    },
};
use crate::{
    judgement::{place, statistic, threshold, title},
    plot::{Axis, Chart, Line, Look, Rule},
    text::escape,
    units::with_unit,
};
use overact_identification::{Axis as EvidenceAxis, Check, Curve, Evidence, Grade, Identification};

/// Section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let body = if identification.checks.is_empty() {
        String::new()
    } else {
        failed(identification) + &passed(identification)
    };
    Section {
        id: "checks",
        title: "Checks behind the verdict",
        body,
    }
}

/// Anchor of a check by its index.
pub(super) fn id(number: usize) -> String {
    format!("check-{}", number + 1)
}

/// All checks of one outcome with their indices.
fn numbered(
    identification: &Identification,
    passed: bool,
) -> impl Iterator<Item = (usize, &Check)> {
    let checks = identification.checks.iter().enumerate();
    checks.filter(move |(_, check)| check.passed == passed)
}

/// Failed checks, the most serious first, each with its plot.
fn failed(identification: &Identification) -> String {
    let mut all: Vec<(usize, &Check)> = numbered(identification, false).collect();
    all.sort_by_key(|(_, check)| std::cmp::Reverse(check.grade));
    if all.is_empty() {
        return paragraph("All checks passed.");
    }
    let mut html = String::new();
    for (number, check) in all {
        let class = match check.grade {
            Grade::Use => "note-worthy",
            Grade::UseListed => "partly",
            Grade::DoNotUse => "bad",
        };
        let _ = writeln!(
            html,
            "<div class=\"check {class}\" id=\"{}\"><h3>{}</h3>\n<p>{}</p>\n{}{}{}</div>",
            id(number),
            escape(&heading(check)),
            prose(&capital(&check.words)),
            measured(check),
            spoiled(check),
            shown(number, check)
        );
    }
    html
}

/// Title and scope of a check.
fn heading(check: &Check) -> String {
    let place = place(check);
    let title = capital(title(check.kind));
    if place.is_empty() {
        title
    } else {
        format!("{title}: {place}")
    }
}

/// Statistic and threshold.
fn measured(check: &Check) -> String {
    let mut parts = Vec::new();
    if let Some(statistic) = statistic(check) {
        parts.push(format!("Measured: {statistic}."));
    }
    if let Some(threshold) = threshold(check) {
        parts.push(format!("Limit: {threshold}."));
    }
    if !check.origin.is_empty() {
        let origin = check.origin.trim_end_matches('.');
        parts.push(format!("Source of the limit: {origin}."));
    }
    if parts.is_empty() {
        return String::new();
    }
    format!("<p class=\"note\">{}</p>\n", prose(&parts.join(" ")))
}

/// Parameters that must not be used.
fn spoiled(check: &Check) -> String {
    if check.spoiled.is_empty() {
        return String::new();
    }
    let names: Vec<String> = check
        .spoiled
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    paragraph(&format!("Do not use: {}.", names.join(", ")))
}

/// Collapsed table of passed checks, followed by their plots.
///
/// In print, each has a line or two and no plot; the plots would take ten pages.
fn passed(identification: &Identification) -> String {
    let all: Vec<(usize, &Check)> = numbered(identification, true).collect();
    if all.is_empty() {
        return String::new();
    }
    // Units here are words, which may be broken.
    let or_nothing = |text: Option<String>| {
        text.map_or_else(Cell::nothing, |text| Cell::prose(&text.replace('-', "−")))
    };
    let rows = all.iter().map(|(_, check)| {
        vec![
            Cell::prose(&heading(check)),
            or_nothing(statistic(check)),
            or_nothing(threshold(check)),
            Cell::prose(&check.origin).class("prose screen-only"),
            Cell::prose(&capital(&check.words)),
        ]
    });
    let titles = [
        ("check", ""),
        ("measured", ""),
        ("limit", ""),
        ("source of the limit", "screen-only"),
        ("result", ""),
    ];
    let table = Table {
        caption: String::from("Passed checks"),
        header: vec![
            titles
                .iter()
                .map(|(title, class)| Cell::text(title).class(class))
                .collect(),
        ],
        rows: rows.collect(),
    };
    let plots: String = all
        .iter()
        .filter(|(_, check)| check.evidence.is_some())
        .map(|(number, check)| {
            let heading = escape(&heading(check));
            format!("<h3>{heading}</h3>\n{}", shown(*number, check))
        })
        .collect();
    let summary = match all.len() {
        1 => String::from("One passed check, over all models and stages"),
        count => format!("{count} passed checks, over all models and stages"),
    };
    let elsewhere = "<p class=\"note paper-only\">The page on screen also shows the sources of the limits and the plots.</p>\n";
    let plots = format!("<div class=\"screen-only\">{plots}</div>\n");
    let table = format!("<div class=\"passed\">{}</div>\n", table.html());
    details(&summary, &(table + elsewhere + &plots))
}

/// Plot of a check.
fn shown(number: usize, check: &Check) -> String {
    let Some(evidence) = &check.evidence else {
        return String::new();
    };
    let lines = curves(evidence);
    let names: Vec<(&str, &str)> = lines
        .iter()
        .filter(|line| !line.label.is_empty())
        .map(|line| (line.look.class(), line.label.as_str()))
        .collect();
    let names = if names.len() > 1 {
        key(&names)
    } else {
        String::new()
    };
    let rules = evidence.limits.iter().enumerate();
    let plot = Chart {
        title: capital(&evidence.title),
        description: heading(check),
        x: Axis::linear(axis(&evidence.x)),
        y: Axis::linear(axis(&evidence.y)),
        rules: rules
            .map(|(order, limit)| Rule::horizontal(*limit, if order == 0 { "limit" } else { "" }))
            .collect(),
        lines,
    };
    figure(
        &format!("figure-{}", id(number)),
        &[plot.svg()],
        &names,
        &escape(&format!("{}.", capital(&evidence.title))),
    )
}

/// Curves of a plot: lines, then points.
///
/// If there are more point series than looks, the largest keep their own look and the others share
/// one.
fn curves(evidence: &Evidence) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for curve in &evidence.lines {
        let look = Look::nth(lines.len());
        lines.push(Line::new(look, &curve.name, &curve.x, &curve.y));
    }
    let size = |curve: &Curve| curve.y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    let mut points: Vec<&Curve> = evidence.points.iter().collect();
    if points.len() > Look::DISTINCT {
        points.sort_by(|a, b| size(b).total_cmp(&size(a)));
    }
    let (named, others) = points.split_at(points.len().min(Look::DISTINCT));
    for curve in named {
        let look = Look::nth(lines.len());
        lines.push(Line::new(look, &curve.name, &curve.x, &curve.y).dots_alone());
    }
    let all = |of: fn(&Curve) -> &[f64]| others.iter().flat_map(move |curve| of(curve)).copied();
    let (x, y): (Vec<f64>, Vec<f64>) = (all(|one| &one.x).collect(), all(|one| &one.y).collect());
    if !others.is_empty() {
        let name = format!("{} others", others.len());
        lines.insert(0, Line::new(Look::Other, name, &x, &y).dots_alone());
    }
    lines
}

/// Axis label.
fn axis(axis: &EvidenceAxis) -> String {
    with_unit(&axis.label, &axis.unit)
}
