use super::Magnitudes;
use crate::float::Float;
use crate::lowering::{Array, Condition, Entry, Guard, Operand, Operation, Program, Step};

fn program(operations: &[Operation], guards: Vec<Guard>) -> Program {
    let array = |name: &str, length: usize| Array {
        name: name.to_owned(),
        shape: vec![length],
    };
    let step = |operation: &Operation| Step {
        operation: *operation,
        name: None,
        scope: String::new(),
    };
    Program {
        least_torques: Vec::new(),
        inputs: vec![array("pose", 2)],
        output: array("result", 1),
        entries: vec![Entry::positive(Operand::Step(operations.len() - 1))],
        steps: operations.iter().map(step).collect(),
        guards,
        pieces: 0,
    }
}

/// Steps with a size guard in a program with inputs up to 1000.
fn guarded(float: Float, mut program: Program) -> Vec<Operand> {
    Magnitudes::new(float).guard(&mut program, &|_, _| 1e3_f64.log2(), f64::INFINITY);
    let own = program.guards.iter();
    own.filter(|guard| matches!(guard.condition, Condition::Size { .. }))
        .map(|guard| guard.operand)
        .collect()
}

const X: Operand = Operand::Input { array: 0, index: 0 };
const Y: Operand = Operand::Input { array: 0, index: 1 };

fn squares(count: usize) -> Vec<Operation> {
    let first = [Operation::Mul(X, Y)].into_iter();
    let squared = |at| Operation::Mul(Operand::Step(at), Operand::Step(at));
    first.chain((0..count - 1).map(squared)).collect()
}

#[test]
fn a_value_that_may_overflow_is_guarded_once() {
    // 1e6, 1e12, 1e24, 1e48, 1e96, 1e192, 1e384
    assert_eq!(guarded(Float::F64, program(&squares(6), Vec::new())), []);
    let found = guarded(Float::F64, program(&squares(7), Vec::new()));
    assert_eq!(found, [Operand::Step(6)]);
    // 1e48 would overflow, and so would its dependents.
    let found = guarded(Float::F32, program(&squares(5), Vec::new()));
    assert_eq!(found, [Operand::Step(4)]);
}

#[test]
fn a_divisor_that_may_be_infinite_is_guarded() {
    let mut operations = squares(7);
    operations.push(Operation::Div(X, Operand::Step(6)));
    operations.push(Operation::Atan2(Operand::Step(7), Y));
    let leg = Guard {
        operand: Operand::Step(6),
        condition: Condition::Leg {
            leg: String::new(),
            home: 1.0,
        },
    };
    let found = guarded(Float::F64, program(&operations, vec![leg]));
    assert_eq!(found, [Operand::Step(6)]);
}

#[test]
fn a_guard_bounds_a_divisor_from_below() {
    let operations = [Operation::Sub(X, Y), Operation::Div(X, Operand::Step(0))];
    let guard = |condition| Guard {
        operand: Operand::Step(0),
        condition,
    };
    let leg = Condition::Leg {
        leg: String::new(),
        home: 1.0,
    };
    assert_eq!(
        guarded(Float::F64, program(&operations, vec![guard(leg)])),
        []
    );
    let found = guarded(
        Float::F64,
        program(&operations, vec![guard(Condition::Mass)]),
    );
    assert_eq!(found, [Operand::Step(1)]);
}

#[test]
fn matrix_entries_are_bounded_as_requested() {
    let mut product = program(&[Operation::Mul(X, Y)], Vec::new());
    let bounds = Magnitudes::new(Float::F64).guard(&mut product, &|_, _| 10.0, 1e4);
    assert_eq!(bounds, [1e4_f64.log2()]);
    let most = Condition::Size { most: 1e4 };
    assert_eq!(product.guards[0].condition, most);
}
