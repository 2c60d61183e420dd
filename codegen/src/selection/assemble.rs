//! One function from mechanism to program: derivation in a graph of its own, then lowering.

use super::formulation;
use super::search::{Search, is_cheaper};
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

/// A way to write a function.
#[derive(Debug, Clone)]
struct Form {
    selection: Selection,
    /// Before a search.
    operations: usize,
    /// Whether it is searched however many operations it has: the cheapest one in the formulation that was chosen
    /// for the robot, and one that a short search makes the cheapest.
    is_worth: bool,
    /// Whether the axes of all legs are the first ones in it.
    is_plain: bool,
    /// Whether a short search looks at it however many operations it has: the axes of some legs are the first ones.
    is_tried: bool,
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
    /// columns, with forces by parameters or by bodies, and in the axes that suit it. All are counted as they
    /// are derived; searched are those that a search could still make the better one.
    ///
    /// # Errors
    /// See [`Underivable`].
    pub fn cheapest(&self, function: Function, from: MotionInput) -> Result<Program, Underivable> {
        let forms = self.forms(function, from)?;
        let least = forms.iter().map(|form| form.operations).min();
        let most = least.unwrap_or_default() * worth_a_search(function) / 100;
        let worth = |form: &&Form| form.is_worth || form.operations <= most;
        let mut best: Option<Program> = None;
        for Form { selection, .. } in forms.iter().filter(worth) {
            let form = Assembler { selection, ..*self }.program(function, from)?;
            if best.as_ref().is_none_or(|best| is_cheaper(&form, best)) {
                best = Some(form);
            }
        }
        best.map_or_else(|| self.program(function, from), Ok)
    }

    /// The forms of a function with their operations before a search: those of the robot's formulation, and of
    /// the best of them in the formulation that is the cheapest for this function, where the search is thorough.
    fn forms(&self, function: Function, from: MotionInput) -> Result<Vec<Form>, Underivable> {
        let count = |selection: Selection| -> Result<Form, Underivable> {
            Ok(Form {
                operations: self.operations(&selection, function, from)?,
                selection,
                is_worth: false,
                is_plain: false,
                is_tried: false,
            })
        };
        let mut forms = vec![count(self.selection.clone())?];
        if let Some(other) = self.other_form(function) {
            forms.push(count(other)?);
        }
        let Some(start) = forms.iter_mut().min_by_key(|form| form.operations) else {
            return Ok(forms);
        };
        start.is_worth = true;
        if !self.search.is_thorough() {
            return Ok(forms);
        }
        let (least, mut best) = (start.operations, start.clone());
        let mut trials = vec![best.clone()];
        for change in &formulation::choices_of_function(self.mechanism, function) {
            let Some(formulation) = change.of(&best.selection.formulation) else {
                continue;
            };
            let other = change.is_plain() && formulation::has_forces(function);
            let other = other.then(|| Selection {
                formulation: formulation.clone(),
                dynamics: best.selection.dynamics.other(),
                ..best.selection.clone()
            });
            let trial = count(Selection {
                formulation,
                ..best.selection.clone()
            });
            // A form in which a leg cannot be written is none to choose.
            let Ok(mut trial) = trial else { continue };
            (trial.is_plain, trial.is_tried) = (change.is_plain(), change.takes_first());
            if let Some(Ok(mut other)) = other.map(count) {
                (other.is_plain, other.is_tried) = (true, true);
                trials.push(other);
            }
            if trial.operations < best.operations {
                best = trial.clone();
            }
            trials.push(trial);
        }
        if best.operations < least {
            forms.push(best.clone());
        }
        forms.extend(self.promising(function, from, trials, &best)?);
        Ok(forms)
    }

    /// Of the forms that a search could make cheaper than the one with the fewest operations before it that which a
    /// short search makes the cheapest, and the plain ones if they come near.
    fn promising(
        &self,
        function: Function,
        from: MotionInput,
        trials: Vec<Form>,
        best: &Form,
    ) -> Result<Vec<Form>, Underivable> {
        let (plain, others): (Vec<Form>, Vec<Form>) =
            trials.into_iter().partition(|form| form.is_tried);
        let mut found = formulation::promising(others, best.operations, |form| form.operations);
        found.extend(plain);
        let (formulation, dynamics) = (&best.selection.formulation, best.selection.dynamics);
        found.retain(|Form { selection, .. }| {
            selection.formulation != *formulation || selection.dynamics != dynamics
        });
        let search = Search::short();
        let after = |form: &Form| -> Result<usize, Underivable> {
            let selection = &form.selection;
            let short = Assembler {
                selection,
                search: &search,
                ..*self
            };
            Ok(short.program(function, from)?.cost().operations())
        };
        if found.is_empty() {
            return Ok(Vec::new());
        }
        let of_best = after(best)?;
        let found = found.into_iter().map(|form| Ok((after(&form)?, form)));
        let found: Vec<(usize, Form)> = found.collect::<Result<_, Underivable>>()?;
        let least = found.iter().map(|(operations, _)| *operations).min();
        let least = least.unwrap_or(of_best).min(of_best);
        let first = found
            .iter()
            .position(|(operations, _)| *operations == least);
        let first = first.filter(|_| least < of_best);
        let near = least * NEAR / 100;
        let worth = found
            .into_iter()
            .enumerate()
            .filter(|(at, (operations, form))| {
                Some(*at) == first || (form.is_plain && *operations <= near)
            });
        let worth = worth.map(|(_, (_, form))| Form {
            is_worth: true,
            ..form
        });
        Ok(worth.collect())
    }

    /// The operations of a function as it is derived.
    fn operations(
        &self,
        selection: &Selection,
        function: Function,
        from: MotionInput,
    ) -> Result<usize, Underivable> {
        let arena = Arena::new();
        let derived = derive(&arena, self.mechanism, selection, function, from)?;
        let program = Search::none().lower(&arena, self.mechanism, function, &derived)?;
        Ok(program.cost().operations())
    }

    /// The selection beside the own one in which a function is written otherwise.
    fn other_form(&self, function: Function) -> Option<Selection> {
        if function.columns() == Some(Columns::Standard) && !self.selection.combined.is_empty() {
            return Some(Selection {
                combined: Vec::new(),
                ..self.selection.clone()
            });
        }
        formulation::has_forces(function).then(|| Selection {
            dynamics: DynamicsBy::Bodies,
            ..self.selection.clone()
        })
    }
}

/// Operations after a short search of a plain form that is worth a longer one, in hundredths of the fewest.
const NEAR: usize = 106;

/// Operations of a form that is worth a search, in hundredths of those of the cheapest one. Single
/// replacements take about as much from each form of the dynamics; with and without combined columns they,
/// and the pairs, take less alike.
const fn worth_a_search(function: Function) -> usize {
    match function.columns() {
        Some(Columns::Standard) => 120,
        _ => 102,
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
