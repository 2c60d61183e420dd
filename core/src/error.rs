//! What can go wrong when a model is evaluated at a state: never a panic, never a NaN.

use core::fmt;

/// Why a robot's model has no value at a state.
///
/// Where several conditions fail at once, the first leg of the description is told, its reach before its
/// singularity, and the actuators only where all legs are regular. Compiled and interpreted models say the
/// same.
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
        /// Which actuators they are.
        actuators: ActuatorGroup,
        /// How many times smaller the determinant is than at the home configuration.
        condition: f64,
    },
    /// The pose is none that a leg allows: of a platform that moves aside, not all coordinates can be chosen.
    NotClosed {
        /// Name of the leg.
        leg: &'static str,
        /// By how much the pose misses, in a direction that no joint of the leg gives (m, rad).
        gap: f64,
    },
    /// The independent coordinates of a platform that moves aside do not determine the others here.
    SingularCoordinates {
        /// How many times smaller the determinant is than at the home configuration.
        condition: f64,
    },
    /// The mass matrix of the given parameters is not positive definite: there is motion without kinetic
    /// energy, or with a negative one.
    MassMatrix,
    /// Other actuators than those of the description are kept in case 2, and they do not determine the
    /// platform's motion.
    SingularPartition {
        /// The kept actuators.
        kept: Actuators,
        /// Condition number of their rows of J_p^inv.
        condition: f64,
    },
    /// There is no actuator of this number.
    NoActuator {
        /// The number, counted from 0.
        index: usize,
        /// How many actuators there are.
        actuators: usize,
    },
    /// The forward kinematics did not converge from the start pose.
    NoConvergence {
        /// Largest remaining difference of an actuator's position, m or rad.
        residual: f64,
    },
    /// A number of an input is NaN or infinite.
    NotFinite {
        /// The input's name.
        input: &'static str,
    },
    /// A number of an input is larger than [`Largest`](crate::limits::Largest) allows: values computed from it
    /// might be too large for a number.
    OutOfRange {
        /// The input's name.
        input: &'static str,
    },
    /// The quaternion of a pose has no direction, so that it is no rotation.
    ZeroQuaternion {
        /// The input's name.
        input: &'static str,
    },
    /// A value on the way to the results, or a result, is too large for a number, although all inputs are in range.
    Overflow,
    /// A function was given another number of inputs than it takes.
    Inputs {
        /// Inputs that the function takes.
        expected: usize,
        /// Inputs that were given.
        found: usize,
    },
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

/// How many times smaller than at home something is; infinitely many times is zero.
struct Smaller(f64);

impl fmt::Display for Smaller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_finite() {
            write!(f, "{:.1e} times smaller than at home", self.0)
        } else {
            write!(f, "zero")
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::OutOfReach { leg } => {
                write!(f, "the pose is out of reach of leg `{leg}`")
            }
            Self::SingularLeg { leg, condition } => write!(
                f,
                "leg `{leg}` is singular here: its determinant is {}",
                Smaller(condition)
            ),
            Self::SingularPlatform {
                actuators,
                condition,
            } => write!(
                f,
                "the {actuators} do not determine the platform's motion here: their determinant is {}",
                Smaller(condition)
            ),
            Self::NotClosed { leg, gap } => write!(
                f,
                "leg `{leg}` does not allow the pose: it is {gap:.1e} m or rad off in a direction that the leg blocks"
            ),
            Self::SingularCoordinates { condition } => write!(
                f,
                "the independent coordinates do not determine the platform's motion here: their determinant is {}",
                Smaller(condition)
            ),
            Self::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite: with these parameters there is a motion without kinetic energy, or with a negative one"
            ),
            Self::SingularPartition { kept, condition } => write!(
                f,
                "the kept actuators {kept} do not determine the platform's motion here: their Jacobian has the condition number {condition:.1e}"
            ),
            Self::NoActuator { index, actuators } => write!(
                f,
                "there is no actuator {index}: the robot has {actuators}, counted from 0"
            ),
            Self::NoConvergence { residual } => write!(
                f,
                "the forward kinematics did not converge (an actuator is off by {residual:.1e})"
            ),
            Self::NotFinite { input } => {
                write!(f, "`{input}` has a number that is not finite")
            }
            Self::OutOfRange { input } => write!(
                f,
                "`{input}` has a number that is too large: values computed from it might overflow"
            ),
            Self::ZeroQuaternion { input } => {
                write!(
                    f,
                    "the quaternion of `{input}` is zero, which is no rotation"
                )
            }
            Self::Overflow => write!(f, "a value is too large for a number"),
            Self::Inputs { expected, found } => {
                write!(f, "the function takes {expected} inputs, found {found}")
            }
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

/// The actuators that are to determine the platform's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ActuatorGroup {
    /// All of them: case 1.
    All,
    /// Those that case 2 keeps.
    Kept,
}

impl fmt::Display for ActuatorGroup {
    /// `actuators` or `kept actuators`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::All => "actuators",
            Self::Kept => "kept actuators",
        })
    }
}

/// A set of actuators, by their numbers in the order of q and τ, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Actuators(u64);

impl Actuators {
    /// The set of the given actuators. Numbers from 64 on are left out: the set serves messages.
    #[must_use]
    pub fn new(numbers: &[usize]) -> Self {
        let bit = |at: &usize| u32::try_from(*at).ok().and_then(|at| 1_u64.checked_shl(at));
        Self(numbers.iter().filter_map(bit).fold(0, |set, bit| set | bit))
    }

    /// The numbers in ascending order.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..64).filter(move |at| self.0 >> at & 1 == 1)
    }
}

impl fmt::Display for Actuators {
    /// `0, 1, 3 (counted from 0)`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, number) in self.iter().enumerate() {
            let comma = if place == 0 { "" } else { ", " };
            write!(f, "{comma}{number}")?;
        }
        write!(f, " (counted from 0)")
    }
}

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

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn a_determinant_of_zero_is_not_infinitely_smaller() {
        let told = |condition| {
            Error::SingularLeg {
                leg: "left",
                condition,
            }
            .to_string()
        };
        assert!(told(f64::INFINITY).ends_with("its determinant is zero"));
        assert!(told(2e9).ends_with("its determinant is 2.0e9 times smaller than at home"));
    }
}
