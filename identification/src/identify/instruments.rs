//! The instruments of all runs, as the settings ask for them.

use crate::{
    data::{Log, periods},
    error::{Error, Problem},
    estimation::instruments::regressor::RepeatedRun,
    settings::{Instruments, Settings},
};

/// What there is of instruments.
#[derive(Debug, Clone, Default)]
pub(super) struct Companions {
    /// One run of instruments for each run, or none at all.
    pub(super) logs: Vec<Log>,
    /// For instruments from other periods, the repetitions of each run.
    pub(super) runs: Vec<RepeatedRun>,
    /// Why there are none where they are asked for.
    pub(super) missing: Option<Error>,
}

impl Companions {
    /// Those of the runs. A run without instruments has no equations for an estimate by them, so all runs
    /// have some, or none has.
    pub(super) fn new(runs: &[Log], settings: &Settings) -> Self {
        let found = match settings.instruments {
            Instruments::None => return Self::default(),
            Instruments::Simulated => runs.iter().map(simulated).collect(),
            Instruments::Periods => repeated(runs, settings.period_s),
        };
        let found: Result<Vec<(Log, Option<RepeatedRun>)>, Error> = found;
        match found {
            Ok(found) => {
                let (logs, runs): (Vec<_>, Vec<_>) = found.into_iter().unzip();
                Self {
                    logs,
                    runs: runs.into_iter().flatten().collect(),
                    missing: None,
                }
            }
            Err(error) => Self {
                missing: Some(error),
                ..Self::default()
            },
        }
    }

    /// What the instruments of a run are, where there are some.
    pub(super) fn of(&self, run: usize) -> Option<&Log> {
        self.logs.get(run)
    }
}

/// The simulated motion beside a run.
fn simulated(log: &Log) -> Result<(Log, Option<RepeatedRun>), Error> {
    let own = log.instruments().cloned();
    let own = own.ok_or_else(|| {
        Problem::new("there is no simulated motion beside the run")
            .file(log.name())
            .help(
                "describe the robot's controller, or set `instruments` to \"periods\" or \"none\"",
            )
    })?;
    Ok((own, None))
}

/// The other periods of all runs.
fn repeated(runs: &[Log], period: Option<f64>) -> Result<Vec<(Log, Option<RepeatedRun>)>, Error> {
    let one = |log: &Log| {
        let periods = periods::periods(log, period)?;
        let frequency = log.sampling_frequency();
        let told = RepeatedRun::new(log.name(), frequency, period.is_none(), &periods);
        Ok((log.others(periods), Some(told)))
    };
    runs.iter().map(one).collect()
}
