//! Comparison of own and published parameters (Table 2 of the paper).

use super::{Contents, find, names};
use crate::{
    choice::{answers, case_heading, of_stage},
    page::elements::{
        markup::note,
        table::{Cell, Table},
    },
    published::{Published, PublishedEstimate},
};
use overact_identification::{Estimate, Stage};

/// Table; empty without published results.
pub(super) fn table(contents: &Contents<'_>) -> String {
    let Some(published) = contents.published else {
        return String::new();
    };
    let mut own = of_stage(contents.identification, Stage::Essential);
    if own.is_empty() {
        own = answers(contents.identification);
    }
    let pairs: Vec<(&Estimate, &PublishedEstimate)> = own
        .into_iter()
        .filter_map(|one| Some((one, published.estimate(one.model)?)))
        .collect();
    if pairs.is_empty() {
        return String::new();
    }
    let own: Vec<&Estimate> = pairs.iter().map(|(one, _)| *one).collect();
    let mut names = names(contents.identification, &own);
    for name in pairs.iter().flat_map(|(_, other)| other.parameters.keys()) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let mut groups = vec![Cell::text("")];
    let mut columns = vec![Cell::text("parameter")];
    for (one, _) in &pairs {
        groups.push(Cell::text(case_heading(one.model)).over(5).class("group"));
        let titles = ["here", "% σ", "published", "% σ", "difference"];
        columns.extend(titles.map(|title| Cell::text(title).class("n")));
    }
    let rows = names.iter().map(|name| {
        let mut row = vec![Cell::text(name)];
        for (own, other) in &pairs {
            row.extend(cells(own, other, name));
        }
        row
    });
    let table = Table {
        caption: String::from("Parameters by the r_σ rule compared with published ones"),
        header: vec![groups, columns],
        rows: rows.collect(),
    };
    table.html() + &note(&explanation(published))
}

/// Own estimate, published estimate, and their difference.
fn cells(own: &Estimate, other: &PublishedEstimate, name: &str) -> Vec<Cell> {
    let own = find(own, name);
    let other = other.parameters.get(name);
    let difference = own.zip(other).and_then(|(own, other)| {
        let percent = 100.0 * (own.value - other.value) / other.value.abs();
        percent.is_finite().then_some(percent)
    });
    vec![
        Cell::digits(own.map(|one| one.value), 4),
        Cell::digits(own.map(|one| one.relative_standard_deviation_percent), 3),
        Cell::digits(other.map(|one| one.value), 4),
        Cell::digits(other.and_then(|one| one.deviation_percent), 3),
        difference.map_or_else(Cell::nothing, |percent| {
            Cell::number(format!("{percent:+.1} %"))
        }),
    ]
}

/// Source of the numbers, and meaning of the standard deviations.
fn explanation(published: &Published) -> String {
    let note = published.note.as_deref();
    let note = note.map_or_else(String::new, |note| format!(" {note}"));
    format!(
        "Published: {}. Both standard deviations follow eq. (47), which assumes white residuals. They are comparable but too small; the intervals above allow for correlation.{note}",
        published.source.trim_end_matches('.')
    )
}
