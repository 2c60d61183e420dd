//! Section on the conditioning of the equations, and of the actuators along each run.

use crate::{
    choice::{case_heading, projection, stage_name},
    line_errors::relative,
    page::{
        Contents,
        elements::{
            markup::{Section, figure, key, paragraph},
            table::{Cell, Table},
        },
    },
    plot::{Axis, Chart, Line, Look, Rule},
    text::{escape, last_part},
};
use overact_identification::{ConditionSeries, Identification, ModelKind, RunFigures};

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    if !identification.estimates.is_empty() {
        body.push_str(&table(identification));
    }
    let plots: Vec<String> = identification
        .figures
        .runs
        .iter()
        .filter(|run| !run.conditions.is_empty())
        .map(|run| chart(run, identification.thresholds.partition_condition))
        .collect();
    if !plots.is_empty() {
        let mut caption = String::from(
            "Condition number of the actuators’ Jacobian along each run, the platform’s coordinates scaled to be comparable.",
        );
        let mut keys = String::new();
        let has_kept = has_kept(identification);
        if has_kept {
            caption.push_str(" The actuator projection uses the kept actuators only: where its line is above the dashed limit, they hardly determine the platform’s motion, and it amplifies noise.");
            keys = key(&[
                ("first", "all actuators (platform projection)"),
                ("second", "kept actuators (actuator projection)"),
            ]);
        }
        body.push_str(&figure(
            "figure-conditioning",
            &plots,
            &keys,
            &escape(&caption),
        ));
        if has_kept {
            body.push_str(&paragraph(&crossings(identification)));
        }
    }
    Section {
        id: "conditioning",
        title: "Conditioning",
        body,
    }
}

/// Whether a model with kept actuators exists.
fn has_kept(identification: &Identification) -> bool {
    let series = identification.figures.runs.iter();
    let mut series = series.flat_map(|run| &run.conditions);
    series.any(|one| !is_platform(one))
}

/// Condition numbers of the systems, and the largest one of the kept actuators.
fn table(identification: &Identification) -> String {
    let rows = identification.by_least_squares().map(|one| {
        let partition = one
            .partition
            .as_ref()
            .filter(|_| one.model == ModelKind::Actuators);
        vec![
            Cell::text(case_heading(one.model)),
            Cell::text(stage_name(one.stage)),
            Cell::text(&projection(one)),
            Cell::number(one.parameters.len().to_string()),
            Cell::number(one.equations.to_string()),
            Cell::digits(Some(relative(&one.lines, one.relative_error_percent)), 3),
            Cell::digits(Some(one.condition_number), 3),
            Cell::digits(partition.map(|partition| partition.largest), 3),
            Cell::text(&partition.map_or_else(String::new, |partition| {
                format!("{}, {:.3} s", partition.run, partition.time)
            })),
        ]
    });
    let titles = [
        ("case", ""),
        ("model", ""),
        ("explains", ""),
        ("parameters", "n"),
        ("equations", "n"),
        ("relative error (%)", "n"),
        ("condition number", "n"),
        ("kept actuators at worst", "n"),
        ("where", ""),
    ];
    Table {
        caption: String::from("Condition numbers of the systems of equations"),
        header: vec![
            titles
                .iter()
                .map(|(title, class)| Cell::text(title).class(class))
                .collect(),
        ],
        rows: rows.collect(),
    }
    .html()
}

/// Whether a series belongs to all actuators.
fn is_platform(series: &ConditionSeries) -> bool {
    series.determinant.is_empty()
}

/// Condition numbers along one run.
fn chart(run: &RunFigures, threshold: f64) -> String {
    let lines = run.conditions.iter().map(|series| {
        let (look, label) = if is_platform(series) {
            (Look::First, String::from("all actuators"))
        } else {
            (
                Look::Second,
                format!("kept: {}", series.kept_actuators.join(", ")),
            )
        };
        Line::new(look, label, &run.time, &series.condition)
    });
    Chart {
        title: last_part(&run.run).to_owned(),
        description: format!("condition numbers along the run {}", run.run),
        x: Axis::linear("t (s)"),
        y: Axis::logarithmic("condition number").including(&[1.0]),
        lines: lines.collect(),
        rules: vec![Rule::horizontal(threshold, format!("limit {threshold}"))],
    }
    .svg()
}

/// Singularities: sign changes of the kept actuators' determinant.
fn crossings(identification: &Identification) -> String {
    let mut places = Vec::new();
    for run in &identification.figures.runs {
        for series in &run.conditions {
            let signs = series.determinant.windows(2).zip(&run.time);
            let crossed = signs.filter(|(pair, _)| pair[0] * pair[1] < 0.0);
            let times: Vec<String> = crossed.map(|(_, time)| format!("{time:.2} s")).collect();
            if let Some(first) = times.first() {
                places.push(match times.len() {
                    1 => format!("{} at {first}", run.run),
                    count => format!("{}, {count} times, first at {first}", run.run),
                });
            }
        }
    }
    if places.is_empty() {
        String::from("No run crosses a singularity of the kept actuators.")
    } else {
        format!(
            "A singularity of the kept actuators is crossed: {}. The actuator projection is undefined there and inaccurate nearby, although its relative error may be lower than that of the platform projection.",
            places.join("; ")
        )
    }
}
