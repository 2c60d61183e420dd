//! A description's tables `[data]` and `[identification]` as settings of the identification.

use crate::{
    error::{Error, Problem},
    robot::Robot,
};
use overact::Model;
use overact_codegen::description::{Factor, Friction, Normalisation, Reversals};
use overact_identification::{Gain, Mapping, Settings};

impl Robot {
    /// The settings of an identification from runs sampled at `frequency` (Hz).
    #[must_use]
    pub fn settings(&self, frequency: f64) -> Settings {
        let table = &self.description().identification;
        let usual = Settings::for_sampling_frequency(frequency, &self.model().info());
        let settings = Settings {
            filter_order: table.filter_order,
            filter_cutoff_hz: table.filter_cutoff.unwrap_or(usual.filter_cutoff_hz),
            decimation: table.decimation.unwrap_or(usual.decimation),
            skip_start: table.skip_start.unwrap_or(0),
            skip_end: table.skip_end.unwrap_or(0),
            velocity_dead_band: table.velocity_dead_band,
            averaged_reversals: table.reversals == Reversals::Averaged,
            r_sigma: table.r_sigma,
            normalisation: match table.normalisation {
                Normalisation::MinusOne => overact_identification::Normalisation::SampleVariance,
                Normalisation::MinusParameters => overact_identification::Normalisation::Unbiased,
            },
            asymmetric_friction: table.friction == Friction::Asymmetric,
            weighted: table.weighted,
            ..usual
        };
        if table.skip_start.is_none() && table.skip_end.is_none() {
            settings.trimmed(frequency)
        } else {
            settings
        }
    }

    /// Which columns of a log are what: those that the description names, or `time`, `q_<actuator>` and
    /// `tau_<actuator>`.
    ///
    /// # Errors
    /// A position that is scaled by a variable of the log: only gains of torques can be.
    pub fn mapping(&self) -> Result<Mapping, Error> {
        let Some(data) = &self.description().data else {
            return Ok(Mapping::for_robot(&self.model().info()));
        };
        let scale = |factor: &Factor| match factor {
            Factor::Value(value) => Ok(*value),
            Factor::Variable(name) => {
                let message =
                    format!("`position_scale`: `{name}` is neither a number nor a constant");
                Err(Problem::new(message).file(self.file()))
            }
        };
        let gain = |factor: &Factor| match factor {
            Factor::Value(value) => Gain::Value(*value),
            Factor::Variable(name) => Gain::Variable(name.clone()),
        };
        Ok(Mapping {
            time: data.time.clone(),
            positions: data.positions.clone(),
            torques: data.torques.clone(),
            position_scale: data
                .position_scale
                .iter()
                .map(scale)
                .collect::<Result<_, _>>()?,
            torque_gain: data.torque_gain.iter().map(gain).collect(),
        })
    }
}
