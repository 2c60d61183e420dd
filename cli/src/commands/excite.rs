//! `overact excite`: searches runs that determine the base parameters best within all limits.

use crate::{
    failure::Failure,
    input,
    output::{self, counted, json, print},
    progress::Progress,
};
use overact::{Info, Model};
use overact_identification::significant;
use overact_report::layout::columns;
use overact_robot::{Excitation, ExcitationEffort, JudgedRuns, Limit};
use std::{
    path::{Path, PathBuf},
    time::Duration,
};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    /// Write the description with the computed runs as training runs, `-` to stdout; without it
    /// only the runs go to stdout
    #[arg(short, long, value_name = "TOML")]
    output: Option<PathBuf>,
    /// Number of runs [default: the description's]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=20))]
    runs: Option<u8>,
    /// Seed of the search: equal seeds give equal runs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Stop the search after this time, s; the runs then depend on the machine
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..))]
    time: Option<u32>,
}

/// Runs the command.
///
/// # Errors
/// A description with errors, or limits that no motion keeps.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let written = output::file(arguments.output.as_ref());
    let is_printed = written.is_none() && arguments.output.is_some();
    if is_printed && as_json {
        let message = "--json and `-o -` both go to standard output: give a file";
        return Err(Failure::Usage(message.to_owned()));
    }
    output::check(&[&arguments.file], written.as_slice())?;
    let robot = input::robot(&arguments.file, as_json)?;
    let effort = ExcitationEffort {
        runs: arguments.runs.map(usize::from),
        seed: arguments.seed,
        time: arguments
            .time
            .map(|seconds| Duration::from_secs(seconds.into())),
        ..ExcitationEffort::default()
    };
    let bar = Progress::new("exciting", as_json);
    let found = robot.excite(&effort, &|fraction, run| bar.at(fraction, run))?;
    drop(bar);
    let description = robot.with_runs(&found)?;
    if is_printed {
        return print(&description);
    }
    if let Some(path) = written {
        output::write(vec![(path.to_owned(), description.into_bytes())])?;
    }
    if as_json {
        return print(&json(&found)?);
    }
    print(&text(&found, &robot.model().info(), written))
}

/// Tables of the comparison and the limits, and the runs if they are not written to a file.
fn text(found: &Excitation, info: &Info<'_>, written: Option<&Path>) -> String {
    let heading = format!(
        "{}: {} of {} s together, {}; all rows at this duration\n",
        info.name,
        counted(found.runs.len(), "run", "runs"),
        significant(found.duration, 4),
        counted(found.base_parameters, "base parameter", "base parameters"),
    );
    let mut text = format!("{heading}\n{}\n{}", comparison(found), limits(found));
    for assumed in &found.assumed {
        text += &format!("\nnote: {assumed}");
    }
    match written {
        Some(path) => text + &format!("\nwrote {}", path.display()),
        None => text + "\n" + &found.tables,
    }
}

/// Names and results of the sets of runs.
fn sets(found: &Excitation) -> impl Iterator<Item = (String, &JudgedRuns)> {
    let described = found.described.iter();
    let described = described.map(|runs| ("described".to_owned(), runs));
    let random = format!("best of {} random", found.hundred.len());
    described.chain([(random, &found.random), ("found".to_owned(), &found.found)])
}

/// Table of how well each set determines the parameters.
fn comparison(found: &Excitation) -> String {
    let header = [
        "runs",
        "model",
        "condition number",
        "log det",
        "relative deviations: min",
        "median",
        "max",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for (name, runs) in sets(found) {
        for case in &runs.cases {
            let mut row = vec![
                name.clone(),
                case.model.label().to_owned(),
                significant(case.condition, 3),
                format!("{:.1}", case.log_det),
            ];
            row.extend(match case.deviations {
                Some(all) => all
                    .map(|one| format!("{} %", significant(100.0 * one, 2)))
                    .to_vec(),
                None => vec!["-".to_owned(); 3],
            });
            rows.push(row);
        }
    }
    columns(&rows, &[true, true])
}

/// Table of each set's use of the limits.
fn limits(found: &Excitation) -> String {
    let names = sets(found).map(|(name, _)| name);
    let mut header = vec!["limit".to_owned(), "largest".to_owned(), String::new()];
    header.extend(names);
    let mut rows = vec![header];
    for (index, limit) in found.limits.iter().enumerate() {
        let mut row = vec![
            limit.kind.name().to_owned(),
            largest(limit),
            limit.origin.words().to_owned(),
        ];
        let used = sets(found).map(|(_, runs)| runs.limits_used.get(index).copied());
        row.extend(used.map(|used| used.map_or_else(|| "-".to_owned(), percent)));
        rows.push(row);
    }
    columns(&rows, &[true, true, true])
}

/// Fraction of a limit in percent, rounded up so that violations are visible.
fn percent(used: f64) -> String {
    format!("{:.1} %", (1000.0 * used).ceil() / 10.0)
}

/// Limit of each coordinate or actuator; one number if all are equal.
fn largest(limit: &Limit) -> String {
    let numbers = limit.values.iter().map(|value| significant(*value, 3));
    let mut all: Vec<(String, &str)> = numbers.zip(limit.units.iter().copied()).collect();
    if all.windows(2).all(|pair| pair[0] == pair[1]) {
        all.truncate(1);
    }
    let mut text = String::new();
    for (index, (number, unit)) in all.iter().enumerate() {
        let last = all.get(index + 1).is_none_or(|(_, next)| next != unit);
        let unit = if last { *unit } else { "" };
        text += format!("{number} {unit}").trim_end();
        text.push(' ');
    }
    text.trim_end().to_owned()
}
