//! Values that depend on the constants of a leg alone are not steps of a program in lanes.

use crate::lowering::simd::fold;
use crate::lowering::{Array, Entry, Operand, Operation, Program, Step};

const STATE: usize = 0;
const OF_LEG: usize = 1;

fn input(array: usize, index: usize) -> Operand {
    Operand::Input { array, index }
}

fn program(operations: &[Operation], entries: &[Operand]) -> Program {
    let array = |name: &str, length: usize| Array {
        name: name.to_owned(),
        shape: vec![length],
    };
    let step = |&operation: &Operation| Step {
        operation,
        name: None,
        scope: String::new(),
    };
    Program {
        least_torques: Vec::new(),
        inputs: vec![array("state", 1), array("of_leg", 2)],
        output: array("output", entries.len()),
        entries: entries.iter().map(|&o| Entry::positive(o)).collect(),
        steps: operations.iter().map(step).collect(),
        guards: Vec::new(),
        pieces: 0,
    }
}

#[test]
fn leg_constants_are_folded() {
    let before = program(
        &[
            Operation::Mul(input(OF_LEG, 0), input(OF_LEG, 1)),
            Operation::Sqrt(Operand::Step(0)),
            Operation::Mul(input(STATE, 0), Operand::Step(1)),
            Operation::Add(Operand::Step(2), input(OF_LEG, 1)),
        ],
        &[Operand::Step(3), Operand::Step(1)],
    );
    let folded = fold(&before, OF_LEG);
    assert_eq!(folded.elements, [Operand::Step(1), input(OF_LEG, 1)]);
    let after = program(
        &[
            Operation::Mul(input(STATE, 0), input(OF_LEG, 0)),
            Operation::Add(Operand::Step(0), input(OF_LEG, 1)),
        ],
        &[Operand::Step(1), input(OF_LEG, 0)],
    );
    assert_eq!(folded.program, after);
}

#[test]
fn unused_constants_are_removed() {
    let before = program(
        &[
            Operation::Neg(input(OF_LEG, 0)),
            Operation::Mul(input(STATE, 0), input(STATE, 0)),
        ],
        &[Operand::Step(1)],
    );
    let folded = fold(&before, OF_LEG);
    assert!(folded.elements.is_empty());
    assert_eq!(folded.program.inputs[OF_LEG].len(), 0);
    assert_eq!(folded.program.steps.len(), 1);
}
