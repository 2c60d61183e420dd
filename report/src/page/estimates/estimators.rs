//! Section that compares least squares, instrumental variables and total least squares.
//!
//! It shows whether noise of the measured positions biases the estimates.

use crate::{
    choice::case_heading,
    page::{
        Contents,
        elements::{
            markup::{Section, details, note, paragraph, prose},
            table::{Cell, Table},
        },
    },
    text::escape,
};
use overact_identification::{
    Agreement, ErrorsInRegressor, Instruments, RegressorError, significant,
};

/// Section; empty if nothing was tested.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let all = &contents.identification.errors_in_regressor;
    let tested = all.iter().any(|comparison| comparison.agreement.is_some());
    let mut body = String::new();
    if tested {
        body.push_str(&paragraph(
            "Least squares assumes an exact measured motion. Position noise biases its estimates, and longer runs do not reduce that bias. Instruments are regressor columns that correlate with the motion but not with its noise. Estimates by instrumental variables have no such bias but a larger variance. If both agree, position noise is harmless. Total least squares allows errors in all columns and is shown for comparison only.",
        ));
        body.extend(all.iter().map(of_model));
    }
    Section {
        id: "estimators",
        title: "Does position noise bias the estimates?",
        body,
    }
}

/// Results for one model.
fn of_model(comparison: &ErrorsInRegressor) -> String {
    let heading = format!("<h3>{}</h3>\n", escape(case_heading(comparison.model)));
    let outcome = match (&comparison.agreement, &comparison.missing) {
        (Some(agreement), _) => verdict(comparison, agreement),
        (None, Some(why)) => format!("Not tested: {why}."),
        (None, None) => String::from("Not tested."),
    };
    let mut html = heading + &paragraph(&outcome);
    let differs = comparison.agreement.as_ref().is_some_and(|one| one.differs);
    if differs && !comparison.parameters.iter().any(|one| one.spoiled) {
        html.push_str(&paragraph("No difference exceeds the standard deviation of least squares, so the bias does not matter."));
    }
    let (differing, rest): (Vec<_>, Vec<_>) =
        comparison.parameters.iter().partition(|one| one.differs);
    if !differing.is_empty() {
        html.push_str(&table("Base parameters that differ", &differing));
        html.push_str(&note(
            "A difference in bold also exceeds the standard deviation of least squares: use the estimate by instruments. The bias of the others is smaller than their standard deviation.",
        ));
    }
    if !rest.is_empty() {
        let summary = match rest.len() {
            1 => String::from("One base parameter agrees"),
            count => format!("{count} base parameters agree"),
        };
        html.push_str(&details(
            &summary,
            &table("Base parameters that agree", &rest),
        ));
    }
    html
}

/// Whether least squares and instrumental variables agree, in words.
fn verdict(comparison: &ErrorsInRegressor, agreement: &Agreement) -> String {
    let source = match comparison.instruments {
        Instruments::Periods => "the other periods of the same motion",
        Instruments::Simulated => "the motion of the simulated robot",
        Instruments::None => "none",
    };
    let outcome = if agreement.differs {
        "Least squares and instruments differ by more than chance"
    } else {
        "Least squares and instruments agree"
    };
    let exceeds = if agreement.together {
        "chance alone gives such a difference"
    } else {
        "chance alone gives one of the parameters such a difference"
    };
    format!(
        "{outcome}: {exceeds} with a probability of {} (limit {}). The instruments are {source}.",
        significant(agreement.probability, 2),
        significant(agreement.level, 2)
    )
}

/// Parameters by all three estimators.
fn table(caption: &str, parameters: &[&RegressorError]) -> String {
    let rows = parameters.iter().map(|one| {
        let difference = one.instruments - one.least_squares;
        let ratio = difference / one.difference_deviation;
        let class = if one.spoiled { "n strong" } else { "n" };
        vec![
            Cell::text(&one.name),
            Cell::markup(prose(&one.unit)).class("unit"),
            Cell::digits(Some(one.least_squares), 5),
            Cell::digits(Some(one.instruments), 5),
            Cell::digits(one.total_least_squares, 5),
            Cell::digits(Some(difference), 2).class(class),
            Cell::digits(ratio.is_finite().then_some(ratio), 2),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    Table {
        caption: caption.to_owned(),
        header: vec![vec![
            Cell::text("parameter"),
            Cell::text("unit"),
            right("least squares"),
            right("instruments"),
            right("total least squares"),
            right("difference of the first two"),
            right("in its σ"),
        ]],
        rows: rows.collect(),
    }
    .html()
}
