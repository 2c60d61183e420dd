//! Section on the verdict: the permitted use of each model's parameters, with reasons.
//!
//! The section `checks` contains the evidence.

use std::fmt::Write;

use super::{
    Contents, checks,
    elements::markup::{Section, capital, paragraph, prose},
};
use crate::{
    choice::stage_name,
    judgement::{grade_words, other_warnings, passed},
    text::escape,
};
use overact_identification::{Check, Grade, Identification, StageVerdict, Verdict, failed_checks};

/// Section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = cards(identification);
    body.push_str(&warnings(identification));
    Section {
        id: "verdict",
        title: "Verdict",
        body,
    }
}

/// Verdict of each model in one sentence.
pub(super) fn summary(identification: &Identification) -> String {
    let verdicts = &identification.verdicts;
    if verdicts.is_empty() {
        return String::from("No verdict: no check was made.");
    }
    let sentence = |one: &Verdict| {
        format!(
            "{}, {}: {}.",
            capital(&one.subject),
            stage_name(one.stage),
            grade_words(one.grade)
        )
    };
    let sentences: Vec<String> = verdicts.iter().map(sentence).collect();
    sentences.join(" ")
}

/// One card per verdict.
fn cards(identification: &Identification) -> String {
    if identification.verdicts.is_empty() {
        return String::new();
    }
    let mut html = String::from("<div class=\"cards\">\n");
    for verdict in &identification.verdicts {
        let (class, sign) = match verdict.grade {
            Grade::Use => ("good", "✓"),
            Grade::UseListed => ("partly", "!"),
            Grade::DoNotUse => ("bad", "✗"),
        };
        let _ = writeln!(
            html,
            "<div class=\"card {class}\"><h3><span aria-hidden=\"true\">{sign}</span> {}: {}</h3>{}{}{}{}</div>",
            escape(&capital(&verdict.subject)),
            grade_words(verdict.grade),
            listed(&verdict.listed),
            reasons(identification, verdict),
            rests_on(verdict),
            others(verdict)
        );
    }
    html.push_str("</div>\n");
    html
}

/// Parameters that may be used, if not all may.
fn listed(names: &[String]) -> String {
    if names.is_empty() {
        return String::new();
    }
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    format!("<p>Usable: {}.</p>", prose(&names.join(", ")))
}

/// Assumptions of a usable result.
fn rests_on(verdict: &Verdict) -> String {
    let words = verdict.rests_on.as_deref().map(prose);
    words.map_or_else(String::new, |words| paragraph(&words))
}

/// Failed checks of a model with links to the evidence, or that there are none.
fn reasons(identification: &Identification, verdict: &Verdict) -> String {
    let found = failed_checks(&identification.checks, verdict.model, verdict.stage);
    if found.reported.is_empty() {
        let count = passed(identification, verdict.model, verdict.stage);
        return match count {
            0 => String::new(),
            1 => {
                String::from("<p>No objection: the <a href=\"#checks\">only check</a> passed.</p>")
            }
            _ => format!("<p>No objection: all <a href=\"#checks\">{count} checks</a> passed.</p>"),
        };
    }
    let reason = |(number, check): &(usize, &Check)| {
        format!(
            "<li>{} <a href=\"#{}\">Details.</a></li>",
            prose(&sentence(&check.located())),
            checks::id(*number)
        )
    };
    let mut reasons: String = found.reported.iter().map(reason).collect();
    if let Some(rest) = found.rest() {
        let _ = write!(reasons, "<li>{}</li>", prose(&sentence(&rest)));
    }
    format!("<ul>{reasons}</ul>")
}

/// Formats words as a sentence.
fn sentence(words: &str) -> String {
    let words = capital(words);
    if words.ends_with(['.', '?', '!']) {
        words
    } else {
        words + "."
    }
}

/// Verdicts of other stages, if they differ.
fn others(verdict: &Verdict) -> String {
    let differs = |one: &&StageVerdict| one.stage != verdict.stage && one.grade != verdict.grade;
    let stated = |one: &StageVerdict| {
        let which = if one.listed.is_empty() {
            String::new()
        } else {
            format!(" ({})", one.listed.join(", "))
        };
        let text = format!(
            "{}: {}{which}.",
            capital(stage_name(one.stage)),
            grade_words(one.grade)
        );
        format!("<p class=\"note\">{}</p>", prose(&text))
    };
    verdict.stages.iter().filter(differs).map(stated).collect()
}

/// Warnings that do not belong to a check.
fn warnings(identification: &Identification) -> String {
    let rest = other_warnings(identification);
    if rest.is_empty() {
        return String::new();
    }
    let items: String = rest
        .iter()
        .map(|warning| format!("<li>{}</li>\n", prose(&capital(warning))))
        .collect();
    format!("<h3 id=\"warnings\">Warnings</h3>\n<ul class=\"warnings\">\n{items}</ul>\n")
}
