//! What can go wrong when a model is evaluated at a state: never a panic, never a NaN.

use core::fmt;

/// Why a robot's model has no value at a state.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The platform pose is outside the reach of a leg.
    OutOfReach {
        /// Name of the leg.
        leg: &'static str,
    },
    /// A leg is at, or very near, a singular configuration: its joint rates are not determined by
    /// the platform's motion.
    SingularLeg {
        /// Name of the leg.
        leg: &'static str,
        /// How many times smaller the leg's determinant is than at the home configuration.
        condition: f64,
    },
    /// The actuators do not determine the platform's motion (parallel singularity), or the kept
    /// actuators of case 2 do not (partition singularity).
    SingularPlatform {
        /// What is singular: `"actuators"` or `"kept actuators"`.
        actuators: &'static str,
        /// How many times smaller the determinant is than at the home configuration.
        condition: f64,
    },
    /// The forward kinematics did not converge from the start pose.
    NoConvergence {
        /// Largest remaining difference of an actuator's position, m or rad.
        residual: f64,
    },
    /// An input is not a finite number.
    NotFinite,
    /// A slice has the wrong number of elements.
    Length {
        /// Elements that the function needs.
        expected: usize,
        /// Elements that were given.
        found: usize,
    },
    /// The model does not offer the function.
    NotOffered {
        /// The function's name.
        function: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfReach { leg } => {
                write!(f, "the pose is out of reach of leg `{leg}`")
            }
            Self::SingularLeg { leg, condition } => write!(
                f,
                "leg `{leg}` is singular here: its determinant is {condition:.1e} times smaller than at home"
            ),
            Self::SingularPlatform {
                actuators,
                condition,
            } => write!(
                f,
                "the {actuators} do not determine the platform's motion here: their determinant is {condition:.1e} times smaller than at home"
            ),
            Self::NoConvergence { residual } => write!(
                f,
                "the forward kinematics did not converge (an actuator is off by {residual:.1e})"
            ),
            Self::NotFinite => write!(f, "an input is not a finite number"),
            Self::Length { expected, found } => {
                write!(f, "expected {expected} numbers, found {found}")
            }
            Self::NotOffered { function } => {
                write!(f, "this model does not offer `{function}`")
            }
        }
    }
}

impl core::error::Error for Error {}

/// An [`Error`] and the sample of a block at which it occurred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleError {
    /// Index of the sample, counted from 0.
    pub sample: usize,
    /// What went wrong there.
    pub error: Error,
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sample {}: {}", self.sample, self.error)
    }
}

impl core::error::Error for SampleError {}
