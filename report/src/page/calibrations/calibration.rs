//! Section on calibrated encoder offsets and lengths.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, capital, details, note, paragraph, with_interval},
        table::{Cell, Table},
    },
};
use overact_identification::{
    CalibratedParameter, Calibration, CalibrationScope, HeldParameter, ParameterKind, significant,
};

/// Section; empty without calibration.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let calibration = contents.identification.calibration.as_ref();
    Section {
        id: "calibration",
        title: "Calibrated encoders and lengths",
        body: calibration.map_or_else(String::new, body),
    }
}

fn body(calibration: &Calibration) -> String {
    let mut html = paragraph(&introduction(calibration));
    if !calibration.estimated.is_empty() {
        html.push_str(&residual(calibration));
        html.push_str(&changes(&calibration.estimated));
        let outcome = if calibration.is_change() {
            "All other results on this page include these changes."
        } else {
            "The estimation has not converged: the other results on this page do not include these changes."
        };
        html.push_str(&note(outcome));
    }
    for remark in &calibration.remarks {
        html.push_str(&note(&capital(&format!("{remark}."))));
    }
    html.push_str(&held(&calibration.held));
    html
}

/// Introduction.
fn introduction(calibration: &Calibration) -> String {
    let (n, r) = (calibration.sensors, calibration.coordinates);
    if n <= r {
        return format!(
            "{n} sensors measure {r} coordinates: no reading is redundant, so nothing can be calibrated."
        );
    }
    let looked_for = match calibration.scope {
        CalibrationScope::Smallest => "the fewest encoder offsets and lengths that explain it",
        CalibrationScope::Offsets => "all encoder offsets that the data determine",
        CalibrationScope::All => "all encoder offsets and lengths that the data determine",
    };
    let found = match calibration.estimated.len() {
        0 => String::from("Nothing is changed."),
        1 => String::from("One value is changed."),
        count => format!("{count} values are changed."),
    };
    format!(
        "{n} sensors measure {r} coordinates, so the measurement of each pose is redundant. If readings contradict each other by more than noise, an encoder or a length differs from its description. Estimated: {looked_for}, from {} samples. {found}",
        calibration.samples
    )
}

/// Closure residuals before and after calibration.
fn residual(calibration: &Calibration) -> String {
    let row = |what: &str, misfit: f64| vec![Cell::text(what), Cell::digits(Some(misfit), 3)];
    let table = Table {
        caption: String::from("Closure residual"),
        header: vec![vec![
            Cell::text("values"),
            Cell::text("times the sensors' noise").class("n"),
        ]],
        rows: vec![
            row("as described", calibration.misfit_before),
            row("as calibrated", calibration.misfit_after),
        ],
    };
    table.html() + &note("Noise alone gives 1.")
}

/// Description of a parameter type.
const fn kind(kind: ParameterKind) -> &'static str {
    match kind {
        ParameterKind::EncoderOffset => "encoder offset",
        ParameterKind::Length => "leg length",
        ParameterKind::PlatformPoint => "attachment point on the platform",
        ParameterKind::BasePoint => "attachment point on the base",
        _ => "other",
    }
}

/// Table of the changes.
fn changes(estimated: &[CalibratedParameter]) -> String {
    let rows = estimated.iter().map(|one| {
        let [low, high] = one.interval_95;
        let (change, interval) = with_interval(one.change, low, high);
        let degrees = (one.unit == "rad").then(|| one.change.to_degrees());
        vec![
            Cell::text(&one.name),
            Cell::text(kind(one.kind)),
            Cell::digits(Some(one.described), 6),
            Cell::number(change),
            interval.map_or_else(Cell::nothing, Cell::number),
            Cell::digits(Some(one.standard_deviation), 2),
            Cell::text(one.unit).class("unit"),
            Cell::digits(degrees, 4),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Calibrated values"),
        header: vec![vec![
            Cell::text("parameter"),
            Cell::text("meaning"),
            right("described"),
            right("change"),
            right("95 % interval of the change"),
            right("σ"),
            Cell::text("unit"),
            right("change (°)"),
        ]],
        rows: rows.collect(),
    };
    let several = estimated.iter().filter(|one| !one.alternatives.is_empty());
    let several = several.map(|one| {
        note(&format!(
            "Instead of `{}`, a change of one of {} explains the data equally well: measure which one is wrong.",
            one.name,
            one.alternatives
                .iter()
                .map(|name| format!("`{name}`"))
                .collect::<Vec<_>>()
                .join(", ")
        ))
    });
    table.html() + &several.collect::<String>()
}

/// Collapsed list of unchanged parameters, grouped by reason.
fn held(held: &[HeldParameter]) -> String {
    if held.is_empty() {
        return String::new();
    }
    let known = held.iter().filter_map(|one| {
        let deviation = one.deviation_of_a_change?;
        let deviation = significant(deviation, 2).replace('-', "−");
        Some(format!("`{}` ({deviation} {})", one.name, one.unit))
    });
    let known: Vec<String> = known.collect();
    let mut html = String::new();
    if !known.is_empty() {
        html.push_str(&paragraph(&format!(
            "Unchanged, with the standard deviation of a change in brackets: {}.",
            known.join(", ")
        )));
    }
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for one in held {
        let Some(reason) = one.reason.as_deref() else {
            continue;
        };
        let name = format!("`{}`", one.name);
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, names)) => names.push(name),
            None => reasons.push((reason, vec![name])),
        }
    }
    for (reason, names) in reasons {
        html.push_str(&paragraph(&format!(
            "Not determined, since {reason}: {}.",
            names.join(", ")
        )));
    }
    let summary = match held.len() {
        1 => String::from("One value is unchanged"),
        count => format!("{count} values are unchanged"),
    };
    details(&summary, &html)
}
