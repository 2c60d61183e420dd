//! The stages of the generator, in order.

use crate::base::{BaseParameter, select, symmetric_order};
use crate::cas::Arena;
use crate::derivation::{
    BodyParameter, Columns, Family, From, GuardKind, Selection, Underivable, derive,
};
use crate::description::{self, Description};
use crate::diagnostic::{Diagnostics, Source};
use crate::evaluation::{Rows, Workspace};
use crate::lowering::{Array, Condition, GuardedExpr, Program, lower};
use crate::mechanism::{self, Mechanism};
use crate::model::{Function, RobotModel};
use crate::states::{State, random_states};
use nalgebra::DMatrix;

/// From a description's text to a robot's model: parse, check, derive, choose columns, lower.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile(source: &Source) -> Result<RobotModel, Diagnostics> {
    let description = description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    model(mechanism).map_err(|e| underivable(&description, &e))
}

/// The model of a checked mechanism.
///
/// # Errors
/// See [`Underivable`].
pub fn model(mechanism: Mechanism) -> Result<RobotModel, Underivable> {
    let mut selection = Selection { kept_actuators: mechanism.kept_actuators.clone(), ..Selection::default() };
    selection.standard = present(&mechanism, &selection, Family::IdmRedPlatform(Columns::Standard))?;
    selection.payload = present(&mechanism, &selection, Family::IdmRedPayload)?;
    let base = base_parameters(&mechanism, &selection)?;
    selection.base = base.iter().map(|b| b.parameter).collect();
    let tree = mechanism.platform.is_none();
    let functions = Family::all(&mechanism)
        .into_iter()
        .map(|(family, from)| {
            let program = program(&mechanism, &selection, family, from)?;
            Ok(Function { name: family.function_name(from, tree), family, from, program })
        })
        .collect::<Result<_, Underivable>>()?;
    Ok(RobotModel { mechanism, selection, base, functions })
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
) -> Result<Program, Underivable> {
    let arena = Arena::new();
    let derived = derive(&arena, mechanism, selection, family, from)?;
    let array = |name: &str, shape: Vec<usize>| Array { name: name.to_owned(), shape };
    let inputs: Vec<Array> = derived.inputs.iter().map(|(n, len)| array(n, vec![*len])).collect();
    let guards: Vec<GuardedExpr<'_>> = derived
        .guards
        .iter()
        .map(|guard| GuardedExpr { value: guard.value, condition: condition(guard.kind, &guard.leg) })
        .collect();
    let (rows, columns) = derived.shape;
    let shape = if family.is_vector() { vec![rows] } else { vec![rows, columns] };
    Ok(lower(&arena, &inputs, array(family.name(), shape), &derived.entries, &guards))
}

fn condition(kind: GuardKind, place: &str) -> Condition {
    let leg = place.to_owned();
    match kind {
        GuardKind::Reach => Condition::Reach { leg },
        GuardKind::Leg(home) => Condition::Leg { leg, home },
        GuardKind::Platform { home, actuators } => Condition::Platform { actuators, home },
    }
}

/// The parameters whose columns are not identically zero.
fn present(
    mechanism: &Mechanism,
    selection: &Selection,
    family: Family,
) -> Result<Vec<BodyParameter>, Underivable> {
    let arena = Arena::new();
    let robot = crate::derivation::Robot::new(&arena, mechanism, From::Joints)?;
    let payload = family == Family::IdmRedPayload;
    let all = if payload { robot.payload_parameters() } else { robot.parameters() };
    let mut everything = selection.clone();
    everything.standard.clone_from(&all);
    everything.payload.clone_from(&all);
    let derived = derive(&arena, mechanism, &everything, family, From::Joints)?;
    let (rows, columns) = derived.shape;
    let is_present = |c: usize| (0..rows).any(|r| !derived.entries[r * columns + c].is_zero());
    Ok(all.into_iter().enumerate().filter(|(c, _)| is_present(*c)).map(|(_, p)| p).collect())
}

/// Independent columns over random states, and what the others are made of.
fn base_parameters(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<Vec<BaseParameter>, Underivable> {
    let family = Family::IdmRedPlatform(Columns::Standard);
    let program = program(mechanism, selection, family, From::Joints)?;
    let columns = selection.standard.len();
    let count = 3 * columns / mechanism.dof().max(1) + 10;
    let states = random_states(mechanism, count, 1);
    let matrix = sample(&program, &states, mechanism.dof(), columns);
    let order = symmetric_order(mechanism, &selection.standard);
    Ok(select(&matrix, &order, &selection.standard))
}

/// A model's rows over states, stacked.
#[must_use]
pub fn sample(program: &Program, states: &[State], rows: usize, columns: usize) -> DMatrix<f64> {
    let gather = |name: &str| -> Vec<f64> {
        let part = |s: &State| match name {
            "pose" => s.pose.clone(),
            "joints" => s.joints.clone(),
            "twist" | "joint_velocities" => s.twist.clone(),
            _ => s.acceleration.clone(),
        };
        states.iter().flat_map(part).collect()
    };
    let inputs: Vec<Vec<f64>> = program.inputs.iter().map(|a| gather(&a.name)).collect();
    let inputs: Vec<Rows<'_>> =
        inputs.iter().map(|values| Rows { values, shared: false }).collect();
    let mut output = vec![0.0; states.len() * rows * columns];
    // Regular states by construction: a guard that fails all the same leaves zeros, which count for
    // nothing.
    let _ = program.evaluate(states.len(), &inputs, &mut output, &mut Workspace::default());
    DMatrix::from_row_slice(states.len() * rows, columns, &output)
}

fn underivable(description: &Description, error: &Underivable) -> Diagnostics {
    mechanism::locate(description, error)
}
