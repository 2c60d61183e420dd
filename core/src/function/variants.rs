//! The functions of a robot.

use crate::columns::Columns;
use crate::frame::{FrameFunction, FrameQuantity};

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
    PoseJacobian,
    PoseError,
    PoseErrorJacobian,
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
    TotalMass,
    CentreOfMass,
    CentreOfMassJacobian,
    KineticEnergy,
    PotentialEnergy,
    InverseDynamicsByDisplacement(Columns),
    InverseDynamicsByTwist(Columns),
    ForwardDynamicsByDisplacement(Columns),
    ForwardDynamicsByTwist(Columns),
    Frame(FrameFunction),
}

impl Function {
    /// All functions of all robots, without those of the frames that a description defines.
    pub const ALL: [Self; 53] = [
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
        Self::PoseJacobian,
        Self::PoseError,
        Self::PoseErrorJacobian,
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
        Self::TotalMass,
        Self::CentreOfMass,
        Self::CentreOfMassJacobian,
        Self::KineticEnergy,
        Self::PotentialEnergy,
        Self::InverseDynamicsByDisplacement(Columns::Standard),
        Self::InverseDynamicsByDisplacement(Columns::Base),
        Self::InverseDynamicsByTwist(Columns::Standard),
        Self::InverseDynamicsByTwist(Columns::Base),
        Self::ForwardDynamicsByDisplacement(Columns::Standard),
        Self::ForwardDynamicsByDisplacement(Columns::Base),
        Self::ForwardDynamicsByTwist(Columns::Standard),
        Self::ForwardDynamicsByTwist(Columns::Base),
    ];

    /// A function of a frame, by the frame's index in the description.
    #[must_use]
    pub const fn of_frame(frame: usize, quantity: FrameQuantity) -> Self {
        Self::Frame(FrameFunction { frame, quantity })
    }

    /// Whether generated code has the function only if it is requested by name.
    ///
    /// These functions are evaluated once in a while, or by few users, and every function adds to
    /// the size of the code and to the time of its compilation.
    #[must_use]
    pub const fn is_on_request(self) -> bool {
        matches!(
            self,
            Self::TotalMass
                | Self::CentreOfMass
                | Self::CentreOfMassJacobian
                | Self::KineticEnergy
                | Self::PotentialEnergy
        ) || self.is_derivative()
    }

    /// Whether the function is a derivative of inverse or forward dynamics.
    #[must_use]
    pub const fn is_derivative(self) -> bool {
        matches!(
            self,
            Self::InverseDynamicsByDisplacement(_)
                | Self::InverseDynamicsByTwist(_)
                | Self::ForwardDynamicsByDisplacement(_)
                | Self::ForwardDynamicsByTwist(_)
        )
    }
}
