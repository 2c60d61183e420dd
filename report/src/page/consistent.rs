//! Section on physically consistent standard parameters, for controllers and simulators.

use super::{
    Contents,
    markup::{Section, details, paragraph},
    table::{Cell, Table},
};
use crate::choice::case_heading;
use overact_identification::{Consistent, ConsistentBody, ConsistentParameter, significant};

/// Section; empty without a consistent estimate.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let all = &contents.identification.consistent;
    let mut body = String::new();
    if !all.is_empty() {
        body.push_str(&paragraph(
            "Base parameters are sums of the masses and inertias of single bodies, and noise can make them sums that no robot has. Here every body has a mass, a centre of mass and inertias that some distribution of matter has, and friction is positive. Among all such parameters these explain the torques best; where the data leave them open, they are the nearest to what was believed before: values and bounds of the table `prior` of the description, bodies filled uniformly between their joints elsewhere.",
        ));
        body.extend(all.iter().map(of_model));
    }
    Section {
        id: "consistent",
        title: "Parameters that a robot can have",
        body,
    }
}

fn of_model(one: &Consistent) -> String {
    let cost = format!(
        "{}: they leave {} % of the torques unexplained, the base parameters {} %.",
        case_heading(one.model),
        significant(one.relative_error_percent, 4),
        significant(one.base_relative_error_percent, 4)
    );
    let mut html = paragraph(&cost);
    html.push_str(&bodies(&one.bodies));
    let summary = format!("{} standard parameters", one.parameters.len());
    html.push_str(&details(&summary, &parameters(&one.parameters)));
    html
}

fn bodies(all: &[ConsistentBody]) -> String {
    let row = |one: &ConsistentBody| {
        vec![
            Cell::text(&one.mass),
            Cell::digits(Some(one.mass_kg), 4),
            Cell::digits(Some(one.definiteness), 2),
        ]
    };
    Table {
        caption: String::from("Bodies"),
        header: vec![vec![
            Cell::text("mass"),
            Cell::text("kg").class("n"),
            Cell::text("how far from degenerate (0 to 0.25)").class("n"),
        ]],
        rows: all.iter().map(row).collect(),
    }
    .html()
}

fn parameters(all: &[ConsistentParameter]) -> String {
    let row = |one: &ConsistentParameter| {
        vec![
            Cell::text(&one.name),
            Cell::digits(Some(one.value), 4),
            Cell::text(&one.unit),
            Cell::digits(Some(one.prior), 4),
            Cell::number(format!("{:.0}", 100.0 * one.determined)),
        ]
    };
    Table {
        caption: String::from("Standard parameters"),
        header: vec![vec![
            Cell::text("parameter"),
            Cell::text("value").class("n"),
            Cell::text("unit"),
            Cell::text("before the data").class("n"),
            Cell::text("told by the data, %").class("n"),
        ]],
        rows: all.iter().map(row).collect(),
    }
    .html()
}
