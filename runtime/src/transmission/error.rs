//! Errors of transmissions between motors and joints.

use core::fmt;

/// Reason why a transmission has no value at a pose.
///
/// ```
/// use overact::transmission::{Error, Transmission};
///
/// // Both motors turn only the sum of two joints.
/// let error = Transmission::new(&[[1.0, 1.0], [2.0, 2.0]]).unwrap_err();
/// assert!(matches!(error, Error::Singular { .. }));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A number of an input is NaN or infinite.
    NotFinite {
        /// The input's name.
        input: &'static str,
    },
    /// The motors do not determine the motion of all joints at this pose.
    Singular {
        /// Condition number of the Jacobian, with columns scaled to the length 1.
        condition: f64,
    },
    /// The pose is beyond a singularity: the same motor positions have another pose in the mode of
    /// the home pose.
    AnotherMode,
    /// Several choices of motor gains have the same effect on the joints.
    Ambiguous,
    /// A limit or direction is not in its range.
    Setting {
        /// The setting's name.
        setting: &'static str,
        /// Condition that it violates.
        condition: &'static str,
    },
    /// A result is too large for a number.
    Overflow,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { input } => write!(f, "`{input}` has a number that is not finite"),
            Self::Singular { condition } if condition.is_finite() => write!(
                f,
                "the motors do not determine all joints here: the Jacobian has the condition number {condition:.1e}"
            ),
            Self::Singular { .. } => {
                write!(f, "the motors do not determine all joints here")
            }
            Self::AnotherMode => write!(
                f,
                "the pose is beyond a singularity: the same motor positions have another pose in the mode of home"
            ),
            Self::Ambiguous => write!(
                f,
                "several choices of motor gains have the same effect on the joints: give all gains but one of each such group"
            ),
            Self::Setting { setting, condition } => write!(f, "`{setting}` must be {condition}"),
            Self::Overflow => write!(f, "a value is too large for a number"),
        }
    }
}

impl core::error::Error for Error {}
