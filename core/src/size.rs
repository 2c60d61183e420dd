//! Sizes of a robot, and the quantities and extents that depend on them.

/// The sizes of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Numbers in a pose (r for all motions without a quaternion).
    pub pose: usize,
    /// r, independent platform coordinates.
    pub dof: usize,
    /// n, actuators.
    pub actuators: usize,
    /// n_t, joints of all legs.
    pub joints: usize,
    /// n_st, standard parameters whose column is not identically zero, without those of the
    /// payload.
    pub parameters: usize,
    /// Base parameters: independent columns.
    pub base_parameters: usize,
    /// n_l, the payload's parameters whose column is not identically zero.
    pub payload_parameters: usize,
}

impl Sizes {
    /// Number of elements of an input.
    #[must_use]
    pub const fn of(&self, input: Input) -> usize {
        match input {
            Input::Pose => self.pose,
            Input::Joints => self.joints,
            Input::Twist | Input::Acceleration => self.dof,
            Input::Actuators
            | Input::ActuatorVelocities
            | Input::ActuatorAccelerations
            | Input::Torques => self.actuators,
            Input::Parameters => self.parameters + self.payload_parameters,
            Input::BaseParameters => self.base_parameters + self.payload_parameters,
            Input::Preload => self.redundancy(),
            Input::Wrench => 6,
        }
    }

    /// Number of rows or columns of an extent.
    #[must_use]
    pub const fn extent(&self, extent: Extent) -> usize {
        match extent {
            Extent::Pose => self.pose,
            Extent::Dof => self.dof,
            Extent::Actuators => self.actuators,
            Extent::Joints => self.joints,
            Extent::Redundancy => self.redundancy(),
            Extent::Parameters => self.parameters,
            Extent::BaseParameters => self.base_parameters,
            Extent::PayloadParameters => self.payload_parameters,
            Extent::Free => self.free(),
            Extent::Blocked => self.blocked(),
            Extent::Dependent => self.dependent(),
            Extent::Fixed(count) => count,
        }
    }

    /// Number of velocity components of the platform as a free body, along its pose coordinates.
    ///
    /// Six if the pose is a position and a quaternion. The independent coordinates are these or
    /// some of them.
    #[must_use]
    pub const fn free(&self) -> usize {
        self.pose.saturating_sub(1)
    }

    /// Number of directions that the legs block, so that other pose coordinates depend on the
    /// independent ones.
    ///
    /// Zero unless the platform has parasitic motion.
    #[must_use]
    pub const fn blocked(&self) -> usize {
        self.free().saturating_sub(self.dof)
    }

    /// Number of dependent joints in the pose of a skeleton.
    #[must_use]
    pub const fn dependent(&self) -> usize {
        self.pose.saturating_sub(self.dof)
    }

    /// n - r, the number of independent internal torques.
    #[must_use]
    pub const fn redundancy(&self) -> usize {
        self.actuators.saturating_sub(self.dof)
    }
}

/// An input quantity of a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Input {
    /// Independent platform coordinates x (m, rad); the joint positions of a robot without a loop.
    Pose,
    /// Joint positions q_t of all legs (m, rad).
    Joints,
    /// Independent coordinates v of the platform twist, eq. (14) (m/s, rad/s).
    Twist,
    /// Time derivative of the twist coordinates (m/s², rad/s²).
    Acceleration,
    /// Positions q of the actuated joints (m, rad).
    Actuators,
    /// Velocities of the actuated joints (m/s, rad/s).
    ActuatorVelocities,
    /// Accelerations of the actuated joints (m/s², rad/s²).
    ActuatorAccelerations,
    /// Actuator forces and torques τ (N, N m).
    Torques,
    /// Values of the standard parameters, then of the payload, in column order.
    Parameters,
    /// Values of the base parameters, with all others regrouped, then of the payload.
    BaseParameters,
    /// Coordinates of the internal torques in the basis of the null space (N, N m).
    Preload,
    /// Force (N) and moment (N m) of the environment on a frame, at its origin, in the base frame.
    Wrench,
}

impl Input {
    /// The name of the argument in generated code.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Joints => "joints",
            Self::Twist => "twist",
            Self::Acceleration => "acceleration",
            Self::Actuators => "actuators",
            Self::ActuatorVelocities => "actuator_velocities",
            Self::ActuatorAccelerations => "actuator_accelerations",
            Self::Torques => "torques",
            Self::Parameters => "parameters",
            Self::BaseParameters => "base_parameters",
            Self::Preload => "preload",
            Self::Wrench => "wrench",
        }
    }

    /// The name in a robot without a loop, whose pose consists of its joint positions.
    #[must_use]
    pub const fn name_without_platform(self) -> &'static str {
        match self {
            Self::Pose => "joints",
            Self::Twist => "joint_velocities",
            Self::Acceleration => "joint_accelerations",
            other => other.name(),
        }
    }
}

/// The number of rows or columns of an output, as a size of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Extent {
    /// Numbers in a pose.
    Pose,
    /// r, independent platform coordinates.
    Dof,
    /// n, actuators.
    Actuators,
    /// n_t, joints of all legs.
    Joints,
    /// n - r, independent internal torques.
    Redundancy,
    /// n_st, standard parameters.
    Parameters,
    /// Base parameters.
    BaseParameters,
    /// n_l, the payload's parameters.
    PayloadParameters,
    /// Velocity components of the platform as a free body: three of its origin, three about the
    /// axes.
    Free,
    /// Directions that the legs block.
    Blocked,
    /// Dependent joints in the pose of a skeleton.
    Dependent,
    /// A number that is the same for all robots.
    Fixed(usize),
}
