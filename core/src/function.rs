//! Table of a robot's functions: names, descriptions, equations, inputs, shapes.

use crate::columns::Columns;
use crate::size::{Extent, Input, Sizes};

/// Condition for a robot to have a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Condition {
    /// None: every robot has the function.
    Any,
    /// A platform; without one there is no closure.
    Platform,
    /// More actuators than degrees of freedom.
    Redundancy,
    /// A payload on the platform.
    Payload,
    /// Forward kinematics in closed form.
    ClosedForm,
    /// Joints by Newton's method, without closed form.
    NumericJoints,
    /// A platform with parasitic motion.
    Parasitic,
    /// Loops, with joints in closed form.
    JointsByRule,
}

/// A function of a robot; [`Function::summary`] describes each.
///
/// The enum is exhaustive: the compiler reports code that does not handle a new function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "`Function::summary` says what each is")]
pub enum Function {
    PoseInClosedForm,
    Joints,
    ActuatorPositions,
    PoseStep,
    InverseJacobian,
    Jacobian,
    LegsJacobian,
    LegsPlatformJacobian,
    ClosurePlatformJacobian,
    ClosureActuatorJacobian,
    ClosureError,
    PlatformJacobian,
    BlockedError,
    BlockedJacobian,
    JointVelocities,
    JointAccelerations,
    TwistFromActuators,
    AccelerationFromActuators,
    IdmRedPlatform(Columns),
    IdmRedActuators(Columns),
    IdmRedPayload,
    IdmRedPayloadActuators,
    ProjectPlatform,
    ProjectActuators,
    InverseDynamics(Columns),
    MassMatrix(Columns),
    Bias(Columns),
    ForwardDynamics(Columns),
    InverseDynamicsPreloaded,
    ProjectTorques,
    NullSpace,
}

/// A line of the table.
struct Entry {
    name: &'static str,
    summary: &'static str,
    inputs: &'static [Input],
    rows: Extent,
    /// `None` for a vector.
    columns: Option<Extent>,
    condition: Condition,
}

impl Function {
    /// All functions of all robots.
    pub const ALL: [Self; 37] = [
        Self::PoseInClosedForm,
        Self::Joints,
        Self::ActuatorPositions,
        Self::PoseStep,
        Self::InverseJacobian,
        Self::Jacobian,
        Self::LegsJacobian,
        Self::LegsPlatformJacobian,
        Self::ClosurePlatformJacobian,
        Self::ClosureActuatorJacobian,
        Self::ClosureError,
        Self::PlatformJacobian,
        Self::BlockedError,
        Self::BlockedJacobian,
        Self::JointVelocities,
        Self::JointAccelerations,
        Self::TwistFromActuators,
        Self::AccelerationFromActuators,
        Self::IdmRedPlatform(Columns::Standard),
        Self::IdmRedActuators(Columns::Standard),
        Self::IdmRedPlatform(Columns::Base),
        Self::IdmRedActuators(Columns::Base),
        Self::IdmRedPayload,
        Self::IdmRedPayloadActuators,
        Self::ProjectPlatform,
        Self::ProjectActuators,
        Self::InverseDynamics(Columns::Standard),
        Self::InverseDynamics(Columns::Base),
        Self::MassMatrix(Columns::Standard),
        Self::MassMatrix(Columns::Base),
        Self::Bias(Columns::Standard),
        Self::Bias(Columns::Base),
        Self::ForwardDynamics(Columns::Standard),
        Self::ForwardDynamics(Columns::Base),
        Self::InverseDynamicsPreloaded,
        Self::ProjectTorques,
        Self::NullSpace,
    ];

    const fn entry(self) -> Entry {
        use Input::{
            Acceleration, ActuatorAccelerations, ActuatorVelocities, Actuators, BaseParameters,
            Joints, Parameters, Pose, Preload, Torques, Twist,
        };
        match self {
            Self::PoseInClosedForm => Entry {
                name: "pose_in_closed_form",
                summary: "The pose from the actuators in closed form, in the assembly mode of the home configuration. It uses only as many actuators as there are degrees of freedom. Working modes of legs may differ from those at home.",
                inputs: &[Actuators],
                rows: Extent::Pose,
                columns: None,
                condition: Condition::ClosedForm,
            },
            Self::Joints => Entry {
                name: "joints",
                summary: "Positions q_t of all joints (m, rad): inverse kinematics, eq. (7), in the working mode of the home configuration.",
                inputs: &[Pose],
                rows: Extent::Joints,
                columns: None,
                condition: Condition::Any,
            },
            Self::ActuatorPositions => Entry {
                name: "actuator_positions",
                summary: "Positions q of the actuated joints (m, rad), in the working mode of the home configuration.",
                inputs: &[Pose],
                rows: Extent::Actuators,
                columns: None,
                condition: Condition::Any,
            },
            Self::PoseStep => Entry {
                name: "pose_step",
                summary: "One Gauss-Newton step v δt from a pose x towards the pose of given actuator positions q: J_p^inv+ (q - q(x)), eq. (21), with differences of angles wrapped to ±π. `forward::displace` applies it to a pose, `forward::displace_quaternion` if the pose has a quaternion. It fails if the elimination would lose digits, even if J_p^inv is regular; `pose_from_actuators` then uses normal equations.",
                inputs: &[Pose, Actuators],
                rows: Extent::Dof,
                columns: None,
                condition: Condition::JointsByRule,
            },
            Self::InverseJacobian => Entry {
                name: "inverse_jacobian",
                summary: "J_p^inv: actuator velocities = J_p^inv v, eq. (20).",
                inputs: &[Pose],
                rows: Extent::Actuators,
                columns: Some(Extent::Dof),
                condition: Condition::Any,
            },
            Self::Jacobian => Entry {
                name: "jacobian",
                summary: "The pseudo-inverse of J_p^inv: v = J_p^inv+ times the actuator velocities, eqs. (21) and (22).",
                inputs: &[Pose],
                rows: Extent::Dof,
                columns: Some(Extent::Actuators),
                condition: Condition::Platform,
            },
            Self::LegsJacobian => Entry {
                name: "legs_jacobian",
                summary: "J_k of J_tk v = J_k q̇_t, eq. (9): the independent velocity components of the legs' ends in the base frame, leg by leg, per joint rate.",
                inputs: &[Pose, Joints],
                rows: Extent::Joints,
                columns: Some(Extent::Joints),
                condition: Condition::Platform,
            },
            Self::LegsPlatformJacobian => Entry {
                name: "legs_platform_jacobian",
                summary: "J_tk of J_tk v = J_k q̇_t, eq. (9): the same velocity components per twist coordinate.",
                inputs: &[Pose, Joints],
                rows: Extent::Joints,
                columns: Some(Extent::Dof),
                condition: Condition::Platform,
            },
            Self::ClosurePlatformJacobian => Entry {
                name: "closure_platform_jacobian",
                summary: "A_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); each row is that of the leg's adjugate.",
                inputs: &[Pose, Joints],
                rows: Extent::Actuators,
                columns: Some(Extent::Dof),
                condition: Condition::Platform,
            },
            Self::ClosureActuatorJacobian => Entry {
                name: "closure_actuator_jacobian",
                summary: "B_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); diagonal.",
                inputs: &[Pose, Joints],
                rows: Extent::Actuators,
                columns: Some(Extent::Actuators),
                condition: Condition::Platform,
            },
            Self::ClosureError => Entry {
                name: "closure_error",
                summary: "Closure errors, eq. (7): distances between the legs' ends and the platform in the directions of the rows of J_k (m, rad).",
                inputs: &[Pose, Joints],
                rows: Extent::Joints,
                columns: None,
                condition: Condition::NumericJoints,
            },
            Self::PlatformJacobian => Entry {
                name: "platform_jacobian",
                summary: "D of t = D v, eq. (14), from the legs' closures: velocity of the platform's origin and its angular velocity, both in the base frame, per independent coordinate.",
                inputs: &[Pose],
                rows: Extent::Free,
                columns: Some(Extent::Dof),
                condition: Condition::Parasitic,
            },
            Self::BlockedError => Entry {
                name: "blocked_error",
                summary: "Closure errors of a pose in the directions that the legs block (m, rad). They are zero for reachable poses.",
                inputs: &[Pose],
                rows: Extent::Blocked,
                columns: None,
                condition: Condition::Parasitic,
            },
            Self::BlockedJacobian => Entry {
                name: "blocked_jacobian",
                summary: "A of A t = 0: the derivative of `blocked_error` along the velocity of the platform's origin and the angular velocity t.",
                inputs: &[Pose],
                rows: Extent::Blocked,
                columns: Some(Extent::Free),
                condition: Condition::Parasitic,
            },
            Self::JointVelocities => Entry {
                name: "joint_velocities",
                summary: "Velocities of all joints (m/s, rad/s), eq. (9).",
                inputs: &[Pose, Twist],
                rows: Extent::Joints,
                columns: None,
                condition: Condition::Any,
            },
            Self::JointAccelerations => Entry {
                name: "joint_accelerations",
                summary: "Accelerations of all joints (m/s², rad/s²), eq. (10).",
                inputs: &[Pose, Twist, Acceleration],
                rows: Extent::Joints,
                columns: None,
                condition: Condition::Any,
            },
            Self::TwistFromActuators => Entry {
                name: "twist_from_actuators",
                summary: "The twist v from the actuator velocities, by least squares, eq. (21).",
                inputs: &[Pose, ActuatorVelocities],
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Any,
            },
            Self::AccelerationFromActuators => Entry {
                name: "acceleration_from_actuators",
                summary: "The acceleration v̇ from the actuator accelerations, by least squares, eq. (24) with J_p^inv.",
                inputs: &[Pose, Twist, ActuatorAccelerations],
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Any,
            },
            Self::IdmRedPlatform(columns) => Entry {
                name: "idm_red_platform",
                summary: "IDM_red of the platform projection (case 1): Γ¹ = IDM_red χ, eq. (30).",
                inputs: &[Pose, Twist, Acceleration],
                rows: Extent::Dof,
                columns: Some(columns.extent()),
                condition: Condition::Any,
            },
            Self::IdmRedActuators(columns) => Entry {
                name: "idm_red_actuators",
                summary: "IDM_red of the actuator projection (case 2): Γ² = IDM_red χ on the kept actuators, eq. (36).",
                inputs: &[Pose, Twist, Acceleration],
                rows: Extent::Dof,
                columns: Some(columns.extent()),
                condition: Condition::Platform,
            },
            Self::IdmRedPayload => Entry {
                name: "idm_red_payload",
                summary: "The payload's columns of the platform projection (case 1), eq. (38).",
                inputs: &[Pose, Twist, Acceleration],
                rows: Extent::Dof,
                columns: Some(Extent::PayloadParameters),
                condition: Condition::Payload,
            },
            Self::IdmRedPayloadActuators => Entry {
                name: "idm_red_payload_actuators",
                summary: "The payload's columns of the actuator projection (case 2), eq. (38).",
                inputs: &[Pose, Twist, Acceleration],
                rows: Extent::Dof,
                columns: Some(Extent::PayloadParameters),
                condition: Condition::Payload,
            },
            Self::ProjectPlatform => Entry {
                name: "project_platform",
                summary: "Γ¹ = (J_p^inv)ᵀ τ, the torques projected on the platform, eq. (30).",
                inputs: &[Pose, Torques],
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Any,
            },
            Self::ProjectActuators => Entry {
                name: "project_actuators",
                summary: "Γ² = τ_a + J_a^-T J_bᵀ τ_b, the torques projected on the kept actuators, eq. (36).",
                inputs: &[Pose, Torques],
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Platform,
            },
            Self::InverseDynamics(columns) => Entry {
                name: "inverse_dynamics",
                summary: "Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the unique ones without redundancy, eq. (19).",
                inputs: match columns {
                    Columns::Standard => &[Pose, Twist, Acceleration, Parameters],
                    Columns::Base => &[Pose, Twist, Acceleration, BaseParameters],
                },
                rows: Extent::Actuators,
                columns: None,
                condition: Condition::Any,
            },
            Self::MassMatrix(columns) => Entry {
                name: "mass_matrix",
                summary: "Mass matrix on the twist coordinates: Γ¹ = M v̇ + bias.",
                inputs: match columns {
                    Columns::Standard => &[Pose, Parameters],
                    Columns::Base => &[Pose, BaseParameters],
                },
                rows: Extent::Dof,
                columns: Some(Extent::Dof),
                condition: Condition::Any,
            },
            Self::Bias(columns) => Entry {
                name: "bias",
                summary: "Γ¹ at v̇ = 0: Coriolis, centrifugal, gravity and friction forces.",
                inputs: match columns {
                    Columns::Standard => &[Pose, Twist, Parameters],
                    Columns::Base => &[Pose, Twist, BaseParameters],
                },
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Any,
            },
            Self::ForwardDynamics(columns) => Entry {
                name: "forward_dynamics",
                summary: "Acceleration under given torques: v̇ = M⁻¹ (Γ¹(τ) - bias), the mass matrix factored as L D Lᵀ.",
                inputs: match columns {
                    Columns::Standard => &[Pose, Twist, Torques, Parameters],
                    Columns::Base => &[Pose, Twist, Torques, BaseParameters],
                },
                rows: Extent::Dof,
                columns: None,
                condition: Condition::Any,
            },
            Self::InverseDynamicsPreloaded => Entry {
                name: "inverse_dynamics_preloaded",
                summary: "Actuator torques of least norm plus N `preload`, where N is the basis from `null_space`.",
                inputs: &[Pose, Twist, Acceleration, Parameters, Preload],
                rows: Extent::Actuators,
                columns: None,
                condition: Condition::Redundancy,
            },
            Self::ProjectTorques => Entry {
                name: "project_torques",
                summary: "τ* = (I - N Nᵀ) τ: the torques without their internal part, eq. (50); τ itself where there is no redundancy.",
                inputs: &[Pose, Torques],
                rows: Extent::Actuators,
                columns: None,
                condition: Condition::Any,
            },
            Self::NullSpace => Entry {
                name: "null_space",
                summary: "N: orthonormal basis of the null space of (J_p^inv)ᵀ; column k is positive at the k-th projected actuator of case 2.",
                inputs: &[Pose],
                rows: Extent::Actuators,
                columns: Some(Extent::Redundancy),
                condition: Condition::Redundancy,
            },
        }
    }

    /// The name without the input motion.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// One sentence with the equation of Briot, Krut, Gautier 2015.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        self.entry().summary
    }

    /// The inputs in the order of the arguments.
    ///
    /// For a robot without a platform their names are [`Input::name_without_platform`].
    #[must_use]
    pub const fn inputs(self) -> &'static [Input] {
        self.entry().inputs
    }

    /// Rows and columns of the output, which is row-major; a vector has one column.
    #[must_use]
    pub const fn shape(self, sizes: &Sizes) -> (usize, usize) {
        let entry = self.entry();
        let columns = match entry.columns {
            Some(columns) => sizes.extent(columns),
            None => 1,
        };
        (sizes.extent(entry.rows), columns)
    }

    /// Rows and columns of the output as sizes of the robot; `None` columns for a vector.
    #[must_use]
    pub const fn extents(self) -> (Extent, Option<Extent>) {
        let entry = self.entry();
        (entry.rows, entry.columns)
    }

    /// Whether the output is a vector and not a matrix.
    #[must_use]
    pub const fn is_vector(self) -> bool {
        self.entry().columns.is_none()
    }

    /// Condition for a robot to have the function.
    #[must_use]
    pub const fn condition(self) -> Condition {
        self.entry().condition
    }

    /// Standard or base columns, if the function has columns of parameters.
    #[must_use]
    pub const fn columns(self) -> Option<Columns> {
        match self.entry().columns {
            Some(Extent::Parameters | Extent::PayloadParameters) => Some(Columns::Standard),
            Some(Extent::BaseParameters) => Some(Columns::Base),
            _ => None,
        }
    }

    /// Standard or base parameters, if the function has their values as an input.
    #[must_use]
    pub const fn parameters(self) -> Option<Columns> {
        match self {
            Self::InverseDynamics(columns)
            | Self::MassMatrix(columns)
            | Self::Bias(columns)
            | Self::ForwardDynamics(columns) => Some(columns),
            Self::InverseDynamicsPreloaded => Some(Columns::Standard),
            _ => None,
        }
    }

    /// Whether the function uses base parameters, as columns or as an input.
    #[must_use]
    pub const fn is_of_base_parameters(self) -> bool {
        let of = match self.columns() {
            None => self.parameters(),
            columns => columns,
        };
        matches!(of, Some(Columns::Base))
    }
}
