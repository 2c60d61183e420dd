//! Errors of the evaluation of a model at a state, which never panics and never returns NaN.

use core::fmt;

/// Reason why a robot's model has no value at a state.
///
/// If several conditions fail at once, the first leg of the description is reported. Its reach
/// precedes its singularity, and the actuators are reported only if all legs are regular. Compiled
/// and interpreted models report the same error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The platform pose is outside the reach of a leg.
    OutOfReach {
        /// Name of the leg.
        leg: &'static str,
    },
    /// A leg is in, or very close to, a singular configuration: the platform's motion does not
    /// determine its joint rates.
    SingularLeg {
        /// Name of the leg.
        leg: &'static str,
        /// Ratio of the leg's determinant at the home configuration to that at the state.
        condition: f64,
    },
    /// The actuators do not determine the platform's motion (parallel singularity).
    ///
    /// Or the kept actuators of the actuator projection do not determine it (partition
    /// singularity).
    SingularPlatform {
        /// The actuators.
        actuators: ActuatorGroup,
        /// Ratio of the determinant at the home configuration to that at the state.
        condition: f64,
    },
    /// A leg does not allow the pose, not all of whose coordinates are independent.
    NotClosed {
        /// Name of the leg.
        leg: &'static str,
        /// Closure error in a direction in which no joint moves the leg's end (m, rad); NaN if the
        /// leg does not reach the pose.
        gap: f64,
    },
    /// The independent coordinates of a pose with dependent ones do not determine the others.
    SingularCoordinates {
        /// Ratio of the determinant at the home configuration to that at the state.
        condition: f64,
    },
    /// The mass matrix of the given parameters is not positive definite.
    ///
    /// There is motion with zero or negative kinetic energy.
    MassMatrix,
    /// No torques with tensions of at least the minima produce the motion.
    Tensions,
    /// Kept actuators other than the description's do not determine the platform's motion.
    SingularPartition {
        /// The kept actuators.
        kept: Actuators,
        /// Condition number of their rows of J_p^inv.
        condition: f64,
    },
    /// There is no actuator of this index.
    NoActuator {
        /// The index, counted from 0.
        index: usize,
        /// Number of actuators.
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
    /// A number of an input exceeds [`Largest`](crate::limits::Largest): values computed from it
    /// might overflow.
    OutOfRange {
        /// The input's name.
        input: &'static str,
    },
    /// The quaternion of a pose is zero and represents no rotation.
    ZeroQuaternion {
        /// The input's name.
        input: &'static str,
    },
    /// An intermediate value or a result overflows, although all inputs are in range.
    Overflow,
    /// A function was called with the wrong number of inputs.
    Inputs {
        /// Number of inputs of the function.
        expected: usize,
        /// Number of inputs given.
        found: usize,
    },
    /// A slice has the wrong number of elements.
    Length {
        /// Number of elements required.
        expected: usize,
        /// Number of elements given.
        found: usize,
    },
    /// The model does not offer the function.
    NotOffered {
        /// The function's name.
        function: &'static str,
    },
}

/// Formats how many times smaller a value is than at home; infinity means zero.
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
            Self::NotClosed { leg, gap } if gap.is_nan() => {
                write!(f, "the pose is out of reach of leg `{leg}`")
            }
            Self::NotClosed { leg, gap } => write!(
                f,
                "leg `{leg}` does not allow the pose: it is {gap:.1e} m or rad off in a direction that the leg blocks"
            ),
            Self::SingularCoordinates { condition } => write!(
                f,
                "the independent coordinates do not determine the others here: their determinant is {}",
                Smaller(condition)
            ),
            Self::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite: with these parameters there is a motion without kinetic energy, or with a negative one"
            ),
            Self::Tensions => write!(
                f,
                "no tensions above the minima of the cables produce this motion"
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

/// A group of actuators that may determine the platform's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ActuatorGroup {
    /// All actuators, as in the platform projection.
    All,
    /// The kept actuators of the actuator projection.
    Kept,
}

impl fmt::Display for ActuatorGroup {
    /// Writes `actuators` or `kept actuators`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::All => "actuators",
            Self::Kept => "kept actuators",
        })
    }
}

/// A set of actuators, by their indices in the order of q and τ, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Actuators(u64);

impl Actuators {
    /// The set of the given actuators. Indices from 64 on are left out, since the set is used in
    /// messages only.
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
    /// Writes `0, 1, 3 (counted from 0)`.
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
    /// The error.
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
    fn zero_determinants_are_printed_as_zero() {
        let message = |condition| {
            Error::SingularLeg {
                leg: "left",
                condition,
            }
            .to_string()
        };
        assert!(message(f64::INFINITY).ends_with("its determinant is zero"));
        assert!(message(2e9).ends_with("its determinant is 2.0e9 times smaller than at home"));
    }

    #[test]
    fn poses_without_a_closure_error_are_out_of_reach() {
        let message = |gap| Error::NotClosed { leg: "rod", gap }.to_string();
        assert_eq!(message(f64::NAN), "the pose is out of reach of leg `rod`");
        assert!(message(0.01).contains("it is 1.0e-2 m or rad off"));
    }
}
