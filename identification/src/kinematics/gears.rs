//! Removal of the gears' friction from measured torques.

use super::motion::Motion;
use crate::{gear_friction::GearFriction, settings::Settings};

/// Gears of all actuators.
pub(super) struct Gears {
    /// Empty if no gear has friction.
    friction: Vec<GearFriction>,
    /// Whether the sign of a velocity is the mean over a sampling interval.
    averaged: bool,
}

impl Gears {
    pub(super) fn new(settings: &Settings) -> Self {
        let mut all = settings.gear_friction.iter();
        let friction = if all.all(GearFriction::is_none) {
            Vec::new()
        } else {
            settings.gear_friction.clone()
        };
        Self {
            friction,
            averaged: settings.averaged_reversals,
        }
    }

    /// Replaces the torques of the drives by those that the gears transmit.
    ///
    /// `accelerations` are those of the actuators, samples × n (m/s², rad/s²).
    pub(super) fn take_losses(&self, motion: &mut Motion, accelerations: &[f64]) {
        let Motion {
            torques,
            velocities,
            sampling_frequency,
            ..
        } = motion;
        let states = velocities.iter().zip(accelerations);
        let gears = self.friction.iter().cycle();
        for ((torque, (velocity, acceleration)), gear) in torques.iter_mut().zip(states).zip(gears)
        {
            let step = if self.averaged {
                acceleration / *sampling_frequency
            } else {
                0.0
            };
            *torque = gear.transmitted(*torque, mean_sign(*velocity, step));
        }
    }
}

/// Mean sign over an interval in which a velocity changes by `step`, with `velocity` at its centre.
pub(crate) fn mean_sign(velocity: f64, step: f64) -> f64 {
    if velocity == 0.0 {
        0.0
    } else {
        (2.0 * velocity / step.abs()).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::mean_sign;

    #[test]
    fn the_mean_sign_is_averaged_over_the_interval() {
        // From -0.5 to 1.5: a quarter of the interval is negative.
        assert_eq!(mean_sign(0.5, 2.0), 0.5);
        assert_eq!(mean_sign(-0.5, -2.0), -0.5);
        assert_eq!(mean_sign(0.0, 0.0), 0.0);
        assert_eq!(mean_sign(1e-9, 0.0), 1.0);
        assert_eq!(mean_sign(-3.0, 2.0), -1.0);
    }
}
