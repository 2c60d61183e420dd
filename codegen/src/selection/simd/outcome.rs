//! Comparison of programs in lanes with straight programs.

use crate::cas::InputElement;
use crate::derivation::{BodyParameter, ROWS, SUMS};
use crate::interpreter::Rows;
use crate::lowering::{Array, Column, Condition, Elements, Entry, LaneOutput, Lanes, LegRows};
use crate::lowering::{Operand, Program, Sums};
use crate::mechanism::states::{State, random_states};
use crate::selection::assemble::Assembler;
use overact_core::StandardParameter;

/// Number of states at which the programs are compared.
const STATES: usize = 4;

/// Values of an input by its name.
type InputValues<'g> = dyn Fn(&str) -> Option<Vec<f64>> + 'g;

/// Magnitude at home of a leg's divisor, relative to other states, below which it vanishes.
const VANISHING: f64 = 1e-4;

/// Whether no leg divides by a value that vanishes at home.
///
/// A value that is zero for a leg may be nonzero for the template, whose numbers are of no leg.
pub(super) fn is_regular_at_home(assembler: &Assembler<'_>, lanes: &Lanes) -> bool {
    let guards = lanes.program.guards.iter().zip(&lanes.homes);
    let of_legs = guards.filter(|(guard, _)| matches!(guard.condition, Condition::Leg { .. }));
    let (operands, homes): (Vec<Operand>, Vec<&Vec<f64>>) =
        of_legs.map(|(guard, homes)| (guard.operand, homes)).unzip();
    let states = random_states(assembler.mechanism, STATES, 5);
    (0..lanes.legs.len()).all(|leg| {
        let largest = states
            .iter()
            .try_fold(vec![0.0_f64; operands.len()], |largest, state| {
                let given = |name: &str| at_state(assembler, state, name);
                let given = |name: &str| of_leg(lanes, leg, name, &given);
                let values = value_of(&lanes.program, &operands, &given)?;
                let larger = largest
                    .iter()
                    .zip(values)
                    .map(|(l, value)| l.max(value.abs()));
                Some(larger.collect())
            });
        largest.is_some_and(|largest| {
            let mut both = homes.iter().zip(largest);
            both.all(|(home, largest)| home[leg] > VANISHING * largest)
        })
    })
}

/// Whether the program agrees with the straight one, at home and at other states.
pub(super) fn agrees(assembler: &Assembler<'_>, lanes: &Lanes, straight: &Program) -> bool {
    let mut states = random_states(assembler.mechanism, STATES, 5);
    let home = &assembler.mechanism.home;
    states.extend(states.first().cloned().map(|state| State {
        pose: home.pose.clone(),
        joints: home.joints.clone(),
        ..state
    }));
    states.iter().all(|state| {
        let given = |name: &str| at_state(assembler, state, name);
        let Some(wanted) = value(straight, &given) else {
            return false;
        };
        let largest = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        outcome(lanes, &given).is_some_and(|found| {
            let mut both = found.iter().zip(&wanted);
            both.all(|(found, wanted)| (found - wanted).abs() <= 1e-10 * largest)
        })
    })
}

/// The function's output.
fn outcome(lanes: &Lanes, given: &InputValues<'_>) -> Option<Vec<f64>> {
    match &lanes.gathered {
        LaneOutput::Columns(columns) => side_by_side(lanes, columns, given),
        LaneOutput::Sums(sums) => following(lanes, sums, given),
    }
}

/// Puts columns in their places in the output.
fn side_by_side(lanes: &Lanes, columns: &[Column], given: &InputValues<'_>) -> Option<Vec<f64>> {
    let width = lanes.output.shape.last().copied().unwrap_or_default();
    let mut output = vec![0.0; lanes.output.len()];
    for leg in 0..lanes.legs.len() {
        let found = value(&lanes.program, &|name| of_leg(lanes, leg, name, given))?;
        for (at, number) in found.into_iter().enumerate() {
            let column = match columns[at % columns.len()] {
                Column::Shared(column) => Some(column),
                Column::OfLegs(place) => place.of(leg),
            };
            if let Some(column) = column {
                output[at / columns.len() * width + column] = number;
            }
        }
    }
    Some(output)
}

/// The output computed from the sums.
fn following(lanes: &Lanes, sums: &Sums, given: &InputValues<'_>) -> Option<Vec<f64>> {
    let added = summed(lanes, sums.count, given)?;
    let rows = rows_of(lanes, sums.count, given)?;
    let inputs = GatheredInputs {
        sums: &added,
        rows: &rows,
    };
    let solution = value(&sums.program, &|name| inputs.get(name))?;
    if !matches!(sums.rows, LegRows::Times(_)) {
        return Some(solution);
    }
    let mut output = Vec::new();
    for leg in 0..lanes.legs.len() {
        let found = value(&lanes.program, &|name| of_leg(lanes, leg, name, given))?;
        for row in found[2 * sums.count..].chunks(sums.width()) {
            let (own, row) = row.split_last()?;
            let products = row.iter().zip(&solution).map(|(r, x)| r * x);
            output.push(own + products.sum::<f64>());
        }
    }
    Some(output)
}

/// Inputs of the program that solves with the contributions of all legs.
#[derive(Clone, Copy)]
pub(super) struct GatheredInputs<'v> {
    /// The sums over the legs.
    pub(super) sums: &'v [f64],
    /// The numbers of the legs' rows.
    pub(super) rows: &'v [f64],
}

impl GatheredInputs<'_> {
    /// An input by its name.
    fn get(&self, name: &str) -> Option<Vec<f64>> {
        match name {
            SUMS => Some(self.sums.to_vec()),
            ROWS => Some(self.rows.to_vec()),
            _ => None,
        }
    }

    /// An element of an input.
    pub(super) fn element(&self, element: InputElement) -> Option<f64> {
        let values = match element.array {
            SUMS => self.sums,
            ROWS => self.rows,
            _ => return None,
        };
        values.get(element.index).copied()
    }
}

/// Nonzero numbers of the legs' rows, each for all legs.
pub(super) fn rows_of(lanes: &Lanes, count: usize, given: &InputValues<'_>) -> Option<Vec<f64>> {
    let legs = 0..lanes.legs.len();
    let all = legs.map(|leg| value(&lanes.program, &|name| of_leg(lanes, leg, name, given)));
    let all: Option<Vec<Vec<f64>>> = all.collect();
    let all = all?;
    let entries = lanes.program.entries.iter().enumerate().skip(2 * count);
    let there = entries.filter(|(_, entry)| !entry.is_zero());
    Some(
        there
            .flat_map(|(at, _)| all.iter().map(move |of_leg| of_leg[at]))
            .collect(),
    )
}

/// The sums over the legs.
pub(super) fn summed(lanes: &Lanes, count: usize, given: &InputValues<'_>) -> Option<Vec<f64>> {
    let mut sums = vec![0.0; count];
    for leg in 0..lanes.legs.len() {
        let found = value(&lanes.program, &|name| of_leg(lanes, leg, name, given))?;
        let (own, shared) = found.split_at(count);
        for ((sum, own), shared) in sums.iter_mut().zip(own).zip(shared) {
            *sum += own;
            if leg == 0 {
                *sum += shared;
            }
        }
    }
    Some(sums)
}

/// Guarded values in a program of sums and rows.
pub(super) fn guarded(program: &Program, inputs: GatheredInputs<'_>) -> Option<Vec<f64>> {
    let guards: Vec<Operand> = program.guards.iter().map(|g| g.operand).collect();
    value_of(program, &guards, &|name| inputs.get(name))
}

/// An input of a program in lanes, for one leg.
pub(super) fn of_leg(
    lanes: &Lanes,
    leg: usize,
    name: &str,
    given: &InputValues<'_>,
) -> Option<Vec<f64>> {
    let inputs = &lanes.program.inputs;
    let at = inputs.iter().position(|input| input.name == name)?;
    match &lanes.inputs[at] {
        Elements::Shared => given(name),
        Elements::Constants => Some(lanes.constants[leg].clone()),
        Elements::InTurn(count) => {
            let mut values = given(name)?;
            values.rotate_left(count * leg);
            Some(values)
        }
        Elements::Scattered { of, places } => {
            let values = given(&inputs[*of].name)?;
            let own = places.iter().map(|place| place.of(leg));
            Some(own.map(|at| at.map_or(0.0, |at| values[at])).collect())
        }
    }
}

/// An input at home; rates have no values there.
pub(super) fn at_home(assembler: &Assembler<'_>, name: &str) -> Option<Vec<f64>> {
    let home = &assembler.mechanism.home;
    match name {
        "pose" => Some(home.pose.clone()),
        "joints" => Some(home.joints.clone()),
        _ => of_body(assembler, name),
    }
}

/// An input at a state.
fn at_state(assembler: &Assembler<'_>, state: &State, name: &str) -> Option<Vec<f64>> {
    match name {
        "pose" => Some(state.pose.clone()),
        "joints" => Some(state.joints.clone()),
        "twist" => Some(state.twist.clone()),
        "acceleration" => Some(state.acceleration.clone()),
        "torques" | "actuators" => {
            let count = assembler.mechanism.actuator_count();
            Some((0..count).map(|at| (at as f64).sin()).collect())
        }
        _ => of_body(assembler, name),
    }
}

/// Parameters of bodies with mass, different for each body.
fn of_body(assembler: &Assembler<'_>, name: &str) -> Option<Vec<f64>> {
    let selection = assembler.selection;
    let chosen = match name {
        "parameters" => &selection.standard,
        "base_parameters" => &selection.base,
        _ => return None,
    };
    let all = chosen.iter().chain(&selection.payload).enumerate();
    let number = |(at, parameter): (usize, &BodyParameter)| {
        let around = match parameter.symbol() {
            StandardParameter::M | StandardParameter::Ia => 1.0,
            StandardParameter::Xx | StandardParameter::Yy | StandardParameter::Zz => 0.3,
            _ => 0.02,
        };
        around * (1.0 + 0.2 * (at as f64).sin())
    };
    Some(all.map(number).collect())
}

/// Values of some operands of a program.
pub(super) fn value_of(
    program: &Program,
    operands: &[Operand],
    given: &InputValues<'_>,
) -> Option<Vec<f64>> {
    let program = Program {
        least_torques: Vec::new(),
        entries: operands.iter().map(|&o| Entry::positive(o)).collect(),
        output: Array {
            name: program.output.name.clone(),
            shape: vec![operands.len()],
        },
        guards: Vec::new(),
        ..program.clone()
    };
    value(&program, given)
}

/// Output of a program; missing inputs are one.
fn value(program: &Program, given: &InputValues<'_>) -> Option<Vec<f64>> {
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
