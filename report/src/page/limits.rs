//! What is not identifiable, and why.

use super::{
    Contents,
    markup::{Cell, Section, Table, paragraph},
    select::{case_heading, finals},
};
use overact_identification::{Identification, Stage};

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut rows = Vec::new();
    structural(identification, &mut rows);
    on_the_data(identification, &mut rows);
    cancelled(identification, &mut rows);
    let body = if rows.is_empty() {
        paragraph("Every standard parameter of the robot was identified by itself.")
    } else {
        let introduction = "Some parameters do not show in the torques at all, some show only in sums, and some show too little in these data.";
        let table = Table {
            caption: String::from("Parameters that were not identified"),
            header: vec![vec![Cell::text("why"), Cell::text("which")]],
            rows: rows
                .into_iter()
                .map(|(why, which)| {
                    vec![
                        Cell::text(&why).class("prose"),
                        Cell::text(&which).class("prose"),
                    ]
                })
                .collect(),
        };
        paragraph(introduction) + &table.html()
    };
    Section {
        id: "limits",
        title: "What is not identifiable, and why",
        body,
    }
}

/// What no data can tell.
fn structural(identification: &Identification, rows: &mut Vec<(String, String)>) {
    if !identification.without_effect.is_empty() {
        let why = "No effect on the torques, whatever the motion: the robot can’t move in a way that would show them";
        rows.push((why.to_owned(), identification.without_effect.join(", ")));
    }
    let mut regrouped: Vec<&str> = Vec::new();
    for term in identification
        .base_parameters
        .iter()
        .flat_map(|base| &base.regrouping)
    {
        if !regrouped.contains(&term.parameter.as_str()) {
            regrouped.push(&term.parameter);
        }
    }
    if !regrouped.is_empty() {
        let why = "Only in sums with others: the structure of the robot makes their columns combinations of others (see the regroupings)";
        rows.push((why.to_owned(), regrouped.join(", ")));
    }
}

/// Base parameters that these data do not tell apart: they are missing in the base estimate.
fn on_the_data(identification: &Identification, rows: &mut Vec<(String, String)>) {
    for estimate in &identification.estimates {
        if estimate.stage != Stage::Base {
            continue;
        }
        let missing: Vec<&str> = identification
            .base_parameters
            .iter()
            .map(|base| base.name.as_str())
            .filter(|name| estimate.parameters.iter().all(|one| one.name != *name))
            .collect();
        if !missing.is_empty() {
            rows.push((
                format!(
                    "{}: on these data their columns are zero or combinations of others (see the warnings); runs that move the robot in other ways would show them",
                    case_heading(estimate.model)
                ),
                missing.join(", "),
            ));
        }
    }
}

/// Base parameters that the elimination cancelled.
fn cancelled(identification: &Identification, rows: &mut Vec<(String, String)>) {
    for estimate in finals(identification) {
        let taken = estimate.removals.iter().filter(|removal| removal.accepted);
        let names: Vec<&str> = taken.map(|removal| removal.name.as_str()).collect();
        if !names.is_empty() {
            rows.push((
                format!(
                    "{}: too small an effect on the torques of these runs, so they were cancelled and count as zero",
                    case_heading(estimate.model)
                ),
                names.join(", "),
            ));
        }
    }
}
