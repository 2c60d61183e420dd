//! `overact partitions`: case 2 for every choice of kept actuators, ranked.
//!
//! All choices estimate the same base parameters, so their standard deviations can be compared one by
//! one: the rank is the geometric mean of σ (case 2) by σ (case 1). Below 1, the choice determines the
//! parameters better than case 1 does, which is the question that the paper leaves open.

use super::{choices, runs};
use crate::{
    InterpretedRobot,
    failure::{Failure, Problem},
    load::load_to_serve,
    output,
    progress::Progress,
};
use overact::Model;
use overact_identification::{
    Estimate, Projection, Settings,
    identify::{Prepared, estimate_projection, prepare},
    report::significant,
};
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    file: PathBuf,
    #[command(flatten)]
    runs: runs::Arguments,
    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The document with `--json`.
#[derive(Debug, Serialize)]
struct Document {
    robot: String,
    /// Case 1.
    platform: Row,
    /// Case 2, best first.
    partitions: Vec<Row>,
}

/// How well one projection does.
#[derive(Debug, Serialize)]
struct Row {
    kept_actuators: Vec<String>,
    /// Geometric mean of σ/σ (case 1) over the base parameters.
    deviation_ratio: Option<f64>,
    relative_error_percent: Option<f64>,
    /// Of W, in base parameters.
    condition_number: Option<f64>,
    /// Worst condition of the kept actuators' Jacobian over all runs.
    partition_condition: Option<f64>,
    essential_parameters: Option<usize>,
    /// Why there is no estimate.
    error: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// A robot without redundancy, or as `overact identify`.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    output::check_folder(arguments.output.as_deref())?;
    let robot = load_to_serve(&arguments.file)?;
    let served = InterpretedRobot::new(robot.model.clone());
    let info = served.info();
    if info.sizes.actuators == info.sizes.dof {
        let message = "the robot has no more actuators than degrees of freedom, so there is nothing to choose";
        return Err(Problem::new(message).file(robot.file).into());
    }
    let runs = arguments.runs.runs(&robot, &served, as_json)?;
    let settings = arguments.runs.settings(&robot, &info, &runs);
    let choices = choices(info.sizes.actuators, info.sizes.dof);
    let mut projections = vec![Projection::Platform];
    projections.extend(choices.iter().cloned().map(Projection::Actuators));
    let bar = Progress::new("comparing", as_json);
    let prepared = prepare(&served, &runs.runs, &projections, &settings, &|stage| {
        runs::tell(&bar, stage)
    })?;
    let (platform, reference) = estimated(&prepared, &settings, 0, None)?;
    let mut partitions = Vec::new();
    for (at, kept) in choices.iter().enumerate() {
        let names: Vec<String> = kept.iter().map(|&i| info.actuators[i].to_owned()).collect();
        bar.at(at as f64 / choices.len() as f64, &names.join(", "));
        let row = match estimated(&prepared, &settings, at + 1, Some(&reference)) {
            Ok((row, _)) => row,
            Err(error) => Row::without(names, &error),
        };
        partitions.push(row);
    }
    drop(bar);
    let key = |row: &Row| row.deviation_ratio.unwrap_or(f64::INFINITY);
    partitions.sort_by(|a, b| key(a).total_cmp(&key(b)));
    let document = Document {
        robot: info.name.to_owned(),
        platform,
        partitions,
    };
    let text = if as_json {
        output::json(&document)?
    } else {
        text(&document)
    };
    output::emit(&text, arguments.output.as_deref())
}

/// Standard deviations by name.
type Deviations = BTreeMap<String, f64>;

fn estimated(
    prepared: &Prepared,
    settings: &Settings,
    projection: usize,
    reference: Option<&Deviations>,
) -> Result<(Row, Deviations), overact_identification::Error> {
    let outcome = estimate_projection(prepared, projection, settings, None)?;
    let base = &outcome.base;
    let parameters = base.parameters.iter();
    let deviations: Deviations = parameters
        .map(|p| (p.name.clone(), p.standard_deviation))
        .collect();
    let row = Row {
        kept_actuators: base.kept_actuators.clone(),
        deviation_ratio: mean_ratio(&deviations, reference.unwrap_or(&deviations)),
        relative_error_percent: Some(base.relative_error_percent),
        condition_number: Some(base.condition_number),
        partition_condition: partition_condition(base),
        essential_parameters: Some(outcome.essential.parameters.len()),
        error: None,
    };
    Ok((row, deviations))
}

fn partition_condition(estimate: &Estimate) -> Option<f64> {
    estimate
        .partition
        .as_ref()
        .map(|partition| partition.largest)
}

/// Geometric mean of the ratios of what both hold; none if they share nothing.
fn mean_ratio(deviations: &Deviations, reference: &Deviations) -> Option<f64> {
    let ratio = |(name, deviation): (&String, &f64)| Some((deviation / reference.get(name)?).ln());
    let logarithms: Vec<f64> = deviations
        .iter()
        .filter_map(ratio)
        .filter(|l| l.is_finite())
        .collect();
    let count = logarithms.len();
    (count > 0).then(|| (logarithms.iter().sum::<f64>() / count as f64).exp())
}

impl Row {
    fn without(kept_actuators: Vec<String>, error: &overact_identification::Error) -> Self {
        Self {
            kept_actuators,
            deviation_ratio: None,
            relative_error_percent: None,
            condition_number: None,
            partition_condition: None,
            essential_parameters: None,
            error: Some(error.to_string()),
        }
    }

    fn cells(&self, name: String) -> Vec<String> {
        let number = |value: Option<f64>, digits| {
            value.map_or_else(|| "-".to_owned(), |value| significant(value, digits))
        };
        vec![
            name,
            number(self.deviation_ratio, 4),
            number(self.relative_error_percent, 5),
            number(self.condition_number, 5),
            number(self.partition_condition, 4),
            self.essential_parameters
                .map_or_else(|| "-".to_owned(), |count| count.to_string()),
        ]
    }
}

fn text(document: &Document) -> String {
    let header = [
        "inputs projected on",
        "sigma by case 1",
        "error %",
        "cond W",
        "cond J_a",
        "essential",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    rows.push(document.platform.cells("platform (case 1)".to_owned()));
    rows.extend(
        document
            .partitions
            .iter()
            .map(|row| row.cells(row.kept_actuators.join(", "))),
    );
    let mut text = output::table(&rows, &[true]);
    for row in &document.partitions {
        if let Some(error) = &row.error {
            text += &format!("{}: {error}\n", row.kept_actuators.join(", "));
        }
    }
    text
}
