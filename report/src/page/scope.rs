//! Section on detection limits and assumptions: faults that these data cannot show.

use super::{
    Contents,
    elements::{
        markup::{Section, capital, details, paragraph, prose},
        table::{Cell, Table},
    },
};
use overact_identification::{Detectable, Identification};

/// Section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let limits = list(
        "unseen",
        "Detection limits",
        "For each kind of fault, up to three of the most harmful: the size that nine of ten such data sets would reveal, the parameter that a fault of this size would shift most, and the number of others that it would shift by more than three standard deviations. A smaller fault shifts them in proportion:",
        &identification.unseen,
    );
    let assumptions = list(
        "assumptions",
        "Assumptions",
        "These data cannot test the following; the result relies on it:",
        &identification.assumptions,
    );
    Section {
        id: "scope",
        title: "Detection limits and assumptions",
        body: limits + &table(identification) + &assumptions,
    }
}

/// Heading, introduction and sentences; empty without sentences.
fn list(id: &str, title: &str, introduction: &str, all: &[String]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let items = all.iter();
    let items = items.map(|one| format!("<li>{}</li>\n", prose(&capital(one))));
    let items: String = items.collect();
    let introduction = paragraph(introduction);
    format!("<h3 id=\"{id}\">{title}</h3>\n{introduction}<ul class=\"plain\">\n{items}</ul>\n")
}

/// All detection limits with all parameters that a fault of this size shifts.
fn table(identification: &Identification) -> String {
    let limits = identification.detection_limits();
    let row = |limit: &&Detectable| {
        vec![
            Cell::prose(&capital(limit.fault.words())),
            Cell::prose(&limit.size_words()),
            Cell::prose(&limit.shift_words()),
        ]
    };
    let rows: Vec<Vec<Cell>> = limits
        .iter()
        .filter(|limit| limit.size.is_finite())
        .map(row)
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let table = Table {
        caption: String::from("Undetected faults and the parameters that they shift"),
        header: vec![
            ["fault", "largest undetected size", "parameters"]
                .map(Cell::text)
                .into(),
        ],
        rows,
    };
    details("All parameters that these faults shift", &table.html())
}
