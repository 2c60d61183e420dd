//! Section on validation runs: Table 3, and torques over time (Figs. 8 and 9).

use super::inputs;
use crate::{
    choice::{answers, case_heading, of_stage, stage_name},
    page::{
        Contents,
        elements::{
            markup::{Section, note, paragraph},
            table::{Cell, Table},
        },
    },
};
use overact_identification::{CrossValidation, Estimate, Identification, Stage};

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    if identification.cross_validation.is_empty() {
        body.push_str(&paragraph(
            "There are no validation data, so the error on new data is unknown. The torques below are those of the training runs.",
        ));
    } else {
        body.push_str(&paragraph(
            "Runs that are only predicted. An error that is much larger than on the training runs means that the model does not generalise. With more actuators than degrees of freedom the model does not determine internal torques: the prediction is the torques of least norm. Measured torques are compared as they are and without preload.",
        ));
        body.push_str(&table(contents, &answers(identification), false));
        let essential = of_stage(identification, Stage::Essential);
        if !essential.is_empty() {
            body.push_str(&table(contents, &essential, true));
        }
    }
    let torques = inputs::torques(contents);
    if torques.is_empty() && identification.cross_validation.is_empty() {
        body.clear();
    }
    body.push_str(&torques);
    Section {
        id: "validation",
        title: "Prediction of validation runs",
        body,
    }
}

/// Rows of one run and model: name of the prediction, and its error for each actuator.
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
        rows.push(("least norm, measured without preload", errors.collect()));
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

/// Table 3: errors of estimates on every validation run, with published ones if comparable.
fn table(contents: &Contents<'_>, estimates: &[&Estimate], comparable: bool) -> String {
    let identification = contents.identification;
    let actuators = actuators(identification);
    let mut rows = Vec::new();
    for one in &identification.cross_validation {
        let mut own = estimates.iter();
        if own.any(|estimate| estimate.model == one.model && estimate.stage == one.stage) {
            for (prediction, errors) in predictions(one) {
                rows.push(row(&one.run, case_heading(one.model), prediction, &errors));
            }
        }
    }
    let published = contents.published.filter(|all| all.actuators == actuators);
    let published = published.filter(|all| comparable && !all.cross_validation.is_empty());
    for one in published.iter().flat_map(|all| &all.cross_validation) {
        let errors: Vec<Option<f64>> = one.torques_percent.iter().copied().map(Some).collect();
        let run = format!("{} (published)", one.run);
        rows.push(row(&run, case_heading(one.model), "eq. (26)", &errors));
    }
    let mut header = vec![
        Cell::text("run"),
        Cell::text("case"),
        Cell::text("compared with"),
    ];
    header.extend(actuators.iter().map(|name| Cell::text(name).class("n")));
    header.push(Cell::text("mean").class("n"));
    let stage = estimates.first().map_or(Stage::Base, |one| one.stage);
    let mut html = Table {
        caption: format!(
            "Relative errors of the torques of validation runs (%), {}",
            stage_name(stage)
        ),
        header: vec![header],
        rows,
    }
    .html();
    if let Some(all) = published {
        html.push_str(&note(&format!(
            "Published: {}.",
            all.source.trim_end_matches('.')
        )));
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
