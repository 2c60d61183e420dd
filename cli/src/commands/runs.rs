//! The runs of an identification: measured logs, or the virtual experiment.

use super::simulate;
use crate::{
    failure::{Failure, Problem},
    progress::Progress,
};
use clap::ValueEnum;
use overact::{Info, Model};
use overact_identification::{Log, Progress as Stage, Settings, data};
use overact_robot::{
    Error, InterpretedRobot,
    experiment::{experiment, true_values},
    load::Robot,
    settings::{mapping, settings},
};
use overact_simulation::Record;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

/// Where the runs come from.
#[derive(Debug, clap::Args)]
#[group(id = "runs")]
pub(super) struct Arguments {
    /// Logs (CSV with a header, or MATLAB v5 .mat); without any, the virtual experiment is made
    #[arg(long, value_name = "LOG", num_args = 1..)]
    data: Vec<PathBuf>,
    /// Logs of runs with the payload on the platform
    #[arg(long, value_name = "LOG", num_args = 1..)]
    payload_data: Vec<PathBuf>,
    /// Logs to compare predictions with; names of runs where the experiment is virtual [default: those
    /// that the description holds out]
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
}

/// How friction is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Friction {
    /// The same coefficients in both directions, and an offset
    Symmetric,
    /// Coefficients of their own for each direction
    Asymmetric,
}

/// The runs.
pub(super) struct Runs {
    /// Those to identify from.
    pub(super) runs: Vec<Log>,
    /// Those to cross-validate on.
    pub(super) validation: Vec<Log>,
    /// True values of the parameters of a virtual robot.
    pub(super) truth: Option<BTreeMap<String, f64>>,
}

impl Arguments {
    /// Whether the runs are those of the virtual experiment.
    pub(super) fn are_virtual(&self) -> bool {
        self.data.is_empty() && self.payload_data.is_empty()
    }

    /// Reads the logs, or makes the virtual experiment.
    ///
    /// # Errors
    /// Logs that can't be used, or a virtual experiment that can't be made.
    pub(super) fn runs(
        &self,
        robot: &Robot,
        served: &InterpretedRobot,
        as_json: bool,
    ) -> Result<Runs, Failure> {
        if self.are_virtual() {
            self.made(robot, served, as_json)
        } else {
            self.measured(robot, &served.info(), as_json)
        }
    }

    /// The description's settings with what the command line says otherwise.
    pub(super) fn settings(&self, robot: &Robot, info: &Info<'_>, runs: &Runs) -> Settings {
        let frequency = runs.runs.first().map_or(0.0, Log::sampling_frequency);
        let mut settings = settings(robot, info, frequency);
        if let Some(friction) = self.friction {
            settings.asymmetric_friction = friction == Friction::Asymmetric;
        }
        settings
    }

    /// Reads logs; the problems of all of them are reported together.
    fn measured(&self, robot: &Robot, info: &Info<'_>, as_json: bool) -> Result<Runs, Failure> {
        let mapping = mapping(robot, info)?;
        let of = |paths: &[PathBuf], payload| -> Vec<(PathBuf, bool)> {
            paths.iter().map(|path| (path.clone(), payload)).collect()
        };
        let own = [of(&self.data, false), of(&self.payload_data, true)].concat();
        let (plain, loaded) = (&self.cross_validate, &self.cross_validate_payload);
        let others = [of(plain, false), of(loaded, true)].concat();
        let files: Vec<(&Path, bool)> = own
            .iter()
            .chain(&others)
            .map(|(path, payload)| (path.as_path(), *payload))
            .collect();
        let mut failures: Vec<Error> = Vec::new();
        let mut logs = Vec::new();
        let bar = Progress::new("reading", as_json);
        let tell = |part: f64| bar.at(part, "");
        for log in data::read_all(&files, &mapping, &tell) {
            match log {
                Ok(log) => logs.push(log),
                Err(error) => failures.push(error.into()),
            }
        }
        if failures.is_empty() {
            let validation = logs.split_off(own.len());
            Ok(Runs {
                runs: logs,
                validation,
                truth: None,
            })
        } else {
            Err(failures.into())
        }
    }

    /// Makes the virtual experiment.
    fn made(
        &self,
        robot: &Robot,
        served: &InterpretedRobot,
        as_json: bool,
    ) -> Result<Runs, Failure> {
        let (mut virtual_experiment, without_effect) = experiment(robot, &served.info())?;
        if let Some(seed) = self.seed {
            virtual_experiment.seed = seed;
        }
        let runs = &virtual_experiment.runs;
        let known: Vec<String> = runs.iter().map(|run| run.name.clone()).collect();
        let held = self
            .cross_validate
            .iter()
            .chain(&self.cross_validate_payload);
        let mut held: Vec<String> = held.map(|path| name(path)).collect();
        let unknown = held.iter().filter(|name| !known.contains(name));
        let problems: Vec<Problem> = unknown
            .map(|name| simulate::unknown_run(robot, name, &known))
            .collect();
        if !problems.is_empty() {
            return Err(problems.into());
        }
        if held.is_empty() {
            held = held_out(robot);
        }
        simulate::warn(&without_effect, as_json);
        let records = simulate::records(robot, served, &virtual_experiment, as_json)?;
        let (validation, runs): (Vec<Record>, Vec<Record>) = records
            .into_iter()
            .partition(|record| held.contains(&record.name));
        let logs =
            |records: Vec<Record>| records.into_iter().map(log).collect::<Result<Vec<_>, _>>();
        let truth = truth(robot, &served.info());
        Ok(Runs {
            runs: logs(runs)?,
            validation: logs(validation)?,
            truth,
        })
    }
}

/// Names of the runs that the description holds out.
pub(super) fn held_out(robot: &Robot) -> Vec<String> {
    let table = robot.description.experiment.as_ref();
    let runs = table.iter().flat_map(|table| &table.runs);
    let held = runs.filter(|run| run.validation);
    held.map(|run| run.name.value.clone()).collect()
}

/// True values of all parameters: one that the description leaves out is zero in the virtual robot.
fn truth(robot: &Robot, info: &Info<'_>) -> Option<BTreeMap<String, f64>> {
    let table = robot.description.experiment.as_ref()?;
    let all = info.parameters.iter().chain(info.payload_parameters);
    let mut truth: BTreeMap<String, f64> = all.map(|p| (p.name.to_owned(), 0.0)).collect();
    truth.extend(true_values(table));
    Some(truth)
}

fn name(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn log(record: Record) -> Result<Log, overact_identification::Error> {
    let n = record.actuators.len();
    let (positions, torques) = (record.positions, record.torques);
    Log::new(
        record.name,
        record.sampling_hz,
        n,
        positions,
        torques,
        record.payload,
    )
}

/// Shows what the identification is doing.
pub(super) fn tell(bar: &Progress, stage: Stage<'_>) {
    let part = |done: usize, samples: usize| done as f64 / samples.max(1) as f64;
    match stage {
        Stage::Base => bar.at(0.0, "base parameters"),
        Stage::Run { run, done, samples } => bar.at(part(done, samples), run),
        Stage::Estimation { model } => bar.at(1.0, &format!("{model}: estimation")),
        Stage::Validation { run, done, samples } => {
            bar.at(part(done, samples), &format!("cross-validation on {run}"));
        }
    }
}
