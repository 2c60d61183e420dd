//! Instruments of all runs, according to the settings.

use crate::{
    estimation::{
        estimate::percent,
        instruments::regressor::{RepeatedRun, SimulatedRun},
    },
    settings::{Instruments, Settings},
};
use overact::Code;
use overact_logs::{Error, Log, Problem, periods};

/// Instruments of all runs.
#[derive(Debug, Clone, Default)]
pub(super) struct InstrumentRuns {
    /// A run of instruments for each run, or none at all.
    pub(super) logs: Vec<Log>,
    /// Periods of each run, for instruments from other periods.
    pub(super) runs: Vec<RepeatedRun>,
    /// Reproduction of each run, for instruments from the simulated robot.
    pub(super) simulated: Vec<SimulatedRun>,
    /// Reason for missing instruments that were requested.
    pub(super) missing: Option<Error>,
}

impl InstrumentRuns {
    /// Instruments of the runs.
    ///
    /// Either all runs have some or none, since a run without instruments has no equations for this
    /// estimate.
    pub(super) fn new(runs: &[Log], settings: &Settings) -> Self {
        let found = match settings.instruments {
            Instruments::None => Ok(Self::default()),
            Instruments::Simulated => Self::simulated(runs),
            Instruments::Periods => Self::repeated(runs, settings.period_s),
        };
        found.unwrap_or_else(|error| Self {
            missing: Some(error),
            ..Self::default()
        })
    }

    /// Simulated motion of all runs.
    fn simulated(runs: &[Log]) -> Result<Self, Error> {
        let mut found = Self::default();
        for log in runs {
            let own = log.instruments().ok_or_else(|| {
                Problem::new(Code::INSTRUMENTS, "there is no simulated motion of the run")
                    .file(log.name())
                    .help("describe the robot's controller, or set `instruments` to \"periods\" or \"none\"")
            })?;
            found.simulated.push(SimulatedRun {
                run: log.name().to_owned(),
                torque_error_percent: torque_error(log, own)?,
            });
            found.logs.push(own.clone());
        }
        Ok(found)
    }

    /// Other periods of all runs.
    fn repeated(runs: &[Log], period: Option<f64>) -> Result<Self, Error> {
        let mut found = Self::default();
        for log in runs {
            let periods = periods::periods(log, period)?;
            let frequency = log.sampling_frequency();
            let repeated_run = RepeatedRun::new(log.name(), frequency, period.is_none(), &periods);
            found.runs.push(repeated_run);
            found.logs.push(log.others(periods));
        }
        Ok(found)
    }

    /// Instruments of a run, if there are any.
    pub(super) fn of(&self, run: usize) -> Option<&Log> {
        self.logs.get(run)
    }
}

/// Relative torque error in percent, 100 ||τ - τ_measured||/||τ_measured||.
fn torque_error(measured: &Log, simulated: &Log) -> Result<f64, Error> {
    let (mut own, mut other) = (measured.reader()?, simulated.reader()?);
    let (mut difference, mut whole) = (0.0, 0.0);
    while let (Some(a), Some(b)) = (own.next()?, other.next()?) {
        for (measured, simulated) in a.torques.iter().zip(&b.torques) {
            difference += (simulated - measured).powi(2);
            whole += measured * measured;
        }
    }
    Ok(percent(f64::sqrt(difference), f64::sqrt(whole)))
}
