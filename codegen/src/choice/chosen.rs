//! The functions of a robot to generate: those requested and those that they call.

use super::group::serves_model;
use crate::derivation::{FunctionForm, JointsBy, MotionInput};
use crate::mechanism::Mechanism;
use overact_core::Function;
use std::collections::BTreeSet;

/// The functions of a robot to generate.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chosen {
    /// The functions.
    pub(crate) functions: BTreeSet<FunctionForm>,
    /// Whether forward kinematics is included.
    pub(crate) forward: bool,
    /// Whether all functions of `overact::Model` are included.
    pub(crate) is_model: bool,
}

impl Chosen {
    /// All functions of an inventory.
    pub(crate) fn all(inventory: &[FunctionForm]) -> Self {
        Self {
            functions: inventory.iter().copied().collect(),
            forward: true,
            is_model: true,
        }
    }

    /// Adds the functions that these call.
    pub(super) fn complete(
        &mut self,
        mechanism: &Mechanism,
        joints: JointsBy,
        inventory: &[FunctionForm],
    ) {
        let is_found = |form: &FunctionForm| {
            form.from == MotionInput::Actuators && form.function != Function::PoseInClosedForm
        };
        self.forward |= self.functions.iter().any(is_found);
        let mut needed = Vec::new();
        if self.forward && !mechanism.is_tree() {
            needed.extend([
                FunctionForm::new(Function::ActuatorPositions, MotionInput::Pose),
                FunctionForm::new(Function::PoseStep, MotionInput::Pose),
                FunctionForm::new(Function::InverseJacobian, MotionInput::Pose),
                FunctionForm::new(Function::PoseInClosedForm, MotionInput::Actuators),
                FunctionForm::new(Function::BlockedError, MotionInput::Pose),
                FunctionForm::new(Function::BlockedJacobian, MotionInput::Pose),
                FunctionForm::new(Function::PoseError, MotionInput::Pose),
                FunctionForm::new(Function::PoseErrorJacobian, MotionInput::Pose),
            ]);
        }
        let from_pose = |one: &FunctionForm| one.from != MotionInput::Joints;
        let iterates = self.forward || self.functions.iter().any(from_pose);
        if joints == JointsBy::Newton && iterates {
            needed.extend([
                FunctionForm::new(Function::Joints, MotionInput::Pose),
                FunctionForm::new(Function::ClosureError, MotionInput::Joints),
                FunctionForm::new(Function::LegsJacobian, MotionInput::Joints),
            ]);
        }
        let has = |one: &FunctionForm| inventory.contains(one);
        self.functions.extend(needed.into_iter().filter(has));
        let mut served = inventory.iter();
        self.is_model = self.forward
            && served.all(|form| {
                !serves_model(mechanism, form.function, form.from) || self.functions.contains(form)
            });
    }
}
