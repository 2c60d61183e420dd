//! A controller of the DualV for a microcontroller: no standard library, no allocator, nothing that panics.
//!
//! It is the controller of the paper's Fig. 4 with the inverse dynamics of identified parameters: independent PD
//! on every actuator, feed-forward of the torques that the desired motion takes, and projection of the sum by
//! eq. (50), so that four motors on three degrees of freedom do not work against one another. The parameters are
//! constants of the generated modules ([`unloaded`], [`loaded`]): `overact generate --parameters` writes them.
//!
//! The same code runs in `firmware/`, on a Cortex-M7, and in the tests, in the loop with the virtual robot.
#![no_std]

/// The robot with its payload: the inverse dynamics alone, for kinematics know no load.
#[rustfmt::skip]
pub mod loaded;
/// The robot without a payload.
#[rustfmt::skip]
pub mod unloaded;

use core::f64::consts::TAU;
use overact::{Error, math::wrap_angle};

/// Number of actuators.
pub const ACTUATORS: usize = unloaded::DualV::ACTUATORS;
/// Samples in a second.
pub const SAMPLING_HZ: f64 = 5000.0;
/// Natural frequency of the controlled robot, section 5.1 of the paper.
pub const BANDWIDTH_HZ: f64 = 70.0;
/// Damping factor, section 5.1 of the paper.
pub const DAMPING: f64 = 0.7;
/// exp(-2π f_d / f_s): what the filter of the derivative, a first-order low-pass of 70 Hz, keeps in a sample.
pub const SMOOTHING: f64 = 0.915_793_300_451_716_7;
/// Largest torque of a drive, N m.
pub const TORQUE_LIMIT: f64 = 127.0;

/// What stands on the platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// Nothing.
    Unloaded,
    /// The payload with which the robot was identified.
    Loaded,
}

impl Load {
    /// Inertia that each actuator moves, kg m²: what the gains are made of. As large as can be while no mode of
    /// the controlled robot is faster than the bandwidth along the runs of the description's experiment.
    #[must_use]
    pub const fn inertia(self) -> [f64; ACTUATORS] {
        match self {
            Self::Unloaded => [0.0913, 0.0931, 0.0931, 0.0945],
            Self::Loaded => [0.1498, 0.1216, 0.1216, 0.1519],
        }
    }
}

/// A desired motion of the platform at one sample: x, y (m) and φ (rad), and their derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Pose.
    pub pose: [f64; unloaded::DualV::POSE],
    /// Twist, m/s and rad/s.
    pub twist: [f64; unloaded::DualV::DOF],
    /// Its derivative, m/s² and rad/s².
    pub acceleration: [f64; unloaded::DualV::DOF],
}

/// The controller's memory: the errors of the sample before, and their filtered rates.
#[derive(Debug, Clone)]
pub struct Controller {
    load: Load,
    stiffness: [f64; ACTUATORS],
    damping: [f64; ACTUATORS],
    previous: Option<[f64; ACTUATORS]>,
    rates: [f64; ACTUATORS],
}

impl Controller {
    /// A controller at its first sample.
    #[must_use]
    pub fn new(load: Load) -> Self {
        let rate = TAU * BANDWIDTH_HZ;
        let inertia = load.inertia();
        Self {
            load,
            stiffness: inertia.map(|m| rate * rate * m),
            damping: inertia.map(|m| 2.0 * DAMPING * rate * m),
            previous: None,
            rates: [0.0; ACTUATORS],
        }
    }

    /// The torques of the motors, N m, for one sample: from what is desired and the positions of the actuators,
    /// rad, in any turn.
    ///
    /// # Errors
    /// A desired motion that the robot does not reach or where it is singular, or numbers that are not finite;
    /// the memory then stays as it was, and what to do is the caller's to say: hold the motors, or brake.
    pub fn step(
        &mut self,
        desired: &Motion,
        measured: &[f64; ACTUATORS],
    ) -> Result<[f64; ACTUATORS], Error> {
        let Motion {
            pose,
            twist,
            acceleration,
        } = desired;
        let positions = unloaded::DualV::actuator_positions(pose)?;
        let mut torques = match self.load {
            Load::Unloaded => unloaded::DualV::inverse_dynamics(pose, twist, acceleration)?,
            Load::Loaded => loaded::DualV::inverse_dynamics(pose, twist, acceleration)?,
        };
        let mut errors = [0.0; ACTUATORS];
        for ((error, desired), measured) in errors.iter_mut().zip(positions).zip(measured) {
            *error = wrap_angle(desired - measured);
        }
        let mut rates = self.rates;
        for ((rate, error), previous) in rates
            .iter_mut()
            .zip(errors)
            .zip(self.previous.unwrap_or(errors))
        {
            *rate += (1.0 - SMOOTHING) * ((error - previous) * SAMPLING_HZ - *rate);
        }
        let gains = self.stiffness.iter().zip(self.damping);
        let parts = gains.zip(errors.iter().zip(rates));
        for (torque, ((stiffness, damping), (error, rate))) in torques.iter_mut().zip(parts) {
            *torque += stiffness * error + damping * rate;
        }
        let torques = unloaded::DualV::project_torques(pose, &torques)?;
        self.previous = Some(errors);
        self.rates = rates;
        Ok(torques.map(|torque| torque.clamp(-TORQUE_LIMIT, TORQUE_LIMIT)))
    }
}
