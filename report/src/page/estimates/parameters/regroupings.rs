//! Regroupings of the base parameters.

use crate::{
    page::elements::{
        markup::{details, paragraph},
        table::{Cell, Table},
    },
    terminal::sum,
    text::escape,
};
use overact_identification::Identification;

/// Cell with a parameter's name, and below it the sum that it is.
pub(super) fn named(identification: &Identification, name: &str) -> Cell {
    let mut base = identification.base_parameters.iter();
    let base = base.find(|one| one.name == name && !one.regrouping.is_empty());
    let Some(base) = base else {
        return Cell::text(name);
    };
    Cell::markup(format!(
        "{}<span class=\"sum\">= {}</span>",
        escape(name),
        escape(&sum(base))
    ))
    .class("defined")
}

/// Collapsed table of the sums that the base parameters are.
pub(super) fn regroupings(identification: &Identification) -> String {
    let (alone, regrouped): (Vec<_>, Vec<_>) = identification
        .base_parameters
        .iter()
        .partition(|base| base.regrouping.is_empty());
    if regrouped.is_empty() {
        return String::new();
    }
    let rows = regrouped.iter().map(|base| {
        vec![
            Cell::text(&base.name),
            Cell::text(&base.unit).class("unit"),
            Cell::text(&sum(base)).class("prose"),
        ]
    });
    let table = Table {
        caption: String::from("Regrouping of each base parameter"),
        header: vec![vec![
            Cell::text("base parameter"),
            Cell::text("unit"),
            Cell::text("sum"),
        ]],
        rows: rows.collect(),
    };
    let mut body = paragraph(
        "The torques depend on these sums only, so no experiment can separate their terms. A name that ends with R is such a sum.",
    );
    body.push_str(&table.html());
    if !alone.is_empty() {
        let names: Vec<&str> = alone.iter().map(|base| base.name.as_str()).collect();
        body.push_str(&paragraph(&format!(
            "Individual standard parameters: {}.",
            names.join(", ")
        )));
    }
    details(
        &format!(
            "Regrouping of the {} base parameters",
            identification.base_parameters.len()
        ),
        &body,
    )
}
