//! A controller of the DualV for a microcontroller: no standard library, no allocator, no panics.
//!
//! It is the controller of the paper's Fig. 4 with inverse dynamics of identified parameters. It
//! consists of PD control of every actuator, feed-forward torques of the desired motion, and
//! projection of the sum by eq. (50). The projection prevents four motors on three degrees of
//! freedom from working against each other. The parameters are constants of the generated modules
//! ([`unloaded`], [`loaded`]), written by `overact generate --parameters`. [`payload`] estimates a
//! payload in closed loop.
//!
//! The same code runs in `firmware/` on a Cortex-M7, and in the tests in closed loop with the
//! virtual robot.
#![no_std]

/// The robot with payload: inverse dynamics only, because kinematics do not depend on the load.
#[rustfmt::skip]
pub mod loaded;
/// The payload, estimated while the robot moves.
pub mod payload;
/// Pose, platform projection and payload columns, independent of the parameters.
#[rustfmt::skip]
pub mod platform;
/// The robot without payload.
#[rustfmt::skip]
pub mod unloaded;

use core::f64::consts::TAU;
use overact::{Error, math::wrap_angle};

/// Number of actuators.
pub const ACTUATORS: usize = unloaded::DualV::ACTUATORS;
/// Sampling frequency, Hz.
pub const SAMPLING_HZ: f64 = 5000.0;
/// Natural frequency of the controlled robot, section 5.1 of the paper.
pub const BANDWIDTH_HZ: f64 = 70.0;
/// Damping factor, section 5.1 of the paper.
pub const DAMPING: f64 = 0.7;
/// exp(-2π f_d / f_s): coefficient of the derivative's first-order low-pass filter of 70 Hz.
pub const SMOOTHING: f64 = 0.915_793_300_451_716_7;
/// Torque limit of a drive, N m.
pub const TORQUE_LIMIT: f64 = 127.0;

/// Load on the platform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// No payload.
    Unloaded,
    /// The payload of the identification.
    Loaded,
}

impl Load {
    /// Effective inertia of each actuator, kg m², from which the gains are computed.
    ///
    /// It is the largest for which no mode of the controlled robot is faster than the bandwidth
    /// along the runs of the description's experiment.
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

/// State of the controller: errors of the previous sample, and their filtered rates.
#[derive(Debug, Clone)]
pub struct Controller {
    load: Load,
    stiffness: [f64; ACTUATORS],
    damping: [f64; ACTUATORS],
    previous: Option<[f64; ACTUATORS]>,
    rates: [f64; ACTUATORS],
}

impl Controller {
    /// Controller at its first sample.
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

    /// Torques of the motors, N m, for one sample, from the desired motion and the actuator
    /// positions.
    ///
    /// Positions are in rad, in any turn.
    ///
    /// # Errors
    /// A desired motion that is unreachable or singular, or numbers that are not finite. The state
    /// is then unchanged, and the caller decides what to do: hold the motors, or brake.
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
