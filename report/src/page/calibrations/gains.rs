//! Section on identified drive gains.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note, paragraph},
        table::{Cell, Table},
    },
};
use overact_identification::{DriveGain, JointParameter, Settings};

/// Section; empty if no gains were identified.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let body = if identification.gains.is_empty() {
        String::new()
    } else {
        introduction(&identification.settings)
            + &drives(&identification.gains)
            + &parameters(&identification.gain_parameters)
    };
    Section {
        id: "gains",
        title: "Gains of the drives",
        body,
    }
}

/// Introduction.
fn introduction(settings: &Settings) -> String {
    let known: Vec<String> = settings
        .known
        .keys()
        .map(|name| format!("`{name}`"))
        .collect();
    paragraph(&format!(
        "The torque of each drive was identified together with the parameters, relative to known values: {}.",
        known.join(", ")
    ))
}

/// Table of the gains.
fn drives(gains: &[DriveGain]) -> String {
    let rows = gains.iter().map(|one| {
        vec![
            Cell::text(&one.actuator),
            Cell::digits(Some(one.factor), 5),
            Cell::digits(Some(one.deviation), 2),
            Cell::digits(one.total_least_squares, 5),
            Cell::text(if one.is_wrong() { "differs" } else { "" }),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Gains relative to the description"),
        header: vec![vec![
            Cell::text("drive"),
            right("gain"),
            right("deviation"),
            right("by total least squares"),
            Cell::text(""),
        ]],
        rows: rows.collect(),
    };
    table.html()
        + &note(
            "All torques on this page are multiplied by these gains. Total least squares assumes equal errors in all columns and is shown for comparison.",
        )
}

/// Table of the parameters estimated with the gains.
fn parameters(parameters: &[JointParameter]) -> String {
    let rows = parameters.iter().map(|one| {
        vec![
            Cell::text(&one.name),
            Cell::digits(Some(one.value), 6),
            Cell::digits(Some(one.deviation), 2),
            Cell::text(&one.unit).class("unit"),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Parameters that were estimated together with the gains"),
        header: vec![vec![
            Cell::text("parameter"),
            right("value"),
            right("deviation"),
            Cell::text("unit"),
        ]],
        rows: rows.collect(),
    };
    table.html()
        + &note(
            "All standard deviations and intervals on this page include the uncertainty of the gains.",
        )
}
