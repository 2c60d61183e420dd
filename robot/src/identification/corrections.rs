//! Quantities that are identified before the parameters: gains of drives, direction of gravity,
//! friction of gears, Stribeck velocities.

use crate::{
    error::{Error, Problem},
    identification::identifier::Identifier,
};
use overact_codegen::description::{
    COUPLED_MOTORS, GAINS_AND_GRAVITY, GEARS_ALONE, GEARS_OF_COUPLED_MOTORS, HELD_AND_CORRECTIONS,
    KNOWN_TORQUES, Leg, NO_STRIBECK, STRIBECK_ALONE,
};
use overact_codegen::diagnostic::Code;
use overact_identification::{
    Gains, GravityDirection, Identification, Log, PriorStage, Progress, Settings, drive_gains,
    gear_friction, stribeck_velocities,
};

impl Identifier<'_> {
    /// Rejects the friction of gears next to other corrections of the torques.
    pub(super) fn check_gears(&self) -> Result<(), Error> {
        let mut legs = self.robot.description().legs.iter();
        let why = if self.gains || self.gravity_direction {
            GEARS_ALONE
        } else if legs.any(Leg::has_coupled_motors) {
            GEARS_OF_COUPLED_MOTORS
        } else {
            return Ok(());
        };
        if !self.gear_friction {
            return Ok(());
        }
        let problem = Problem::new(Code::CONTRADICTION, why).file(self.robot.file());
        Err(problem.help("identify without `gear_friction`").into())
    }

    /// Rejects Stribeck velocities next to other corrections, and of robots without any.
    pub(super) fn check_stribeck(&self) -> Result<(), Error> {
        if !self.stribeck_velocity {
            return Ok(());
        }
        let why = if self.gains || self.gravity_direction || self.gear_friction {
            STRIBECK_ALONE
        } else if !self.robot.description().has_stribeck() {
            NO_STRIBECK
        } else {
            return Ok(());
        };
        let problem = Problem::new(Code::CONTRADICTION, why).file(self.robot.file());
        let help = "identify without `stribeck_velocity`";
        Err(problem.help(help).into())
    }

    /// Rejects held parameters next to corrections of the torques.
    pub(super) fn check_held(&self) -> Result<(), Error> {
        let is_corrected = self.gains || self.gravity_direction || self.gear_friction;
        if !is_corrected || self.robot.description().prior.held.is_empty() {
            return Ok(());
        }
        let problem = Problem::new(Code::CONTRADICTION, HELD_AND_CORRECTIONS);
        let help = "leave out `held` of [prior], or identify without the correction";
        Err(problem.file(self.robot.file()).help(help).into())
    }

    /// Identification from the torques that the gears transmit.
    pub(super) fn with_gear_friction(&self) -> Result<Identification, Error> {
        let settings = self.with_checks();
        let dataset = self.dataset();
        let model = self.robot.model();
        let found = gear_friction(model, &dataset, &settings, self.progress)?;
        let own = Identifier {
            settings: Some(Settings {
                gear_friction: found.gears(),
                ..settings
            }),
            ..self.clone()
        };
        let mut result = own.estimated(PriorStage::GearFriction(&found))?;
        result.warnings.splice(0..0, found.warnings());
        result.gear_friction = found.drives;
        Ok(result)
    }

    /// Identification with the estimated Stribeck velocities.
    pub(super) fn with_stribeck_velocities(&self) -> Result<Identification, Error> {
        let settings = self.with_checks();
        let model = self.robot.model();
        let found = stribeck_velocities(model, &self.dataset(), &settings, self.progress)?;
        let own = Identifier {
            settings: Some(Settings {
                stribeck_velocities: found.velocities(),
                ..settings
            }),
            ..self.clone()
        };
        let mut result = own.estimated(PriorStage::Stribeck(&found))?;
        result.warnings.splice(0..0, found.warnings());
        result.stribeck_velocities = found.joints;
        Ok(result)
    }

    /// Identifies the gains of the drives.
    fn drive_gains(&self) -> Result<Gains, Error> {
        let mut legs = self.robot.description().legs.iter();
        if legs.any(Leg::has_coupled_motors) {
            let problem = Problem::new(Code::CONTRADICTION, COUPLED_MOTORS).file(self.robot.file());
            let help =
                "identify without gains; a gain of a motor scales its `torque_gain` in [data]";
            return Err(problem.help(help).into());
        }
        let mut legs = self.robot.description().legs.iter();
        let mut springs = self.robot.description().springs.iter();
        if legs.any(Leg::has_known_torques) || springs.any(|spring| spring.known.is_some()) {
            let problem = Problem::new(Code::CONTRADICTION, KNOWN_TORQUES).file(self.robot.file());
            let help = "identify without gains, or leave out the key `known` of joints and springs";
            return Err(problem.help(help).into());
        }
        let tell = |run: &str, done, samples| (self.progress)(Progress::Run { run, done, samples });
        let settings = self.with_defaults();
        let (model, runs) = (self.robot.model(), self.runs);
        Ok(drive_gains(model, runs, &settings, &tell)?)
    }

    /// Calls `make` for runs whose torques are scaled by the identified gains.
    pub(super) fn with_gains<T>(
        &self,
        make: impl FnOnce(&Identifier<'_>, &Gains) -> Result<T, Error>,
    ) -> Result<(T, Gains), Error> {
        let gains = self.drive_gains()?;
        let factors = gains.factors();
        let scaled = |logs: &[Log]| -> Vec<Log> {
            let logs = logs.iter().cloned();
            logs.map(|log| log.with_torque_factors(&factors)).collect()
        };
        let (runs, validation) = (scaled(self.runs), scaled(self.validation));
        let own = Identifier {
            runs: &runs,
            validation: &validation,
            ..self.clone()
        };
        Ok((make(&own, &gains)?, gains))
    }

    /// Calls `make` for the robot with the identified gravity direction.
    pub(super) fn in_gravity<T>(
        &self,
        make: impl FnOnce(&Identifier<'_>, &GravityDirection) -> Result<T, Error>,
    ) -> Result<(T, GravityDirection), Error> {
        if self.gains {
            let help = "identify the gains first, put them into `torque_gain` of [data], then identify the direction";
            let problem =
                Problem::new(Code::CONTRADICTION, GAINS_AND_GRAVITY).file(self.robot.file());
            return Err(problem.help(help).into());
        }
        let tell = |run: &str, done, samples| (self.progress)(Progress::Run { run, done, samples });
        let settings = self.with_defaults();
        let found = self.robot.gravity_direction(self.runs, &settings, &tell)?;
        let turned = if found.significant {
            Some(self.robot.in_gravity(found.used())?)
        } else {
            None
        };
        let robot = turned.as_ref().unwrap_or(self.robot);
        // The prior must refer to the parameters that have an effect in this gravity.
        let frequency = self.runs.first().map_or(0.0, Log::sampling_frequency);
        let settings = Settings {
            prior: robot.settings(frequency).prior,
            ..settings
        };
        let own = Identifier {
            robot,
            settings: Some(settings),
            ..self.clone()
        };
        Ok((make(&own, &found)?, found))
    }
}
