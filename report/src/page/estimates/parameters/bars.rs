//! Plot of all intervals, relative to the true value or to the first estimate.

use std::fmt::Write;

use super::{find, names};
use crate::{
    choice::{case_heading, of, stage_name},
    page::elements::{
        markup::{key, with_interval},
        select::look,
    },
    plot::{Axis, Bar, Forest},
    text::escape,
};
use overact_identification::{Estimate, Identification, ParameterEstimate, Stage};

/// Reach (percent) above which intervals are listed instead of drawn, because they would hide the
/// others.
const LONGEST_BAR: f64 = 100.0;

/// Ratio of the reaches above which well-known parameters get a plot of their own.
const SCALES_APART: f64 = 5.0;

/// A parameter and its intervals.
type Row = (String, Vec<Bar>);

/// Figure; empty if no parameter can be drawn.
pub(super) fn figure(identification: &Identification, estimates: &[&Estimate]) -> String {
    let mut rows = Vec::new();
    let mut left_out = Vec::new();
    let mut to_truth = false;
    let mut moved = false;
    for name in names(identification, estimates) {
        let found = || {
            let own = estimates.iter();
            own.filter_map(|one| Some((*one, find(one, name)?)))
        };
        let truth = found().find_map(|(_, one)| one.true_value);
        let reference = truth.or_else(|| found().next().map(|(_, one)| one.value));
        let Some(reference) = reference.filter(|value| *value != 0.0) else {
            left_out.push(name);
            continue;
        };
        let bar = |(estimate, one): (&Estimate, &ParameterEstimate)| {
            let essential = of(identification, estimate.model, Stage::Essential);
            let essential = essential.and_then(|estimate| find(estimate, name));
            bar(estimate, one, essential, reference)
        };
        let bars: Vec<Bar> = found().map(bar).collect();
        if bars.iter().all(|bar| bar.reach() <= LONGEST_BAR) {
            to_truth |= truth.is_some();
            moved |= bars.iter().any(|bar| bar.other.is_some());
            rows.push((name.to_owned(), bars));
        } else {
            left_out.push(name);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let reference = if to_truth {
        "the true value"
    } else {
        "the first estimate"
    };
    let plot = |rows: Vec<Row>| {
        Forest {
            title: format!("Difference from {reference}"),
            description: format!(
                "estimates of {} parameters with their 95 % intervals, relative to {reference}",
                rows.len()
            ),
            x: Axis::linear(format!("difference from {reference} (%)")).including(&[0.0]),
            rows,
        }
        .svg()
    };
    let plots: Vec<String> = by_reach(rows).into_iter().map(plot).collect();
    let caption = caption(to_truth, moved, &left_out);
    let mut entries: Vec<(&str, &str)> = estimates
        .iter()
        .map(|one| (look(one.model).class(), case_heading(one.model)))
        .collect();
    if moved {
        entries.push(("cross", stage_name(Stage::Essential)));
    }
    crate::page::elements::markup::figure(
        "figure-parameters",
        &plots,
        &key(&entries),
        &escape(&caption),
    )
}

/// Splits rows by reach if one scale would hide the short intervals.
fn by_reach(rows: Vec<Row>) -> Vec<Vec<Row>> {
    let reach = |row: &Row| row.1.iter().map(Bar::reach).fold(0.0, f64::max);
    let farthest = rows.iter().map(reach).fold(0.0, f64::max);
    let (near, far): (Vec<Row>, Vec<Row>) = rows
        .into_iter()
        .partition(|row| reach(row) < farthest / SCALES_APART);
    let parts = [near, far].into_iter();
    parts.filter(|rows| !rows.is_empty()).collect()
}

/// Interval of a parameter relative to a reference, with the essential estimate.
fn bar(
    estimate: &Estimate,
    one: &ParameterEstimate,
    essential: Option<&ParameterEstimate>,
    reference: f64,
) -> Bar {
    let percent = |value: f64| 100.0 * (value - reference) / reference.abs();
    let [low, high] = one.interval_95;
    let (value, interval) = with_interval(one.value, low, high);
    Bar {
        look: look(estimate.model),
        value: percent(one.value),
        interval: one.interval_95.map(percent),
        other: essential.map(|one| percent(one.value)),
        label: format!(
            "{}, {}: {value} {}, 95 % interval {}",
            one.name,
            estimate.model.label(),
            one.unit,
            interval.unwrap_or_else(|| String::from("not known"))
        ),
    }
}

/// Caption: meaning of the intervals, and parameters without one.
fn caption(to_truth: bool, moved: bool, left_out: &[&str]) -> String {
    let mut caption = String::from("Dots are the estimates, lines their 95 % intervals. ");
    caption.push_str(if to_truth {
        "One line in twenty may miss zero, which is the true value."
    } else {
        "Lines of one parameter that do not overlap contradict each other."
    });
    if moved {
        caption.push_str(
            " A cross is the estimate of the r_σ rule; outside the line, the data contradict it.",
        );
    }
    if !left_out.is_empty() {
        let _ = write!(
            caption,
            " Not drawn, since they are zero or their intervals are wider than their values: {}.",
            left_out.join(", ")
        );
    }
    caption
}
