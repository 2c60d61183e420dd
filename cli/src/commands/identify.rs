//! `overact identify`: parameters from measured motion and torque, or from the virtual experiment.
//!
//! Measured or virtual, the identification sees positions and torques of the actuators only. The true
//! values of a virtual experiment stand beside the estimates and nowhere in them.

use super::simulate;
use crate::{
    InterpretedRobot,
    experiment::{experiment, true_values},
    failure::{Failure, Problem},
    load::{Robot, load},
    output,
    progress::Progress,
    settings::{mapping, settings},
};
use clap::ValueEnum;
use overact::{Info, Model};
use overact_identification::{
    Experiment, Identification, Log, Mapping, Progress as Stage, Settings, data, identify, report,
};
use overact_simulation::Record;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    file: PathBuf,
    /// Logs (CSV with a header, or MATLAB v5 .mat); without any, the virtual experiment is made
    #[arg(long, value_name = "LOG", num_args = 1..)]
    data: Vec<PathBuf>,
    /// Logs of runs with the payload on the platform
    #[arg(long, value_name = "LOG", num_args = 1..)]
    payload_data: Vec<PathBuf>,
    /// Logs to compare predictions with; names of runs where the experiment is virtual
    #[arg(long, value_name = "LOG", num_args = 1..)]
    cross_validate: Vec<PathBuf>,
    /// The same, with the payload
    #[arg(long, value_name = "LOG", num_args = 1..)]
    cross_validate_payload: Vec<PathBuf>,
    /// Seed of the virtual experiment's noise [default: the description's]
    #[arg(long)]
    seed: Option<u64>,
    /// Friction in both directions of motion [default: the description's]
    #[arg(long, value_enum)]
    friction: Option<Friction>,
    /// Kept actuators of case 2 [default: those of the description]
    #[arg(long, value_delimiter = ',', value_name = "ACTUATORS")]
    kept: Option<Vec<String>>,
    /// Write the report to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// How friction is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Friction {
    /// The same coefficients in both directions, and an offset
    Symmetric,
    /// Coefficients of their own for each direction
    Asymmetric,
}

/// The runs of an identification.
struct Runs {
    runs: Vec<Log>,
    validation: Vec<Log>,
    truth: Option<BTreeMap<String, f64>>,
}

/// Runs the command.
///
/// # Errors
/// Logs that can't be used, a virtual experiment that can't be made, or data that determine nothing.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let robot = load(&arguments.file)?;
    let served = InterpretedRobot::new(robot.model.clone());
    let info = served.info();
    let is_measured = !(arguments.data.is_empty() && arguments.payload_data.is_empty());
    let runs = if is_measured {
        measured(&robot, &info, arguments)?
    } else {
        made(&robot, &served, arguments, as_json)?
    };
    let settings = chosen(&robot, &info, arguments, &runs)?;
    let experiment = Experiment {
        runs: &runs.runs,
        validation: &runs.validation,
        true_values: runs.truth.as_ref(),
    };
    let bar = Progress::new("identifying", as_json);
    let tell = |stage: Stage<'_>| tell(&bar, stage);
    let mut result = identify(&served, &experiment, &settings, &tell)?;
    drop(bar);
    if !robot.description.identification.essential {
        without_essential(&mut result, robot.description.identification.r_sigma);
    }
    let text = if as_json {
        output::json(&result)?
    } else {
        report::report(&result)
    };
    output::emit(&text, arguments.output.as_deref())
}

/// The description's settings with what the command line says otherwise.
fn chosen(
    robot: &Robot,
    info: &Info<'_>,
    arguments: &Arguments,
    runs: &Runs,
) -> Result<Settings, Failure> {
    let frequency = runs.runs.first().map_or(0.0, Log::sampling_frequency);
    let mut settings = settings(robot, info, frequency);
    if let Some(friction) = arguments.friction {
        settings.asymmetric_friction = friction == Friction::Asymmetric;
    }
    if let Some(names) = &arguments.kept {
        settings.kept_actuators = super::kept_actuators(&robot.model, names)?;
    }
    Ok(settings)
}

/// Reads logs; the problems of all of them are reported together.
fn measured(robot: &Robot, info: &Info<'_>, arguments: &Arguments) -> Result<Runs, Failure> {
    let mapping = mapping(robot, info)?;
    let mut failures = Vec::new();
    let mut runs = logs(&arguments.data, &mapping, false, &mut failures);
    runs.extend(logs(&arguments.payload_data, &mapping, true, &mut failures));
    let mut validation = logs(&arguments.cross_validate, &mapping, false, &mut failures);
    validation.extend(logs(
        &arguments.cross_validate_payload,
        &mapping,
        true,
        &mut failures,
    ));
    if failures.is_empty() {
        Ok(Runs {
            runs,
            validation,
            truth: None,
        })
    } else {
        Err(Failure::Several(failures))
    }
}

fn logs(
    paths: &[PathBuf],
    mapping: &Mapping,
    payload: bool,
    failures: &mut Vec<Failure>,
) -> Vec<Log> {
    let mut logs = Vec::new();
    for path in paths {
        match data::read(path, mapping, payload) {
            Ok(log) => logs.push(log),
            Err(error) => failures.push(error.into()),
        }
    }
    logs
}

/// Makes the virtual experiment.
fn made(
    robot: &Robot,
    served: &InterpretedRobot,
    arguments: &Arguments,
    as_json: bool,
) -> Result<Runs, Failure> {
    let (mut virtual_experiment, without_effect) = experiment(robot, &served.info())?;
    if let Some(seed) = arguments.seed {
        virtual_experiment.seed = seed;
    }
    let known: Vec<String> = virtual_experiment
        .runs
        .iter()
        .map(|run| run.name.clone())
        .collect();
    let held = arguments
        .cross_validate
        .iter()
        .chain(&arguments.cross_validate_payload);
    let held: Vec<String> = held.map(|path: &PathBuf| name(path)).collect();
    let unknown = held.iter().filter(|name| !known.contains(name));
    let problems: Vec<Problem> = unknown
        .map(|n| simulate::unknown_run(robot, n, &known))
        .collect();
    if !problems.is_empty() {
        return Err(Failure::Problems(problems));
    }
    simulate::warn(&without_effect);
    let records = simulate::records(robot, served, &virtual_experiment, as_json)?;
    let (validation, runs): (Vec<Record>, Vec<Record>) = records
        .into_iter()
        .partition(|record| held.contains(&record.name));
    let logs = |records: Vec<Record>| records.into_iter().map(log).collect::<Result<Vec<_>, _>>();
    let truth = robot.description.experiment.as_ref().map(|table| {
        // A parameter that the description leaves out is zero in the virtual robot.
        let info = served.info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        let mut truth: BTreeMap<String, f64> = all.map(|p| (p.name.to_owned(), 0.0)).collect();
        truth.extend(true_values(table));
        truth
    });
    Ok(Runs {
        runs: logs(runs)?,
        validation: logs(validation)?,
        truth,
    })
}

fn name(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn log(record: Record) -> Result<Log, overact_identification::Error> {
    let n = record.actuators.len();
    Log::new(
        record.name,
        record.sampling_hz,
        n,
        record.positions,
        record.torques,
        record.payload,
    )
}

/// The base parameters only; the setting that kept the elimination from starting is put back.
fn without_essential(result: &mut Identification, r_sigma: f64) {
    let essential = overact_identification::Stage::Essential;
    result
        .estimates
        .retain(|estimate| estimate.stage != essential);
    result.cross_validation.retain(|one| one.stage != essential);
    result.settings.r_sigma = r_sigma;
}

fn tell(bar: &Progress, stage: Stage<'_>) {
    match stage {
        Stage::Kinematics { run, done, samples } => {
            bar.at(
                done as f64 / samples.max(1) as f64,
                &format!("motion of {run}"),
            );
        }
        Stage::Base => bar.at(0.0, "base parameters"),
        Stage::Equations { model, run } => bar.at(0.3, &format!("{model}: equations of {run}")),
        Stage::Estimation { model } => bar.at(0.8, &format!("{model}: estimation")),
        Stage::Validation { run } => bar.at(0.9, &format!("cross-validation on {run}")),
    }
}
