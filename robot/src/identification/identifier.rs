//! Identification of a robot from runs with the settings of its description.

use crate::{
    error::Error,
    identification::{
        functions_base::functions_base, motors::at_motors, partitions::partitions, runs::Runs,
        standstill::without_standstills,
    },
    robot::Robot,
};
use overact::Model;
use overact_identification::{
    Calibration, CalibrationScope, Dataset, Estimate, Identification, Instruments, Log, PriorStage,
    Progress, Settings, Stage, Study, identify_after, study,
};
use std::collections::BTreeMap;

/// Builder of an identification.
///
/// ```no_run
/// use overact_robot::{Identifier, Robot};
/// use std::path::Path;
///
/// # fn main() -> Result<(), overact_robot::Error> {
/// let robot = Robot::from_toml("robots/dualv.toml")?;
/// let logs = robot.read_logs(&[(Path::new("log.csv"), false)], &|_| {})?;
/// let result = Identifier::new(&robot).runs(&logs).run()?;
/// for parameter in &result.estimates[0].parameters {
///     println!("{} = {} {}", parameter.name, parameter.value, parameter.unit);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Identifier<'a> {
    pub(super) robot: &'a Robot,
    pub(super) runs: &'a [Log],
    pub(super) validation: &'a [Log],
    pub(super) true_values: Option<&'a BTreeMap<String, f64>>,
    pub(super) settings: Option<Settings>,
    pub(super) calibration: Option<CalibrationScope>,
    pub(super) gains: bool,
    pub(super) gravity_direction: bool,
    pub(super) gear_friction: bool,
    pub(super) stribeck_velocity: bool,
    pub(super) progress: &'a dyn Fn(Progress<'_>),
}

impl std::fmt::Debug for Identifier<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Identifier")
            .field("robot", &self.robot.file())
            .field("runs", &self.runs.len())
            .field("validation", &self.validation.len())
            .finish_non_exhaustive()
    }
}

impl<'a> Identifier<'a> {
    /// Creates an identification without runs.
    ///
    /// Whether drive gains and the gravity direction are identified follows from the description.
    #[must_use]
    pub fn new(robot: &'a Robot) -> Self {
        Self {
            robot,
            runs: &[],
            validation: &[],
            true_values: None,
            settings: None,
            calibration: None,
            gains: robot.description().identification.gains,
            gravity_direction: robot.description().identification.gravity_direction,
            gear_friction: robot.description().identification.gear_friction,
            stribeck_velocity: robot.description().identification.stribeck_velocity,
            progress: &|_| {},
        }
    }

    /// Sets the training runs.
    #[must_use]
    pub fn runs(self, runs: &'a [Log]) -> Self {
        Self { runs, ..self }
    }

    /// Sets the validation runs.
    #[must_use]
    pub fn validation(self, validation: &'a [Log]) -> Self {
        Self { validation, ..self }
    }

    /// Sets training runs, validation runs and true values.
    #[must_use]
    pub fn data(self, data: &'a Runs) -> Self {
        Self {
            runs: data.identified.as_slice(),
            validation: data.validation.as_slice(),
            true_values: data.true_values.as_ref(),
            ..self
        }
    }

    /// Sets the settings, by default those of the description ([`Robot::settings`]).
    #[must_use]
    pub fn settings(self, settings: Settings) -> Self {
        let settings = Some(settings);
        Self { settings, ..self }
    }

    /// First calibrates encoder offsets and lengths from the training runs: [`Robot::calibrate`].
    #[must_use]
    pub fn calibrate(self, scope: CalibrationScope) -> Self {
        let calibration = Some(scope);
        Self {
            calibration,
            ..self
        }
    }

    /// Sets whether drive gains are identified first, from the training runs and
    /// [`Settings::known`].
    ///
    /// This overrides the description.
    #[must_use]
    pub fn gains(self, gains: bool) -> Self {
        Self { gains, ..self }
    }

    /// Sets whether the gravity direction is identified; this overrides the description.
    #[must_use]
    pub fn gravity_direction(self, gravity_direction: bool) -> Self {
        Self {
            gravity_direction,
            ..self
        }
    }

    /// Sets whether the friction of the gears is identified first, from the training runs.
    ///
    /// This overrides the description.
    #[must_use]
    pub fn gear_friction(self, gear_friction: bool) -> Self {
        Self {
            gear_friction,
            ..self
        }
    }

    /// Sets whether the Stribeck velocities are identified first, from the training runs.
    ///
    /// This overrides the description.
    #[must_use]
    pub fn stribeck_velocity(self, stribeck_velocity: bool) -> Self {
        Self {
            stribeck_velocity,
            ..self
        }
    }

    /// Sets the callback for progress.
    #[must_use]
    pub fn progress(self, progress: &'a dyn Fn(Progress<'_>)) -> Self {
        Self { progress, ..self }
    }

    /// Estimates and validates the parameters.
    ///
    /// The models are both projections of an overactuated robot, or the joint model of another
    /// robot.
    ///
    /// # Errors
    /// Runs or settings that cannot be used, or data that determine no parameter.
    pub fn run(&self) -> Result<Identification, Error> {
        let (runs, validation) = (self.moving(self.runs)?, self.moving(self.validation)?);
        let own = Identifier {
            runs: &runs,
            validation: &validation,
            ..self.clone()
        };
        let mut result = own.calibrated()?;
        if !self.gains {
            let unintended = self.robot.description_warnings();
            result.warnings.splice(0..0, unintended);
        }
        Ok(result)
    }

    /// Parts of runs without long standstills.
    fn moving(&self, runs: &[Log]) -> Result<Vec<Log>, Error> {
        let parts = without_standstills(runs, &self.with_defaults())?;
        Ok(parts.into_iter().flatten().collect())
    }

    /// Identification after a calibration, if that is requested.
    fn calibrated(&self) -> Result<Identification, Error> {
        let Some(scope) = self.calibration else {
            return self.identified();
        };
        let calibration = self.robot.calibrate(self.runs, scope)?;
        let mut result = self.with_calibration(&calibration)?;
        let others = std::mem::take(&mut result.warnings);
        result.warnings = [calibration.warnings.clone(), others].concat();
        result.calibration = Some(calibration);
        Ok(result)
    }

    /// Identification with calibrated offsets and lengths.
    fn with_calibration(&self, calibration: &Calibration) -> Result<Identification, Error> {
        if !calibration.is_change() {
            return self.identified();
        }
        let offsets = calibration.offsets();
        let shifted = |logs: &[Log]| -> Vec<Log> {
            let logs = logs.iter().cloned();
            logs.map(|log| log.without_offsets(&offsets)).collect()
        };
        let (runs, validation) = (shifted(self.runs), shifted(self.validation));
        let rebuilt = match calibration.lengths().next() {
            Some(_) => Some(self.robot.calibrated(calibration)?),
            None => None,
        };
        let own = Identifier {
            robot: rebuilt.as_ref().unwrap_or(self.robot),
            runs: &runs,
            validation: &validation,
            ..self.clone()
        };
        own.identified()
    }

    /// Identification without calibration, with gains, gravity direction and friction of gears as
    /// requested.
    fn identified(&self) -> Result<Identification, Error> {
        self.check_gears()?;
        self.check_stribeck()?;
        self.check_held()?;
        if self.gravity_direction {
            let made = self.in_gravity(|own, found| own.estimated(PriorStage::Gravity(found)))?;
            let (mut result, found) = made;
            result.warnings.splice(0..0, found.warnings());
            result.gravity = Some(found);
            return Ok(result);
        }
        if self.gear_friction {
            return self.with_gear_friction();
        }
        if self.stribeck_velocity {
            return self.with_stribeck_velocities();
        }
        if !self.gains {
            return self.estimated(PriorStage::Nothing);
        }
        let (mut result, gains) =
            self.with_gains(|own, gains| own.estimated(PriorStage::Gains(gains)))?;
        let others = std::mem::take(&mut result.warnings);
        result.warnings = [gains.warnings(), others].concat();
        result.gains = gains.drives;
        result.gain_parameters = gains.parameters;
        Ok(result)
    }

    /// Identification in the current state, after the preceding stages.
    pub(super) fn estimated(&self, before: PriorStage<'_>) -> Result<Identification, Error> {
        self.robot.check_prior()?;
        let settings = self.with_checks();
        let essential = self.essential();
        let instrumented = match settings.instruments {
            Instruments::Simulated => Some(self.robot.simulated(self.runs, &settings)?),
            _ => None,
        };
        let variants = self.robot.variants();
        let scales = self.robot.scales();
        let dataset = Dataset {
            runs: instrumented.as_deref().unwrap_or(self.runs),
            variants: &variants.lent(),
            scales: Some(&scales),
            ..self.dataset()
        };
        let mut result = identify_after(
            self.robot.model(),
            &dataset,
            before,
            &essential_or_not(&settings, essential),
            self.progress,
        )?;
        if !essential {
            without_essential(&mut result);
        }
        result.settings = settings;
        self.robot.set_limits(&mut result.figures.ranges);
        result.motors = at_motors(self.robot.description(), &result.estimates);
        result.functions_base = functions_base(self.robot.model().model(), &result);
        Ok(result)
    }

    /// Compares the actuator projection for all partitions.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn study(&self) -> Result<Study, Error> {
        let (runs, validation) = (self.moving(self.runs)?, self.moving(self.validation)?);
        let own = Identifier {
            runs: &runs,
            validation: &validation,
            ..self.clone()
        };
        if self.gravity_direction {
            let (mut study, found) = own.in_gravity(|own, _| own.studied())?;
            study.warnings.splice(0..0, found.warnings());
            return Ok(study);
        }
        if !self.gains {
            return own.studied();
        }
        let (mut study, gains) = own.with_gains(|own, _| own.studied())?;
        study.warnings.splice(0..0, gains.warnings());
        Ok(study)
    }

    /// Comparison without further preparation of the torques.
    fn studied(&self) -> Result<Study, Error> {
        let sizes = self.robot.model().info().sizes;
        let choices = partitions(sizes.actuators, sizes.dof);
        let settings = essential_or_not(&self.with_defaults(), self.essential());
        let (model, dataset) = (self.robot.model(), self.dataset());
        Ok(study(model, &dataset, &choices, &settings, self.progress)?)
    }

    pub(super) fn dataset(&self) -> Dataset<'a> {
        Dataset {
            runs: self.runs,
            validation: self.validation,
            true_values: self.true_values,
            variants: &[],
            scales: None,
        }
    }

    /// Settings, by default those of the description.
    pub(super) fn with_defaults(&self) -> Settings {
        let frequency = self.runs.first().map_or(0.0, Log::sampling_frequency);
        let own = || self.robot.settings(frequency);
        self.settings.clone().unwrap_or_else(own)
    }

    /// Settings without what basic checks leave out.
    pub(super) fn with_checks(&self) -> Settings {
        let settings = self.with_defaults();
        if settings.checks.has_fault_hypotheses() {
            return settings;
        }
        Settings {
            instruments: Instruments::None,
            ..settings
        }
    }

    /// Whether the description requests essential parameters.
    fn essential(&self) -> bool {
        self.robot.description().identification.essential
    }
}

/// Settings that disable the elimination if essential parameters are not requested.
pub(crate) fn essential_or_not(settings: &Settings, essential: bool) -> Settings {
    let r_sigma = if essential {
        settings.r_sigma
    } else {
        f64::INFINITY
    };
    Settings {
        r_sigma,
        ..settings.clone()
    }
}

/// Keeps the base and consistent estimates only.
pub(crate) fn without_essential_estimates(estimates: &mut Vec<Estimate>) {
    estimates.retain(|one| matches!(one.stage, Stage::Base | Stage::Consistent));
}

/// Removes results on essential parameters.
fn without_essential(result: &mut Identification) {
    let is_kept = |stage: Stage| matches!(stage, Stage::Base | Stage::Consistent);
    without_essential_estimates(&mut result.estimates);
    result.cross_validation.retain(|one| is_kept(one.stage));
    for verdict in &mut result.verdicts {
        verdict.stages.retain(|one| is_kept(one.stage));
        verdict.stage = Stage::Base;
    }
    let figures = &mut result.figures;
    figures.predictions.retain(|one| is_kept(one.stage));
    figures.residuals.retain(|one| is_kept(one.stage));
}
