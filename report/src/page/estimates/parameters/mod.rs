//! Section on the parameters with their intervals.
//!
//! The order is: recommended parameters, essential parameters, published ones, all base parameters
//! with their regroupings. `bars` draws the intervals, `comparison` compares with published
//! results, `regroupings` lists the sums that the base parameters are.

mod bars;
mod comparison;
mod regroupings;

use crate::{
    choice::{answers, case_heading, of_stage, stage_name},
    intervals::{half_width_percent, is_outside, misses_truth},
    line_errors::relative_words,
    page::{
        Contents,
        elements::{
            markup::{Section, capital, details, note, paragraph, with_interval},
            table::{Cell, Table},
        },
    },
};
use overact_identification::{Estimate, Identification, ParameterEstimate, Stage, significant};

/// Half width in percent above which a parameter counts as unknown.
const LARGEST_PERCENT: f64 = 1000.0;

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let answers = answers(identification);
    let mut body = String::new();
    if let Some(first) = answers.first() {
        body.push_str(&paragraph(introduction(
            first.stage,
            !identification.cross_validation.is_empty(),
        )));
        body.push_str(&table(identification, &answers));
        body.push_str(&bars::figure(identification, &answers));
        body.push_str(&essential(identification, &answers));
        body.push_str(&comparison::table(contents));
        if first.stage != Stage::Base {
            body.push_str(&base(identification));
        }
    }
    body.push_str(&regroupings::regroupings(identification));
    Section {
        id: "parameters",
        title: "Parameters",
        body,
    }
}

/// Introduction to the first table.
const fn introduction(stage: Stage, is_held_out: bool) -> &'static str {
    match stage {
        Stage::Recommended if is_held_out => {
            "The recommended parameters are the fewest that these data do not refute: all others could be zero together, and the prediction of validation data is no worse without them."
        }
        Stage::Recommended => {
            "The recommended parameters are the fewest that these data do not refute: all others could be zero together."
        }
        Stage::Base => {
            "All base parameters: the smallest set of combinations that determines the torques. None was eliminated."
        }
        Stage::Essential => "The parameters that the r_σ rule keeps.",
        Stage::Consistent => "Physically consistent standard parameters.",
    }
}

/// Explanation of the intervals.
const INTERVALS: &str = "The interval contains the true value in 95 of 100 experiments like this one. All intervals are those of the model with all base parameters: the shorter intervals of a smaller model hold only if the eliminated parameters are exactly zero. The intervals allow for autocorrelated residuals.";

/// Names of the parameters in any of the estimates, in the order of the base parameters.
fn names<'a>(identification: &Identification, estimates: &[&'a Estimate]) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for parameter in estimates.iter().flat_map(|one| &one.parameters) {
        if !names.contains(&parameter.name.as_str()) {
            names.push(&parameter.name);
        }
    }
    let base = &identification.base_parameters;
    names.sort_by_key(|name| base.iter().position(|one| one.name == *name));
    names
}

fn find<'a>(estimate: &'a Estimate, name: &str) -> Option<&'a ParameterEstimate> {
    estimate.parameters.iter().find(|one| one.name == name)
}

/// Estimates of one stage in adjacent columns, with intervals and notes.
fn table(identification: &Identification, estimates: &[&Estimate]) -> String {
    let parameters = || estimates.iter().flat_map(|one| &one.parameters);
    let truth = parameters().any(|one| one.true_value.is_some());
    let names = names(identification, estimates);
    let rows = names.iter().map(|name| {
        let first = estimates.iter().find_map(|one| find(one, name));
        let mut row = vec![
            regroupings::named(identification, name),
            Cell::text(first.map_or("", |one| &one.unit)).class("unit"),
        ];
        if truth {
            row.push(Cell::digits(first.and_then(|one| one.true_value), 5));
        }
        for estimate in estimates {
            row.extend(estimated(find(estimate, name), truth));
        }
        row
    });
    let stage = estimates.first().map_or(Stage::Base, |one| one.stage);
    let mut html = Table {
        caption: format!("{}, SI units", capital(stage_name(stage))),
        header: header(estimates, truth),
        rows: rows.collect(),
    }
    .html();
    if parameters().any(is_outside) {
        html.push_str(&note("* outside its own interval: eliminating other parameters moved this estimate to a value that the data contradict."));
    }
    if parameters().any(misses_truth) {
        html.push_str(&note(
            "† the interval misses the true value, as one in twenty does on average.",
        ));
    }
    html.push_str(&note(INTERVALS));
    html
}

/// Two header rows.
fn header(estimates: &[&Estimate], truth: bool) -> Vec<Vec<Cell>> {
    let mut groups = vec![Cell::text("").over(if truth { 3 } else { 2 })];
    let mut columns = vec![Cell::text("parameter"), Cell::text("unit")];
    if truth {
        columns.push(Cell::text("true value").class("n"));
    }
    for estimate in estimates {
        let heading = Cell::text(case_heading(estimate.model)).over(3);
        groups.push(heading.class("group"));
        let last = if truth { "error" } else { "±\u{a0}%" };
        let titles = ["estimate", "95 % interval", last];
        columns.extend(titles.map(|title| Cell::text(title).class("n")));
    }
    vec![groups, columns]
}

/// Cells of one estimate.
fn estimated(parameter: Option<&ParameterEstimate>, truth: bool) -> Vec<Cell> {
    let Some(one) = parameter else {
        return vec![Cell::nothing(); 3];
    };
    let [low, high] = one.interval_95;
    let (mut value, interval) = with_interval(one.value, low, high);
    if is_outside(one) {
        value.push('*');
    }
    let mut interval = interval.unwrap_or_else(|| String::from("–"));
    if misses_truth(one) {
        interval.push_str(" †");
    }
    let last = if truth {
        one.error_percent.map_or_else(Cell::nothing, |percent| {
            Cell::number(format!("{percent:+.2} %"))
        })
    } else {
        half_width_percent(one).map_or_else(Cell::nothing, |percent| {
            Cell::number(if percent < LARGEST_PERCENT {
                significant(percent, 2)
            } else {
                format!("> {LARGEST_PERCENT:.0}")
            })
        })
    };
    vec![
        Cell::text(&value).class("n strong"),
        Cell::text(&interval).class("n"),
        last,
    ]
}

/// Essential parameters, if they differ from the results.
fn essential(identification: &Identification, answers: &[&Estimate]) -> String {
    let essential = of_stage(identification, Stage::Essential);
    let same = |one: &&Estimate| {
        let mut answers = answers.iter().filter(|answer| answer.model == one.model);
        answers.any(|answer| {
            let names = |of: &Estimate| -> Vec<String> {
                of.parameters.iter().map(|one| one.name.clone()).collect()
            };
            names(answer) == names(one)
        })
    };
    if essential.iter().all(same) {
        return String::new();
    }
    let counts: Vec<String> = essential
        .iter()
        .map(|one| {
            let answer = answers.iter().find(|answer| answer.model == one.model);
            let recommended = answer.map_or_else(String::new, |answer| {
                format!(
                    " (the {} recommended ones: {})",
                    answer.parameters.len(),
                    relative_words(&answer.lines, answer.relative_error_percent, 3)
                )
            });
            format!(
                "{}: {} parameters, relative residual {}{recommended}.",
                case_heading(one.model),
                one.parameters.len(),
                relative_words(&one.lines, one.relative_error_percent, 3),
            )
        })
        .collect();
    let text = format!(
        "The essential parameters of Briot, Krut and Gautier (2015): the parameter of the largest relative standard deviation is eliminated, again and again, until the largest deviation is less than r_σ = {} times the smallest. The rule tests how precisely a parameter is known, not whether the data need it. It also eliminates parameters that the data determine, which biases the others. {}",
        significant(identification.settings.r_sigma, 4),
        counts.join(" ")
    );
    format!(
        "<h3 id=\"essential\">Parameters by the r_σ rule</h3>\n{}{}",
        paragraph(&text),
        table(identification, &essential)
    )
}

/// All base parameters.
fn base(identification: &Identification) -> String {
    let base = of_stage(identification, Stage::Base);
    let errors: Vec<String> = base
        .iter()
        .map(|one| {
            format!(
                "{} {}",
                one.model.label(),
                relative_words(&one.lines, one.relative_error_percent, 3)
            )
        })
        .collect();
    let summary = format!(
        "All {} base parameters (relative error: {})",
        identification.base_parameters.len(),
        errors.join(", ")
    );
    details(&summary, &table(identification, &base))
}
