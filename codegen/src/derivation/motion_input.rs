//! From which measured motion a function is evaluated.

/// What a model is evaluated from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MotionInput {
    /// The platform's pose; joints follow from the closure.
    Pose,
    /// The joint positions (and the pose, for the platform's orientation).
    Joints,
    /// The pose that forward kinematics finds, with the actuators' velocities and accelerations.
    Actuators,
}

impl MotionInput {
    /// `pose`, `joints` or `actuators`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Joints => "joints",
            Self::Actuators => "actuators",
        }
    }
}
