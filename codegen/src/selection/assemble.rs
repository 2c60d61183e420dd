//! From the mechanism to the program of one function: derivation in its own graph, then lowering.

use super::search::Search;
use crate::cas::Arena;
use crate::derivation::{DerivationError, JointsBy, MotionInput, Selection, derive};
use crate::lowering::Program;
use crate::mechanism::Mechanism;
use overact_core::Function;

/// Input of the programs of a robot.
#[derive(Debug, Clone, Copy)]
pub struct Assembler<'m> {
    /// The robot.
    pub mechanism: &'m Mechanism,
    /// Form and columns of the model.
    pub selection: &'m Selection,
    /// Extent of the search for cheaper forms of the functions.
    pub search: &'m Search,
}

impl Assembler<'_> {
    /// Derives and lowers one function.
    ///
    /// # Errors
    /// See [`DerivationError`].
    pub fn program(
        &self,
        function: Function,
        from: MotionInput,
    ) -> Result<Program, DerivationError> {
        let arena = Arena::new();
        let derived = derive(&arena, self.mechanism, self.selection, function, from)?;
        let mut program = self
            .search
            .lower(&arena, self.mechanism, function, &derived)?;
        if matches!(function, Function::InverseDynamics(_)) && self.mechanism.has_cables() {
            let least = self.mechanism.minimum_tensions().into_iter();
            program.least_torques = least
                .map(|least| least.unwrap_or(f64::NEG_INFINITY))
                .collect();
            program.output.shape = vec![program.least_torques.len()];
        }
        Ok(program)
    }
}

/// How the joints follow from the pose: in closed form if a rule fits every leg, and the positions
/// of motors and springs follow, too.
///
/// # Errors
/// See [`DerivationError`].
pub(super) fn joints(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<JointsBy, DerivationError> {
    let from = if mechanism.is_tree() {
        MotionInput::Joints
    } else {
        MotionInput::Pose
    };
    match derive(&Arena::new(), mechanism, selection, Function::Joints, from) {
        Ok(_) => Ok(JointsBy::Rule),
        Err(
            DerivationError::InverseKinematics { .. }
            | DerivationError::UndeterminedMotor { .. }
            | DerivationError::UndeterminedSpring { .. },
        ) => Ok(JointsBy::Newton),
        Err(error) => Err(error),
    }
}
