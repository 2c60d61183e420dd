//! Guards: conditions that a function checks before it divides or takes a root.

use crate::cas::Expr;
use overact_core::ActuatorGroup;

/// A value and the condition that it has to satisfy.
#[derive(Debug, Clone)]
pub struct Guard<'a> {
    /// The quantity.
    pub value: Expr<'a>,
    /// The meaning of the condition.
    pub kind: GuardKind,
    /// Name of the leg.
    pub leg: String,
}

/// The meaning of a guard's condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GuardKind {
    /// Negative: the pose is out of reach. Near zero relative to this value at home: the leg is
    /// singular.
    Reach(f64),
    /// Near zero relative to this magnitude at home: the leg is singular.
    Leg(f64),
    /// Near zero relative to this magnitude at home: the actuators do not determine the platform's
    /// motion.
    Platform {
        /// The magnitude at home.
        home: f64,
        /// The actuators.
        actuators: ActuatorGroup,
    },
    /// Farther from zero than this (m, rad): the leg does not allow the pose.
    Closed(f64),
    /// Near zero relative to this magnitude at home: the independent coordinates do not determine
    /// the others.
    Coordinates(f64),
    /// Not positive: the mass matrix is not positive definite.
    Mass,
}

/// The magnitude at home with four significant digits, as the generated code states it.
///
/// A guard uses it only as an order of magnitude.
#[must_use]
pub fn rounded_magnitude(magnitude: f64) -> f64 {
    format!("{magnitude:.3e}").parse().unwrap_or(magnitude)
}

impl GuardKind {
    /// The magnitude at home to which a value is compared; `None` if only the sign matters.
    #[must_use]
    pub const fn home(&self) -> Option<f64> {
        match self {
            Self::Mass | Self::Closed(_) => None,
            Self::Reach(home)
            | Self::Leg(home)
            | Self::Coordinates(home)
            | Self::Platform { home, .. } => Some(*home),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::rounded_magnitude;

    #[test]
    fn magnitudes_are_rounded_to_four_digits() {
        let cases = [
            (0.0, 0.0),
            (0.156_064_759_329_289_5, 0.1561),
            (25.592_368_899_353_342, 25.59),
            (9.999_9e-9, 1e-8),
            (123_456.0, 123_500.0),
        ];
        for (magnitude, expected) in cases {
            assert_eq!(rounded_magnitude(magnitude), expected);
        }
        assert!(rounded_magnitude(f64::NAN).is_nan());
    }
}
