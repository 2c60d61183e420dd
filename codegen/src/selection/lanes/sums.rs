//! Functions of given parameters in lanes: what a leg adds to sums over all of them, and what follows from these.

use super::draft::Draft;
use super::outcome::{at_home, guarded, rows_of, summed};
use crate::cas::{Arena, InputElement};
use crate::derivation::{Addends, DynamicsBy, ROWS, SUMS, Selection};
use crate::derivation::{derive_addends, derive_of_rows, derive_of_sums};
use crate::lowering::{Condition, Gathered, Lanes, LegRows, Program, Sums};

/// The cheaper one of both ways to add up forces.
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
    draft.template.stand_in(&arena);
    let mechanism = &draft.template.mechanism;
    let addends = derive_addends(&arena, mechanism, selection, (draft.function, draft.from));
    let Addends {
        derived,
        count,
        rows,
        by_cofactors,
    } = addends.ok()??;
    let lowered = draft.lowered(&arena, derived)?;
    let mut sums = Sums {
        count,
        // Until the sums at home are known.
        program: lowered.program.clone(),
        rows: match (rows, by_cofactors) {
            (0, _) => LegRows::None,
            (rows, false) => LegRows::Times(rows),
            (rows, true) => LegRows::Given(rows),
        },
    };
    let mut lanes = draft.lanes(lowered, Gathered::Sums(sums.clone()))?;
    let given = |name: &str| at_home(draft.assembler, name);
    let added = summed(&lanes, count, &given)?;
    let rows = rows_of(&lanes, count, &given)?;
    sums.program = following(draft, &lanes, &sums, [&added, &rows])?;
    lanes.gathered = Gathered::Sums(sums);
    Some(lanes)
}

/// The program of what follows from the sums and the rows, which have these values at home.
fn following(
    draft: &Draft<'_>,
    lanes: &Lanes,
    sums: &Sums,
    [added, rows]: [&[f64]; 2],
) -> Option<Program> {
    let arena = Arena::new();
    let mechanism = draft.assembler.mechanism;
    let standing = |element: InputElement| match element.array {
        SUMS => added.get(element.index).copied(),
        ROWS => rows.get(element.index).copied(),
        _ => None,
    };
    let (dof, legs) = (mechanism.dof(), mechanism.legs.len());
    let derived = match sums.rows {
        LegRows::Given(_) => {
            let entries = lanes.program.entries[2 * sums.count..].iter();
            let is_there: Vec<bool> = entries.map(|entry| !entry.is_zero()).collect();
            derive_of_rows(&arena, (dof, legs), &is_there, &standing)?
        }
        _ => derive_of_sums(&arena, draft.function, dof),
    };
    let search = draft.assembler.search;
    let program = search.lower_with(&arena, mechanism, draft.function, &derived, &standing);
    let mut program = program.ok()?;
    let values = guarded(&program, [added, rows])?;
    for (guard, value) in program.guards.iter_mut().zip(values) {
        if let Condition::Platform { home, .. } = &mut guard.condition {
            *home = value.abs();
        }
    }
    Some(program)
}
