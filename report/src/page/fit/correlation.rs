//! Section on the correlation of the parameters.

use crate::{
    choice::{case_heading, is_answer},
    page::{
        Contents,
        elements::markup::{Section, figure, key, paragraph},
    },
    plot::Heatmap,
    text::escape,
};
use overact_identification::CorrelationFigures;

/// Number of pairs that are named.
const PAIRS: usize = 5;

/// Magnitude from which a pair is named.
const STRONG: f64 = 0.7;

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let all = identification.figures.correlations.iter();
    let shown =
        all.filter(|one| one.names.len() > 1 && is_answer(identification, one.model, one.stage));
    let mut body: String = shown.map(matrix).collect();
    if !body.is_empty() {
        let introduction = "Correlation of the estimates. Two parameters with a coefficient near 1 or −1 affect the torques alike: the data determine a combination of them better than each one. A motion that separates them lowers the coefficient.";
        body = paragraph(introduction) + &body;
    }
    Section {
        id: "correlation",
        title: "Correlation of the parameters",
        body,
    }
}

/// Matrix of one estimate.
fn matrix(one: &CorrelationFigures) -> String {
    let plot = Heatmap {
        title: format!("{}: correlation", case_heading(one.model)),
        description: format!("correlation of {} parameters", one.names.len()),
        names: &one.names,
        rows: &one.correlation,
    };
    let keys = key(&[("positive", "positive"), ("negative", "negative")]);
    let strongest = strongest(one);
    let pairs = if strongest.is_empty() {
        format!("No coefficient exceeds {STRONG}.")
    } else {
        format!("Strongest: {}.", strongest.join("; "))
    };
    let caption = format!(
        "Rows and columns are the parameters in the same order. A saturated colour is a coefficient of ±1. {pairs}"
    );
    figure(
        &format!("figure-correlation-{}", one.model),
        &[plot.svg()],
        &keys,
        &escape(&caption),
    )
}

/// The most correlated pairs with their coefficients.
fn strongest(one: &CorrelationFigures) -> Vec<String> {
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    for (i, row) in one.correlation.iter().enumerate() {
        let below = row.iter().enumerate().take(i);
        let strong = below.filter(|(_, value)| value.abs() >= STRONG);
        pairs.extend(strong.map(|(j, value)| (i, j, *value)));
    }
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    let name = |index: usize| one.names.get(index).map_or("", String::as_str);
    let pairs = pairs.iter().take(PAIRS);
    pairs
        .map(|(i, j, value)| {
            format!("{} and {}: {value:.2}", name(*j), name(*i)).replace(": -", ": −")
        })
        .collect()
}
