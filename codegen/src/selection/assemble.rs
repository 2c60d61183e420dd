//! One function from mechanism to program: derivation in a graph of its own, then lowering.

use super::search::Search;
use crate::cas::Arena;
use crate::derivation::{JointsBy, MotionInput, Selection, Underivable, derive};
use crate::lowering::Program;
use crate::mechanism::Mechanism;
use overact_core::{Columns, Function};

/// What the programs of a robot are made from.
#[derive(Debug, Clone, Copy)]
pub struct Assembler<'m> {
    /// The robot.
    pub mechanism: &'m Mechanism,
    /// The form and the columns of its model.
    pub selection: &'m Selection,
    /// How far cheaper ways to write its functions are searched.
    pub search: &'m Search,
}

impl Assembler<'_> {
    /// Derives and lowers one function.
    ///
    /// # Errors
    /// See [`Underivable`].
    pub fn program(&self, function: Function, from: MotionInput) -> Result<Program, Underivable> {
        let arena = Arena::new();
        let derived = derive(&arena, self.mechanism, self.selection, function, from)?;
        let program = self
            .search
            .lower(&arena, self.mechanism, function, &derived)?;
        Ok(program)
    }

    /// The function with or without combined columns, whichever needs fewer operations.
    ///
    /// # Errors
    /// See [`Underivable`].
    pub fn cheapest(&self, function: Function, from: MotionInput) -> Result<Program, Underivable> {
        let combined = self.program(function, from)?;
        if self.selection.combined.is_empty() || function.columns() != Some(Columns::Standard) {
            return Ok(combined);
        }
        let selection = &Selection {
            combined: Vec::new(),
            ..self.selection.clone()
        };
        let plain = Assembler { selection, ..*self }.program(function, from)?;
        let is_better = plain.cost().operations() < combined.cost().operations();
        Ok(if is_better { plain } else { combined })
    }
}

/// How the joints follow from the pose: by rule, if one fits every leg.
///
/// # Errors
/// See [`Underivable`].
pub(super) fn joints(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<JointsBy, Underivable> {
    let from = match mechanism.platform {
        Some(_) => MotionInput::Pose,
        None => MotionInput::Joints,
    };
    match derive(&Arena::new(), mechanism, selection, Function::Joints, from) {
        Ok(_) => Ok(JointsBy::Rule),
        Err(Underivable::InverseKinematics { .. }) => Ok(JointsBy::Newton),
        Err(error) => Err(error),
    }
}
