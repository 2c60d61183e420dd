//! Converts the `[data]` and `[identification]` tables to settings of the identification.

use crate::{
    configuration::prior::{prior, with_loads},
    robot::Robot,
};
use overact::{Info, Model};
use overact_codegen::description::{
    self, Clock, Description, Factor, Friction, Normalisation, Reversals,
};
use overact_identification::{Gain, Instruments, Mapping, Settings, Time};

impl Robot {
    /// Settings of an identification from runs sampled at `frequency` (Hz).
    #[must_use]
    pub fn settings(&self, frequency: f64) -> Settings {
        settings(self.description(), &self.model().info(), frequency)
    }

    /// Columns of a log: those of the description, or `time`, `q_<actuator>` and `tau_<actuator>`.
    #[must_use]
    pub fn mapping(&self) -> Mapping {
        let Some(data) = &self.description().data else {
            let mapping = Mapping::for_robot(&self.model().info());
            let torque_gain = self.of_drums(mapping.torque_gain);
            return Mapping {
                torque_gain,
                ..mapping
            };
        };
        let gain = |factor: &Factor| match factor {
            Factor::Value(value) => Gain::Value(*value),
            Factor::Variable(name) => Gain::Variable(name.clone()),
        };
        Mapping {
            time: match &data.time {
                Clock::Column(name) => Time::Column(name.clone()),
                Clock::Frequency(frequency) => Time::Frequency(*frequency),
            },
            positions: data.positions.clone(),
            torques: data.torques.clone(),
            velocities: data.velocities.clone(),
            position_scale: data.position_scale.clone(),
            position_offset: data.position_offset.clone(),
            torque_gain: self.of_drums(data.torque_gain.iter().map(gain).collect()),
            resample: data.resample,
            transmission: data.transmission.clone(),
            rotating: rotating(&data.transmission, self.model().info().actuator_is_revolute),
        }
    }
}

impl Robot {
    /// Factors to the tensions of cables whose logs contain torques of drums.
    ///
    /// A gain that is a variable of the log is that of a tension; the description refuses a drum
    /// with it.
    fn of_drums(&self, mut gains: Vec<Gain>) -> Vec<Gain> {
        let legs = self.description().legs.iter();
        let actuated = legs.flat_map(|leg| {
            let own = leg.joints.iter().filter(|joint| joint.actuated);
            own.map(|_| leg.cable.as_ref().and_then(|cable| cable.drum))
        });
        for (gain, drum) in gains.iter_mut().zip(actuated) {
            if let (Gain::Value(value), Some(drum)) = (gain, drum) {
                *value /= drum.value();
            }
        }
        gains
    }
}

/// Whether each position of a log is an angle: of a joint, or of a motor that drives revolute
/// joints only.
fn rotating(transmission: &[Vec<f64>], joints: &[bool]) -> Vec<bool> {
    if transmission.is_empty() {
        return joints.to_vec();
    }
    let turns = |row: &Vec<f64>| {
        let mut moved = row.iter().zip(joints).filter(|(factor, _)| **factor != 0.0);
        moved.all(|(_, rotates)| *rotates)
    };
    transmission.iter().map(turns).collect()
}

/// Settings of a description for runs sampled at `frequency` (Hz).
pub(crate) fn settings(description: &Description, info: &Info<'_>, frequency: f64) -> Settings {
    let table = &description.identification;
    let usual = Settings::for_sampling_frequency(frequency, info);
    let settings = Settings {
        filter_order: table.filter_order,
        filter_cutoff_hz: table.filter_cutoff.unwrap_or(usual.filter_cutoff_hz),
        difference_order: table.difference_order.unwrap_or(usual.difference_order),
        decimation: table.decimation.unwrap_or(usual.decimation),
        skip_start: table.skip_start.unwrap_or(0),
        skip_end: table.skip_end.unwrap_or(0),
        velocity_dead_band: table.velocity_dead_band,
        standstill_velocity: table.standstill_velocity.clone(),
        filter_torques: table.filter_torques,
        filter_equations: table.filter_equations,
        validation_samples: table.validation_samples,
        averaged_reversals: table.reversals == Reversals::Averaged,
        r_sigma: table.r_sigma,
        normalisation: match table.normalisation {
            Normalisation::MinusOne => overact_identification::Normalisation::SampleVariance,
            Normalisation::MinusParameters => overact_identification::Normalisation::Unbiased,
        },
        asymmetric_friction: table.friction == Friction::Asymmetric,
        weighted: table.weighted,
        instruments: match table.instruments {
            description::Instruments::Periods => Instruments::Periods,
            description::Instruments::Simulated => Instruments::Simulated,
            description::Instruments::None => Instruments::None,
        },
        period_s: table.period,
        prior: prior(
            description,
            &with_loads(description, info),
            info.home_joints,
        ),
        known: table.known.iter().cloned().collect(),
        ..usual
    };
    if table.skip_start.is_none() && table.skip_end.is_none() {
        settings.trimmed(frequency)
    } else {
        settings
    }
}
