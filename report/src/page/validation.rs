//! Cross-validation: Table 3, and the torques over time of Figs. 8 and 9.

use std::fmt::Write;

use super::{
    Contents, inputs,
    markup::{Cell, Section, Table, paragraph},
    select::is_final,
};
use crate::escape::escape;
use overact_identification::{CrossValidation, Identification};

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    if identification.cross_validation.is_empty() {
        body.push_str(&paragraph(
            "No run was held out, so nothing tells how well the model predicts what it has not seen; the torques below are those of the runs identified from.",
        ));
    } else {
        body.push_str(&paragraph(
            "Runs that no parameter was estimated from. An error here that is much larger than on the runs identified from means that the model does not generalise.",
        ));
        body.push_str(&table(contents));
    }
    let torques = inputs::torques(contents);
    if torques.is_empty() && identification.cross_validation.is_empty() {
        body.clear();
    }
    body.push_str(&torques);
    Section {
        id: "validation",
        title: "Cross-validation",
        body,
    }
}

/// The rows of one run and model: name of the prediction and its error for each actuator.
fn predictions(one: &CrossValidation) -> Vec<(&'static str, Vec<Option<f64>>)> {
    let mut rows = Vec::new();
    if one.table.is_empty() {
        let errors = one.torques.iter().map(|t| Some(t.relative_error_percent));
        rows.push(("least norm", errors.collect()));
    } else {
        let least = one.table.iter().map(|t| Some(t.least_norm_percent));
        rows.push(("least norm", least.collect()));
        if one.table.iter().any(|t| t.closure_percent.is_some()) {
            let closure = one.table.iter().map(|t| t.closure_percent);
            rows.push(("eq. (26)", closure.collect()));
        }
    }
    if !one.projected_torques.is_empty() {
        let projected = one.projected_torques.iter();
        let errors = projected.map(|t| Some(t.relative_error_percent));
        rows.push(("measured without preload", errors.collect()));
    }
    rows
}

/// Names of the actuators.
fn actuators(identification: &Identification) -> Vec<&str> {
    identification
        .cross_validation
        .first()
        .map_or_else(Vec::new, |one| {
            one.torques
                .iter()
                .map(|torque| torque.name.as_str())
                .collect()
        })
}

/// Table 3.
fn table(contents: &Contents<'_>) -> String {
    let identification = contents.identification;
    let actuators = actuators(identification);
    let mut rows = Vec::new();
    for one in &identification.cross_validation {
        if is_final(identification, one.model, one.stage) {
            for (prediction, errors) in predictions(one) {
                rows.push(row(&one.run, one.model.case(), prediction, &errors));
            }
        }
    }
    let published = contents.published.filter(|all| all.actuators == actuators);
    for one in published.iter().flat_map(|all| &all.cross_validation) {
        let errors: Vec<Option<f64>> = one.torques_percent.iter().copied().map(Some).collect();
        let run = format!("{} (published)", one.run);
        rows.push(row(&run, one.model.case(), "eq. (26)", &errors));
    }
    let mut header = vec![
        Cell::text("run"),
        Cell::text("parameters"),
        Cell::text("compared with"),
    ];
    header.extend(actuators.iter().map(|name| Cell::text(name).class("n")));
    header.push(Cell::text("mean").class("n"));
    let mut html = Table {
        caption: String::from("Relative error norms of the torques (%)"),
        header: vec![header],
        rows,
    }
    .html();
    if let Some(all) = published.filter(|all| !all.cross_validation.is_empty()) {
        let _ = writeln!(
            html,
            "<p class=\"note\">Published: {}.</p>",
            escape(all.source.trim_end_matches('.'))
        );
    }
    html
}

/// A row of Table 3.
fn row(run: &str, case: &str, prediction: &str, errors: &[Option<f64>]) -> Vec<Cell> {
    let mut cells = vec![Cell::text(run), Cell::text(case), Cell::text(prediction)];
    let percent = |value: Option<f64>| match value {
        Some(value) if value.is_finite() => Cell::number(format!("{value:.1}")),
        _ => Cell::nothing(),
    };
    cells.extend(errors.iter().map(|error| percent(*error)));
    let known: Vec<f64> = errors.iter().flatten().copied().collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    cells.push(percent((!known.is_empty()).then_some(mean)).class("n strong"));
    cells
}
