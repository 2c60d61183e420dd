//! One function from mechanism to program: derivation in a graph of its own, then lowering.

use super::search::Search;
use crate::cas::Arena;
use crate::derivation::{DynamicsBy, JointsBy, MotionInput, Selection, Underivable, derive};
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

    /// The function in that of its equal forms that needs the fewest operations: with or without combined
    /// columns, and with bodies added up in one way or another.
    ///
    /// # Errors
    /// See [`Underivable`].
    pub fn cheapest(&self, function: Function, from: MotionInput) -> Result<Program, Underivable> {
        let mut best = self.program(function, from)?;
        for selection in &self.other_forms(function) {
            let other = Assembler { selection, ..*self }.program(function, from)?;
            let (of_other, of_best) = (other.cost(), best.cost());
            let is_better = of_other.operations() < of_best.operations()
                && of_other.trigonometric_pairs <= of_best.trigonometric_pairs
                && of_other.square_roots <= of_best.square_roots;
            if is_better {
                best = other;
            }
        }
        Ok(best)
    }

    /// The selections beside the own one in which a function is written otherwise.
    fn other_forms(&self, function: Function) -> Vec<Selection> {
        if function.columns() == Some(Columns::Standard) && !self.selection.combined.is_empty() {
            return vec![Selection {
                combined: Vec::new(),
                ..self.selection.clone()
            }];
        }
        let is_dynamics = matches!(
            function,
            Function::MassMatrix
                | Function::Bias
                | Function::ForwardDynamics
                | Function::InverseDynamics
                | Function::InverseDynamicsPreloaded
        );
        let at_ends: &[bool] = match (is_dynamics, &self.mechanism.platform) {
            (false, _) => &[],
            (true, None) => &[false],
            (true, Some(_)) => &[false, true],
        };
        let form = |&at_ends: &bool| Selection {
            dynamics: DynamicsBy::Bodies { at_ends },
            ..self.selection.clone()
        };
        at_ends.iter().map(form).collect()
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
