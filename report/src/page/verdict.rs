//! The verdict in plain words, the thresholds that it rests on, and all warnings.

use std::fmt::Write;

use super::{
    Contents,
    markup::{Section, capital, details, paragraph, prose},
    table::{Cell, Table},
};

use crate::escape::escape;
use overact_identification::{Check, Grade, Identification, Verdict, significant};

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = paragraph(&summary(identification));
    body.push_str(&cards(identification));
    body.push_str(&findings(identification));
    body.push_str(&details(
        "The thresholds of this verdict",
        &thresholds(identification),
    ));
    Section {
        id: "verdict",
        title: "Verdict",
        body,
    }
}

/// The verdict in one sentence or two.
fn summary(identification: &Identification) -> String {
    let verdicts = &identification.verdicts;
    let sentence = |one: &Verdict| format!("{}: {}.", capital(&one.subject), one.grade.words());
    let sentences: Vec<String> = verdicts.iter().map(sentence).collect();
    let mut text = if sentences.is_empty() {
        String::from("Nothing was judged: the numbers below have to speak for themselves.")
    } else {
        sentences.join(" ")
    };
    match identification.warnings.len() {
        0 => text.push_str(" There are no warnings."),
        1 => text.push_str(" There is one warning to read."),
        count => {
            let _ = write!(text, " There are {count} warnings to read.");
        }
    }
    text
}

/// One card for each verdict.
fn cards(identification: &Identification) -> String {
    if identification.verdicts.is_empty() {
        return String::new();
    }
    let mut html = String::from("<div class=\"cards\">\n");
    for verdict in &identification.verdicts {
        let (class, sign) = match verdict.grade {
            Grade::Use => ("good", "✓"),
            Grade::UseListed => ("bad", "!"),
            Grade::DoNotUse => ("bad", "✗"),
        };
        let word = verdict.grade.words();
        let reasons: String = verdict
            .reasons
            .iter()
            .map(|reason| format!("<li>{}</li>", prose(reason)))
            .collect();
        let _ = writeln!(
            html,
            "<div class=\"card {class}\"><h3><span aria-hidden=\"true\">{sign}</span> {}: {word}</h3><ul>{reasons}</ul></div>",
            escape(&capital(&verdict.subject))
        );
    }
    html.push_str("</div>\n");
    html
}

/// What is suspicious in the data, and every other warning.
fn findings(identification: &Identification) -> String {
    let found: Vec<&Check> = identification
        .checks
        .iter()
        .filter(|check| !check.passed)
        .collect();
    if identification.warnings.is_empty() && found.is_empty() {
        return String::new();
    }
    let mut html = String::from("<h3 id=\"warnings\">Warnings</h3>\n<ul class=\"warnings\">\n");
    for check in &found {
        let place = check.run.iter().chain(&check.actuator).cloned();
        let place: Vec<String> = place.collect();
        let _ = write!(html, "<li>");
        if !place.is_empty() {
            let _ = write!(html, "<b>{}:</b> ", escape(&place.join(", ")));
        }
        let _ = writeln!(html, "{}</li>", prose(&check.words));
    }
    let rest = identification
        .warnings
        .iter()
        .filter(|warning| !found.iter().any(|check| warning.contains(&check.words)));
    for warning in rest {
        let _ = writeln!(html, "<li>{}</li>", prose(&capital(warning)));
    }
    html.push_str("</ul>\n");
    html
}

/// Every threshold with what it decides.
fn thresholds(identification: &Identification) -> String {
    let thresholds = &identification.thresholds;
    let rows = [
        (
            "Condition of the kept actuators",
            significant(thresholds.partition_condition, 4),
            "above it, case 2 is too close to a singularity of its choice of actuators",
        ),
        (
            "Significance |χ|/σ",
            significant(thresholds.significance, 4),
            "above it, the data speak for a parameter; σ is that of correlated residuals",
        ),
        (
            "Growth of the held-out error",
            format!("{} %", significant(thresholds.held_out_growth_percent, 4)),
            "above it, a significant parameter is not cancelled",
        ),
        (
            "Move of another parameter",
            format!("{} %", significant(thresholds.drift_percent, 4)),
            "above it, a significant parameter is not cancelled",
        ),
        (
            "r_σ, largest by smallest relative deviation",
            significant(identification.settings.r_sigma, 4),
            "below it, the elimination of parameters ends",
        ),
    ];
    let cell = |(name, value, what): (&str, String, &str)| {
        vec![Cell::text(name), Cell::number(value), Cell::prose(what)]
    };
    Table {
        caption: String::from("Thresholds and what they decide"),
        header: vec![vec![
            Cell::text("threshold"),
            Cell::text("value").class("n"),
            Cell::text("what it decides"),
        ]],
        rows: rows.into_iter().map(cell).collect(),
    }
    .html()
}
