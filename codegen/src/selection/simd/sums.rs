//! Functions of given parameters in lanes: a leg's contributions to sums, and the output from the
//! sums.

use super::draft::Draft;
use super::outcome::{GatheredInputs, at_home, guarded, rows_of, summed};
use crate::cas::{Arena, InputElement};
use crate::derivation::{Addends, DynamicsBy, FunctionForm, LegRowLayout, Selection};
use crate::derivation::{derive_addends, derive_of_rows, derive_of_sums};
use crate::lowering::{Condition, LaneOutput, Lanes, LegRows, Program, Sums};

/// The cheaper of the two ways to sum forces.
pub(super) fn lanes(draft: &Draft<'_>) -> Option<Lanes> {
    let ways = [DynamicsBy::Bodies, DynamicsBy::Parameters].into_iter();
    let found = ways.filter_map(|dynamics| {
        let selection = Selection {
            dynamics,
            ..draft.selection()
        };
        of_selection(draft, &selection)
    });
    found.min_by_key(|lanes| {
        let (once, each) = lanes.operations();
        once + each * lanes.legs.len()
    })
}

fn of_selection(draft: &Draft<'_>, selection: &Selection) -> Option<Lanes> {
    let arena = Arena::new();
    draft.template.substitute_placeholders(&arena);
    let mechanism = &draft.template.mechanism;
    let addends = derive_addends(
        &arena,
        mechanism,
        selection,
        FunctionForm::new(draft.function, draft.from),
    );
    let Addends {
        derived,
        count,
        rows,
        by_cofactors,
    } = addends.ok()??;
    let lowered = draft.lowered(&arena, derived)?;
    let mut sums = Sums {
        count,
        // A placeholder until the sums at home are known.
        program: lowered.program.clone(),
        rows: match (rows, by_cofactors) {
            (0, _) => LegRows::None,
            (rows, false) => LegRows::Times(rows),
            (rows, true) => LegRows::Given(rows),
        },
    };
    let mut lanes = draft.lanes(lowered, LaneOutput::Sums(sums.clone()))?;
    let given = |name: &str| at_home(draft.assembler, name);
    let added = summed(&lanes, count, &given)?;
    let rows = rows_of(&lanes, count, &given)?;
    let at_home = GatheredInputs {
        sums: &added,
        rows: &rows,
    };
    sums.program = following(draft, &lanes, &sums, at_home)?;
    lanes.gathered = LaneOutput::Sums(sums);
    Some(lanes)
}

/// The program that solves with the sums and rows of all legs, for given values at home.
fn following(
    draft: &Draft<'_>,
    lanes: &Lanes,
    sums: &Sums,
    at_home: GatheredInputs<'_>,
) -> Option<Program> {
    let arena = Arena::new();
    let mechanism = draft.assembler.mechanism;
    let home = |element: InputElement| at_home.element(element);
    let dof = mechanism.dof();
    let derived = match sums.rows {
        LegRows::Given(_) => {
            let entries = lanes.program.entries[2 * sums.count..].iter();
            let is_present: Vec<bool> = entries.map(|entry| !entry.is_zero()).collect();
            let layout = LegRowLayout {
                dof,
                legs: mechanism.legs.len(),
                is_present: &is_present,
            };
            derive_of_rows(&arena, &layout, &home)?
        }
        _ => derive_of_sums(&arena, draft.function, dof),
    };
    let search = draft.assembler.search;
    let program = search.lower_with(&arena, mechanism, draft.function, &derived, &home);
    let mut program = program.ok()?;
    let values = guarded(&program, at_home)?;
    for (guard, value) in program.guards.iter_mut().zip(values) {
        if let Condition::Platform { home, .. } = &mut guard.condition {
            *home = value.abs();
        }
    }
    Some(program)
}
