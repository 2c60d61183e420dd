//! One way to write a function, and what was counted of the ways that were looked at.

use super::assemble::Assembler;
use super::search::Search;
use crate::derivation::{MotionInput, Selection, Underivable};
use crate::lowering::Program;
use overact_core::Function;
use std::cell::RefCell;

/// A way to write a function.
#[derive(Debug, Clone)]
pub(super) struct Form {
    pub(super) selection: Selection,
    /// Before a search.
    pub(super) operations: usize,
    /// Whether it is searched however many operations it has: the cheapest one in the formulation that was chosen
    /// for the robot, and one that a short search makes the cheapest.
    pub(super) is_worth: bool,
    /// Whether the axes of all legs are the first ones in it.
    pub(super) is_plain: bool,
    /// Whether a short search looks at it however many operations it has: the axes of some legs are the first ones.
    pub(super) is_tried: bool,
}

/// Forms of which each is searched once, though several ways may have led to it.
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

/// Whether a function is written alike with both, with columns of the same robot.
fn is_written_as(one: &Selection, other: &Selection) -> bool {
    one.formulation == other.formulation
        && one.dynamics == other.dynamics
        && one.combined.is_empty() == other.combined.is_empty()
}

/// The operations of one function in its forms. Several ways lead to a form, and each is derived and counted once.
pub(super) struct Counts<'m> {
    assembler: Assembler<'m>,
    function: Function,
    from: MotionInput,
    before: Known,
    after: Known,
}

/// What is known of forms.
type Known = RefCell<Vec<(Selection, Result<usize, Underivable>)>>;

impl<'m> Counts<'m> {
    /// Of a function, nothing of which is known yet.
    pub(super) fn new(assembler: Assembler<'m>, function: Function, from: MotionInput) -> Self {
        Self {
            assembler,
            function,
            from,
            before: RefCell::default(),
            after: RefCell::default(),
        }
    }

    /// The operations of the function as it is derived.
    pub(super) fn before(&self, selection: &Selection) -> Result<usize, Underivable> {
        known(&self.before, selection, || {
            self.searched(selection, &Search::none())
        })
    }

    /// Those after a short search.
    pub(super) fn after(&self, selection: &Selection) -> Result<usize, Underivable> {
        known(&self.after, selection, || {
            self.searched(selection, &Search::short())
        })
    }

    /// The function after the search that was asked for.
    pub(super) fn program(&self, selection: &Selection) -> Result<Program, Underivable> {
        let own = Assembler {
            selection,
            ..self.assembler
        };
        own.program(self.function, self.from)
    }

    /// The operations after a search.
    fn searched(&self, selection: &Selection, search: &Search) -> Result<usize, Underivable> {
        let own = Assembler {
            selection,
            search,
            ..self.assembler
        };
        Ok(own.program(self.function, self.from)?.cost().operations())
    }
}

/// What is known of a form, told where it is not.
fn known(
    all: &Known,
    selection: &Selection,
    tell: impl FnOnce() -> Result<usize, Underivable>,
) -> Result<usize, Underivable> {
    let is_it = |(known, _): &&(Selection, _)| is_written_as(known, selection);
    if let Some((_, told)) = all.borrow().iter().find(is_it) {
        return told.clone();
    }
    let told = tell();
    all.borrow_mut().push((selection.clone(), told.clone()));
    told
}
