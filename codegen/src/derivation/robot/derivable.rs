//! Checks whether a mechanism has a model, without deriving it.

use super::Robot;
use crate::cas::Arena;
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::Formulation;
use crate::mechanism::Mechanism;

/// Checks the closures and the partition of the actuator projection.
///
/// Only these can lack a symbolic inverse. Functions are built from them, and if no rule solves a
/// leg they start from Newton's method.
///
/// # Errors
/// A leg or a partition that is singular in every configuration.
pub(crate) fn derivable(mechanism: &Mechanism) -> Result<(), DerivationError> {
    let arena = Arena::new();
    let plain = Formulation::default();
    let robot = Robot::new(&arena, mechanism, MotionInput::Joints, &plain, &[])?;
    if !mechanism.is_tree() {
        robot.project_on_actuators(&mechanism.kept_actuators)?;
    }
    Ok(())
}
