//! The face that a robot shows to identification and simulation, compiled or interpreted.

use crate::{Error, SampleError};

/// A quantity that enters a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
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
    /// Values of the standard parameters followed by the payload's, in column order. One vector
    /// serves a whole block of samples.
    Parameters,
}

/// What a model can be asked for. The table lists inputs and the output's shape, row-major; r, n
/// and n_t are [`Sizes::dof`], [`Sizes::actuators`] and [`Sizes::joints`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Function {
    /// Pose -> positions of all joints, n_t (inverse kinematics).
    Joints,
    /// Pose -> positions of the actuated joints, n.
    ActuatorPositions,
    /// Pose -> J_p^inv, n x r: actuator velocities = J_p^inv v.
    InverseJacobian,
    /// Pose, twist, acceleration -> velocities of all joints, n_t.
    JointVelocities,
    /// Pose, twist, acceleration -> accelerations of all joints, n_t.
    JointAccelerations,
    /// Pose, actuator velocities -> twist v, r: least squares, eq. (21).
    TwistFromActuators,
    /// Pose, twist, actuator accelerations -> v̇, r: least squares, eq. (24) in its J_p^inv form.
    AccelerationFromActuators,
    /// Pose, twist, acceleration -> IDM_red of case 1 in standard parameters, r x n_st, eq. (30).
    IdmRedPlatform,
    /// Pose, twist, acceleration -> columns of the payload in case 1, r x n_l, eq. (38).
    IdmRedPayload,
    /// Pose, torques -> Γ¹ = (J_p^inv)ᵀ τ, r, eq. (30).
    ProjectPlatform,
    /// Pose, twist, acceleration, parameters -> least-norm torques, n.
    InverseDynamics,
    /// Pose, parameters -> mass matrix on the platform coordinates, r x r.
    MassMatrix,
    /// Pose, twist, parameters -> Γ¹ at zero acceleration (Coriolis, gravity, friction), r.
    Bias,
    /// Pose, torques -> torques without their internal part, n, eq. (50).
    ProjectTorques,
    /// Pose -> orthonormal basis N of the null space of (J_p^inv)ᵀ, n x (n - r).
    NullSpace,
    /// Joint positions -> B_p of the reduced closure A_p v + B_p q̇ = 0, n x n, eq. (11). With
    /// A_p = -B_p J_p^inv it gives the torques of eq. (26).
    ClosureActuatorJacobian,
}

impl Function {
    /// The inputs in the order in which [`Model::evaluate`] takes them.
    #[must_use]
    pub const fn inputs(self) -> &'static [Input] {
        use Input::{
            Acceleration, ActuatorAccelerations, ActuatorVelocities, Joints, Parameters, Pose,
            Torques, Twist,
        };
        match self {
            Self::Joints | Self::ActuatorPositions | Self::InverseJacobian | Self::NullSpace => {
                &[Pose]
            }
            Self::JointVelocities
            | Self::JointAccelerations
            | Self::IdmRedPlatform
            | Self::IdmRedPayload => &[Pose, Twist, Acceleration],
            Self::TwistFromActuators => &[Pose, ActuatorVelocities],
            Self::AccelerationFromActuators => &[Pose, Twist, ActuatorAccelerations],
            Self::ProjectPlatform | Self::ProjectTorques => &[Pose, Torques],
            Self::InverseDynamics => &[Pose, Twist, Acceleration, Parameters],
            Self::MassMatrix => &[Pose, Parameters],
            Self::Bias => &[Pose, Twist, Parameters],
            Self::ClosureActuatorJacobian => &[Joints],
        }
    }

    /// Shape of the output: rows and columns (one column for a vector).
    #[must_use]
    pub const fn shape(self, sizes: &Sizes) -> (usize, usize) {
        match self {
            Self::Joints | Self::JointVelocities | Self::JointAccelerations => (sizes.joints, 1),
            Self::ActuatorPositions | Self::InverseDynamics | Self::ProjectTorques => {
                (sizes.actuators, 1)
            }
            Self::InverseJacobian => (sizes.actuators, sizes.dof),
            Self::TwistFromActuators
            | Self::AccelerationFromActuators
            | Self::ProjectPlatform
            | Self::Bias => (sizes.dof, 1),
            Self::IdmRedPlatform => (sizes.dof, sizes.parameters),
            Self::IdmRedPayload => (sizes.dof, sizes.payload_parameters),
            Self::MassMatrix => (sizes.dof, sizes.dof),
            Self::NullSpace => (sizes.actuators, sizes.actuators - sizes.dof),
            Self::ClosureActuatorJacobian => (sizes.actuators, sizes.actuators),
        }
    }

    /// The name of the function in generated code.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Joints => "joints",
            Self::ActuatorPositions => "actuator_positions",
            Self::InverseJacobian => "inverse_jacobian",
            Self::JointVelocities => "joint_velocities",
            Self::JointAccelerations => "joint_accelerations",
            Self::TwistFromActuators => "twist_from_actuators",
            Self::AccelerationFromActuators => "acceleration_from_actuators",
            Self::IdmRedPlatform => "idm_red_platform",
            Self::IdmRedPayload => "idm_red_payload",
            Self::ProjectPlatform => "project_platform",
            Self::InverseDynamics => "inverse_dynamics",
            Self::MassMatrix => "mass_matrix",
            Self::Bias => "bias",
            Self::ProjectTorques => "project_torques",
            Self::NullSpace => "null_space",
            Self::ClosureActuatorJacobian => "closure_actuator_jacobian",
        }
    }
}

/// The sizes of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Numbers in a pose (r for all motions but those with a quaternion).
    pub pose: usize,
    /// r, independent platform coordinates.
    pub dof: usize,
    /// n, actuators.
    pub actuators: usize,
    /// n_t, joints of all legs.
    pub joints: usize,
    /// n_st, standard parameters whose column is not identically zero, without the payload's.
    pub parameters: usize,
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
        }
    }
}

/// The 14 standard parameters of a link, eq. (2), in the paper's order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names are the paper's symbols")]
pub enum Symbol {
    Xx,
    Xy,
    Xz,
    Yy,
    Yz,
    Zz,
    Mx,
    My,
    Mz,
    M,
    Ia,
    Fv,
    Fs,
    Off,
}

impl Symbol {
    /// All 14, in the paper's order.
    pub const ALL: [Self; 14] = [
        Self::Xx,
        Self::Xy,
        Self::Xz,
        Self::Yy,
        Self::Yz,
        Self::Zz,
        Self::Mx,
        Self::My,
        Self::Mz,
        Self::M,
        Self::Ia,
        Self::Fv,
        Self::Fs,
        Self::Off,
    ];

    /// The name as it stands in a description and in a parameter's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Xx => "xx",
            Self::Xy => "xy",
            Self::Xz => "xz",
            Self::Yy => "yy",
            Self::Yz => "yz",
            Self::Zz => "zz",
            Self::Mx => "mx",
            Self::My => "my",
            Self::Mz => "mz",
            Self::M => "m",
            Self::Ia => "ia",
            Self::Fv => "fv",
            Self::Fs => "fs",
            Self::Off => "off",
        }
    }

    /// Whether the parameter belongs to the ten inertial ones of a rigid body.
    #[must_use]
    pub const fn is_inertial(self) -> bool {
        !matches!(self, Self::Ia | Self::Fv | Self::Fs | Self::Off)
    }
}

/// One standard parameter: a column of the identification model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// Unique name, `zz_2_leg3`, `m_platform` or `m_payload`.
    pub name: &'static str,
    /// Which of the 14 standard parameters it is.
    pub symbol: Symbol,
    /// SI unit, for instance `kg m²`.
    pub unit: &'static str,
    /// Where the body is.
    pub body: Body,
}

impl Parameter {
    /// A parameter of a leg's body or joint; see [`Body::Leg`].
    #[must_use]
    pub const fn of_leg(
        name: &'static str,
        symbol: Symbol,
        unit: &'static str,
        leg: u16,
        index: u16,
        shape: u16,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Leg { leg, index, shape },
        }
    }

    /// A parameter of the platform.
    #[must_use]
    pub const fn of_platform(name: &'static str, symbol: Symbol, unit: &'static str) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Platform,
        }
    }

    /// A parameter of the payload.
    #[must_use]
    pub const fn of_payload(name: &'static str, symbol: Symbol, unit: &'static str) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Payload,
        }
    }
}

/// A base parameter: an independent column, and the standard parameters that are regrouped into it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseParameter {
    /// Name: the kept parameter's, with the suffix `R` where others are regrouped into it.
    pub name: &'static str,
    /// The standard parameter whose column is kept.
    pub parameter: &'static str,
    /// Other standard parameters that it stands for, with their coefficients.
    pub regrouped: &'static [(&'static str, f64)],
}

impl BaseParameter {
    /// A base parameter.
    #[must_use]
    pub const fn new(
        name: &'static str,
        parameter: &'static str,
        regrouped: &'static [(&'static str, f64)],
    ) -> Self {
        Self {
            name,
            parameter,
            regrouped,
        }
    }
}

/// Where a body is in the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Body {
    /// The platform.
    Platform,
    /// The payload, fixed on the platform.
    Payload,
    /// A body of a leg. Bodies of different legs with one `index` are a priori alike when their
    /// legs have one `shape`.
    Leg {
        /// Index of the leg.
        leg: u16,
        /// Index of the body in its leg, counted from 0.
        index: u16,
        /// Legs written once and placed several times share this number.
        shape: u16,
    },
}

/// What a model says about its robot, sizes aside.
#[derive(Debug, Clone, Copy)]
pub struct Info<'a> {
    /// Name of the robot.
    pub name: &'a str,
    /// Sizes of all inputs and outputs.
    pub sizes: Sizes,
    /// Names of the legs.
    pub legs: &'a [&'a str],
    /// Names of the actuated joints, in the order of q and τ.
    pub actuators: &'a [&'a str],
    /// Indices of the actuated joints among all joints.
    pub actuated_joints: &'a [usize],
    /// Whether each actuator is a revolute joint (rad, N m) and not a prismatic one (m, N).
    pub actuator_is_revolute: &'a [bool],
    /// Names of the independent platform coordinates.
    pub coordinates: &'a [&'a str],
    /// Standard parameters whose column is not identically zero, in column order.
    pub parameters: &'a [Parameter],
    /// The payload's parameters, in column order.
    pub payload_parameters: &'a [Parameter],
    /// Pose of the home configuration, which fixes assembly and working modes.
    pub home_pose: &'a [f64],
    /// Joint positions of the home configuration.
    pub home_joints: &'a [f64],
    /// Kept actuators of case 2 as the description chooses them (indices among the actuators).
    pub kept_actuators: &'a [usize],
}

/// A robot whose functions can be evaluated at states.
///
/// Numbers lie in slices, sample after sample; matrices are row-major.
pub trait Model: Sync {
    /// Names and sizes.
    fn info(&self) -> Info<'_>;

    /// Evaluates `function` at `output.len() / (rows * columns)` samples. `inputs` are those of
    /// [`Function::inputs`], each holding one row of numbers per sample; an input of exactly one row, as
    /// [`Input::Parameters`] is, serves all samples.
    ///
    /// # Errors
    /// The first sample at which the model has no value, and why. The output is then undefined.
    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError>;

    /// Forward kinematics: the pose that fits all measured actuator positions best in the sense of
    /// least squares, found from the start pose in `pose`, so that the assembly mode is that of the
    /// start.
    ///
    /// # Errors
    /// No convergence, or a singular or unreachable configuration on the way; `pose` is unchanged then.
    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error>;

    /// Moves a pose by a small displacement `step` along the twist coordinates (r numbers).
    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        crate::forward::displace(pose, step);
    }
}
