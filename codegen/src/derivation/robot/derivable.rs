//! Whether a mechanism has a model, without deriving it.

use super::Robot;
use crate::cas::Arena;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::Formulation;
use crate::derivation::underivable::Underivable;
use crate::mechanism::Mechanism;

/// Closures and the partition of case 2 are all that can be without a symbolic inverse; functions are
/// made of them, and where no rule solves a leg they start from Newton's method.
///
/// # Errors
/// A leg or a partition that is singular in every configuration.
pub(crate) fn derivable(mechanism: &Mechanism) -> Result<(), Underivable> {
    let arena = Arena::new();
    let plain = Formulation::default();
    let robot = Robot::new(&arena, mechanism, MotionInput::Joints, &plain, &[])?;
    if !mechanism.is_tree() {
        robot.project_on_actuators(&mechanism.kept_actuators)?;
    }
    Ok(())
}
