//! Section with measured and predicted Γ over time (Figs. 5 and 6 of the paper).
//!
//! The plots of measured and predicted torques (Figs. 8 and 9) share its functions.

use crate::{
    choice::{answers, case_heading, is_answer, stage_name},
    page::{
        Contents,
        elements::{
            markup::{Section, details, figure, key},
            select::{durations, relative_error, worst_part},
        },
    },
    plot::{Axis, Chart, Line, Look},
    text::escape,
    units::{Units, with_unit},
};
use overact_identification::{ModelKind, PredictionFigures, Series, significant};

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    for estimate in answers(identification) {
        let all: Vec<&PredictionFigures> = identification
            .figures
            .predictions
            .iter()
            .filter(|one| one.model == estimate.model && one.stage == estimate.stage)
            .filter(|one| one.identified && !one.lines.is_empty())
            .collect();
        // Fig. 5 shows a run with payload, if there is one.
        let loaded = |one: &&PredictionFigures| {
            let mut runs = identification.figures.runs.iter();
            runs.any(|run| run.run == one.run && run.payload)
        };
        let shown = all.iter().position(loaded).unwrap_or(0);
        let mut others = String::new();
        for (index, one) in all.iter().enumerate() {
            let id = format!("figure-inputs-{}-{}", one.model, index + 1);
            let figure = compared(&id, one, &one.lines, "Γ", contents.units);
            let heading = format!("{}: {}", case_heading(one.model), one.run);
            if index == shown {
                body.push_str(&format!("<h3>{}</h3>\n{figure}", escape(&heading)));
            } else {
                others.push_str(&details(&heading, &figure));
            }
        }
        body.push_str(&others);
    }
    Section {
        id: "inputs",
        title: if answers(identification)
            .iter()
            .all(|one| one.model == ModelKind::Joints)
        {
            "Measured and predicted torques"
        } else {
            "Measured and predicted torques, projected"
        },
        body,
    }
}

/// Plot of the torque with the largest relative error of the first model, on a validation run if
/// there is one; `None` without torques.
pub(crate) fn first(contents: &Contents<'_>) -> Option<String> {
    let identification = contents.identification;
    let model = answers(identification).first()?.model;
    let all = identification.figures.predictions.iter().filter(|one| {
        one.model == model
            && !one.torques.is_empty()
            && is_answer(identification, one.model, one.stage)
    });
    let all: Vec<&PredictionFigures> = all.collect();
    let held_out = all.iter().find(|one| !one.identified);
    let shown = held_out.or_else(|| all.first())?;
    let error = |one: &&Series| relative_error(one).unwrap_or(0.0);
    let worst = shown.torques.iter();
    let worst = worst.max_by(|a, b| error(a).total_cmp(&error(b)))?;
    Some(compared(
        "figure-first",
        shown,
        std::slice::from_ref(worst),
        "τ",
        contents.units,
    ))
}

/// Torque plots of one run, validation runs first.
pub(crate) fn torques(contents: &Contents<'_>) -> String {
    let identification = contents.identification;
    let all = || {
        let predictions = identification.figures.predictions.iter();
        predictions.filter(|one| {
            !one.torques.is_empty() && is_answer(identification, one.model, one.stage)
        })
    };
    let held_out = all().filter(|one| !one.identified);
    let mut ordered: Vec<&PredictionFigures> = held_out.collect();
    if ordered.is_empty() {
        ordered = all().collect();
    }
    let mut body = String::new();
    for (index, one) in ordered.iter().enumerate() {
        let id = format!("figure-torques-{}", index + 1);
        let figure = compared(&id, one, &one.torques, "τ", contents.units);
        let heading = format!(
            "{}, {} of {}",
            one.run,
            stage_name(one.stage),
            one.model.label()
        );
        // Runs of the first model are shown, all others are collapsed.
        if ordered
            .first()
            .is_some_and(|first| first.model == one.model)
            && index < 2
        {
            body.push_str(&format!("<h3>{}</h3>\n{figure}", escape(&heading)));
        } else {
            body.push_str(&details(&heading, &figure));
        }
    }
    body
}

/// Figure of several measured and predicted series.
fn compared(
    id: &str,
    prediction: &PredictionFigures,
    series: &[Series],
    symbol: &str,
    units: &Units,
) -> String {
    let part = worst_part(series);
    let plot = |one: &Series| {
        let cut = |values: &[f64]| values.get(part.clone()).unwrap_or_default().to_vec();
        let (time, measured, predicted) = (cut(&one.time), cut(&one.measured), cut(&one.predicted));
        let residual: Vec<f64> = measured
            .iter()
            .zip(&predicted)
            .map(|(m, p)| m - p)
            .collect();
        let error = relative_error(one);
        let error = error.map(|error| format!(": {} %", significant(error, 3)));
        Chart {
            title: format!("{}{}", one.name, error.unwrap_or_default()),
            description: format!(
                "measured and predicted {symbol} of {} in the run {}",
                one.name, prediction.run
            ),
            x: Axis::linear("t (s)"),
            y: Axis::linear(with_unit(symbol, units.torque(&one.name))),
            lines: vec![
                Line::new(Look::Measured, "measured", &time, &measured),
                Line::new(Look::Predicted, "predicted", &time, &predicted),
                Line::new(Look::Residual, "difference", &time, &residual),
            ],
            rules: Vec::new(),
        }
        .svg()
    };
    let plots: Vec<String> = series.iter().map(plot).collect();
    let (shown, whole) = series
        .first()
        .map_or((0.0, 0.0), |one| durations(one, &part));
    let which = if shown < whole {
        format!(
            "The {} s of the run’s {} s with the largest prediction error.",
            significant(shown, 2),
            significant(whole, 3)
        )
    } else {
        format!("The whole run of {} s.", significant(whole, 3))
    };
    let caption = format!(
        "{which} The broad line is measured, the thin one predicted. The difference should look like noise around zero. The titles give the relative error of the whole run."
    );
    let keys = key(&[
        ("measured", "measured"),
        ("predicted", "predicted"),
        ("residual", "difference"),
    ]);
    figure(id, &plots, &keys, &escape(&caption))
}
