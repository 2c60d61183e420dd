//! Angles that depend on inputs alone: their sines and cosines are evaluated together, to fill
//! vector registers.

use crate::lowering::{Operand, Operation, Program};

/// Sine and cosine of one angle, as steps of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The angle.
    pub angle: Operand,
    /// The step of its sine, if the program has one.
    pub sine: Option<usize>,
    /// The step of its cosine, if the program has one.
    pub cosine: Option<usize>,
}

/// Angles whose sines and cosines can be evaluated first, and the steps that compute the angles.
#[derive(Debug, Default)]
pub struct Early {
    /// Steps of the angles, in the program's order.
    pub steps: Vec<usize>,
    /// The angles, in the order of first use; empty if there are fewer than two.
    pub pairs: Vec<Pair>,
}

/// Finds the angles that depend on inputs by sums, differences and products alone.
#[must_use]
pub fn early(program: &Program) -> Early {
    // Whether a step is a sum, difference or product of inputs and constants.
    let mut simple = vec![false; program.steps.len()];
    for at in 0..program.steps.len() {
        let operation = program.steps[at].operation;
        simple[at] =
            is_arithmetic(operation) && operation.operands().iter().all(|&o| is_known(o, &simple));
    }
    let mut pairs: Vec<Pair> = Vec::new();
    for (at, step) in program.steps.iter().enumerate() {
        let (angle, is_sine) = match step.operation {
            Operation::Sine(angle) => (angle, true),
            Operation::Cosine(angle) => (angle, false),
            _ => continue,
        };
        if !is_known(angle, &simple) {
            continue;
        }
        let known = pairs.iter().position(|p| p.angle == angle);
        let index = known.unwrap_or_else(|| {
            pairs.push(Pair {
                angle,
                sine: None,
                cosine: None,
            });
            pairs.len() - 1
        });
        let place = if is_sine {
            &mut pairs[index].sine
        } else {
            &mut pairs[index].cosine
        };
        place.get_or_insert(at);
    }
    if pairs.len() < 2 {
        return Early::default();
    }
    let mut wanted = vec![false; program.steps.len()];
    let mut open: Vec<Operand> = pairs.iter().map(|p| p.angle).collect();
    while let Some(operand) = open.pop() {
        if let Operand::Step(at) = operand
            && !std::mem::replace(&mut wanted[at], true)
        {
            open.extend(program.steps[at].operation.operands());
        }
    }
    let steps = (0..wanted.len()).filter(|&at| wanted[at]).collect();
    Early { steps, pairs }
}

const fn is_arithmetic(operation: Operation) -> bool {
    matches!(
        operation,
        Operation::Add(..) | Operation::Sub(..) | Operation::Mul(..) | Operation::Neg(_)
    )
}

fn is_known(operand: Operand, simple: &[bool]) -> bool {
    match operand {
        Operand::Constant(_) | Operand::Input { .. } => true,
        Operand::Step(at) => simple[at],
    }
}
