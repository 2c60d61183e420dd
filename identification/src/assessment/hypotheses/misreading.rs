//! Position dependence of encoder errors.

use super::shapes::ActuatorState;

/// Dependence of a position error on the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Misreading {
    /// Constant: an offset.
    Offset,
    /// Proportional to the position: a scale, or the ratio of a gear.
    Scale,
    /// Proportional to its sine or cosine: an eccentric encoder.
    Sine,
    Cosine,
}

impl Misreading {
    /// All variants, in the order of their columns.
    pub(super) const ALL: [Self; 4] = [Self::Offset, Self::Scale, Self::Sine, Self::Cosine];

    /// Whether it applies to an actuator; sine and cosine only to revolute ones.
    pub(super) const fn concerns(self, revolute: bool) -> bool {
        revolute || matches!(self, Self::Offset | Self::Scale)
    }

    /// Error of unit size at a motion.
    pub(super) fn at(self, motion: ActuatorState) -> PositionError {
        let ActuatorState {
            position,
            velocity,
            acceleration,
            ..
        } = motion;
        let of = |error: f64, slope: f64, bend: f64| PositionError {
            error,
            slope,
            acceleration: bend * velocity * velocity + slope * acceleration,
        };
        match self {
            Self::Offset => of(1.0, 0.0, 0.0),
            Self::Scale => of(position, 1.0, 0.0),
            Self::Sine => {
                let (sine, cosine) = position.sin_cos();
                of(sine, cosine, -sine)
            }
            Self::Cosine => {
                let (sine, cosine) = position.sin_cos();
                of(cosine, -sine, -cosine)
            }
        }
    }
}

/// Error e(q) of a position, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PositionError {
    /// e.
    pub(super) error: f64,
    /// e', the relative error of the velocity.
    pub(super) slope: f64,
    /// e'' q̇² + e' q̈, the error of the acceleration.
    pub(super) acceleration: f64,
}
