//! Section on the residuals: over time, autocorrelation and spectrum.

use crate::{
    choice::{case_heading, is_answer, stage_name},
    line_errors::{ErrorRow, cells, rows},
    page::{
        Contents,
        elements::{
            markup::{Section, details, figure, note, paragraph},
            select::look,
            table::{Cell, Table},
        },
    },
    plot::{Axis, Chart, Line, Look, Rule},
    text::{escape, last_part},
    units::Units,
};
use overact_identification::{
    Identification, LineResidual, ResidualFigures, ResidualSeries, significant,
};

/// Fraction of autocorrelations within the 95 % bound from which a residual counts as white.
const WHITE: f64 = 0.9;

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let mut body = String::new();
    let all = identification.figures.residuals.iter();
    let shown = all.filter(|one| is_answer(identification, one.model, one.stage));
    for (index, one) in shown.enumerate() {
        let figure = residuals(one, contents.units);
        let heading = format!("{}: {}", case_heading(one.model), stage_name(one.stage));
        if index == 0 {
            body.push_str(&format!("<h3>{}</h3>\n{figure}", escape(&heading)));
        } else {
            body.push_str(&details(&heading, &figure));
        }
    }
    if !body.is_empty() {
        let introduction = "Measured minus predicted torques. A residual of noise alone is white: not autocorrelated, with equal power at all frequencies. Effects that the model lacks appear here: other friction, ripple of the drives, flexibility. The intervals of the parameters allow for autocorrelation.";
        body = paragraph(introduction) + &body;
    }
    body = table(identification) + &body;
    Section {
        id: "residuals",
        title: "Residuals",
        body,
    }
}

/// Root mean square, relative error and fit of every line and drive.
fn table(identification: &Identification) -> String {
    let rows = rows(identification);
    if rows.is_empty() {
        return String::new();
    }
    let row = |one: &ErrorRow<'_>| {
        let mut row = vec![
            Cell::text(one.name),
            Cell::text(one.model.unwrap_or_default()),
            Cell::text(one.unit).class("unit"),
        ];
        for error in [one.training, one.validation] {
            row.extend(cells(error).map(Cell::number));
        }
        row
    };
    let groups = [("", 3), ("training runs", 3), ("worst validation run", 3)];
    let groups = groups.map(|(title, columns)| Cell::text(title).over(columns).class("group"));
    let titles = ["residual of", "case", "unit"].map(Cell::text).to_vec();
    let figures = ["RMS", "relative error (%)", "NRMSE fit (%)"];
    let figures = [figures, figures].concat();
    let figures = figures.iter().map(|title| Cell::text(title).class("n"));
    let table = Table {
        caption: String::from("Residual of every line and drive"),
        header: vec![groups.to_vec(), titles.into_iter().chain(figures).collect()],
        rows: rows.iter().map(row).collect(),
    };
    table.html()
        + &note(
            "RMS: root mean square of measured minus predicted, after filters and decimation. Relative error: its norm divided by that of the measurement. NRMSE fit: 100 (1 − ‖e‖/‖y − ȳ‖).",
        )
}

/// Figure of one estimate.
fn residuals(one: &ResidualFigures, units: &Units) -> String {
    let plots: Vec<String> = one
        .lines
        .iter()
        .flat_map(|line| {
            [
                over_time(one, line, units),
                autocorrelation(one, line),
                spectrum(one, line, units),
            ]
        })
        .flatten()
        .collect();
    if plots.is_empty() {
        return String::new();
    }
    let colours: Vec<String> = one
        .lines
        .iter()
        .map(|line| {
            let colour = if line.within_bound >= WHITE {
                "white"
            } else {
                "correlated"
            };
            let percent = significant(100.0 * line.within_bound, 2);
            format!("{} {colour} ({percent} % within)", line.name)
        })
        .collect();
    let caption = format!(
        "For each coordinate: the residual of the run in which it is largest; its autocorrelation, which lies between the dashed lines for 95 % of all lags if the residual is white; its power spectral density. {}: {}.",
        case_heading(one.model),
        colours.join(", ")
    );
    figure(
        &format!("figure-residuals-{}", one.model),
        &plots,
        "",
        &escape(&caption),
    )
}

/// Residual of the run with the largest one.
fn over_time(one: &ResidualFigures, line: &LineResidual, units: &Units) -> Option<String> {
    let size = |run: &ResidualSeries| {
        let squares: f64 = run.residual.iter().map(|value| value * value).sum();
        squares / run.residual.len().max(1) as f64
    };
    let worst = line
        .runs
        .iter()
        .filter(|run| !run.residual.is_empty())
        .max_by(|a, b| size(a).total_cmp(&size(b)))?;
    Some(
        Chart {
            title: format!("{}: {}", line.name, last_part(&worst.run)),
            description: format!(
                "residual of {} over time in the run {}",
                line.name, worst.run
            ),
            x: Axis::linear("t (s)"),
            y: Axis::linear(format!("residual{}", bracketed(units.torque(&line.name)))),
            lines: vec![Line::new(
                Look::Residual,
                format!("residual, {}", one.model.label()),
                &worst.time,
                &worst.residual,
            )],
            rules: Vec::new(),
        }
        .svg(),
    )
}

/// ` (N)`, or nothing if the unit is unknown.
fn bracketed(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" ({unit})")
    }
}

fn autocorrelation(one: &ResidualFigures, line: &LineResidual) -> Option<String> {
    if line.autocorrelation.is_empty() {
        return None;
    }
    let lags: Vec<f64> = (0..line.autocorrelation.len())
        .map(|lag| lag as f64 * line.lag_s)
        .collect();
    Some(
        Chart {
            title: format!("{}: autocorrelation", line.name),
            description: format!("autocorrelation of the residual of {}", line.name),
            x: Axis::linear("lag (s)"),
            y: Axis::linear("").including(&[0.0, 1.0]),
            lines: vec![Line::new(
                look(one.model),
                "autocorrelation",
                &lags,
                &line.autocorrelation,
            )],
            rules: vec![
                Rule::horizontal(line.white_bound, "95 % of white noise"),
                Rule::horizontal(-line.white_bound, ""),
            ],
        }
        .svg(),
    )
}

fn spectrum(one: &ResidualFigures, line: &LineResidual, units: &Units) -> Option<String> {
    if line.power.is_empty() {
        return None;
    }
    let unit = units.torque(&line.name);
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!("({unit})²/Hz")
    };
    Some(
        Chart {
            title: format!("{}: spectrum", line.name),
            description: format!("power spectral density of the residual of {}", line.name),
            x: Axis::linear("frequency (Hz)").including(&[0.0]),
            y: Axis::logarithmic(unit),
            lines: vec![Line::new(
                look(one.model),
                "power spectral density",
                &line.frequency_hz,
                &line.power,
            )],
            rules: Vec::new(),
        }
        .svg(),
    )
}
