//! A form of a function, and the operation counts of the forms examined so far.

use super::assemble::Assembler;
use super::search::Search;
use crate::derivation::{DerivationError, MotionInput, Selection};
use crate::lowering::Program;
use overact_core::Function;
use std::cell::RefCell;

/// A form of a function.
#[derive(Debug, Clone)]
pub(super) struct Form {
    pub(super) selection: Selection,
    /// Operation count before a search.
    pub(super) operations: usize,
    /// Whether it is searched regardless of its operation count.
    ///
    /// It holds for the cheapest form in the robot's formulation, and for one that a short search
    /// makes the cheapest.
    pub(super) is_worth: bool,
    /// Whether all legs have the first axes.
    pub(super) is_plain: bool,
    /// Whether a short search is tried regardless of the operation count: some legs have the first
    /// axes.
    pub(super) is_tried: bool,
}

/// Removes duplicate forms, so that each is searched once.
pub(super) fn distinct(forms: Vec<Form>) -> Vec<Form> {
    let mut own: Vec<Form> = Vec::new();
    for form in forms {
        if !own
            .iter()
            .any(|known| is_written_as(&known.selection, &form.selection))
        {
            own.push(form);
        }
    }
    own
}

/// Whether both selections give a function the same form, for columns of the same robot.
fn is_written_as(one: &Selection, other: &Selection) -> bool {
    one.formulation == other.formulation
        && one.dynamics == other.dynamics
        && one.combined.is_empty() == other.combined.is_empty()
}

/// Operation counts of one function in its forms; each form is derived and counted once.
pub(super) struct Counts<'m> {
    assembler: Assembler<'m>,
    function: Function,
    from: MotionInput,
    before: CachedCounts,
    after: CachedCounts,
}

/// Cached counts by form.
type CachedCounts = RefCell<Vec<(Selection, Result<usize, DerivationError>)>>;

impl<'m> Counts<'m> {
    /// Counts of a function, initially empty.
    pub(super) fn new(assembler: Assembler<'m>, function: Function, from: MotionInput) -> Self {
        Self {
            assembler,
            function,
            from,
            before: RefCell::default(),
            after: RefCell::default(),
        }
    }

    /// Operations of the function as derived.
    pub(super) fn before(&self, selection: &Selection) -> Result<usize, DerivationError> {
        known(&self.before, selection, || {
            self.searched(selection, &Search::none())
        })
    }

    /// Operations after a short search.
    pub(super) fn after(&self, selection: &Selection) -> Result<usize, DerivationError> {
        known(&self.after, selection, || {
            self.searched(selection, &Search::short())
        })
    }

    /// The function after the requested search.
    pub(super) fn program(&self, selection: &Selection) -> Result<Program, DerivationError> {
        let own = Assembler {
            selection,
            ..self.assembler
        };
        own.program(self.function, self.from)
    }

    /// Operations after a search.
    fn searched(&self, selection: &Selection, search: &Search) -> Result<usize, DerivationError> {
        let own = Assembler {
            selection,
            search,
            ..self.assembler
        };
        Ok(own.program(self.function, self.from)?.cost().operations())
    }
}

/// The cached count of a form, computed on the first request.
fn known(
    all: &CachedCounts,
    selection: &Selection,
    tell: impl FnOnce() -> Result<usize, DerivationError>,
) -> Result<usize, DerivationError> {
    let is_it = |(known, _): &&(Selection, _)| is_written_as(known, selection);
    if let Some((_, outcome)) = all.borrow().iter().find(is_it) {
        return outcome.clone();
    }
    let outcome = tell();
    all.borrow_mut().push((selection.clone(), outcome.clone()));
    outcome
}
