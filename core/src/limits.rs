//! Numerical limits for each precision: thresholds for zero, and largest magnitudes.
//!
//! Thresholds are multiples of the rounding error, so they depend on the precision. The runtime,
//! the interpreter and generated C use these values.
//!
//! Inputs of generated functions are bounded by [`Largest`]. With these bounds the generator proves
//! that no value of a function overflows, and adds a guard to each value for which it cannot.

use crate::singular::SINGULAR;

/// The limits of a precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A determinant below this fraction of its magnitude at home counts as zero.
    pub singular: f64,
    /// A radicand of inverse or forward kinematics below this fraction of its value at home is
    /// dominated by rounding: its root has less than two digits.
    pub radicand: f64,
    /// Largest deviation of a quaternion's squared length from 1 for which its inverse root is
    /// linearised.
    ///
    /// The error is 3/8 of the square of this.
    pub quaternion: f64,
    /// Forward kinematics has converged when the largest step is below this (m, rad).
    pub step: f64,
    /// Magnitude (m, rad) beyond which a pose has a rounding error above that step.
    ///
    /// Vanishing steps do not mean convergence there.
    pub farthest: f64,
    /// A pivot of the normal matrix below this fraction of the largest counts as zero.
    pub pivot: f64,
    /// Newton's method on the joints has converged when the largest step is below this (m, rad).
    pub joint_step: f64,
    /// A leg whose closure errors (m, rad) are below this counts as closed after the last
    /// iteration.
    pub closed: f64,
    /// A partition whose condition number exceeds this counts as singular.
    pub partition: f64,
    /// A tension below its minimum by this fraction of the largest torque counts as the minimum.
    pub tension: f64,
    /// Largest magnitudes of inputs.
    pub largest: Largest,
}

/// Largest magnitudes of a function's inputs, by quantity, in SI units. All are far above physical values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// Coordinates of poses (m, rad).
    pub pose: f64,
    /// Positions of joints and actuators (m, rad), which may be angles of many turns.
    pub position: f64,
    /// Twists, rates of joints and actuators (m/s, rad/s).
    pub velocity: f64,
    /// Accelerations (m/s², rad/s²).
    pub acceleration: f64,
    /// Forces and torques (N, N m).
    pub force: f64,
    /// Standard and base parameters.
    pub parameter: f64,
}

impl Largest {
    /// The bound of an input by the name of its array in generated code.
    #[must_use]
    pub fn of(&self, array: &str) -> f64 {
        match array {
            "pose" | "start" => self.pose,
            "twist" | "joint_velocities" | "actuator_velocities" => self.velocity,
            "acceleration" | "joint_accelerations" | "actuator_accelerations" => self.acceleration,
            "torques" | "preload" | "wrench" => self.force,
            "parameters" | "base_parameters" => self.parameter,
            _ => self.position,
        }
    }
}

/// Limits for double precision, with a relative rounding error of 10⁻¹⁶.
pub const DOUBLE: Limits = Limits {
    singular: SINGULAR,
    radicand: 1e-13,
    quaternion: 1e-8,
    step: 1e-12,
    farthest: 4e3,
    pivot: 1e-15,
    joint_step: 1e-13,
    closed: 1e-10,
    partition: 1e9,
    tension: 1e-12,
    largest: Largest {
        pose: 1e6,
        position: 1e12,
        velocity: 1e9,
        acceleration: 1e12,
        force: 1e12,
        parameter: 1e12,
    },
};

/// Limits for single precision, with a relative rounding error of 6 · 10⁻⁸.
///
/// Lengths and angles of about 1 have an accuracy of 10⁻⁷. Steps of an iteration, which divide by a
/// Jacobian, have about 10⁻⁶.
pub const SINGLE: Limits = Limits {
    singular: 1e-5,
    radicand: 1e-5,
    quaternion: 2e-4,
    step: 1e-5,
    farthest: 80.0,
    pivot: 1e-7,
    joint_step: 3e-6,
    closed: 3e-5,
    partition: 1e5,
    tension: 1e-5,
    largest: Largest {
        pose: 1e3,
        position: 1e5,
        velocity: 1e5,
        acceleration: 1e8,
        force: 1e9,
        parameter: 1e6,
    },
};
