//! Small improvements of a finished program: selections for products with a sign, quotients for
//! products with a reciprocal that is used once, and no step that nothing needs.

use super::program::{Entry, Guard, Operand, Operation, Program, Step};

/// Improves a program without changing what it computes.
#[must_use]
pub fn improve(mut program: Program) -> Program {
    select_signs(&mut program);
    merge_reciprocals(&mut program);
    remove_unused(program)
}

/// How often each step is used by steps, entries and guards.
#[must_use]
pub fn uses(program: &Program) -> Vec<usize> {
    let mut uses = vec![0; program.steps.len()];
    let mut count = |operand: Operand| {
        if let Operand::Step(at) = operand {
            uses[at] += 1;
        }
    };
    program
        .steps
        .iter()
        .flat_map(|s| s.operation.operands())
        .for_each(&mut count);
    program.entries.iter().for_each(|e| count(e.operand));
    program.guards.iter().for_each(|g| count(g.operand));
    uses
}

/// x × sign(y) is x with the sign of y: a selection, not a multiplication.
fn select_signs(program: &mut Program) {
    let signs: Vec<Option<Operand>> = program
        .steps
        .iter()
        .map(|s| match s.operation {
            Operation::Sign(of) => Some(of),
            _ => None,
        })
        .collect();
    let sign_of = |operand: Operand| match operand {
        Operand::Step(at) => signs[at],
        _ => None,
    };
    for step in &mut program.steps {
        if let Operation::Mul(a, b) = step.operation {
            if let Some(of) = sign_of(a) {
                step.operation = Operation::Signed(b, of);
            } else if let Some(of) = sign_of(b) {
                step.operation = Operation::Signed(a, of);
            }
        }
    }
}

/// x × (1 / y) is x / y where nothing else needs the reciprocal.
fn merge_reciprocals(program: &mut Program) {
    let uses = uses(program);
    let reciprocals: Vec<Option<Operand>> = program
        .steps
        .iter()
        .zip(&uses)
        .map(|(s, uses)| match s.operation {
            Operation::Div(Operand::Constant(one), of) if one == 1.0 && *uses == 1 => Some(of),
            _ => None,
        })
        .collect();
    let reciprocal_of = |operand: Operand| match operand {
        Operand::Step(at) => reciprocals[at],
        _ => None,
    };
    for step in &mut program.steps {
        if let Operation::Mul(a, b) = step.operation {
            if let Some(of) = reciprocal_of(a) {
                step.operation = Operation::Div(b, of);
            } else if let Some(of) = reciprocal_of(b) {
                step.operation = Operation::Div(a, of);
            }
        }
    }
}

/// Drops steps that no entry and no guard needs, and renumbers the rest.
fn remove_unused(program: Program) -> Program {
    let mut needed = vec![false; program.steps.len()];
    let mark = |needed: &mut Vec<bool>, operand: Operand| {
        if let Operand::Step(at) = operand {
            needed[at] = true;
        }
    };
    program
        .entries
        .iter()
        .for_each(|e| mark(&mut needed, e.operand));
    program
        .guards
        .iter()
        .for_each(|g| mark(&mut needed, g.operand));
    for at in (0..program.steps.len()).rev() {
        if needed[at] {
            for operand in program.steps[at].operation.operands() {
                mark(&mut needed, operand);
            }
        }
    }
    let mut number = vec![0; program.steps.len()];
    let mut next = 0;
    for (at, needed) in needed.iter().enumerate() {
        number[at] = next;
        next += usize::from(*needed);
    }
    let moved = |operand: Operand| match operand {
        Operand::Step(at) => Operand::Step(number[at]),
        other => other,
    };
    let steps = program
        .steps
        .into_iter()
        .zip(&needed)
        .filter(|(_, n)| **n)
        .map(|(step, _)| Step {
            operation: map_operands(step.operation, &moved),
            ..step
        });
    Program {
        steps: steps.collect(),
        entries: program
            .entries
            .iter()
            .map(|e| Entry {
                operand: moved(e.operand),
                ..*e
            })
            .collect(),
        guards: program
            .guards
            .into_iter()
            .map(|g| Guard {
                operand: moved(g.operand),
                ..g
            })
            .collect(),
        inputs: program.inputs,
        output: program.output,
    }
}

/// The operation with its operands replaced.
#[must_use]
pub fn map_operands(operation: Operation, f: &dyn Fn(Operand) -> Operand) -> Operation {
    match operation {
        Operation::Add(a, b) => Operation::Add(f(a), f(b)),
        Operation::Sub(a, b) => Operation::Sub(f(a), f(b)),
        Operation::Mul(a, b) => Operation::Mul(f(a), f(b)),
        Operation::Div(a, b) => Operation::Div(f(a), f(b)),
        Operation::Signed(a, b) => Operation::Signed(f(a), f(b)),
        Operation::Atan2(a, b) => Operation::Atan2(f(a), f(b)),
        Operation::Neg(a) => Operation::Neg(f(a)),
        Operation::Sqrt(a) => Operation::Sqrt(f(a)),
        Operation::Sine(a) => Operation::Sine(f(a)),
        Operation::Cosine(a) => Operation::Cosine(f(a)),
        Operation::Sign(a) => Operation::Sign(f(a)),
    }
}
