//! One function from mechanism to program: derivation in a graph of its own, then lowering.

use crate::cas::Arena;
use crate::derivation::{
    Columns, Family, From, GuardKind, JointsBy, Selection, Underivable, derive,
};
use crate::lowering::{Array, Condition, GuardedExpr, Program, Reach, States, lower};
use crate::mechanism::Mechanism;
use crate::mechanism::states::State;

/// How the joints of a robot follow from its pose: by rule, if one fits every leg.
///
/// # Errors
/// See [`Underivable`].
pub fn joints_by(mechanism: &Mechanism, selection: &Selection) -> Result<JointsBy, Underivable> {
    let from = if mechanism.platform.is_some() {
        From::Pose
    } else {
        From::Joints
    };
    match program(mechanism, selection, Family::Joints, from, JointsBy::Rule) {
        Ok(_) => Ok(JointsBy::Rule),
        Err(Underivable::InverseKinematics { .. }) => Ok(JointsBy::Newton),
        Err(error) => Err(error),
    }
}

/// Derives and lowers one function.
///
/// # Errors
/// See [`Underivable`].
pub fn program(
    mechanism: &Mechanism,
    selection: &Selection,
    family: Family,
    from: From,
    joints: JointsBy,
) -> Result<Program, Underivable> {
    let arena = Arena::new();
    let derived = derive(&arena, mechanism, selection, family, from, joints)?;
    let array = |name: &str, shape: Vec<usize>| Array {
        name: name.to_owned(),
        shape,
    };
    let inputs: Vec<Array> = derived
        .inputs
        .iter()
        .map(|(n, len)| array(n, vec![*len]))
        .collect();
    let guards: Vec<GuardedExpr<'_>> = derived
        .guards
        .iter()
        .map(|guard| GuardedExpr {
            value: guard.value,
            condition: condition(guard.kind, &guard.leg),
        })
        .collect();
    let (rows, columns) = derived.shape;
    let shape = if family.is_vector() {
        vec![rows]
    } else {
        vec![rows, columns]
    };
    let reach = reach(selection.reach, family);
    // Of single replacements in functions that matter less, only those near singular states are looked at.
    let compared = match reach {
        Reach::Nothing | Reach::Singles => &[][..],
        _ => &selection.states,
    };
    Ok(lower(
        &arena,
        &inputs,
        array(family.name(), shape),
        &derived.entries,
        &guards,
        reach,
        &States {
            home: &|symbol| at_home(mechanism, symbol),
            groups: &compared.iter().map(Vec::len).collect::<Vec<_>>(),
            regular: &|group, number, symbol| at_state(mechanism, &compared[group][number], symbol),
        },
    ))
}

/// The value of an input, by its symbol `name[index]`, in the home configuration; rates have none.
fn at_home(mechanism: &Mechanism, symbol: &str) -> Option<f64> {
    let (name, index) = indexed(symbol)?;
    let home = &mechanism.home;
    let values = match name {
        "pose" => &home.pose,
        "joints" => &home.joints,
        "actuators" => &home.actuators,
        _ => return None,
    };
    values.get(index).copied()
}

/// The same at a state.
fn at_state(mechanism: &Mechanism, state: &State, symbol: &str) -> Option<f64> {
    let (name, index) = indexed(symbol)?;
    let values = match name {
        "pose" => &state.pose,
        "joints" => &state.joints,
        "twist" | "joint_velocities" => &state.twist,
        "acceleration" | "joint_accelerations" => &state.acceleration,
        "actuators" => return state.joints.get(*mechanism.actuated().get(index)?).copied(),
        _ => return None,
    };
    values.get(index).copied()
}

/// Name and index of a symbol `name[index]`.
fn indexed(symbol: &str) -> Option<(&str, usize)> {
    let (name, index) = symbol.strip_suffix(']')?.split_once('[')?;
    Some((name, index.parse().ok()?))
}

/// How far the search of a function goes: the identification models, which run at every sample of
/// every log, are searched as far as asked; of the others only the nodes one by one.
fn reach(asked: Reach, family: Family) -> Reach {
    match family {
        Family::IdmRedPlatform(_) => asked,
        _ => asked.min(Reach::Singles),
    }
}

/// The function with or without combined columns, whichever needs fewer operations.
///
/// # Errors
/// See [`Underivable`].
pub fn cheapest(
    mechanism: &Mechanism,
    selection: &Selection,
    family: Family,
    from: From,
    joints: JointsBy,
) -> Result<Program, Underivable> {
    let combined = program(mechanism, selection, family, from, joints)?;
    if selection.combined.is_empty() || family.columns() != Some(Columns::Standard) {
        return Ok(combined);
    }
    let plain = Selection {
        combined: Vec::new(),
        ..selection.clone()
    };
    let plain = program(mechanism, &plain, family, from, joints)?;
    let is_better = plain.cost().operations() < combined.cost().operations();
    Ok(if is_better { plain } else { combined })
}

fn condition(kind: GuardKind, place: &str) -> Condition {
    let leg = place.to_owned();
    match kind {
        GuardKind::Reach => Condition::Reach { leg },
        GuardKind::Leg(home) => Condition::Leg { leg, home },
        GuardKind::Platform { home, actuators } => Condition::Platform { actuators, home },
    }
}
