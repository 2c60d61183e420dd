//! Regressors in SIMD lanes: the columns of one leg, and the shared ones.

use super::draft::Draft;
use super::kept::kept_columns;
use crate::cas::Arena;
use crate::derivation::derive;
use crate::lowering::{LaneOutput, Lanes};
use overact_core::Columns;

/// Regressor of a template's first leg and of the shared bodies.
pub(super) fn lanes(draft: &Draft<'_>, columns: Columns) -> Option<Lanes> {
    let selection = draft.selection();
    let parameters = match columns {
        Columns::Standard => &selection.standard,
        Columns::Base => &selection.base,
    };
    let (kept, columns) = kept_columns(parameters, draft.assembler.mechanism.legs.len())?;
    let arena = Arena::new();
    draft.template.substitute_placeholders(&arena);
    let mechanism = &draft.template.mechanism;
    let derived = derive(&arena, mechanism, &selection, draft.function, draft.from);
    let mut derived = derived.ok()?;
    derived.keep_columns(&kept);
    let lowered = draft.lowered(&arena, derived)?;
    draft.lanes(lowered, LaneOutput::Columns(columns))
}
