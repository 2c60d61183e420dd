//! How the error of an encoder depends on where it stands.

use super::shapes::Moment;

/// How the error of a position depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Misreading {
    /// Not at all: an offset.
    Offset,
    /// As the position itself: a scale, or the ratio of a gear.
    Scale,
    /// As its sine or its cosine: an encoder that is out of centre.
    Sine,
    Cosine,
}

impl Misreading {
    /// All of them, in the order of their columns.
    pub(super) const ALL: [Self; 4] = [Self::Offset, Self::Scale, Self::Sine, Self::Cosine];

    /// Whether it is looked for at an actuator, which may be revolute: a length does not return with a turn.
    pub(super) const fn concerns(self, revolute: bool) -> bool {
        revolute || matches!(self, Self::Offset | Self::Scale)
    }

    /// The error e(q) of unit size, and its first and second derivative along a motion: e' q̇ and e'' q̇² + e' q̈.
    pub(super) fn at(self, motion: Moment) -> [f64; 3] {
        let Moment {
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
