//! Section on what was not identified, with reasons.

use crate::{
    choice::{answers, case_heading, of, of_stage},
    intervals::{excludes_zero, half_width_percent},
    page::{
        Contents,
        elements::{
            markup::{Section, paragraph},
            table::{Cell, Table},
        },
    },
};
use overact_identification::{Estimate, Identification, Stage, significant};

/// Reason and parameters.
type Row = (String, String);

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut rows = structural(identification);
    rows.extend(on_the_data(identification));
    rows.extend(not_needed(identification));
    rows.extend(eliminated_by_rule(identification));
    let body = if rows.is_empty() {
        paragraph("Every standard parameter of the robot was identified individually.")
    } else {
        let introduction = "Some parameters affect the torques of no motion, some only in sums with others, and some not in these runs.";
        let table = Table {
            caption: String::from("Parameters that were not identified individually"),
            header: vec![vec![Cell::text("why"), Cell::text("which")]],
            rows: rows
                .into_iter()
                .map(|(why, which)| vec![Cell::prose(&why), Cell::prose(&which)])
                .collect(),
        };
        paragraph(introduction) + &table.html()
    };
    Section {
        id: "limits",
        title: "Parameters that were not identified",
        body,
    }
}

/// Parameters that no data can determine.
fn structural(identification: &Identification) -> Vec<Row> {
    let mut rows = Vec::new();
    if !identification.without_effect.is_empty() {
        let why = "No effect on the torques of any motion.";
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
        let why = "Only in sums with others, for any motion: see the base parameters.";
        rows.push((why.to_owned(), regrouped.join(", ")));
    }
    rows
}

/// Base parameters that these data do not determine; they are missing from the base estimate.
fn on_the_data(identification: &Identification) -> Vec<Row> {
    let missing = |estimate: &Estimate| {
        let base = identification.base_parameters.iter();
        let names = base.map(|base| base.name.as_str());
        names_without(names, estimate).join(", ")
    };
    let why = "In these runs their effect is zero or a combination of other effects (see the warnings). Runs with other motions can determine them.";
    let base = of_stage(identification, Stage::Base);
    for_each(&base, why, missing)
}

/// Base parameters that are not recommended.
fn not_needed(identification: &Identification) -> Vec<Row> {
    let eliminated = |estimate: &Estimate| {
        of(identification, estimate.model, Stage::Base).map_or_else(String::new, |base| {
            let names = base.parameters.iter().map(|one| one.name.as_str());
            names_without(names, estimate).join(", ")
        })
    };
    let why = "Zero in the recommended model: these runs do not refute that all of them are zero together. The table of all base parameters has their estimates and intervals.";
    for_each(
        &of_stage(identification, Stage::Recommended),
        why,
        eliminated,
    )
}

/// Parameters that the r_σ rule removes although the data determine them.
fn eliminated_by_rule(identification: &Identification) -> Vec<Row> {
    let eliminated = |essential: &Estimate| {
        let answers = answers(identification);
        let answer = answers.iter().find(|one| one.model == essential.model);
        let parameters = answer.iter().flat_map(|one| &one.parameters);
        let gone = parameters.filter(|one| {
            let mut left = essential.parameters.iter();
            excludes_zero(one) && !left.any(|other| other.name == one.name)
        });
        let named = gone.map(|one| match half_width_percent(one) {
            Some(percent) => format!("{} (± {} %)", one.name, significant(percent, 2)),
            None => one.name.clone(),
        });
        named.collect::<Vec<_>>().join(", ")
    };
    let why = "Eliminated by the r_σ rule alone. The data determine them: their 95 % intervals exclude zero, and half their widths are given in parentheses. The recommended model keeps them.";
    for_each(&of_stage(identification, Stage::Essential), why, eliminated)
}

/// One row for each model with such parameters.
fn for_each(estimates: &[&Estimate], why: &str, which: impl Fn(&Estimate) -> String) -> Vec<Row> {
    let rows = estimates
        .iter()
        .map(|one| (format!("{}. {why}", case_heading(one.model)), which(one)));
    rows.filter(|(_, which)| !which.is_empty()).collect()
}

/// Names that are not among an estimate's parameters.
fn names_without<'a>(names: impl Iterator<Item = &'a str>, estimate: &Estimate) -> Vec<&'a str> {
    let is_there = |name: &&str| estimate.parameters.iter().any(|one| one.name == *name);
    names.filter(|name| !is_there(name)).collect()
}
