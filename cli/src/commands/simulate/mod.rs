//! `overact simulate`: writes logs of a virtual experiment, or of a fleet of virtual robots.

mod fleet;

use crate::{
    failure::{Failure, Problem},
    input,
    names::file_stem,
    note::{print_warnings, print_without_effect},
    output::{self, json, print},
    progress::Progress,
};
use overact::Model;
use overact_codegen::diagnostic::Code;
use overact_identification::significant;
use overact_report::layout::columns;
use overact_robot::{VirtualExperiment, read_parameters};
use overact_simulation::{Experiment, Record, write_csv};
use serde::Serialize;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    /// The log; several runs get `log_RUN.csv` each, or `RUN.csv` in a folder. Without it, a single
    /// run goes to stdout
    #[arg(short, long, value_name = "FILE|FOLDER")]
    output: Option<PathBuf>,
    /// Simulate only this run (repeat for others)
    #[arg(long = "run", value_name = "RUN")]
    runs: Vec<String>,
    /// Standard parameters of the virtual robot [default: the description's]
    #[arg(long, value_name = "TOML")]
    parameters: Option<PathBuf>,
    /// Seed of all noise [default: the description's]
    #[arg(long)]
    seed: Option<u64>,
    #[command(flatten)]
    fleet: fleet::Arguments,
}

/// Summary of a simulated run.
#[derive(Debug, Serialize)]
struct Summary {
    name: String,
    file: Option<String>,
    payload: bool,
    samples: usize,
    sampling_hz: f64,
    /// Largest difference between desired and measured position of each actuator (rad, m).
    tracking_error: Vec<f64>,
}

/// Runs the command.
///
/// # Errors
/// A description without an experiment, or a run that fails.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let robot = input::robot(&arguments.file, as_json)?;
    let mut experiment = robot.experiment()?;
    keep_runs(&mut experiment, &arguments.runs)?;
    if let Some(path) = &arguments.parameters {
        let info = robot.model().info();
        let given = read_parameters(path, robot.description(), &info)?;
        print_warnings(&given.warnings, as_json);
        experiment.set_parameters(&given.values);
    }
    if let Some(seed) = arguments.seed {
        experiment.plan_mut().seed = seed;
    }
    if arguments.fleet.fleet.is_some() {
        let folder = arguments.output.as_deref().unwrap_or(Path::new("."));
        print_without_effect(experiment.without_effect(), as_json);
        return fleet::run(&arguments.fleet, &robot, &experiment, folder, as_json);
    }
    let files = files(experiment.plan(), output::file(arguments.output.as_ref()))?;
    let outputs: Vec<&Path> = files.iter().flatten().map(PathBuf::as_path).collect();
    let mut inputs = vec![arguments.file.as_path()];
    inputs.extend(arguments.parameters.as_deref());
    output::check_distinct(&inputs, &outputs)?;
    print_without_effect(experiment.without_effect(), as_json);
    let bar = Progress::new("simulating", as_json);
    let records = experiment.records(&|fraction, run| bar.at(fraction, run))?;
    drop(bar);
    let logs = records.iter().map(csv).collect::<Result<Vec<_>, _>>()?;
    let summaries: Vec<Summary> = { records.iter().zip(&files) }
        .map(|(record, file)| summary(record, file.as_deref()))
        .collect();
    let document = serde_json::json!({ "robot": robot.model().info().name, "runs": summaries });
    if files.iter().all(Option::is_none) && !as_json {
        let text = logs
            .into_iter()
            .map(String::from_utf8)
            .collect::<Result<String, _>>();
        return print(
            &text.map_err(|error| Problem::new(Code::NO_RESULT_TEXT, error.to_string()))?,
        );
    }
    let files = files
        .into_iter()
        .zip(logs)
        .filter_map(|(file, log)| Some((file?, log)));
    let files: Vec<(PathBuf, Vec<u8>)> = files.collect();
    output::make_folders(&files)?;
    output::write(files)?;
    if as_json {
        print(&json(&document)?)
    } else {
        print(&text(&summaries))
    }
}

/// Removes the runs that are not in `names`; keeps all if `names` is empty.
fn keep_runs(experiment: &mut VirtualExperiment<'_>, names: &[String]) -> Result<(), Failure> {
    experiment.check_runs(names)?;
    if !names.is_empty() {
        let runs = &mut experiment.plan_mut().runs;
        runs.retain(|run| names.contains(&run.name));
    }
    Ok(())
}

/// Output file of each run; `None` if the only run goes to stdout.
fn files(experiment: &Experiment, output: Option<&Path>) -> Result<Vec<Option<PathBuf>>, Failure> {
    let runs = &experiment.runs;
    let Some(output) = output else {
        if runs.len() > 1 {
            let message =
                "several runs need output files: add `-o log.csv`, or choose one with `--run`";
            return Err(Failure::Usage(message.to_owned()));
        }
        return Ok(vec![None; runs.len()]);
    };
    let written = output.as_os_str().to_string_lossy();
    let is_folder = output.is_dir() || written.ends_with(std::path::is_separator);
    let file = |run: &str| {
        let run = file_stem(run);
        if is_folder {
            return output.join(format!("{run}.csv"));
        }
        if runs.len() == 1 {
            return output.to_owned();
        }
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        let extension = output
            .extension()
            .map_or("csv".into(), |e| e.to_string_lossy());
        output.with_file_name(format!("{stem}_{run}.{extension}"))
    };
    let files: Vec<PathBuf> = runs.iter().map(|run| file(&run.name)).collect();
    let mut known: BTreeMap<&Path, &str> = BTreeMap::new();
    for (run, file) in runs.iter().zip(&files) {
        if let Some(other) = known.insert(file, &run.name) {
            let message = format!("the runs `{other}` and `{}` would have one file", run.name);
            return Err(Problem::new(Code::MODULES_COLLIDE, message)
                .file(file.display().to_string())
                .into());
        }
    }
    if !is_folder {
        output::check(&[], &[output])?;
    }
    Ok(files.into_iter().map(Some).collect())
}

/// Log of a run as CSV.
fn csv(record: &Record) -> Result<Vec<u8>, Problem> {
    let mut log = Vec::new();
    write_csv(record, &mut log)
        .map_err(|error| Problem::new(Code::NO_RESULT_TEXT, error.to_string()))?;
    Ok(log)
}

/// Summary of a run and the file of its log.
fn summary(record: &Record, file: Option<&Path>) -> Summary {
    Summary {
        name: record.name.clone(),
        file: file.map(|file| file.display().to_string()),
        payload: record.payload,
        samples: record.time.len(),
        sampling_hz: record.sampling_hz,
        tracking_error: record.tracking_error.clone(),
    }
}

/// Table of all runs.
fn text(summaries: &[Summary]) -> String {
    let header = [
        "file",
        "run",
        "samples",
        "Hz",
        "payload",
        "largest tracking errors",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for summary in summaries {
        let errors: Vec<String> = summary
            .tracking_error
            .iter()
            .map(|e| significant(*e, 3))
            .collect();
        rows.push(vec![
            summary.file.clone().unwrap_or_default(),
            summary.name.clone(),
            summary.samples.to_string(),
            summary.sampling_hz.to_string(),
            if summary.payload { "yes" } else { "no" }.to_owned(),
            errors.join(" "),
        ]);
    }
    columns(&rows, &[true, true])
}
