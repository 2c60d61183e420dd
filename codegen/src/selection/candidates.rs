//! The forms of one function, and the cheapest of them.

use super::assemble::Assembler;
use super::candidate::{Counts, Form, distinct};
use super::formulation::{self, Change};
use super::search::is_cheaper;
use crate::derivation::{DerivationError, DynamicsBy, MotionInput, Selection};
use crate::lowering::Program;
use crate::mechanism::Mechanism;
use overact_core::{Columns, Function};

/// The forms of one function.
pub(crate) struct Forms<'m> {
    mechanism: &'m Mechanism,
    /// The form chosen for the robot.
    selection: &'m Selection,
    function: Function,
    /// Whether the search tries other forms to save operations.
    is_thorough: bool,
    /// Whether programs are searched at all.
    is_searched: bool,
    counts: Counts<'m>,
}

/// A form improved by the last changes.
struct Refinement {
    form: Form,
    /// Operations of the original form after a short search.
    operations_before: usize,
    /// Operations after a short search.
    operations: usize,
}

impl<'m> Forms<'m> {
    /// Forms of a function.
    pub(crate) fn new(assembler: Assembler<'m>, function: Function, from: MotionInput) -> Self {
        Self {
            mechanism: assembler.mechanism,
            selection: assembler.selection,
            function,
            is_thorough: assembler.search.is_thorough(),
            is_searched: assembler.search.is_searched(),
            counts: Counts::new(assembler, function, from),
        }
    }
}

impl Forms<'_> {
    /// The function in the equivalent form that needs the fewest operations.
    ///
    /// Forms differ by combined columns, by forces summed by parameters or by bodies, and by axes.
    /// All are counted as derived. Those that a search could still make the cheapest are searched.
    ///
    /// # Errors
    /// See [`DerivationError`].
    pub(crate) fn cheapest(&self) -> Result<Program, DerivationError> {
        let forms = self.forms()?;
        let least = forms.iter().map(|form| form.operations).min();
        let most = least.unwrap_or_default() * worth_a_search(self.function) / 100;
        let worth = |form: &&Form| form.is_worth || form.operations <= most;
        let mut searched: Vec<Form> = Vec::new();
        for form in forms.iter().filter(worth) {
            let Some(refinement) = self.refined(form)? else {
                searched.push(form.clone());
                continue;
            };
            if refinement.operations * 100 > refinement.operations_before * CLEARLY {
                searched.push(form.clone());
            }
            searched.extend(self.in_other_axes(&refinement)?);
            searched.push(refinement.form);
        }
        let searched = distinct(searched);
        let mut best: Option<Program> = None;
        for Form { selection, .. } in &searched {
            let form = self.counts.program(selection)?;
            if best.as_ref().is_none_or(|best| is_cheaper(&form, best)) {
                best = Some(form);
            }
        }
        let Some(best) = best else {
            return self.counts.program(self.selection);
        };
        match self.closing(&searched)? {
            Some(other) if is_cheaper(&other, &best) && weighed(&other) < weighed(&best) => {
                Ok(other)
            }
            _ => Ok(best),
        }
    }

    /// Applies the closing change to the form that it makes the cheapest.
    ///
    /// The change has to save operations before a search and after a short one.
    fn closing(&self, forms: &[Form]) -> Result<Option<Program>, DerivationError> {
        let change = formulation::closing_choice(self.mechanism, self.function);
        let Some(change) = change.filter(|_| self.is_thorough) else {
            return Ok(None);
        };
        let before = |selection: &Selection| self.counts.before(selection);
        let after = |selection: &Selection| self.counts.after(selection);
        let mut found: Option<(usize, Selection)> = None;
        for Form { selection, .. } in forms {
            let Some(other) = change.on(selection) else {
                continue;
            };
            if before(&other)? >= before(selection)? {
                continue;
            }
            let least = after(&other)?;
            if least < after(selection)? && found.as_ref().is_none_or(|(known, _)| least < *known) {
                found = Some((least, other));
            }
        }
        let program = |(_, selection): (usize, Selection)| self.counts.program(&selection);
        found.map(program).transpose()
    }

    /// The forms of a function with their operations before a search.
    ///
    /// They are those of the robot's formulation and, if the search is thorough, the best of them
    /// in the formulation that is cheapest for this function.
    fn forms(&self) -> Result<Vec<Form>, DerivationError> {
        let mut forms = vec![self.form(self.selection.clone())?];
        if let Some(other) = self.other_form() {
            forms.push(self.form(other)?);
        }
        if self.is_searched {
            let orders = formulation::orders(self.function);
            for form in forms.clone() {
                let other = orders.iter().filter_map(|order| order.on(&form.selection));
                let other = other.map(|selection| self.form(selection));
                forms.extend(other.collect::<Result<Vec<_>, DerivationError>>()?);
            }
        }
        let Some(start) = forms.iter_mut().min_by_key(|form| form.operations) else {
            return Ok(forms);
        };
        start.is_worth = true;
        if !self.is_thorough || self.function.is_derivative() {
            return Ok(forms);
        }
        let start = start.clone();
        let changes = formulation::choices_of_function(self.mechanism, self.function);
        let (best, trials) = self.changed(&start, &changes)?;
        if best.operations < start.operations {
            forms.push(best.clone());
        }
        let other = self.starting_from_first_axes(&start, &best, &changes)?;
        forms.extend(self.promising(trials, &best)?);
        forms.extend(other);
        Ok(forms)
    }

    /// A form with its operations before a search.
    fn form(&self, selection: Selection) -> Result<Form, DerivationError> {
        Ok(Form {
            operations: self.counts.before(&selection)?,
            selection,
            is_worth: false,
            is_plain: false,
            is_tried: false,
        })
    }

    /// The best form after changes of a formulation, applied one after the other if they improve
    /// it.
    ///
    /// Also returns all forms that were examined.
    fn changed(
        &self,
        start: &Form,
        changes: &[Change],
    ) -> Result<(Form, Vec<Form>), DerivationError> {
        let mut best = start.clone();
        let mut trials = vec![best.clone()];
        for change in changes {
            let Some(selection) = change.on(&best.selection) else {
                continue;
            };
            let other = change.is_plain() && formulation::has_forces(self.function);
            let other = other.then(|| Selection {
                dynamics: selection.dynamics.other(),
                ..selection.clone()
            });
            // Forms in which a leg cannot be written are skipped.
            let Ok(mut trial) = self.form(selection) else {
                continue;
            };
            (trial.is_plain, trial.is_tried) = (change.is_plain(), change.takes_first());
            let other = other.map(|selection| self.form(selection));
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

    /// The best form that results from changes to the first axes of all legs.
    ///
    /// It is used if legs differ in shape and a short search makes it cheaper than the best form.
    /// Axes that suit one shape may not suit the axes of the others in the robot's formulation.
    fn starting_from_first_axes(
        &self,
        start: &Form,
        best: &Form,
        changes: &[Change],
    ) -> Result<Option<Form>, DerivationError> {
        let plain = Change::Plain.on(&start.selection);
        let Some(plain) = plain.filter(|_| formulation::has_several_shapes(self.mechanism)) else {
            return Ok(None);
        };
        let Ok(plain) = self.form(plain) else {
            return Ok(None);
        };
        let (mut other, _) = self.changed(&plain, changes)?;
        if other.selection.formulation == best.selection.formulation {
            return Ok(None);
        }
        other.is_worth = true;
        let after = |form: &Form| self.counts.after(&form.selection);
        Ok((after(&other)? < after(best)?).then_some(other))
    }

    /// Applies the last changes that save operations after a short search. `None` if none does.
    fn refined(&self, form: &Form) -> Result<Option<Refinement>, DerivationError> {
        let changes = formulation::last_choices(self.mechanism, self.function);
        if changes.is_empty() || !self.is_thorough {
            return Ok(None);
        }
        let mut selection = form.selection.clone();
        let first = self.counts.after(&selection)?;
        let mut least = first;
        for change in &changes {
            let Some(other) = change.on(&selection) else {
                continue;
            };
            let after = self.counts.after(&other)?;
            if after < least {
                (selection, least) = (other, after);
            }
        }
        let refinement = Refinement {
            form: Form {
                selection,
                ..form.clone()
            },
            operations_before: first,
            operations: least,
        };
        Ok((least < first).then_some(refinement))
    }

    /// The best form in other axes of a refined form, if it needs fewer operations after a short
    /// search.
    ///
    /// The refinement may change which axes are best.
    fn in_other_axes(&self, refinement: &Refinement) -> Result<Option<Form>, DerivationError> {
        if self.function.columns().is_none() {
            return Ok(None);
        }
        let changes = formulation::choices_of_function(self.mechanism, self.function);
        let start = self.form(refinement.form.selection.clone())?;
        let (best, trials) = self.changed(&start, &changes)?;
        let operations = |form: &Form| form.operations;
        let mut found: Option<(usize, Form)> = None;
        for form in formulation::promising(trials, best.operations, operations) {
            let after = self.counts.after(&form.selection)?;
            let least = found.as_ref().map(|(operations, _)| *operations);
            if after < least.unwrap_or(refinement.operations) {
                found = Some((after, form));
            }
        }
        Ok(found.map(|(_, form)| form))
    }

    /// The form that a short search makes the cheapest, and plain forms that come close.
    ///
    /// Only forms are considered that a search could make cheaper than the one with the fewest
    /// operations.
    fn promising(&self, trials: Vec<Form>, best: &Form) -> Result<Vec<Form>, DerivationError> {
        let (plain, others): (Vec<Form>, Vec<Form>) =
            trials.into_iter().partition(|form| form.is_tried);
        let mut found = formulation::promising(others, best.operations, |form| form.operations);
        found.extend(plain);
        let (formulation, dynamics) = (&best.selection.formulation, best.selection.dynamics);
        found.retain(|Form { selection, .. }| {
            selection.formulation != *formulation || selection.dynamics != dynamics
        });
        let after = |form: &Form| self.counts.after(&form.selection);
        if found.is_empty() {
            return Ok(Vec::new());
        }
        let of_best = after(best)?;
        let found = found.into_iter().map(|form| Ok((after(&form)?, form)));
        let found: Vec<(usize, Form)> = found.collect::<Result<_, DerivationError>>()?;
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

    /// Another selection in which the function has a different form.
    fn other_form(&self) -> Option<Selection> {
        let function = self.function;
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

/// Weighted operation count of a program: a division counts as four.
///
/// Divisions have about that latency, and sums over divisors may contain more of them.
fn weighed(program: &Program) -> usize {
    let cost = program.cost();
    cost.operations() + 3 * cost.divisions
}

/// Largest count after a short search at which a plain form gets a longer one, in percent of the
/// smallest.
const NEAR: usize = 106;

/// Count of a changed form after a short search below which the original form is dropped, in
/// percent of the original's count.
const CLEARLY: usize = 97;

/// Largest count at which a form is searched, in percent of the cheapest.
///
/// Single replacements save about as much in each form of the dynamics. With and without combined
/// columns, they and the pairs save different amounts.
const fn worth_a_search(function: Function) -> usize {
    match function.columns() {
        Some(Columns::Standard) => 120,
        _ => 102,
    }
}
