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
    /// columns, and with forces by parameters or by bodies. Both are counted as they are derived; searched
    /// are those that a search could still make the better one.
    ///
    /// # Errors
    /// See [`Underivable`].
    pub fn cheapest(&self, function: Function, from: MotionInput) -> Result<Program, Underivable> {
        let Some(other) = self.other_form(function) else {
            return self.program(function, from);
        };
        let arenas = [Arena::new(), Arena::new()];
        let mut forms = Vec::new();
        for (arena, selection) in arenas.iter().zip([self.selection, &other]) {
            let derived = derive(arena, self.mechanism, selection, function, from)?;
            let unsearched = Search::none().lower(arena, self.mechanism, function, &derived)?;
            forms.push((unsearched.cost().operations(), arena, derived));
        }
        let least = forms.iter().map(|&(operations, ..)| operations).min();
        let most = least.unwrap_or_default() * worth_a_search(function) / 100;
        forms.retain(|&(operations, ..)| operations <= most);
        let mut best: Option<Program> = None;
        for (_, arena, derived) in &forms {
            let form = self
                .search
                .lower(arena, self.mechanism, function, derived)?;
            if best.as_ref().is_none_or(|best| is_cheaper(&form, best)) {
                best = Some(form);
            }
        }
        best.map_or_else(|| self.program(function, from), Ok)
    }

    /// The selection beside the own one in which a function is written otherwise.
    fn other_form(&self, function: Function) -> Option<Selection> {
        if function.columns() == Some(Columns::Standard) && !self.selection.combined.is_empty() {
            return Some(Selection {
                combined: Vec::new(),
                ..self.selection.clone()
            });
        }
        let has_forces = matches!(
            function,
            Function::Bias(_)
                | Function::ForwardDynamics(_)
                | Function::InverseDynamics(_)
                | Function::InverseDynamicsPreloaded
        );
        has_forces.then(|| Selection {
            dynamics: DynamicsBy::Bodies,
            ..self.selection.clone()
        })
    }
}

/// Operations of a form that is worth a search, in hundredths of those of the cheapest one. Single
/// replacements take about as much from each form of the dynamics; with and without combined columns they,
/// and the pairs, take less alike.
const fn worth_a_search(function: Function) -> usize {
    match function.columns() {
        Some(Columns::Standard) => 120,
        _ => 102,
    }
}

/// Whether a program takes fewer operations than another one and no more sines and roots.
fn is_cheaper(program: &Program, other: &Program) -> bool {
    let (of_program, of_other) = (program.cost(), other.cost());
    of_program.operations() < of_other.operations()
        && of_program.trigonometric_pairs <= of_other.trigonometric_pairs
        && of_program.square_roots <= of_other.square_roots
}

/// How the joints follow from the pose: by rule, if one fits every leg.
///
/// # Errors
/// See [`Underivable`].
pub(super) fn joints(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<JointsBy, Underivable> {
    let from = match mechanism.is_tree() {
        false => MotionInput::Pose,
        true => MotionInput::Joints,
    };
    match derive(&Arena::new(), mechanism, selection, Function::Joints, from) {
        Ok(_) => Ok(JointsBy::Rule),
        Err(Underivable::InverseKinematics { .. }) => Ok(JointsBy::Newton),
        Err(error) => Err(error),
    }
}
