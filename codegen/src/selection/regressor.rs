//! The standard regressor of the platform projection from joint angles, derived once for each
//! formulation. All choices of columns are based on it.

use super::search::Search;
use crate::cas::arena::Handle;
use crate::cas::{Arena, Expr, Number};
use crate::derivation::{BodyParameter, DerivationError, MotionInput, Selection, derive};
use crate::lowering::Program;
use crate::mechanism::Mechanism;
use overact_core::{Columns, Function};

/// The function that is compared: its operations are most of an identification's work.
pub(super) const FAMILY: Function = Function::IdmRedPlatform(Columns::Standard);

/// The regressor of one formulation.
#[derive(Debug)]
pub(super) struct Regressor {
    arena: Arena,
    /// Parameters of the columns.
    parameters: Vec<BodyParameter>,
    /// Entries, column by column.
    columns: Vec<Vec<Handle>>,
    /// Program of the form as derived.
    pub(super) program: Program,
}

impl Regressor {
    /// Derives the regressor; columns that are identically zero are removed from those of the
    /// selection.
    ///
    /// # Errors
    /// See [`DerivationError`].
    pub(super) fn new(
        mechanism: &Mechanism,
        selection: &Selection,
    ) -> Result<Self, DerivationError> {
        let arena = Arena::new();
        let mut derived = derive(&arena, mechanism, selection, FAMILY, MotionInput::Joints)?;
        let present = derived.present_columns();
        derived.keep_columns(&present);
        let program = Search::none().lower(&arena, mechanism, FAMILY, &derived)?;
        let width = present.len();
        let column = |c: usize| {
            let entries = derived.entries.iter().skip(c).step_by(width);
            entries.map(|entry| entry.handle()).collect()
        };
        let columns = (0..width).map(column).collect();
        let parameters = present.iter().map(|&c| selection.standard[c]).collect();
        Ok(Self {
            arena,
            parameters,
            columns,
            program,
        })
    }

    /// Operations of the program.
    pub(super) fn operations(&self) -> usize {
        self.program.cost().operations()
    }

    /// The parameters of the columns.
    pub(super) fn parameters(&self) -> &[BodyParameter] {
        &self.parameters
    }

    /// The column of a parameter.
    pub(super) fn column(&self, parameter: BodyParameter) -> Option<Vec<Expr<'_>>> {
        let at = self.parameters.iter().position(|p| *p == parameter)?;
        let entries = self.columns[at].iter();
        Some(entries.map(|&handle| self.arena.expr(handle)).collect())
    }

    /// A linear combination of columns, row by row.
    pub(super) fn combination(&self, terms: &[(BodyParameter, Number)]) -> Option<Vec<Expr<'_>>> {
        let rows = self.columns.first().map_or(0, Vec::len);
        let mut sum = vec![self.arena.zero(); rows];
        for (parameter, factor) in terms {
            for (sum, entry) in sum.iter_mut().zip(self.column(*parameter)?) {
                *sum = *sum + entry * *factor;
            }
        }
        Some(sum)
    }
}
