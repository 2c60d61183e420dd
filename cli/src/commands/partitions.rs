//! `overact partitions`: ranks all partitions for the actuator projection.

use crate::{
    failure::{Failure, Problem},
    input,
    measurements::runs,
    output,
    progress::Progress,
};
use overact::Model;
use overact_codegen::diagnostic::Code;
use overact_identification::{Progress as Doing, RankedProjection, Study, significant};
use overact_report::layout::{columns, paragraph};
use overact_robot::Identifier;
use std::path::PathBuf;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    #[command(flatten)]
    runs: runs::Arguments,
    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// A robot without redundancy, or as `overact identify`.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let inputs = arguments.runs.inputs(&arguments.file);
    output::check(&inputs, arguments.output.as_deref().as_slice())?;
    let robot = input::robot(&arguments.file, as_json)?;
    let sizes = robot.model().info().sizes;
    if sizes.actuators == sizes.dof {
        let message =
            "the robot has no more actuators than degrees of freedom, so there is no choice";
        return Err(Problem::new(Code::NO_REDUNDANCY, message)
            .file(robot.file())
            .into());
    }
    let runs = arguments.runs.runs(&robot, as_json)?;
    let settings = arguments.runs.settings(&robot, &runs);
    let bar = Progress::new("comparing", as_json);
    let tell = |doing: Doing<'_>| runs::tell(&bar, doing);
    let identifier = Identifier::new(&robot).data(&runs).settings(settings);
    let result = identifier.progress(&tell).study()?;
    drop(bar);
    let text = if as_json {
        output::json(&result)?
    } else {
        text(&result)
    };
    output::emit(&text, arguments.output.as_deref())
}

/// Row of the table.
fn cells(row: &RankedProjection, name: String) -> Vec<String> {
    let number = |value: Option<f64>, digits| {
        value.map_or_else(|| "-".to_owned(), |value| significant(value, digits))
    };
    let crossings = row.partition.as_ref().map(|partition| partition.crossings);
    let count = |count: Option<usize>| count.map_or_else(|| "-".to_owned(), |c| c.to_string());
    let ranks = row
        .ranks
        .map(|ranks| ranks.map(|rank| rank.to_string()).join(" "));
    vec![
        name,
        number(row.partition_condition, 4),
        count(crossings),
        number(row.deviation_ratio, 4),
        number(row.deviation_sum_percent, 4),
        number(row.error_sum_percent, 4),
        number(row.held_out_percent, 4),
        number(row.torque_percent, 4),
        number(row.relative_error_percent, 4),
        number(row.condition_number, 5),
        count(row.essential_parameters),
        ranks.unwrap_or_else(|| "-".to_owned()),
    ]
}

fn text(study: &Study) -> String {
    let header = [
        "inputs projected on",
        "cond J_a",
        "crossings",
        "sigma by platform",
        "sum sigma %",
        "sum error %",
        "validation %",
        "torques %",
        "error %",
        "cond W",
        "essential",
        "ranks",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    rows.push(cells(&study.platform, "platform".to_owned()));
    let partitions = study.partitions.iter();
    rows.extend(partitions.map(|row| cells(row, row.kept_actuators.join(", "))));
    let mut text = columns(&rows, &[true]);
    text += "ranks: by conditioning, parameters, prediction; unreliable choices are last\n";
    text += "`docs/cli.md` explains the columns\n";
    for warning in &study.warnings {
        paragraph(&mut text, "", &format!("warning: {warning}"));
    }
    text
}
