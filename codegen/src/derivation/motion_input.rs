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
    /// All.
    pub const ALL: [Self; 3] = [Self::Pose, Self::Joints, Self::Actuators];

    /// `pose`, `joints` or `actuators`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Joints => "joints",
            Self::Actuators => "actuators",
        }
    }

    /// What has this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|from| from.name() == name)
    }
}
