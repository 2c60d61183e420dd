//! Quantities that are limited in a run.

use serde::Serialize;

/// Limited quantity.
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
    /// Condition number of J_p^inv, or of its rows of the kept actuators; columns scaled at home.
    Condition,
}

impl LimitKind {
    /// Name, which is also the key of `[excitation]` if there is one.
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

    /// Unit for a length or prismatic joint, or for an angle or revolute joint.
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
