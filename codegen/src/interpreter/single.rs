//! Evaluation of one sample at a time, for iterations and simulations.
//!
//! The passes of the plan run on scalars. For a single evaluation a plan does not pay, so the
//! program's steps are interpreted directly.

use super::passes::{Worker, work};
use super::plan::{Pass, Plan, Slot};
use super::{Failed, Rows, signed};
use crate::lowering::{Operand, Operation, Program};
use std::cell::Cell;

/// A program prepared for successive samples.
#[derive(Debug)]
pub(super) struct Single {
    plan: Plan,
    /// The slots of the plan.
    values: Vec<f64>,
}

impl Single {
    /// Prepares a program.
    pub(super) fn new(program: &Program) -> Self {
        let plan = Plan::new(program, usize::MAX);
        let mut values = vec![0.0; plan.slots as usize];
        for &(slot, value) in &plan.constants {
            values[slot as usize] = value;
        }
        Self { plan, values }
    }

    /// Evaluates the program at a sample.
    pub(super) fn evaluate(
        &mut self,
        program: &Program,
        inputs: &[Rows<'_>],
        output: &mut [f64],
    ) -> Result<(), Failed> {
        let Self { plan, values } = self;
        for load in &plan.loads {
            let input = inputs.get(load.array).map(|rows| rows.values);
            let value = input.and_then(|values| values.get(load.index).copied());
            values[load.slot as usize] = value.unwrap_or(0.0);
        }
        let scalars = Scalars(Cell::from_mut(values.as_mut_slice()).as_slice_of_cells());
        for pass in &plan.passes {
            work(pass, &scalars);
        }
        for (guard, (checked, slot)) in program.guards.iter().zip(&plan.guards).enumerate() {
            let value = values[*slot as usize];
            if !checked.condition.holds(value) {
                return Err(Failed {
                    sample: 0,
                    guard,
                    value,
                });
            }
        }
        for number in &plan.outputs {
            if let Some(place) = output.get_mut(number.index) {
                *place = values[number.slot as usize] * number.sign;
            }
        }
        Ok(())
    }
}

/// The values of a sample. Cells, because a result may overwrite its operands.
struct Scalars<'a>(&'a [Cell<f64>]);

impl Scalars<'_> {
    #[inline(always)]
    fn get(&self, slot: Slot) -> f64 {
        self.0[slot as usize].get()
    }

    #[inline(always)]
    fn set(&self, slot: Slot, value: f64) {
        self.0[slot as usize].set(value);
    }
}

impl Worker for Scalars<'_> {
    #[inline(always)]
    fn each<const N: usize>(&self, at: &Pass, f: impl Fn([f64; N]) -> f64) {
        let mut operands = [0.0; N];
        for (operand, slot) in operands.iter_mut().zip(at.operands) {
            *operand = self.get(slot);
        }
        self.set(at.results[0], f(operands));
    }

    #[inline(always)]
    fn two(&self, at: &Pass, f: impl Fn(f64, f64) -> f64) {
        let [a, b, c, _] = at.operands.map(|slot| self.get(slot));
        self.set(at.results[0], f(a, b));
        self.set(at.results[1], f(a, c));
    }

    #[inline(always)]
    fn three(&self, at: &Pass, f: impl Fn(f64, f64) -> f64) {
        let [a, b, c, d] = at.operands.map(|slot| self.get(slot));
        self.set(at.results[0], f(a, b));
        self.set(at.results[1], f(a, c));
        self.set(at.results[2], f(a, d));
    }

    #[inline(always)]
    fn angles(&self, at: &Pass) {
        let (sine, cosine) = self.get(at.operands[0]).sin_cos();
        self.set(at.results[0], sine);
        self.set(at.results[1], cosine);
    }

    #[inline(always)]
    fn directions(&self, at: &Pass) {
        self.each(at, |[y, x]| y.atan2(x));
    }
}

/// Evaluates a program at a single sample, once.
pub(super) fn evaluate(
    program: &Program,
    inputs: &[Rows<'_>],
    output: &mut [f64],
) -> Result<(), Failed> {
    let mut steps: Vec<f64> = Vec::with_capacity(program.steps.len());
    for step in &program.steps {
        let value = |operand: Operand| fetch(operand, inputs, &steps);
        let result = match step.operation {
            Operation::Add(a, b) => value(a) + value(b),
            Operation::Sub(a, b) => value(a) - value(b),
            Operation::Mul(a, b) => value(a) * value(b),
            Operation::Div(a, b) => value(a) / value(b),
            Operation::Neg(a) => -value(a),
            Operation::Sqrt(a) => value(a).sqrt(),
            Operation::Sine(a) => value(a).sin(),
            Operation::Cosine(a) => value(a).cos(),
            Operation::Sign(a) => signed(1.0, value(a)),
            Operation::Signed(a, b) => signed(value(a), value(b)),
            Operation::Atan2(y, x) => value(y).atan2(value(x)),
        };
        steps.push(result);
    }
    for (guard, checked) in program.guards.iter().enumerate() {
        let value = fetch(checked.operand, inputs, &steps);
        if !checked.condition.holds(value) {
            return Err(Failed {
                sample: 0,
                guard,
                value,
            });
        }
    }
    for (slot, entry) in output.iter_mut().zip(&program.entries) {
        let value = fetch(entry.operand, inputs, &steps);
        *slot = if entry.negative { -value } else { value };
    }
    Ok(())
}

#[inline]
fn fetch(operand: Operand, inputs: &[Rows<'_>], steps: &[f64]) -> f64 {
    match operand {
        Operand::Constant(value) => value,
        Operand::Step(at) => steps[at],
        Operand::Input { array, index } => {
            let values = inputs
                .get(array)
                .map(|rows| rows.values)
                .unwrap_or_default();
            values.get(index).copied().unwrap_or(0.0)
        }
    }
}
