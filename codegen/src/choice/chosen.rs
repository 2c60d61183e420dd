//! The functions of a robot that are generated: those that are wanted, and what they call.

use super::group::serves_model;
use crate::derivation::{JointsBy, MotionInput};
use crate::mechanism::Mechanism;
use overact_core::Function;
use std::collections::BTreeSet;

/// The functions of a robot that are generated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chosen {
    /// The functions.
    pub(crate) functions: BTreeSet<(Function, MotionInput)>,
    /// Whether forward kinematics is among them.
    pub(crate) forward: bool,
    /// Whether all are among them that `overact::Model` is asked for.
    pub(crate) is_model: bool,
}

impl Chosen {
    /// All of an inventory.
    pub(crate) fn all(inventory: &[(Function, MotionInput)]) -> Self {
        Self {
            functions: inventory.iter().copied().collect(),
            forward: true,
            is_model: true,
        }
    }

    /// Adds what the functions call.
    pub(super) fn complete(
        &mut self,
        mechanism: &Mechanism,
        joints: JointsBy,
        inventory: &[(Function, MotionInput)],
    ) {
        let is_found = |(function, from): &(Function, MotionInput)| {
            *from == MotionInput::Actuators && *function != Function::PoseInClosedForm
        };
        self.forward |= self.functions.iter().any(is_found);
        let mut needed = Vec::new();
        if self.forward && !mechanism.is_tree() {
            needed.extend([
                (Function::ActuatorPositions, MotionInput::Pose),
                (Function::PoseStep, MotionInput::Pose),
                (Function::InverseJacobian, MotionInput::Pose),
                (Function::PoseInClosedForm, MotionInput::Actuators),
                (Function::BlockedError, MotionInput::Pose),
                (Function::BlockedJacobian, MotionInput::Pose),
            ]);
        }
        let from_pose = |one: &(Function, MotionInput)| one.1 != MotionInput::Joints;
        let iterates = self.forward || self.functions.iter().any(from_pose);
        if joints == JointsBy::Newton && iterates {
            needed.extend([
                (Function::Joints, MotionInput::Pose),
                (Function::ClosureError, MotionInput::Joints),
                (Function::LegsJacobian, MotionInput::Joints),
            ]);
        }
        let has = |one: &(Function, MotionInput)| inventory.contains(one);
        self.functions.extend(needed.into_iter().filter(has));
        let mut served = inventory.iter();
        self.is_model = self.forward
            && served.all(|&(function, from)| {
                let one = (function, from);
                !serves_model(mechanism, function, from) || self.functions.contains(&one)
            });
    }
}
