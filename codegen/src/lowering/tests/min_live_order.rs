//! Tests of the order with few live values.

use crate::lowering::program::{Array, Condition, Entry, Guard, Operand, Operation, Program, Step};
use crate::lowering::schedule_min_live;

/// Element of the only input.
fn input(index: usize) -> Operand {
    Operand::Input { array: 0, index }
}

/// A program of one input, a matrix and these steps.
fn program(shape: [usize; 2], steps: &[Operation], entries: &[usize]) -> Program {
    let array = |name: &str, shape: &[usize]| Array {
        name: name.to_owned(),
        shape: shape.to_vec(),
    };
    let steps = steps.iter().map(|&operation| Step {
        operation,
        name: None,
        scope: String::new(),
    });
    let entries = entries.iter().map(|&at| Entry::positive(Operand::Step(at)));
    Program {
        least_torques: Vec::new(),
        inputs: vec![array("x", &[4])],
        output: array("output", &shape),
        entries: entries.collect(),
        steps: steps.collect(),
        guards: Vec::new(),
        pieces: 0,
    }
}

/// Largest number of live values if results are written at once.
fn most_live_values(program: &Program) -> usize {
    let last = |at: usize| {
        let uses = program.steps.iter().enumerate().skip(at + 1);
        let mut uses =
            uses.filter(|(_, step)| step.operation.operands().contains(&Operand::Step(at)));
        uses.next_back().map(|(user, _)| user)
    };
    let last: Vec<Option<usize>> = (0..program.steps.len()).map(last).collect();
    let behind = |now: usize| {
        let last = last[..=now].iter();
        last.filter(|last| last.is_some_and(|last| last > now))
            .count()
    };
    (0..last.len()).map(behind).max().unwrap_or(0)
}

#[test]
fn operations_that_share_a_value_are_adjacent() {
    let step = Operand::Step;
    // Two values with two results each, which the columns have in the opposite order.
    let steps = [
        Operation::Mul(input(0), input(1)),
        Operation::Mul(step(0), input(2)),
        Operation::Mul(input(2), input(3)),
        Operation::Mul(step(2), input(1)),
        Operation::Mul(step(0), input(3)),
        Operation::Mul(step(2), input(0)),
    ];
    let before = program([1, 4], &steps, &[1, 3, 4, 5]);
    let after = schedule_min_live(&before);
    assert_eq!(
        [most_live_values(&before), most_live_values(&after)],
        [2, 1]
    );
    assert_eq!(after.verify(), Ok(()));
    let order = [steps[0], steps[1], Operation::Mul(step(0), input(3))];
    let found: Vec<Operation> = after.steps[..3].iter().map(|s| s.operation).collect();
    assert_eq!(found, order);
}

#[test]
fn sine_and_cosine_stay_adjacent() {
    let step = Operand::Step;
    let steps = [
        Operation::Add(input(0), input(1)),
        Operation::Cosine(step(0)),
        Operation::Sine(step(0)),
        Operation::Mul(step(1), input(2)),
        Operation::Mul(step(3), step(3)),
        Operation::Mul(step(2), input(3)),
    ];
    let after = schedule_min_live(&program([1, 2], &steps, &[4, 5]));
    let at = |wanted: Operation| after.steps.iter().position(|s| s.operation == wanted);
    let cosine = at(Operation::Cosine(step(0))).expect("a cosine");
    assert_eq!(at(Operation::Sine(step(0))), Some(cosine + 1));
    assert_eq!(after.verify(), Ok(()));
}

#[test]
fn guarded_values_are_computed_first() {
    let step = Operand::Step;
    let steps = [
        Operation::Mul(input(0), input(1)),
        Operation::Mul(input(2), input(3)),
        Operation::Div(input(0), step(1)),
    ];
    let mut before = program([1, 2], &steps, &[0, 2]);
    before.guards.push(Guard {
        operand: step(1),
        condition: Condition::Mass,
    });
    let after = schedule_min_live(&before);
    assert_eq!(after.steps[0].operation, steps[1]);
    assert_eq!(after.guards[0].operand, step(0));
    assert_eq!(after.verify(), Ok(()));
}

#[test]
fn constant_and_repeated_entries_keep_their_places() {
    let steps = [Operation::Mul(input(0), input(1))];
    let mut before = program([2, 2], &steps, &[0, 0, 0, 0]);
    before.entries[1] = Entry::positive(Operand::Constant(0.0));
    before.entries[2] = Entry::positive(input(3)).times(true);
    assert_eq!(schedule_min_live(&before), before);
}

#[test]
fn large_programs_are_scheduled_without_comparing_results() {
    // The first two results share a value; the third needs no step and would come first.
    for (links, is_compared) in [(3, true), (32_000, false)] {
        let link = |at: usize| match at {
            0 => Operation::Mul(input(0), input(1)),
            _ => Operation::Mul(Operand::Step(at - 1), input(2)),
        };
        let mut steps: Vec<Operation> = (0..links).map(link).collect();
        steps.push(Operation::Mul(Operand::Step(0), input(3)));
        steps.push(Operation::Mul(input(1), input(3)));
        let before = program([1, 3], &steps, &[links - 1, links, links + 1]);
        let after = schedule_min_live(&before);
        assert_eq!(after.verify(), Ok(()));
        let alone = after.steps[0].operation == steps[links + 1];
        assert_eq!(alone, is_compared, "{links} links");
    }
}
