//! The parameters: estimates with both deviations beside true and published values, their error bars,
//! and what is regrouped into each.

use std::fmt::Write;

use super::{
    Contents,
    markup::{Cell, Section, Table, details, figure, key, paragraph, with_deviation},
    select::{case_heading, finals, look, projection},
};
use crate::{
    escape::escape,
    plot::{Axis, Bar, Forest},
    published::PublishedEstimate,
    terminal::signed_term,
};
use overact_identification::{Estimate, Identification, ParameterEstimate, Stage, significant};

/// Error bars longer than this (percent) are told of and not drawn: they would hide all others.
const LONGEST_BAR: f64 = 100.0;

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let estimates = finals(identification);
    let mut body = String::new();
    if !estimates.is_empty() {
        body.push_str(&introduction(&estimates));
        body.push_str(&comparison(contents, &estimates));
        body.push_str(&error_bars(&estimates));
    }
    body.push_str(&regroupings(identification));
    for estimate in &identification.estimates {
        let is_shown = estimates.iter().any(|one| std::ptr::eq(*one, estimate));
        if estimate.stage == Stage::Base && !is_shown {
            body.push_str(&base(estimate));
        }
    }
    Section {
        id: "parameters",
        title: "Parameters",
        body,
    }
}

/// What the table shows.
fn introduction(estimates: &[&Estimate]) -> String {
    let names: Vec<String> = estimates
        .iter()
        .map(|one| {
            let weighted = if one.weighted { ", weighted" } else { "" };
            format!(
                "{}: {}{weighted}, {} equations, condition number {}, relative error {} %",
                one.model.case(),
                projection(one),
                one.equations,
                significant(one.condition_number, 3),
                significant(one.relative_error_percent, 3)
            )
        })
        .collect();
    let text = format!(
        "Each estimate stands with its standard deviation σ. The first σ in percent assumes white residuals, as in eqs. (46) and (47); the second one allows for correlation over time and between the lines, and is the one to trust. {}.",
        names.join("; ")
    );
    paragraph(&capitalised(&text))
}

fn capitalised(text: &str) -> String {
    text.replace(". case", ". Case")
        .replace(". joint", ". Joint")
}

/// Names of all parameters in any of the estimates, in order.
fn names<'a>(estimates: &[&'a Estimate]) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for parameter in estimates.iter().flat_map(|one| &one.parameters) {
        if !names.contains(&parameter.name.as_str()) {
            names.push(&parameter.name);
        }
    }
    names
}

fn find<'a>(estimate: &'a Estimate, name: &str) -> Option<&'a ParameterEstimate> {
    estimate.parameters.iter().find(|one| one.name == name)
}

/// Table 2.
fn comparison(contents: &Contents<'_>, estimates: &[&Estimate]) -> String {
    let mut names: Vec<&str> = names(estimates);
    let published: Vec<&PublishedEstimate> = contents.published.map_or_else(Vec::new, |all| {
        let estimates = estimates.iter();
        estimates
            .filter_map(|one| all.estimate(one.model))
            .collect()
    });
    for name in published.iter().flat_map(|one| one.parameters.keys()) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let first = |name: &str| estimates.iter().find_map(|one| find(one, name));
    let truth = estimates
        .iter()
        .flat_map(|one| &one.parameters)
        .any(|one| one.true_value.is_some());
    let rows = names.iter().map(|name| {
        let mut row = vec![
            Cell::text(name),
            Cell::text(first(name).map_or("", |one| &one.unit)),
        ];
        if truth {
            row.push(Cell::digits(first(name).and_then(|one| one.true_value), 5));
        }
        for estimate in estimates {
            row.extend(estimated(find(estimate, name), truth));
        }
        for one in &published {
            row.push(one.parameters.get(*name).map_or_else(Cell::nothing, |one| {
                let deviation = one.deviation_percent;
                let deviation = deviation.map(|d| format!(" ({d} %)")).unwrap_or_default();
                Cell::number(format!("{}{deviation}", significant(one.value, 4)))
            }));
        }
        row
    });
    let mut table = Table {
        caption: String::from("Identified parameters"),
        header: header(contents, estimates, &published, truth),
        rows: rows.collect(),
    }
    .html();
    if let Some(note) = published.first().and(contents.published) {
        let _ = writeln!(
            table,
            "<p class=\"note\">Published: {}, deviation in parentheses.{}</p>",
            escape(note.source.trim_end_matches('.')),
            note.note
                .as_deref()
                .map(|note| format!(" {}", escape(note)))
                .unwrap_or_default()
        );
    }
    table
}

/// The two header rows of Table 2.
fn header(
    contents: &Contents<'_>,
    estimates: &[&Estimate],
    published: &[&PublishedEstimate],
    truth: bool,
) -> Vec<Vec<Cell>> {
    let mut groups = vec![Cell::text("").over(if truth { 3 } else { 2 })];
    let mut columns = vec![Cell::text("parameter"), Cell::text("unit")];
    if truth {
        columns.push(Cell::text("true value").class("n"));
    }
    for estimate in estimates {
        groups.push(
            Cell::text(case_heading(estimate.model))
                .over(if truth { 4 } else { 3 })
                .class("group"),
        );
        columns.push(Cell::text("estimate ± σ").class("n"));
        columns.push(Cell::text("% σ white").class("n"));
        columns.push(Cell::text("% σ correl.").class("n"));
        if truth {
            columns.push(Cell::text("error").class("n"));
        }
    }
    if !published.is_empty() && contents.published.is_some() {
        groups.push(Cell::text("Published").over(published.len()).class("group"));
        let heading = |one: &&PublishedEstimate| Cell::text(case_heading(one.model)).class("n");
        columns.extend(published.iter().map(heading));
    }
    vec![groups, columns]
}

/// The cells of one estimate.
fn estimated(parameter: Option<&ParameterEstimate>, truth: bool) -> Vec<Cell> {
    let Some(one) = parameter else {
        return vec![Cell::nothing(); if truth { 4 } else { 3 }];
    };
    let correlated = one.correlated_standard_deviation;
    let percent = 100.0 * correlated / one.value.abs();
    let mut cells = vec![
        Cell::text(&with_deviation(one.value, correlated)).class("n strong"),
        Cell::digits(Some(one.relative_standard_deviation_percent), 3),
        Cell::digits(Some(percent), 3),
    ];
    if truth {
        cells.push(one.true_value.map_or_else(Cell::nothing, |value| {
            let in_deviations = (one.value - value) / correlated;
            let percent = one.error_percent;
            let percent = percent.map(|p| format!("{p:+.2} %, ")).unwrap_or_default();
            Cell::number(format!("{percent}{in_deviations:+.1} σ"))
        }));
    }
    cells
}

/// The plot of all error bars, relative to the true value or to the first estimate.
fn error_bars(estimates: &[&Estimate]) -> String {
    let mut rows = Vec::new();
    let mut left_out = Vec::new();
    let mut to_truth = false;
    for name in names(estimates) {
        let found = || {
            estimates
                .iter()
                .filter_map(|one| Some((one, find(one, name)?)))
        };
        let truth = found().find_map(|(_, one)| one.true_value);
        let reference = truth.or_else(|| found().next().map(|(_, one)| one.value));
        let Some(reference) = reference.filter(|value| *value != 0.0) else {
            left_out.push(name);
            continue;
        };
        to_truth |= truth.is_some();
        let bars: Vec<Bar> = found()
            .map(|(estimate, one)| bar(estimate, one, reference))
            .collect();
        if bars
            .iter()
            .all(|bar| bar.value.abs() + bar.outer <= LONGEST_BAR)
        {
            rows.push((name.to_owned(), bars));
        } else {
            left_out.push(name);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let reference = if to_truth {
        "the true value"
    } else {
        "the first estimate"
    };
    let plot = Forest {
        title: format!("Deviation from {reference}"),
        description: format!(
            "error bars of {} parameters relative to {reference}",
            rows.len()
        ),
        x: Axis::linear(format!("deviation from {reference} (%)")).including(&[0.0]),
        rows,
    };
    let caption = bars_caption(to_truth, &left_out);
    let entries: Vec<(&str, &str)> = estimates
        .iter()
        .map(|one| (look(one.model).class(), case_heading(one.model)))
        .collect();
    figure(
        "figure-parameters",
        &[plot.svg()],
        &key(&entries),
        &escape(&caption),
    )
}

/// The error bar of a parameter, relative to a reference.
fn bar(estimate: &Estimate, one: &ParameterEstimate, reference: f64) -> Bar {
    let percent = |value: f64| 100.0 * value / reference.abs();
    Bar {
        look: look(estimate.model),
        value: percent(one.value - reference),
        inner: percent(2.0 * one.standard_deviation),
        outer: percent(2.0 * one.correlated_standard_deviation),
        label: format!(
            "{}, {}: {} {}",
            one.name,
            estimate.model.case(),
            with_deviation(one.value, one.correlated_standard_deviation),
            one.unit
        ),
    }
}

/// What the error bars mean, and which parameters have none.
fn bars_caption(to_truth: bool, left_out: &[&str]) -> String {
    let mut caption = format!(
        "Estimates with error bars of two standard deviations: bold for white residuals, thin for correlated ones. {}",
        if to_truth {
            "A thin bar that misses zero is an estimate that is further from the truth than its deviation admits."
        } else {
            "Bars of one parameter that do not overlap contradict each other."
        }
    );
    if !left_out.is_empty() {
        let _ = write!(
            caption,
            " Not drawn, because their bars are as long as their values: {}.",
            left_out.join(", ")
        );
    }
    caption
}

/// What is regrouped into each base parameter.
fn regroupings(identification: &Identification) -> String {
    let (alone, regrouped): (Vec<_>, Vec<_>) = identification
        .base_parameters
        .iter()
        .partition(|base| base.regrouping.is_empty());
    if regrouped.is_empty() {
        return String::new();
    }
    let rows = regrouped.iter().map(|base| {
        let terms: String = base.regrouping.iter().map(signed_term).collect();
        let sum = format!("{}{terms}", base.parameter);
        vec![
            Cell::text(&base.name),
            Cell::text(&base.unit),
            Cell::text(&sum).class("sum"),
        ]
    });
    let table = Table {
        caption: String::from("Regroupings"),
        header: vec![vec![
            Cell::text("base parameter"),
            Cell::text("unit"),
            Cell::text("is the sum"),
        ]],
        rows: rows.collect(),
    };
    let mut body = paragraph(
        "Torques depend on these sums only: no experiment tells their terms apart. A name that ends with R is such a sum.",
    );
    body.push_str(&table.html());
    if !alone.is_empty() {
        let names: Vec<&str> = alone.iter().map(|base| base.name.as_str()).collect();
        body.push_str(&paragraph(&format!("By themselves: {}.", names.join(", "))));
    }
    details(
        &format!(
            "Regroupings of the {} base parameters",
            identification.base_parameters.len()
        ),
        &body,
    )
}

/// All base parameters of one model.
fn base(estimate: &Estimate) -> String {
    let truth = estimate
        .parameters
        .iter()
        .any(|one| one.true_value.is_some());
    let mut columns = vec![Cell::text("parameter"), Cell::text("unit")];
    if truth {
        columns.push(Cell::text("true value").class("n"));
    }
    let titles = ["estimate ± σ", "% σ white", "% σ correl.", "error"];
    let titles = titles.iter().take(if truth { 4 } else { 3 });
    columns.extend(titles.map(|title| Cell::text(title).class("n")));
    let rows = estimate.parameters.iter().map(|one| {
        let mut row = vec![Cell::text(&one.name), Cell::text(&one.unit)];
        if truth {
            row.push(Cell::digits(one.true_value, 5));
        }
        row.extend(estimated(Some(one), truth));
        row
    });
    let table = Table {
        caption: format!("{}, all base parameters", case_heading(estimate.model)),
        header: vec![columns],
        rows: rows.collect(),
    };
    details(
        &format!(
            "{}: all {} base parameters (relative error {} %)",
            case_heading(estimate.model),
            estimate.parameters.len(),
            significant(estimate.relative_error_percent, 3)
        ),
        &table.html(),
    )
}
