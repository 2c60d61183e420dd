//! What of a run is limited.

use serde::Serialize;

/// What is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitKind {
    /// Displacement of each coordinate from home, m or rad.
    Position,
    /// Displacement of each actuator from home, m or rad.
    Travel,
    /// Speed of each actuator, m/s or rad/s.
    Velocity,
    /// Acceleration of each actuator, m/s² or rad/s².
    Acceleration,
    /// Torque or force of each actuator, N m or N.
    Torque,
    /// Condition number of J_p^inv or of its part of the kept actuators, columns scaled at home.
    Condition,
}

impl LimitKind {
    /// `position`, `travel` and so on: the key of `[excitation]` where there is one.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Travel => "travel",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Torque => "torque",
            Self::Condition => "condition",
        }
    }

    /// The unit, of a length or a prismatic joint, or of an angle or a revolute one.
    pub(super) const fn unit(self, is_length: bool) -> &'static str {
        match (self, is_length) {
            (Self::Position | Self::Travel, true) => "m",
            (Self::Position | Self::Travel, false) => "rad",
            (Self::Velocity, true) => "m/s",
            (Self::Velocity, false) => "rad/s",
            (Self::Acceleration, true) => "m/s²",
            (Self::Acceleration, false) => "rad/s²",
            (Self::Torque, true) => "N",
            (Self::Torque, false) => "N m",
            (Self::Condition, _) => "",
        }
    }
}
