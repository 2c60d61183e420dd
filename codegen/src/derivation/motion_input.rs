//! The measured motion from which a function is evaluated.

/// The motion from which a model is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MotionInput {
    /// The platform's pose; the closure gives the joints.
    Pose,
    /// The joint positions (and the pose, for the platform's orientation).
    Joints,
    /// The actuators: forward kinematics gives the pose, their rates give velocities and
    /// accelerations.
    Actuators,
}

impl MotionInput {
    /// All inputs.
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

    /// The input of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|from| from.name() == name)
    }
}
