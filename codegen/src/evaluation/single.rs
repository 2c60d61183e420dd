//! One sample at a time: the same steps on scalars, for iterations and simulations whose next sample
//! depends on the last.

use super::{Failed, Rows, signed};
use crate::lowering::{Operand, Operation, Program};

/// Evaluates a program at a single sample.
pub(super) fn evaluate(
    program: &Program,
    inputs: &[Rows<'_>],
    output: &mut [f64],
    steps: &mut Vec<f64>,
) -> Result<(), Failed> {
    steps.clear();
    for step in &program.steps {
        let value = |operand: Operand| fetch(operand, inputs, steps);
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
        let value = fetch(checked.operand, inputs, steps);
        if !checked.condition.holds(value) {
            return Err(Failed {
                sample: 0,
                guard,
                value,
            });
        }
    }
    for (slot, entry) in output.iter_mut().zip(&program.entries) {
        let value = fetch(entry.operand, inputs, steps);
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
