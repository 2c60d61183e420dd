//! The functions that a robot has: names, meaning, equations, units.

use super::forward_kinematics::closed_form;
use super::motion_input::MotionInput;
use super::selection::JointsBy;
use crate::cas::Arena;
use crate::mechanism::Mechanism;

/// Which columns an identification model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Columns {
    /// All standard parameters whose column is not identically zero.
    Standard,
    /// The base parameters: independent columns only.
    Base,
}

impl Columns {
    /// `standard` or `base`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Base => "base",
        }
    }
}

/// A function of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "`Family::summary` says what each is")]
pub enum Family {
    PoseInClosedForm,
    Joints,
    ActuatorPositions,
    InverseJacobian,
    Jacobian,
    ClosurePlatformJacobian,
    ClosureActuatorJacobian,
    LegsJacobian,
    LegsPlatformJacobian,
    ClosureError,
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
    InverseDynamics,
    InverseDynamicsPreloaded,
    MassMatrix,
    Bias,
    ProjectTorques,
    NullSpace,
}

impl Family {
    /// The function's name without what it is evaluated from.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::PoseInClosedForm => "pose_in_closed_form",
            Self::Joints => "joints",
            Self::ActuatorPositions => "actuator_positions",
            Self::InverseJacobian => "inverse_jacobian",
            Self::Jacobian => "jacobian",
            Self::ClosurePlatformJacobian => "closure_platform_jacobian",
            Self::ClosureActuatorJacobian => "closure_actuator_jacobian",
            Self::LegsJacobian => "legs_jacobian",
            Self::LegsPlatformJacobian => "legs_platform_jacobian",
            Self::ClosureError => "closure_error",
            Self::JointVelocities => "joint_velocities",
            Self::JointAccelerations => "joint_accelerations",
            Self::TwistFromActuators => "twist_from_actuators",
            Self::AccelerationFromActuators => "acceleration_from_actuators",
            Self::IdmRedPlatform(_) => "idm_red_platform",
            Self::IdmRedActuators(_) => "idm_red_actuators",
            Self::IdmRedPayload => "idm_red_payload",
            Self::IdmRedPayloadActuators => "idm_red_payload_actuators",
            Self::ProjectPlatform => "project_platform",
            Self::ProjectActuators => "project_actuators",
            Self::InverseDynamics => "inverse_dynamics",
            Self::InverseDynamicsPreloaded => "inverse_dynamics_preloaded",
            Self::MassMatrix => "mass_matrix",
            Self::Bias => "bias",
            Self::ProjectTorques => "project_torques",
            Self::NullSpace => "null_space",
        }
    }

    /// One sentence with the equation of Briot, Krut, Gautier 2015.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        match self {
            Self::PoseInClosedForm => {
                "The pose from the actuators in closed form, in the assembly mode of the home configuration; of redundant actuators only some are used."
            }
            Self::Joints => {
                "Positions q_t of all joints (m, rad): inverse kinematics, eq. (7), in the working mode of the home configuration."
            }
            Self::ActuatorPositions => {
                "Positions q of the actuated joints (m, rad), in the working mode of the home configuration."
            }
            Self::InverseJacobian => "J_p^inv: actuator velocities = J_p^inv v, eq. (20).",
            Self::Jacobian => {
                "The pseudo-inverse of J_p^inv: v = J_p^inv+ times the actuator velocities, eqs. (21) and (22)."
            }
            Self::ClosurePlatformJacobian => {
                "A_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); each row is that of the leg's adjugate."
            }
            Self::ClosureActuatorJacobian => {
                "B_p of the reduced closure A_p v + B_p q̇ = 0, eq. (11); diagonal."
            }
            Self::LegsJacobian => {
                "J_k of J_tk v = J_k q̇_t, eq. (9): the independent velocity components of the legs' ends in the base frame, leg by leg, per joint rate."
            }
            Self::LegsPlatformJacobian => {
                "J_tk of J_tk v = J_k q̇_t, eq. (9): the same velocity components per twist coordinate."
            }
            Self::ClosureError => {
                "By how much the legs' ends miss the platform, eq. (7): velocity components of J_k, integrated (m, rad)."
            }
            Self::JointVelocities => "Velocities of all joints (m/s, rad/s), eq. (9).",
            Self::JointAccelerations => "Accelerations of all joints (m/s², rad/s²), eq. (10).",
            Self::TwistFromActuators => {
                "The twist v that fits the actuator velocities in the sense of least squares, eq. (21)."
            }
            Self::AccelerationFromActuators => {
                "The acceleration v̇ that fits the actuator accelerations in the sense of least squares; eq. (24) on J_p^inv."
            }
            Self::IdmRedPlatform(_) => {
                "IDM_red of case 1: Γ¹ = IDM_red χ, inputs projected on the platform, eq. (30)."
            }
            Self::IdmRedActuators(_) => {
                "IDM_red of case 2: Γ² = IDM_red χ, inputs projected on the kept actuators, eq. (36)."
            }
            Self::IdmRedPayload => "The payload's columns of case 1, eq. (38).",
            Self::IdmRedPayloadActuators => "The payload's columns of case 2, eq. (38).",
            Self::ProjectPlatform => {
                "Γ¹ = (J_p^inv)ᵀ τ, the torques projected on the platform, eq. (30)."
            }
            Self::ProjectActuators => {
                "Γ² = τ_a + J_a^-T J_bᵀ τ_b, the torques projected on the kept actuators, eq. (36)."
            }
            Self::InverseDynamics => {
                "Actuator torques τ of least norm for given parameters: τ = J_p^inv (J_p^invᵀ J_p^inv)⁻¹ Γ¹; the only ones where there is no redundancy, eq. (19)."
            }
            Self::InverseDynamicsPreloaded => {
                "Actuator torques of least norm plus N `preload`, N being the basis that `null_space` gives."
            }
            Self::MassMatrix => "Mass matrix on the twist coordinates: Γ¹ = M v̇ + bias.",
            Self::Bias => "Γ¹ at v̇ = 0: Coriolis, centrifugal, gravity and friction forces.",
            Self::ProjectTorques => {
                "τ* = (I - N Nᵀ) τ: the torques without their internal part, eq. (50)."
            }
            Self::NullSpace => {
                "N: orthonormal basis of the null space of (J_p^inv)ᵀ; column k is positive on the k-th actuator that case 2 projects."
            }
        }
    }

    /// Standard or base columns, where the function has columns of parameters.
    #[must_use]
    pub const fn columns(self) -> Option<Columns> {
        match self {
            Self::IdmRedPlatform(columns) | Self::IdmRedActuators(columns) => Some(columns),
            Self::IdmRedPayload | Self::IdmRedPayloadActuators => Some(Columns::Standard),
            _ => None,
        }
    }

    /// Whether the output is a vector and not a matrix.
    #[must_use]
    pub const fn is_vector(self) -> bool {
        matches!(
            self,
            Self::PoseInClosedForm
                | Self::Joints
                | Self::ActuatorPositions
                | Self::ClosureError
                | Self::JointVelocities
                | Self::JointAccelerations
                | Self::TwistFromActuators
                | Self::AccelerationFromActuators
                | Self::ProjectPlatform
                | Self::ProjectActuators
                | Self::InverseDynamics
                | Self::InverseDynamicsPreloaded
                | Self::Bias
                | Self::ProjectTorques
        )
    }

    /// The name of the Rust function, unique in the robot.
    #[must_use]
    pub fn function_name(self, from: MotionInput, tree: bool) -> String {
        if self == Self::PoseInClosedForm {
            return self.name().to_owned();
        }
        let base = if self.columns() == Some(Columns::Base) {
            "_base"
        } else {
            ""
        };
        let from = match from {
            MotionInput::Joints if !tree => "_from_joints",
            MotionInput::Actuators => "_from_actuators",
            MotionInput::Pose | MotionInput::Joints => "",
        };
        format!("{}{base}{from}", self.name())
    }

    /// All functions of a robot with what they are evaluated from.
    #[must_use]
    pub fn all(mechanism: &Mechanism, joints: JointsBy) -> Vec<(Self, MotionInput)> {
        use MotionInput::{Actuators, Joints, Pose};
        let tree = mechanism.platform.is_none();
        let redundant = mechanism.actuated().len() > mechanism.dof();
        let payload = mechanism
            .platform
            .as_ref()
            .is_some_and(|p| p.payload.is_some());
        let mut all = Vec::new();
        let mut add = |families: &[Self], from: &[MotionInput]| {
            for &family in families {
                for &from in from {
                    all.push((family, from));
                }
            }
        };
        let pose: &[MotionInput] = if tree { &[Joints] } else { &[Pose] };
        let pose_and_joints: &[MotionInput] = if tree { &[Joints] } else { &[Pose, Joints] };
        let dynamic: &[MotionInput] = if tree {
            &[Joints]
        } else {
            &[Pose, Joints, Actuators]
        };
        let arena = Arena::new();
        if closed_form(&arena, mechanism).is_some() {
            add(&[Self::PoseInClosedForm], &[Actuators]);
        }
        add(&[Self::Joints, Self::ActuatorPositions], pose);
        add(&[Self::InverseJacobian], pose_and_joints);
        if !tree {
            add(&[Self::Jacobian], pose);
            add(
                &[
                    Self::LegsJacobian,
                    Self::LegsPlatformJacobian,
                    Self::ClosurePlatformJacobian,
                    Self::ClosureActuatorJacobian,
                ],
                &[Joints],
            );
        }
        if joints == JointsBy::Newton {
            add(&[Self::ClosureError], &[Joints]);
        }
        add(&[Self::JointVelocities, Self::JointAccelerations], pose);
        add(
            &[Self::TwistFromActuators, Self::AccelerationFromActuators],
            pose,
        );
        for columns in [Columns::Standard, Columns::Base] {
            add(&[Self::IdmRedPlatform(columns)], dynamic);
            if !tree {
                add(&[Self::IdmRedActuators(columns)], dynamic);
            }
        }
        if payload {
            add(&[Self::IdmRedPayload], dynamic);
            add(&[Self::IdmRedPayloadActuators], pose);
        }
        add(&[Self::ProjectPlatform], pose);
        if !tree {
            add(&[Self::ProjectActuators], pose);
        }
        add(&[Self::InverseDynamics], dynamic);
        add(&[Self::MassMatrix, Self::Bias], pose);
        if redundant {
            add(
                &[
                    Self::InverseDynamicsPreloaded,
                    Self::ProjectTorques,
                    Self::NullSpace,
                ],
                pose,
            );
        }
        all
    }
}
