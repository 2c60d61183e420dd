//! Groups of functions by purpose.

use crate::derivation::MotionInput;
use crate::mechanism::Mechanism;
use overact_core::{Columns, FrameFunction, FrameQuantity, Function};

/// Functions for one purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Pose from actuators, twist, inverse dynamics with internal torques, mass matrix and bias,
    /// functions of frames.
    Control,
    /// The functions of `overact::Model`, and all forms of the identification models from the pose.
    Identification,
    /// Positions, rates and Jacobians, in all forms, also of frames.
    Kinematics,
}

impl Group {
    /// All.
    pub const ALL: [Self; 3] = [Self::Control, Self::Identification, Self::Kinematics];

    /// The name in attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Control => "control",
            Self::Identification => "identification",
            Self::Kinematics => "kinematics",
        }
    }

    /// Whether a form of a function belongs to the group, by default.
    pub(super) fn has(self, mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
        let is_plain = from == plain(mechanism);
        match self {
            Self::Control => is_plain && is_for_control(function),
            Self::Identification => {
                let is_model =
                    function.columns().is_some() || function == Function::ProjectActuators;
                serves_model(mechanism, function, from) || (is_plain && is_model)
            }
            Self::Kinematics => is_kinematic(function),
        }
    }
}

const fn is_for_control(function: Function) -> bool {
    matches!(
        function,
        Function::ActuatorPositions
            | Function::InverseJacobian
            | Function::TwistFromActuators
            | Function::InverseDynamics(Columns::Standard)
            | Function::InverseDynamicsPreloaded
            | Function::MassMatrix(Columns::Standard)
            | Function::Bias(Columns::Standard)
            | Function::ProjectTorques
            | Function::NullSpace
            | Function::Frame(_)
    )
}

const fn is_kinematic(function: Function) -> bool {
    matches!(
        function,
        Function::PoseInClosedForm
            | Function::Joints
            | Function::ActuatorPositions
            | Function::PoseStep
            | Function::InverseJacobian
            | Function::Jacobian
            | Function::LegsJacobian
            | Function::LegsPlatformJacobian
            | Function::ClosurePlatformJacobian
            | Function::ClosureActuatorJacobian
            | Function::ClosureError
            | Function::PlatformJacobian
            | Function::BlockedError
            | Function::BlockedJacobian
            | Function::PoseJacobian
            | Function::PoseError
            | Function::PoseErrorJacobian
            | Function::JointVelocities
            | Function::JointAccelerations
            | Function::TwistFromActuators
            | Function::AccelerationFromActuators
            | Function::Frame(FrameFunction {
                quantity: FrameQuantity::Pose
                    | FrameQuantity::Jacobian
                    | FrameQuantity::Velocity
                    | FrameQuantity::AccelerationBias,
                ..
            })
    )
}

/// Input of functions for plain states.
fn plain(mechanism: &Mechanism) -> MotionInput {
    if mechanism.is_tree() {
        MotionInput::Joints
    } else {
        MotionInput::Pose
    }
}

/// Whether identification and simulation use a function of a model, or it computes pose and joints.
#[must_use]
pub fn serves_model(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
    match function {
        Function::PoseInClosedForm => true,
        Function::ClosureError | Function::LegsJacobian | Function::ClosureActuatorJacobian => {
            from == MotionInput::Joints
        }
        // Inverse dynamics of cables includes their minimum tensions, so known torques follow from
        // the bias.
        Function::Bias(Columns::Standard) => mechanism.has_cables() && from == MotionInput::Pose,
        Function::Jacobian
        | Function::LegsPlatformJacobian
        | Function::ClosurePlatformJacobian
        | Function::IdmRedPlatform(Columns::Base)
        | Function::IdmRedActuators(_)
        | Function::IdmRedPayloadActuators
        | Function::ProjectActuators
        | Function::InverseDynamics(Columns::Base)
        | Function::MassMatrix(Columns::Base)
        | Function::Bias(_)
        | Function::ForwardDynamics(Columns::Base)
        | Function::InverseDynamicsPreloaded
        | Function::TotalMass
        | Function::CentreOfMass
        | Function::CentreOfMassJacobian
        | Function::KineticEnergy
        | Function::PotentialEnergy
        | Function::Frame(_) => false,
        _ if function.is_derivative() => false,
        _ => from == plain(mechanism),
    }
}
