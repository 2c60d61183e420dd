//! `overact factor`: computes R factors of logs.

use crate::{
    failure::Failure,
    measurements::{dates::instant, runs},
    output,
    progress::Progress,
};
use overact_identification::{
    Log, Progress as Doing,
    factors::{Origin, write_factors},
};
use overact_robot::Robot;
use std::path::PathBuf;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    /// Logs, as for `overact identify --data`
    #[arg(value_name = "LOG", required_unless_present = "payload_data")]
    data: Vec<PathBuf>,
    /// Logs of runs with the payload on the platform; `NAME=LOG` if the description names several
    /// payloads, `A+B=LOG` for two at once
    #[arg(long, value_name = "LOG", num_args = 1..)]
    payload_data: Vec<PathBuf>,
    /// Serial number of the robot
    #[arg(long, default_value = "")]
    serial: String,
    /// Start of each run, in the order of the logs, those with payload last: `2026-03-02` or
    /// `2026-03-02T14:05:00`, UTC
    #[arg(long, value_name = "TIME", num_args = 1..)]
    time: Vec<String>,
    /// Recording session of each log, in the same order, such as its day; intervals from sessions
    /// of several factor files contain the changes of the robot between them
    #[arg(long, value_name = "NAME", num_args = 1..)]
    sessions: Vec<String>,
    /// Also store successive equations, for the standard deviations of the logs: larger files
    #[arg(long)]
    equations: bool,
    /// The factor file
    #[arg(short, long, value_name = "PARQUET")]
    output: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// Logs that cannot be used, or invalid times.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let runs = runs::Arguments::of_logs(
        arguments.data.clone(),
        arguments.payload_data.clone(),
        arguments.sessions.clone(),
    );
    let logs = arguments.data.len() + arguments.payload_data.len();
    if !arguments.time.is_empty() && arguments.time.len() != logs {
        let message = format!(
            "`--time` gives {} times for {logs} logs",
            arguments.time.len()
        );
        return Err(Failure::Usage(message));
    }
    let times = arguments.time.iter().map(|time| instant(time));
    let times: Vec<i64> = times.collect::<Result<_, _>>()?;
    output::check(&runs.inputs(&arguments.file), &[arguments.output.as_path()])?;
    let robot = Robot::from_toml(&arguments.file)?;
    let found = runs.runs(&robot, as_json)?;
    let origin = Origin {
        serial: arguments.serial.clone(),
        times_us: starts(&found.identified, &times),
    };
    let settings = runs.settings(&robot, &found);
    let bar = Progress::new("factoring", as_json);
    let tell = |doing: Doing<'_>| runs::tell(&bar, doing);
    let made = robot.factors(
        &found.identified,
        &origin,
        &settings,
        arguments.equations,
        &tell,
    )?;
    drop(bar);
    let bytes = write_factors(&made)?;
    let said = if as_json {
        output::json(&serde_json::json!({
            "runs": made.iter().map(|run| &run.summary).collect::<Vec<_>>(),
            "like": made.first().map(|run| &run.settings_hash),
            "bytes": bytes.len(),
        }))?
    } else {
        format!(
            "{}, {} bytes",
            output::counted(made.len(), "run", "runs"),
            bytes.len()
        )
    };
    output::emit_with(&said, None, vec![(arguments.output.clone(), bytes)])
}

/// Start of each run, µs since 1970, from that of each log: a log with gaps has several runs.
fn starts(runs: &[Log], logs: &[i64]) -> Vec<Option<i64>> {
    let mut number = 0;
    let start = |run: &Log| {
        number += usize::from(!run.continues());
        let log = logs.get(usize::checked_sub(number, 1)?)?;
        Some(log + (1e6 * run.start()).round() as i64)
    };
    runs.iter().map(start).collect()
}
