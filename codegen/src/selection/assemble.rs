//! One function from mechanism to program: derivation in a graph of its own, then lowering.

use super::formulation::{self, Change};
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
        let mut searched: Vec<Form> = Vec::new();
        for form in forms.iter().filter(worth) {
            let Some((refined, [first, least])) = self.refined(function, from, form)? else {
                searched.push(form.clone());
                continue;
            };
            if least * 100 > first * CLEARLY {
                searched.push(form.clone());
            }
            searched.extend(self.in_other_axes(function, from, (&refined, least))?);
            searched.push(refined);
        }
        let searched = distinct(searched);
        let mut best: Option<Program> = None;
        for Form { selection, .. } in &searched {
            let form = Assembler { selection, ..*self }.program(function, from)?;
            if best.as_ref().is_none_or(|best| is_cheaper(&form, best)) {
                best = Some(form);
            }
        }
        let Some(best) = best else {
            return self.program(function, from);
        };
        match self.closing(function, from, &searched)? {
            Some(other) if is_cheaper(&other, &best) && weighed(&other) < weighed(&best) => {
                Ok(other)
            }
            _ => Ok(best),
        }
    }

    /// What the closing change makes the cheapest of some forms, where it pays for that one before a search and after
    /// a short one.
    fn closing(
        &self,
        function: Function,
        from: MotionInput,
        forms: &[Form],
    ) -> Result<Option<Program>, Underivable> {
        let change = formulation::closing_choice(self.mechanism, function);
        let Some(change) = change.filter(|_| self.search.is_thorough()) else {
            return Ok(None);
        };
        let before = |selection: &Selection| self.operations(selection, function, from);
        let after = |selection: &Selection| self.after_short_search(selection, function, from);
        let mut found: Option<(usize, Selection)> = None;
        for Form { selection, .. } in forms {
            let Some(formulation) = change.of(&selection.formulation) else {
                continue;
            };
            let other = Selection {
                formulation,
                ..selection.clone()
            };
            if before(&other)? >= before(selection)? {
                continue;
            }
            let least = after(&other)?;
            if least < after(selection)? && found.as_ref().is_none_or(|(known, _)| least < *known) {
                found = Some((least, other));
            }
        }
        let program = |(_, selection): &(usize, Selection)| {
            Assembler { selection, ..*self }.program(function, from)
        };
        found.as_ref().map(program).transpose()
    }

    /// The forms of a function with their operations before a search: those of the robot's formulation, and of
    /// the best of them in the formulation that is the cheapest for this function, where the search is thorough.
    fn forms(&self, function: Function, from: MotionInput) -> Result<Vec<Form>, Underivable> {
        let mut forms = vec![self.form(self.selection.clone(), function, from)?];
        if let Some(other) = self.other_form(function) {
            forms.push(self.form(other, function, from)?);
        }
        let Some(start) = forms.iter_mut().min_by_key(|form| form.operations) else {
            return Ok(forms);
        };
        start.is_worth = true;
        if !self.search.is_thorough() {
            return Ok(forms);
        }
        let start = start.clone();
        let changes = formulation::choices_of_function(self.mechanism, function);
        let (best, trials) = self.changed(&start, &changes, function, from)?;
        if best.operations < start.operations {
            forms.push(best.clone());
        }
        let other = self.starting_from_first_axes(&start, &best, &changes, function, from)?;
        forms.extend(self.promising(function, from, trials, &best)?);
        forms.extend(other);
        Ok(forms)
    }

    /// A form with its operations before a search.
    fn form(
        &self,
        selection: Selection,
        function: Function,
        from: MotionInput,
    ) -> Result<Form, Underivable> {
        Ok(Form {
            operations: self.operations(&selection, function, from)?,
            selection,
            is_worth: false,
            is_plain: false,
            is_tried: false,
        })
    }

    /// The best form that changes of a formulation lead to, one after the other, each if it is better; also all that
    /// were looked at.
    fn changed(
        &self,
        start: &Form,
        changes: &[Change],
        function: Function,
        from: MotionInput,
    ) -> Result<(Form, Vec<Form>), Underivable> {
        let mut best = start.clone();
        let mut trials = vec![best.clone()];
        for change in changes {
            let Some(formulation) = change.of(&best.selection.formulation) else {
                continue;
            };
            let other = change.is_plain() && formulation::has_forces(function);
            let other = other.then(|| Selection {
                formulation: formulation.clone(),
                dynamics: best.selection.dynamics.other(),
                ..best.selection.clone()
            });
            let selection = Selection {
                formulation,
                ..best.selection.clone()
            };
            // A form in which a leg cannot be written is none to choose.
            let Ok(mut trial) = self.form(selection, function, from) else {
                continue;
            };
            (trial.is_plain, trial.is_tried) = (change.is_plain(), change.takes_first());
            let other = other.map(|selection| self.form(selection, function, from));
            if let Some(Ok(mut other)) = other {
                (other.is_plain, other.is_tried) = (true, true);
                trials.push(other);
            }
            if trial.operations < best.operations {
                best = trial.clone();
            }
            trials.push(trial);
        }
        Ok((best, trials))
    }

    /// The best form that changes lead to from the first axes of all legs, where legs differ in shape and a short
    /// search makes it cheaper than the best one: what suits one shape may be no better with what the robot's
    /// formulation has for the others.
    fn starting_from_first_axes(
        &self,
        start: &Form,
        best: &Form,
        changes: &[Change],
        function: Function,
        from: MotionInput,
    ) -> Result<Option<Form>, Underivable> {
        let plain = Change::Plain.of(&start.selection.formulation);
        let Some(formulation) = plain.filter(|_| formulation::has_several_shapes(self.mechanism))
        else {
            return Ok(None);
        };
        let selection = Selection {
            formulation,
            ..start.selection.clone()
        };
        let Ok(plain) = self.form(selection, function, from) else {
            return Ok(None);
        };
        let (mut other, _) = self.changed(&plain, changes, function, from)?;
        if other.selection.formulation == best.selection.formulation {
            return Ok(None);
        }
        other.is_worth = true;
        let after = |form: &Form| self.after_short_search(&form.selection, function, from);
        Ok((after(&other)? < after(best)?).then_some(other))
    }

    /// What the changes that are tried last make of a form, each where a short search says that it pays, with the
    /// operations after such searches: of the form, and of what is made of it. `None` if nothing pays.
    fn refined(
        &self,
        function: Function,
        from: MotionInput,
        form: &Form,
    ) -> Result<Option<(Form, [usize; 2])>, Underivable> {
        let changes = formulation::last_choices(self.mechanism, function);
        if changes.is_empty() || !self.search.is_thorough() {
            return Ok(None);
        }
        let mut selection = form.selection.clone();
        let first = self.after_short_search(&selection, function, from)?;
        let mut least = first;
        for change in &changes {
            let Some(formulation) = change.of(&selection.formulation) else {
                continue;
            };
            let other = Selection {
                formulation,
                ..selection.clone()
            };
            let after = self.after_short_search(&other, function, from)?;
            if after < least {
                (selection, least) = (other, after);
            }
        }
        let refined = Form {
            selection,
            ..form.clone()
        };
        Ok((least < first).then_some((refined, [first, least])))
    }

    /// The best form in other axes of one that the last changes have made, if a short search makes it better: which
    /// axes suit it may be another matter than before.
    fn in_other_axes(
        &self,
        function: Function,
        from: MotionInput,
        (form, least): (&Form, usize),
    ) -> Result<Option<Form>, Underivable> {
        if function.columns().is_none() {
            return Ok(None);
        }
        let changes = formulation::choices_of_function(self.mechanism, function);
        let start = self.form(form.selection.clone(), function, from)?;
        let (best, trials) = self.changed(&start, &changes, function, from)?;
        let operations = |form: &Form| form.operations;
        let mut found: Option<(usize, Form)> = None;
        for form in formulation::promising(trials, best.operations, operations) {
            let after = self.after_short_search(&form.selection, function, from)?;
            if after < found.as_ref().map_or(least, |(after, _)| *after) {
                found = Some((after, form));
            }
        }
        Ok(found.map(|(_, form)| form))
    }

    /// The operations of a function after a short search.
    fn after_short_search(
        &self,
        selection: &Selection,
        function: Function,
        from: MotionInput,
    ) -> Result<usize, Underivable> {
        let short = Assembler {
            selection,
            search: &Search::short(),
            ..*self
        };
        Ok(short.program(function, from)?.cost().operations())
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
        let after = |form: &Form| self.after_short_search(&form.selection, function, from);
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

/// Operations of a program, each division as four: processors take that long from one to the next, and sums over
/// divisors may be more divisions.
fn weighed(program: &Program) -> usize {
    let cost = program.cost();
    cost.operations() + 3 * cost.divisions
}

/// Forms of which each is searched once, though several ways may have led to it.
fn distinct(forms: Vec<Form>) -> Vec<Form> {
    let mut own: Vec<Form> = Vec::new();
    for form in forms {
        if !own.iter().any(|known| known.is_written_as(&form)) {
            own.push(form);
        }
    }
    own
}

impl Form {
    /// Whether a function is written alike in both, with columns of the same robot.
    fn is_written_as(&self, other: &Self) -> bool {
        let (own, other) = (&self.selection, &other.selection);
        own.formulation == other.formulation
            && own.dynamics == other.dynamics
            && own.combined.is_empty() == other.combined.is_empty()
    }
}

/// Operations after a short search of a plain form that is worth a longer one, in hundredths of the fewest.
const NEAR: usize = 106;

/// Operations after a short search of what changes have made of a form, in hundredths of the form's own, that leave no
/// hope for the form.
const CLEARLY: usize = 97;

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
