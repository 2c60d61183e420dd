//! The runs of an identification: measured logs, or the virtual experiment.

use crate::{error::Error, experiment::VirtualExperiment, robot::Robot};
use overact_codegen::description::Instruments;
use overact_identification::{
    Gain, Log, Mapping,
    data::{self, Array},
};
use overact_simulation::Record;
use std::{collections::BTreeMap, path::Path};

/// Runs to identify from and runs to validate with.
#[derive(Debug, Clone, Default)]
pub struct Runs {
    /// Runs to identify from.
    pub identified: Vec<Log>,
    /// Runs that are held out, to validate with.
    pub validation: Vec<Log>,
    /// True values of the parameters of a virtual robot.
    pub true_values: Option<BTreeMap<String, f64>>,
}

impl Runs {
    /// f_m of the first run, Hz; 0 without a run.
    #[must_use]
    pub fn sampling_frequency(&self) -> f64 {
        self.identified.first().map_or(0.0, Log::sampling_frequency)
    }
}

impl Robot {
    /// Reads logs, each with a word on whether the platform carried the payload; their columns are those
    /// that the description names. `progress` hears the part that is done, from 0 to 1.
    ///
    /// # Errors
    /// What is wrong with all of them.
    pub fn read_logs(
        &self,
        files: &[(&Path, bool)],
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Vec<Log>, Error> {
        let mapping = self.mapping();
        let (mut logs, mut errors) = (Vec::new(), Vec::new());
        for log in data::read_all(files, &mapping, progress) {
            match log {
                Ok(log) => logs.push(log),
                Err(error) => errors.push(Error::from(error)),
            }
        }
        if errors.is_empty()
            && let Some(mapping) = self.references(&mapping)
        {
            return beside_references(logs, files, &mapping);
        }
        match errors.is_empty() {
            true => Ok(logs),
            false => Err(Error::Several(errors)),
        }
    }
}

impl Robot {
    /// A log of arrays in memory, whose columns are those that the description names; `name` is what messages
    /// call it.
    ///
    /// # Errors
    /// Missing arrays, numbers that are not finite, a time that is not uniform.
    pub fn log_of_arrays(
        &self,
        name: &str,
        arrays: &[Array<'_>],
        payload: bool,
    ) -> Result<Log, Error> {
        let mapping = self.mapping();
        let log = data::read_arrays(name, arrays, &mapping, payload)?;
        match self.references(&mapping) {
            None => Ok(log),
            Some(mapping) => {
                Ok(log.with_instruments(data::read_arrays(name, arrays, &mapping, payload)?))
            }
        }
    }

    /// Where the references of runs stand, if the robot is to be simulated along them.
    fn references(&self, own: &Mapping) -> Option<Mapping> {
        let description = self.description();
        let controller = description.controller.as_ref()?;
        let wanted = description.identification.instruments == Instruments::Simulated;
        wanted.then(|| Mapping {
            positions: controller.reference.clone(),
            // A log has two signals; the reference's second one is not looked at.
            torques: controller.reference.clone(),
            velocities: Vec::new(),
            torque_gain: vec![Gain::Value(1.0); controller.reference.len()],
            ..own.clone()
        })
    }
}

/// Runs with the reference that they followed beside each.
fn beside_references(
    logs: Vec<Log>,
    files: &[(&Path, bool)],
    mapping: &Mapping,
) -> Result<Vec<Log>, Error> {
    let references = data::read_all(files, mapping, &|_| ());
    let pairs = logs.into_iter().zip(references);
    let beside = |(log, reference): (Log, Result<Log, _>)| {
        let reference = reference.map_err(Error::from)?;
        Ok(log.with_instruments(reference))
    };
    pairs.map(beside).collect()
}

impl VirtualExperiment<'_> {
    /// Makes all runs; those named in `held_out` are to validate with.
    ///
    /// # Errors
    /// Names that no run has, or as [`records`](Self::records).
    pub fn runs(&self, held_out: &[String], progress: &dyn Fn(f64, &str)) -> Result<Runs, Error> {
        self.check_runs(held_out)?;
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

    /// A record as a log, with the name of the payload that its run carries.
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

/// A record as a log: positions and torques alone, as a laboratory would have them.
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
