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

    /// Error e(q) of unit size, and its time derivatives e' q̇ and e'' q̇² + e' q̈.
    pub(super) fn at(self, motion: ActuatorState) -> [f64; 3] {
        let ActuatorState {
            position,
            velocity,
            acceleration,
            ..
        } = motion;
        let (sine, cosine) = position.sin_cos();
        let [error, slope, bend] = match self {
            Self::Offset => [1.0, 0.0, 0.0],
            Self::Scale => [position, 1.0, 0.0],
            Self::Sine => [sine, cosine, -sine],
            Self::Cosine => [cosine, -sine, -cosine],
        };
        [
            error,
            slope * velocity,
            bend * velocity * velocity + slope * acceleration,
        ]
    }
}
