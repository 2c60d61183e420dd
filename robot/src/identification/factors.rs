//! R factors of a robot's runs, and identification from them.

use crate::{
    error::{Error, Problem},
    identification::{
        identifier::{essential_or_not, without_essential_estimates},
        standstill::without_standstills,
    },
    robot::Robot,
};
use overact_codegen::diagnostic::Code;
use overact_identification::{
    Log, Progress, Settings,
    factors::{self, CollectedRuns, FactorEstimation, Factory, Origin, RunFactors},
};

impl Robot {
    /// R factors of runs; with `equations`, also for successive equations.
    ///
    /// Long standstills are left out as in an identification.
    ///
    /// # Errors
    /// Runs that cannot be used, or a description with settings that factors do not support.
    pub fn factors(
        &self,
        logs: &[Log],
        origin: &Origin,
        settings: &Settings,
        equations: bool,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<Vec<RunFactors>, Error> {
        let factory = self.factory(settings)?;
        let parts = without_standstills(logs, settings)?;
        let times = parts
            .iter()
            .zip(logs)
            .enumerate()
            .flat_map(|(number, (parts, log))| {
                let time = origin.times_us.get(number).copied().flatten();
                let start = move |part: &Log| {
                    let microseconds = 1e6 * (part.start() - log.start());
                    time.map(|time| time + microseconds.round() as i64)
                };
                parts.iter().map(start)
            });
        let origin = Origin {
            serial: origin.serial.clone(),
            times_us: times.collect(),
        };
        let runs: Vec<Log> = parts.into_iter().flatten().collect();
        Ok(factory.runs(&runs, &origin, equations, progress)?)
    }

    /// Factory for R factors of runs one by one, also of many robots.
    ///
    /// # Errors
    /// Settings that do not fit, or a description with settings that factors do not support.
    pub fn factory<'a>(&'a self, settings: &'a Settings) -> Result<Factory<'a>, Error> {
        self.check_factors()?;
        let text = self.source().text.as_str();
        Ok(Factory::new(self.model(), text, settings)?)
    }

    /// Compatibility key of factors for this description and these settings.
    #[must_use]
    pub fn settings_hash(&self, settings: &Settings) -> String {
        factors::settings_hash(&self.source().text, settings)
    }

    /// Identifies the parameters from factors of runs.
    ///
    /// # Errors
    /// Incompatible factors, or data that determine no parameter.
    pub fn identify_factors(
        &self,
        gathered: &CollectedRuns,
        settings: &Settings,
        skip_bad: bool,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<FactorEstimation, Error> {
        self.check_factors()?;
        self.check_prior()?;
        let essential = self.description().identification.essential;
        let own = essential_or_not(settings, essential);
        let mut found =
            factors::identify_factors(self.model(), gathered, &own, skip_bad, progress)?;
        if !essential {
            without_essential_estimates(&mut found.estimates);
        }
        Ok(found)
    }

    /// Rejects identification of gains, gears and gravity, which needs the logs themselves.
    fn check_factors(&self) -> Result<(), Error> {
        let identification = &self.description().identification;
        let is_of_logs = identification.gains
            || identification.gravity_direction
            || identification.gear_friction
            || identification.stribeck_velocity;
        if !self.description().prior.held.is_empty() {
            let message = "the description holds parameters, which factors do not support";
            let help = "identify from the logs, or leave out `held` of [prior]";
            return Err(Problem::new(Code::FACTORS, message)
                .file(self.file())
                .help(help)
                .into());
        }
        if !is_of_logs {
            return Ok(());
        }
        let message = "the description requests gains of drives, friction of gears or the direction of gravity, which factors do not support";
        let help =
            "first identify them from logs, write them into the description and leave out the key";
        Err(Problem::new(Code::FACTORS, message)
            .file(self.file())
            .help(help)
            .into())
    }
}
