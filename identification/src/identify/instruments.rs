//! The instruments of all runs, as the settings ask for them.

use crate::{
    data::{Log, periods},
    error::{Error, Problem},
    estimation::{
        estimate::percent,
        instruments::regressor::{RepeatedRun, SimulatedRun},
    },
    settings::{Instruments, Settings},
};
use overact::Code;

/// What there is of instruments.
#[derive(Debug, Clone, Default)]
pub(super) struct Companions {
    /// One run of instruments for each run, or none at all.
    pub(super) logs: Vec<Log>,
    /// For instruments from other periods, the repetitions of each run.
    pub(super) runs: Vec<RepeatedRun>,
    /// For instruments from the simulated robot, how well it reproduces each run.
    pub(super) simulated: Vec<SimulatedRun>,
    /// Why there are none where they are asked for.
    pub(super) missing: Option<Error>,
}

impl Companions {
    /// Those of the runs. A run without instruments has no equations for an estimate by them, so all runs
    /// have some, or none has.
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

    /// The simulated motion beside all runs.
    fn simulated(runs: &[Log]) -> Result<Self, Error> {
        let mut found = Self::default();
        for log in runs {
            let own = log.instruments().ok_or_else(|| {
                Problem::new(Code::INSTRUMENTS, "there is no simulated motion beside the run")
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

    /// The other periods of all runs.
    fn repeated(runs: &[Log], period: Option<f64>) -> Result<Self, Error> {
        let mut found = Self::default();
        for log in runs {
            let periods = periods::periods(log, period)?;
            let frequency = log.sampling_frequency();
            let told = RepeatedRun::new(log.name(), frequency, period.is_none(), &periods);
            found.runs.push(told);
            found.logs.push(log.others(periods));
        }
        Ok(found)
    }

    /// What the instruments of a run are, where there are some.
    pub(super) fn of(&self, run: usize) -> Option<&Log> {
        self.logs.get(run)
    }
}

/// 100 ||τ - τ_measured||/||τ_measured||.
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
