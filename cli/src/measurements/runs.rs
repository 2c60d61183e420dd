//! Runs of an identification: measured logs, or the virtual experiment.

use super::{
    payloads::{self, GivenLog, Payloads},
    same,
    streams::Streams,
};
use crate::{failure::Failure, note::print_without_effect, progress::Progress};
use clap::ValueEnum;
use overact_identification::{Log, Progress as Doing, Settings};
use overact_robot::{Error, Robot, Runs};
use std::{
    cell::RefCell,
    path::{Path, PathBuf},
};

/// Where the runs come from.
#[derive(Debug, clap::Args)]
#[group(id = "runs")]
pub(crate) struct Arguments {
    /// Logs (CSV and other text, JSON Lines, MATLAB's .mat up to version 7, NumPy's .npz, Parquet),
    /// `a.csv+b.csv` for one run in two files, `'log.csv[10:60]'` for a range of its time in s, `-`
    /// for standard input, or a pipe such as `<(ssh robot cat log.csv)`; without any, the virtual
    /// experiment is simulated
    #[arg(long, value_name = "LOG", num_args = 1..)]
    data: Vec<PathBuf>,
    /// Logs of runs with the payload on the platform; `NAME=LOG` if the description names several
    /// payloads, `A+B=LOG` for two at once
    #[arg(long, value_name = "LOG", num_args = 1..)]
    payload_data: Vec<PathBuf>,
    /// Logs of validation runs; names of runs if the experiment is virtual [default: the validation
    /// runs of the description]
    #[arg(long, value_name = "LOG", num_args = 1..)]
    cross_validate: Vec<PathBuf>,
    /// The same, with the payload
    #[arg(long, value_name = "LOG", num_args = 1..)]
    cross_validate_payload: Vec<PathBuf>,
    /// Recording session of each log of `--data`, then of `--payload-data`, such as its day; the
    /// intervals then contain the changes of the robot between sessions
    #[arg(long, value_name = "NAME", num_args = 1..)]
    sessions: Vec<String>,
    /// Seed of the virtual experiment's noise [default: the description's]
    #[arg(long)]
    seed: Option<u64>,
    /// Logs from standard input and pipes; their copies are removed with this value.
    #[arg(skip)]
    streams: RefCell<Streams>,
    /// Friction in both directions of motion [default: the description's]
    #[arg(long, value_enum)]
    friction: Option<Friction>,
}

/// How friction is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Friction {
    /// The same coefficients in both directions, and an offset
    Symmetric,
    /// Separate coefficients for each direction
    Asymmetric,
}

impl Arguments {
    /// Runs from logs, without and with payload, and the session of each, or none.
    pub(crate) fn of_logs(
        data: Vec<PathBuf>,
        payload_data: Vec<PathBuf>,
        sessions: Vec<String>,
    ) -> Self {
        Self {
            data,
            payload_data,
            cross_validate: Vec::new(),
            cross_validate_payload: Vec::new(),
            sessions,
            seed: None,
            streams: RefCell::default(),
            friction: None,
        }
    }

    /// Whether any log is given.
    pub(crate) fn names_logs(&self) -> bool {
        let held_out = [&self.cross_validate, &self.cross_validate_payload];
        !self.are_virtual() || held_out.into_iter().any(|logs| !logs.is_empty())
    }

    /// Whether the runs come from the virtual experiment.
    pub(crate) fn are_virtual(&self) -> bool {
        self.data.is_empty() && self.payload_data.is_empty()
    }

    /// Files to read: description and logs; validation runs of a virtual experiment are names only.
    pub(crate) fn inputs<'a>(&'a self, description: &'a Path) -> Vec<&'a Path> {
        let logs = [&self.data, &self.payload_data];
        let held_out = [&self.cross_validate, &self.cross_validate_payload];
        let held_out = held_out.into_iter().filter(|_| !self.are_virtual());
        let all = logs.into_iter().chain(held_out).flatten();
        std::iter::once(description)
            .chain(all.flat_map(|path| overact_logs::parts(payloads::file(path))))
            .collect()
    }

    /// Reads the logs, or simulates the virtual experiment.
    ///
    /// # Errors
    /// Logs that cannot be used, or an invalid virtual experiment.
    pub(crate) fn runs(&self, robot: &Robot, as_json: bool) -> Result<Runs, Failure> {
        if self.are_virtual() && !self.sessions.is_empty() {
            let message = "`--sessions` names the recording sessions of logs: give logs with `--data` or `--payload-data`";
            Err(Failure::Usage(message.to_owned()))
        } else if self.are_virtual() {
            self.made(robot, as_json)
        } else if self.seed.is_some() {
            let message = "`--seed` sets the noise of the virtual experiment: leave it out with `--data` and `--payload-data`";
            Err(Failure::Usage(message.to_owned()))
        } else {
            self.measured(robot, as_json)
        }
    }

    /// Settings of the description with overrides from the command line.
    pub(crate) fn settings(&self, robot: &Robot, runs: &Runs) -> Settings {
        let mut settings = robot.settings(runs.sampling_frequency());
        if let Some(friction) = self.friction {
            settings.asymmetric_friction = friction == Friction::Asymmetric;
        }
        settings
    }

    /// Reads logs and reports the problems of all of them.
    fn measured(&self, robot: &Robot, as_json: bool) -> Result<Runs, Failure> {
        let payloads = Payloads::new(robot);
        let mut own = [
            payloads.without(&self.data),
            payloads.with(&self.payload_data),
        ]
        .concat();
        self.check_sessions(own.len())?;
        let (plain, loaded) = (&self.cross_validate, &self.cross_validate_payload);
        let mut others = [payloads.without(plain), payloads.with(loaded)].concat();
        let all = || own.iter().chain(&others);
        payloads.check(all())?;
        for one in own.iter_mut().chain(&mut others) {
            let copied = self.streams.borrow_mut().copied(&one.path)?;
            if let Some(path) = copied {
                one.given = Some(one.path.display().to_string());
                one.path = path;
            }
        }
        let all = || own.iter().chain(&others);
        let files: Vec<(&Path, bool)> = all().map(|one| (one.path.as_path(), one.loaded)).collect();
        let logs: Vec<&Path> = files.iter().map(|(path, _)| *path).collect();
        same::check(&logs, own.len())?;
        let bar = Progress::new("reading", as_json);
        let logs = robot.read_runs(&files, &|part: f64| bar.at(part, ""));
        let logs = logs.map_err(|error| self.as_given(error))?;
        let labelled = |(runs, one): (Vec<Log>, &GivenLog)| -> Vec<Log> {
            runs.into_iter().map(|log| one.label(log)).collect()
        };
        let mut identified: Vec<Vec<Log>> = logs.into_iter().zip(all()).map(labelled).collect();
        let validation = identified.split_off(own.len());
        let sessions = self
            .sessions
            .iter()
            .map(Some)
            .chain(std::iter::repeat(None));
        let identified = identified
            .into_iter()
            .zip(sessions)
            .flat_map(|(runs, session)| {
                let in_session = move |log: Log| match session {
                    Some(name) => log.with_session(name),
                    None => log,
                };
                runs.into_iter().map(in_session)
            });
        Ok(Runs {
            identified: identified.collect(),
            validation: validation.into_iter().flatten().collect(),
            true_values: None,
        })
    }

    /// Checks that each of `logs` training logs has a session.
    ///
    /// # Errors
    /// Another number of sessions than logs.
    fn check_sessions(&self, logs: usize) -> Result<(), Failure> {
        let names = self.sessions.len();
        if names == 0 || names == logs {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "`--sessions` names {names} for {logs} logs: name one session for each log of `--data`, then of `--payload-data`"
        )))
    }

    /// Replaces temporary files by the user's names of streams in an error.
    fn as_given(&self, error: Error) -> Error {
        let mut problems = error.problems();
        let streams = self.streams.borrow();
        problems
            .iter_mut()
            .for_each(|problem| streams.as_given(problem));
        match error {
            description @ Error::Description { .. } => description,
            _ => Error::Problems(problems),
        }
    }

    /// Simulates the virtual experiment.
    fn made(&self, robot: &Robot, as_json: bool) -> Result<Runs, Failure> {
        let mut experiment = robot.experiment()?;
        if let Some(seed) = self.seed {
            experiment.plan_mut().seed = seed;
        }
        let held = self.cross_validate.iter();
        let held = held.chain(&self.cross_validate_payload);
        let mut held: Vec<String> = held.map(|path| name(path)).collect();
        experiment.check_runs(&held)?;
        if held.is_empty() {
            held = robot.held_out();
        }
        print_without_effect(experiment.without_effect(), as_json);
        let bar = Progress::new("simulating", as_json);
        let tell = |fraction: f64, run: &str| bar.at(fraction, run);
        Ok(experiment.runs(&held, &tell)?)
    }
}

fn name(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// Shows the progress of the identification.
pub(crate) fn tell(bar: &Progress, doing: Doing<'_>) {
    let part = |done: usize, samples: usize| done as f64 / samples.max(1) as f64;
    match doing {
        Doing::Base => bar.at(0.0, "base parameters"),
        Doing::Run { run, done, samples } => bar.at(part(done, samples), run),
        Doing::Estimation { model } => bar.at(1.0, &format!("{model}: estimation")),
        Doing::Validation { run, done, samples } => {
            bar.at(part(done, samples), &format!("cross-validation on {run}"));
        }
        _ => {}
    }
}
