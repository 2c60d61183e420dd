//! Choice of the base parameters: independent columns, and proved combinations for the others.

use super::assemble::Assembler;
use super::base::{BaseParameter, select, symmetric_order};
use super::combine::exact_combinations;
use super::regressor::Regressor;
use super::search::Search;
use crate::derivation::{Combination, DerivationError, MotionInput, Selection};
use crate::interpreter::{BLOCK, Evaluator, Rows};
use crate::lowering::{Operand, Program};
use crate::mechanism::states::{State, random_states};
use crate::mechanism::{BaseColumns, Mechanism};
use nalgebra::DMatrix;
use overact_core::{Columns, Function};
use std::collections::BTreeSet;

/// Independent columns over random states, the regrouping of the others, and the combinations that
/// are proved to be exact.
///
/// # Errors
/// See [`DerivationError`].
pub(super) fn base_parameters(
    mechanism: &Mechanism,
    selection: &Selection,
    regressor: &Regressor,
) -> Result<(Vec<BaseParameter>, Vec<Combination>), DerivationError> {
    let columns = selection.standard.len();
    let count = 3 * columns / mechanism.dof().max(1) + 10;
    let states = random_states(mechanism, count, 1);
    let matrix = sample(&regressor.program, &states, mechanism.dof(), columns);
    let symmetric = symmetric_order(mechanism, &selection.standard);
    let mut base = select(&matrix, &symmetric, &selection.standard);
    if mechanism.base_columns == BaseColumns::Cheapest {
        let shares = shares(&regressor.program, columns);
        let mut order = symmetric;
        order.sort_by(|a, b| shares[*a].total_cmp(&shares[*b]));
        let other = select(&matrix, &order, &selection.standard);
        if operations(mechanism, selection, &other)? < operations(mechanism, selection, &base)? {
            base = other;
        }
    }
    let exact = exact_combinations(regressor, &mut base);
    Ok((base, exact))
}

/// Operations of the model with these columns after a short search: choices differ little.
fn operations(
    mechanism: &Mechanism,
    selection: &Selection,
    base: &[BaseParameter],
) -> Result<usize, DerivationError> {
    let trial = Assembler {
        mechanism,
        selection: &Selection {
            base: base.iter().map(|b| b.parameter).collect(),
            ..selection.clone()
        },
        search: &Search::short(),
    };
    let function = Function::IdmRedPlatform(Columns::Base);
    let program = trial.program(function, MotionInput::Joints)?;
    Ok(program.cost().operations())
}

/// Cost of each column: the operations of a program, divided among the columns that need them.
///
/// If no operation were shared, the independent columns that come first in this order would be the
/// cheapest set (the greedy algorithm on a matroid). With shared operations it is a good guess.
fn shares(program: &Program, columns: usize) -> Vec<f64> {
    let mut needed: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); program.steps.len()];
    for (at, entry) in program.entries.iter().enumerate() {
        if let Operand::Step(step) = entry.operand {
            needed[step].insert(at % columns);
        }
    }
    let mut shares = vec![0.0; columns];
    for (at, step) in program.steps.iter().enumerate().rev() {
        let by = std::mem::take(&mut needed[at]);
        for operand in step.operation.operands() {
            if let Operand::Step(step) = operand {
                needed[step].extend(&by);
            }
        }
        if step.operation.is_counted() {
            by.iter().for_each(|c| shares[*c] += 1.0 / by.len() as f64);
        }
    }
    shares
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
    let inputs: Vec<Rows<'_>> = inputs
        .iter()
        .map(|values| Rows {
            values,
            shared: false,
        })
        .collect();
    let mut sampled = DMatrix::zeros(states.len() * rows, columns);
    let done = Evaluator::new(program).evaluate_numbers(states.len(), &inputs, |number| {
        let (row, column) = (number.index / columns, number.index % columns);
        let mut column = sampled.column_mut(column);
        let places = column
            .iter_mut()
            .skip(number.first * rows + row)
            .step_by(rows);
        places
            .zip(number.values)
            .for_each(|(place, value)| *place = number.sign * value);
    });
    // States are regular by construction. If a guard fails nevertheless, the rest from its block on
    // is zero and has no effect.
    if let Err(failed) = done {
        let valid = failed.sample / BLOCK * BLOCK * rows;
        sampled.rows_range_mut(valid..).fill(0.0);
    }
    sampled
}
