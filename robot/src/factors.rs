//! Factor files of a robot: its runs as R factors, and its parameters from them.

use crate::{
    error::{Error, Problem},
    identifier::{essential_or_not, without_essential_estimates},
    robot::Robot,
};
use overact_codegen::diagnostic::Code;
use overact_identification::{
    Log, Progress, Settings,
    factors::{self, Factory, FromFactors, Gathered, Origin, RunFactors},
};

impl Robot {
    /// The factors of runs; with `equations` successive equations, too.
    ///
    /// # Errors
    /// Runs that can't be used; a description that asks for what factors can't give.
    pub fn factors(
        &self,
        (logs, origin): (&[Log], &Origin),
        settings: &Settings,
        equations: bool,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<Vec<RunFactors>, Error> {
        self.check_factors()?;
        let runs = (logs, self.source().text.as_str(), origin);
        Ok(factors::factor_runs(
            self.model(),
            runs,
            settings,
            equations,
            progress,
        )?)
    }

    /// What makes factors of runs one by one, of many robots.
    ///
    /// # Errors
    /// Settings that do not fit; a description that asks for what factors can't give.
    pub fn factory<'a>(&'a self, settings: &'a Settings) -> Result<Factory<'a>, Error> {
        self.check_factors()?;
        let text = self.source().text.as_str();
        Ok(Factory::new(self.model(), text, settings)?)
    }

    /// What factors must be like to be those of this description, with these settings.
    #[must_use]
    pub fn likeness(&self, settings: &Settings) -> String {
        factors::likeness(&self.source().text, settings)
    }

    /// The parameters from the factors of runs.
    ///
    /// # Errors
    /// Factors that do not fit, data that determine no parameter.
    pub fn identify_factors(
        &self,
        gathered: &Gathered,
        settings: &Settings,
        skip_bad: bool,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<FromFactors, Error> {
        self.check_factors()?;
        self.check_prior()?;
        let essential = self.description().identification.essential;
        let own = essential_or_not(settings, essential);
        let runs = (gathered.runs.as_slice(), gathered.left_out.as_slice());
        let mut found = factors::identify_factors(self.model(), runs, &own, skip_bad, progress)?;
        if !essential {
            without_essential_estimates(&mut found.estimates);
        }
        Ok(found)
    }

    /// What is identified before the parameters needs the logs themselves.
    fn check_factors(&self) -> Result<(), Error> {
        let identification = &self.description().identification;
        if !identification.gains && !identification.gravity_direction {
            return Ok(());
        }
        let message = "the description asks for gains of drives or for the direction of gravity, which factors can't give";
        let help =
            "identify them from logs first, write them into the description and leave out the key";
        Err(Problem::new(Code::FACTORS, message)
            .file(self.file())
            .help(help)
            .into())
    }
}
