//! Legs that are alike, side by side: the program of one leg, to be run in the lanes of vectors.
//!
//! Straight code of many equal legs is longer than an instruction cache, and the compiler finds hardly any vectors
//! in it. So where legs differ in nothing but numbers, one of them is derived with elements of an array in the
//! place of these numbers ([`template`]), which keeps all that the algebra knows of them: a cosine and a sine
//! that differ from leg to leg still have squares that add up to one. The columns of the other legs are the same
//! program with their numbers. Special values of a leg, a point on an axis for instance, bring nothing then, and nothing
//! is shared between legs that lie symmetrically, so there are more operations than in the straight program, which
//! interpreted robots and other languages keep. Both are compared at random states before this one is taken.

mod fields;
mod template;

use super::assemble::Assembler;
use crate::cas::{Arena, InputElement};
use crate::derivation::{BodyParameter, Derived, MotionInput, Selection, derive};
use crate::evaluation::Rows;
use crate::lowering::{Array, Column, Condition, Entry, Lanes, Operand, Program, fold};
use crate::mechanism::states::{State, random_states};
use overact_core::{Columns, Function};
use template::{ARRAY, Template};

/// Operations of a straight program from which its code is longer than an instruction cache of 32 kB: it has 19 bytes
/// for each, as measured on x86-64 with regressors.
const TOO_LONG: usize = 32 * 1024 / 19;

/// The fewest legs that are worth it.
const LEGS: usize = 4;

/// Operations of all lanes that are still worth it, in hundredths of the straight program's.
const MOST: usize = 125;

/// States at which the program is compared with the straight one.
const STATES: usize = 4;

/// The program of a function in lanes, where that is the faster one.
pub(crate) fn beside(
    assembler: &Assembler<'_>,
    function: Function,
    from: MotionInput,
    straight: &Program,
) -> Option<Lanes> {
    let Function::IdmRedPlatform(columns) = function else {
        return None;
    };
    let legs = assembler.mechanism.legs.len();
    let operations = straight.cost().operations();
    if legs < LEGS || operations < TOO_LONG {
        return None;
    }
    let template = Template::of(assembler.mechanism)?;
    let lanes = program(assembler, &template, (function, columns, from), straight)?;
    let (shared, own) = lanes.operations();
    let is_cheap = (shared + own * legs) * 100 <= operations * MOST;
    let is_right = has_lanes_guards(&lanes) && agrees(assembler, &lanes, straight);
    (is_cheap && is_right).then_some(lanes)
}

/// The program of a template's first leg and of what all legs share.
fn program(
    assembler: &Assembler<'_>,
    template: &Template,
    (function, columns, from): (Function, Columns, MotionInput),
    straight: &Program,
) -> Option<Lanes> {
    let selection = Selection {
        combined: Vec::new(),
        ..assembler.selection.clone()
    };
    let parameters = match columns {
        Columns::Standard => &selection.standard,
        Columns::Base => &selection.base,
    };
    let legs = assembler.mechanism.legs.len();
    let (kept, columns) = kept_columns(parameters, legs)?;
    let arena = Arena::new();
    template.stand_in(&arena);
    let mut derived = derive(&arena, &template.mechanism, &selection, function, from).ok()?;
    derived.keep_columns(&kept);
    keep_guards(&mut derived, &template.mechanism.legs[0].name);
    derived.inputs.push((ARRAY, template.len()));
    let (first, search) = (template.values(0), assembler.search);
    let standing = |element: InputElement| match element.array {
        ARRAY => first.get(element.index).copied(),
        _ => None,
    };
    let mechanism = assembler.mechanism;
    let program = search.lower_with(&arena, mechanism, function, &derived, &standing);
    let (program, array) = (program.ok()?, derived.inputs.len() - 1);
    let folded = fold(&program, array);
    let wanted = of_operands(&program, &folded.elements);
    let of_leg = |leg| {
        let given = |name: &str| (name == ARRAY).then(|| template.values(leg));
        value(&wanted, &given)
    };
    let constants: Option<Vec<Vec<f64>>> = (0..legs).map(of_leg).collect();
    let strides = strides(assembler, &folded.program, array)?;
    let mut program = folded.program;
    name_guards(&mut program, &mechanism.legs[0].name);
    let mut lanes = Lanes {
        program,
        output: straight.output.clone(),
        columns,
        legs: mechanism.legs.iter().map(|l| l.name.clone()).collect(),
        array,
        constants: constants?,
        strides,
        homes: Vec::new(),
    };
    lanes.homes = homes(assembler, &lanes)?;
    Some(lanes)
}

/// Which columns of a function stay, and where they and those of the other legs stand. None if the legs' columns do
/// not follow one another at a distance of their own.
fn kept_columns(parameters: &[BodyParameter], legs: usize) -> Option<(Vec<usize>, Vec<Column>)> {
    let mut kept = Vec::new();
    for (at, &parameter) in parameters.iter().enumerate() {
        let BodyParameter::Leg { leg, joint, symbol } = parameter else {
            kept.push((at, Column::Shared(at)));
            continue;
        };
        if leg > 0 {
            continue;
        }
        let of = |leg| {
            let same = BodyParameter::Leg { leg, joint, symbol };
            parameters.iter().position(|other| *other == same)
        };
        let stride = of(1)?.checked_sub(at)?;
        if !(0..legs).all(|leg| of(leg) == Some(at + leg * stride)) {
            return None;
        }
        kept.push((at, Column::OfLegs { first: at, stride }));
    }
    let of_first = kept
        .iter()
        .filter(|(_, column)| matches!(column, Column::OfLegs { .. }));
    let shared = kept.len() - of_first.clone().count();
    let whole = of_first.count() * legs + shared == parameters.len();
    whole.then(|| kept.into_iter().unzip())
}

/// Leaves out the guards of all legs but the first.
fn keep_guards(derived: &mut Derived<'_>, first: &str) {
    for guards in [&mut derived.guards, &mut derived.divisors] {
        guards.retain(|guard| guard.leg.is_empty() || guard.leg == first);
    }
}

/// What all legs share fails in the first one first. In which leg another guard fails is known when it does.
fn name_guards(program: &mut Program, first: &str) {
    for guard in &mut program.guards {
        if let Condition::Reach { leg }
        | Condition::Leg { leg, .. }
        | Condition::Closed { leg, .. } = &mut guard.condition
        {
            first.clone_into(leg);
        }
    }
}

/// Whether all guards that belong to legs are such that lanes have.
fn has_lanes_guards(lanes: &Lanes) -> bool {
    let of_legs = lanes.of_legs();
    let mut own = lanes.program.guards.iter();
    own.all(|guard| {
        let is_of_leg = matches!(
            guard.condition,
            Condition::Reach { .. } | Condition::Leg { .. } | Condition::Closed { .. }
        );
        is_of_leg || !lanes.is_of_leg(guard.operand, &of_legs)
    })
}

/// How many elements of each input belong to a leg. None if the program reads what belongs to another leg than the
/// first.
fn strides(assembler: &Assembler<'_>, program: &Program, array: usize) -> Option<Vec<usize>> {
    let joints = assembler.mechanism.legs[0].independent().count();
    let of = |(at, input): (usize, &Array)| match &*input.name {
        _ if at == array => input.len(),
        "joints" => joints,
        _ => 0,
    };
    let strides: Vec<usize> = program.inputs.iter().enumerate().map(of).collect();
    let operands = program.steps.iter().flat_map(|s| s.operation.operands());
    let operands = operands.chain(program.entries.iter().map(|e| e.operand));
    let is_own = |operand| match operand {
        Operand::Input { array, index } => strides[array] == 0 || index < strides[array],
        _ => true,
    };
    operands.into_iter().all(is_own).then_some(strides)
}

/// The magnitudes at home of what is guarded, in each leg.
fn homes(assembler: &Assembler<'_>, lanes: &Lanes) -> Option<Vec<Vec<f64>>> {
    let guards: Vec<Operand> = lanes.program.guards.iter().map(|g| g.operand).collect();
    let wanted = of_operands(&lanes.program, &guards);
    let home = &assembler.mechanism.home;
    let of_legs: Option<Vec<Vec<f64>>> = (0..lanes.legs.len())
        .map(|leg| {
            let given = |name: &str| match name {
                "pose" => Some(home.pose.clone()),
                "joints" => Some(of_leg(lanes, name, &home.joints, leg)),
                ARRAY => Some(lanes.constants[leg].clone()),
                _ => None,
            };
            value(&wanted, &given)
        })
        .collect();
    let of_legs = of_legs?;
    let of_guard = |guard: usize| of_legs.iter().map(|values| values[guard].abs()).collect();
    Some((0..guards.len()).map(of_guard).collect())
}

/// Whether the program gives what the straight one does, in every leg.
fn agrees(assembler: &Assembler<'_>, lanes: &Lanes, straight: &Program) -> bool {
    let states = random_states(assembler.mechanism, STATES, 5);
    states.iter().all(|state| {
        let wanted = value(straight, &|name| at_state(state, name));
        wanted.is_some_and(|wanted| {
            (0..lanes.legs.len()).all(|leg| agrees_in(lanes, leg, state, &wanted))
        })
    })
}

fn agrees_in(lanes: &Lanes, leg: usize, state: &State, wanted: &[f64]) -> bool {
    let given = |name: &str| match name {
        ARRAY => Some(lanes.constants[leg].clone()),
        "joints" => Some(of_leg(lanes, name, &state.joints, leg)),
        _ => at_state(state, name),
    };
    let Some(found) = value(&lanes.program, &given) else {
        return false;
    };
    let width = lanes.output.shape.last().copied().unwrap_or_default();
    let largest = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let is_close = |(row, column): (usize, usize)| {
        let at = match lanes.columns[column] {
            Column::Shared(at) => at,
            Column::OfLegs { first, stride } => first + leg * stride,
        };
        let (found, wanted) = (
            found[row * lanes.columns.len() + column],
            wanted[row * width + at],
        );
        (found - wanted).abs() <= 1e-10 * largest
    };
    let rows = wanted.len() / width.max(1);
    (0..rows).all(|row| (0..lanes.columns.len()).all(|column| is_close((row, column))))
}

/// The elements of an input with those of a leg in the place of the first leg's.
fn of_leg(lanes: &Lanes, name: &str, values: &[f64], leg: usize) -> Vec<f64> {
    let input = lanes.program.inputs.iter().position(|i| i.name == name);
    let shift = input.map_or(0, |input| lanes.strides[input] * leg);
    let mut values = values.to_vec();
    values.rotate_left(shift);
    values
}

fn at_state(state: &State, name: &str) -> Option<Vec<f64>> {
    match name {
        "pose" => Some(state.pose.clone()),
        "joints" => Some(state.joints.clone()),
        "twist" => Some(state.twist.clone()),
        "acceleration" => Some(state.acceleration.clone()),
        _ => None,
    }
}

/// The program that computes some operands of another one.
fn of_operands(program: &Program, operands: &[Operand]) -> Program {
    Program {
        entries: operands.iter().map(|&o| Entry::positive(o)).collect(),
        output: Array {
            name: program.output.name.clone(),
            shape: vec![operands.len()],
        },
        guards: Vec::new(),
        ..program.clone()
    }
}

/// A program's output; inputs that are not given are one.
fn value(program: &Program, given: &dyn Fn(&str) -> Option<Vec<f64>>) -> Option<Vec<f64>> {
    let inputs = program.inputs.iter();
    let inputs: Vec<Vec<f64>> = inputs
        .map(|input| given(&input.name).unwrap_or_else(|| vec![1.0; input.len()]))
        .collect();
    let rows = inputs.iter().map(|values| Rows {
        values,
        shared: false,
    });
    let mut output = vec![0.0; program.entries.len()];
    let evaluated = program.evaluate(1, &rows.collect::<Vec<_>>(), &mut output);
    evaluated.is_ok().then_some(output)
}
