//! Runs of an identification: measured logs, or the virtual experiment.

use crate::{
    error::{Error, Problem},
    experiment::VirtualExperiment,
    robot::Robot,
};
use overact::Model;
use overact_codegen::description::{self, Instruments};
use overact_codegen::diagnostic::Code;
use overact_identification::{Gain, Log, Mapping};
use overact_logs::{Array, NeededSamples};
use overact_simulation::Record;
use std::{collections::BTreeMap, path::Path, sync::Arc};

/// Training and validation runs.
#[derive(Debug, Clone, Default)]
pub struct Runs {
    /// Training runs.
    pub identified: Vec<Log>,
    /// Validation runs.
    pub validation: Vec<Log>,
    /// True values of the parameters of a virtual robot.
    pub true_values: Option<BTreeMap<String, f64>>,
}

impl Runs {
    /// Sampling frequency f_m of the first training run, Hz; 0 without a run.
    #[must_use]
    pub fn sampling_frequency(&self) -> f64 {
        self.identified.first().map_or(0.0, Log::sampling_frequency)
    }
}

impl Robot {
    /// Reads logs, each with a flag for the payload, with the columns of the description.
    ///
    /// A log with gaps in its time is several runs ([`read_runs`](Self::read_runs)). `progress` is
    /// called with the completed fraction, from 0 to 1.
    ///
    /// # Errors
    /// All errors of all logs.
    pub fn read_logs(
        &self,
        files: &[(&Path, bool)],
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Vec<Log>, Error> {
        Ok(self
            .read_runs(files, progress)?
            .into_iter()
            .flatten()
            .collect())
    }

    /// Reads the runs of each log: several if its time has gaps too long to be interpolated.
    ///
    /// The description's filters are not run across gaps. Stretches that are too short for them are
    /// left out, and the first run of a log has a note on both ([`Log::note`]).
    ///
    /// ```no_run
    /// use overact_robot::Robot;
    /// use std::path::Path;
    ///
    /// # fn main() -> Result<(), overact_robot::Error> {
    /// let robot = Robot::from_toml("robots/dualv.toml")?;
    /// let runs = robot.read_runs(&[(Path::new("log.csv"), false)], &|_| {})?;
    /// println!("{} runs, the first one from {} s on", runs[0].len(), runs[0][0].start());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// All errors of all logs.
    pub fn read_runs(
        &self,
        files: &[(&Path, bool)],
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Vec<Vec<Log>>, Error> {
        let mapping = self.mapping();
        let needed = |frequency: f64| self.settings(frequency).samples_needed();
        let (mut logs, mut errors) = (Vec::new(), Vec::new());
        for runs in overact_logs::read_runs(files, &mapping, &needed, progress) {
            match runs.and_then(|runs| self.all_meant(runs)) {
                Ok(runs) => logs.push(runs),
                Err(error) => errors.push(self.located(error).into()),
            }
        }
        if !errors.is_empty() {
            return Err(Error::Several(errors));
        }
        let Some(mapping) = self.references(&mapping) else {
            return Ok(logs);
        };
        let references = overact_logs::read_runs(files, &mapping, &needed, &|_| ());
        let pairs = logs.into_iter().zip(references);
        pairs
            .map(|(runs, references)| with_references(runs, references?))
            .collect()
    }

    /// The only run of arrays in memory with the columns of the description; `name` is used in
    /// messages.
    ///
    /// # Errors
    /// Missing arrays, numbers that are not finite, nonuniform time, or several runs.
    pub fn log_of_arrays(
        &self,
        name: &str,
        arrays: &[Array<'_>],
        payload: bool,
    ) -> Result<Log, Error> {
        only(name, self.runs_of_arrays(name, arrays, payload)?)
    }

    /// Runs of arrays in memory: several if the time has gaps, as [`read_runs`](Self::read_runs).
    ///
    /// # Errors
    /// Missing arrays, numbers that are not finite, or nonuniform time.
    pub fn runs_of_arrays(
        &self,
        name: &str,
        arrays: &[Array<'_>],
        payload: bool,
    ) -> Result<Vec<Log>, Error> {
        self.runs(&|mapping, needed| {
            overact_logs::runs_of_arrays(name, arrays, mapping, payload, needed)
        })
    }

    /// The only run of a file's bytes in any supported format; `name` is used in messages.
    ///
    /// # Errors
    /// As [`read_logs`](Self::read_logs), or several runs.
    pub fn log_of_bytes(&self, name: &str, bytes: Arc<[u8]>, payload: bool) -> Result<Log, Error> {
        only(name, self.runs_of_bytes(name, bytes, payload)?)
    }

    /// Runs of a file's bytes: several if the time has gaps, as [`read_runs`](Self::read_runs).
    ///
    /// # Errors
    /// As [`read_logs`](Self::read_logs).
    pub fn runs_of_bytes(
        &self,
        name: &str,
        bytes: Arc<[u8]>,
        payload: bool,
    ) -> Result<Vec<Log>, Error> {
        self.runs(&|mapping, needed| {
            overact_logs::runs_of_bytes(name, &bytes, mapping, payload, needed)
        })
    }

    /// Runs of one log, and those of its references, if the robot is to be simulated along them.
    fn runs(&self, read: &ReadRuns<'_>) -> Result<Vec<Log>, Error> {
        let mapping = self.mapping();
        let needed = |frequency: f64| self.settings(frequency).samples_needed();
        let runs = read(&mapping, &needed).and_then(|runs| self.all_meant(runs));
        let runs = runs.map_err(|error| self.located(error))?;
        match self.references(&mapping) {
            None => Ok(runs),
            Some(mapping) => with_references(runs, read(&mapping, &needed)?),
        }
    }

    /// Checks all runs of a log.
    fn all_meant(&self, runs: Vec<Log>) -> Result<Vec<Log>, overact_identification::Error> {
        runs.into_iter().map(|log| self.meant(log)).collect()
    }

    /// Checks that a log's columns can have the meaning that the description gives them.
    fn meant(&self, log: Log) -> Result<Log, overact_identification::Error> {
        log.check_column_plausibility(self.model().info().actuators)?;
        Ok(log)
    }

    /// Adds the description's location of wrong columns to an error.
    fn located(&self, error: overact_identification::Error) -> overact_identification::Error {
        let mut error = error;
        for problem in &mut error.problems {
            let of_columns = [Code::LOG_COLUMNS, Code::SAME_COLUMN].contains(&problem.code);
            if let (true, Some(column)) = (of_columns, problem.column_name()) {
                let place = self.place_of_column(column);
                let help = match problem.help.take() {
                    Some(help) if help.ends_with('?') => {
                        format!("{help} The names are in {place}")
                    }
                    Some(help) => format!("{help}; columns are named in {place}"),
                    None => format!("columns are named in {place}"),
                };
                problem.help = Some(help);
            }
        }
        error
    }

    /// Location in the description of a column or list of columns, in words.
    fn place_of_column(&self, column: &str) -> String {
        let Some(data) = &self.description().data else {
            return String::from(
                "the table [data] of the description; without it they are `time`, `q_` and `tau_` with the actuator's name",
            );
        };
        let lists = [
            ("positions", &data.positions),
            ("torques", &data.torques),
            ("velocities", &data.velocities),
        ];
        let path = lists.into_iter().find_map(|(key, names)| {
            let place = names.iter().position(|name| name == column);
            let place = place.or_else(|| names.iter().position(|name| name.contains(column)));
            let whole = (key == column).then(|| format!("data.{key}"));
            whole.or_else(|| place.map(|place| format!("data.{key}[{place}]")))
        });
        let path = path.unwrap_or_else(|| String::from("data.time"));
        let span = description::place(self.source(), &path);
        let line = span.map_or(1, |span| self.source().position(&span).line);
        format!("the table [data], {}:{line}", self.file())
    }

    /// Columns of the runs' references, if the robot is to be simulated along them.
    fn references(&self, own: &Mapping) -> Option<Mapping> {
        let description = self.description();
        let controller = description.controller.as_ref()?;
        let wanted = description.identification.instruments == Instruments::Simulated;
        wanted.then(|| Mapping {
            positions: controller.reference.clone(),
            // A log has two signals per actuator; the second one of the reference is not used.
            torques: controller.reference.clone(),
            velocities: Vec::new(),
            torque_gain: vec![Gain::Value(1.0); controller.reference.len()],
            ..own.clone()
        })
    }
}

/// Reads the runs of a log with a mapping.
type ReadRuns<'a> =
    dyn Fn(&Mapping, &NeededSamples<'_>) -> Result<Vec<Log>, overact_identification::Error> + 'a;

/// The only run of a log.
///
/// # Errors
/// Several runs.
fn only(name: &str, mut runs: Vec<Log>) -> Result<Log, Error> {
    if runs.len() < 2
        && let Some(run) = runs.pop()
    {
        return Ok(run);
    }
    let message = format!(
        "the time has gaps, which split the log into {} runs",
        runs.len()
    );
    Err(Problem::new(Code::LOG_TIME, message)
        .file(name)
        .help("write each run to its own log")
        .into())
}

/// Adds the recorded references to the runs of a log.
fn with_references(runs: Vec<Log>, references: Vec<Log>) -> Result<Vec<Log>, Error> {
    if runs.len() != references.len() {
        let name = runs.first().map_or("", Log::name);
        let message = format!(
            "the time has gaps, which split the measured columns into {} runs and those of the references into {}",
            runs.len(),
            references.len()
        );
        return Err(Problem::new(Code::LOG_TIME, message).file(name).into());
    }
    let pairs = runs.into_iter().zip(references);
    Ok(pairs
        .map(|(run, reference)| run.with_instruments(reference))
        .collect())
}

impl VirtualExperiment<'_> {
    /// Simulates all runs; those named in `held_out` are validation runs.
    ///
    /// # Errors
    /// Unknown names, no remaining training run, or as [`records`](Self::records).
    pub fn runs(&self, held_out: &[String], progress: &dyn Fn(f64, &str)) -> Result<Runs, Error> {
        self.check_runs(held_out)?;
        self.check_some_left(held_out)?;
        let records = self.records(progress)?.into_iter();
        let (validation, identified): (Vec<Record>, Vec<Record>) =
            records.partition(|record| held_out.contains(&record.name));
        let logs = |records: Vec<Record>| {
            let logs = records.into_iter().map(|record| self.log_of(record));
            logs.collect::<Result<Vec<_>, _>>()
        };
        Ok(Runs {
            identified: logs(identified)?,
            validation: logs(validation)?,
            true_values: self.robot().true_values(),
        })
    }

    /// Converts a record to a log with the name of its payload.
    ///
    /// # Errors
    /// A record with numbers that are not finite.
    pub fn log_of(&self, record: Record) -> Result<Log, Error> {
        let load = self.robot().payload_of(&record.name);
        let load = load.filter(|_| record.payload);
        let own = log(record)?;
        Ok(match load {
            Some(name) => own.with_payload_name(name),
            None => own,
        })
    }
}

/// Converts a record to a log with positions and torques only, as in a laboratory.
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
