//! Section on physically consistent standard parameters, for controllers and simulators.

use crate::{
    choice::case_heading,
    line_errors::{base_words, relative_words},
    page::{
        Contents,
        elements::{
            markup::{Section, details, paragraph},
            table::{Cell, Table},
        },
    },
};
use overact_identification::{Consistent, ConsistentBody, ConsistentParameter, Identification};

/// Section; empty without a consistent estimate.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let all = &contents.identification.consistent;
    let mut body = String::new();
    if !all.is_empty() {
        body.push_str(&paragraph(
            "Base parameters are sums of masses and inertias of single bodies. Noise can give them values that no robot has. Here the pseudo-inertia of every body is positive definite, and friction and rotor inertia are positive. Among such parameters these fit the torques best. Where the data do not determine them, they stay close to the prior: values and bounds of the table `prior` of the description, otherwise bodies filled uniformly between their joints.",
        ));
        body.extend(all.iter().map(|one| of_model(contents.identification, one)));
    }
    Section {
        id: "consistent",
        title: "Physically consistent parameters",
        body,
    }
}

fn of_model(identification: &Identification, one: &Consistent) -> String {
    let cost = format!(
        "{}: relative residual {}, with the base parameters {}.",
        case_heading(one.model),
        relative_words(&one.lines, one.relative_error_percent, 4),
        base_words(identification, one)
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
            Cell::text("distance from degenerate (0 to 0.25)").class("n"),
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
            Cell::text("prior").class("n"),
            Cell::text("from the data, %").class("n"),
        ]],
        rows: all.iter().map(row).collect(),
    }
    .html()
}
