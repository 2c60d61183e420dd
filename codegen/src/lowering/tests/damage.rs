//! Damaged graphs and programs are rejected.

use super::build::{Built, Start, build};
use super::random::function;
use crate::cas::Stream;
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Definition, Edge};
use crate::lowering::passes;
use crate::lowering::program::{Condition, Entry, Guard, Operand, Operation, Program, Step};
use crate::lowering::schedule::schedule;

fn program(seed: u64) -> Program {
    let Built {
        mut dag,
        inputs,
        output,
        ..
    } = build(&function(seed), Start::Arena);
    passes::run(&mut dag, &SearchLimits::NONE).expect("sound passes");
    schedule(&dag, &inputs, &output).expect("a program")
}

/// Damages a program at a step.
type Damage = fn(&mut Program, usize);

/// Ways to damage a program.
const DAMAGES: [(&str, Damage); 12] = [
    ("a step uses itself", |p, at| {
        p.steps[at].operation = Operation::Neg(Operand::Step(at))
    }),
    ("a step uses a later one", |p, at| {
        let last = p.steps.len();
        p.steps[at].operation = Operation::Sqrt(Operand::Step(last));
    }),
    ("a constant is no number", |p, at| {
        p.steps[at].operation = Operation::Add(Operand::Constant(f64::NAN), Operand::Constant(1.0));
    }),
    ("a constant is infinite", |p, _| {
        p.entries[0] = Entry::positive(Operand::Constant(f64::INFINITY))
    }),
    ("an input array is missing", |p, at| {
        p.steps[at].operation = Operation::Neg(Operand::Input {
            array: 99,
            index: 0,
        });
    }),
    ("an element is beyond its array", |p, at| {
        p.steps[at].operation = Operation::Neg(Operand::Input { array: 0, index: 1 });
    }),
    ("an entry is missing", |p, _| {
        p.entries.truncate(p.entries.len() - 1)
    }),
    ("an entry refers to no node", |p, _| {
        p.entries[0].operand = Operand::Step(p.steps.len());
    }),
    ("a guard refers to no node", |p, _| {
        let condition = Condition::Reach {
            leg: String::new(),
            home: 0.0,
        };
        let operand = Operand::Step(p.steps.len());
        p.guards.push(Guard { operand, condition });
    }),
    ("a guard compares with no number", |p, _| {
        let condition = Condition::Leg {
            leg: String::new(),
            home: f64::NAN,
        };
        p.guards.push(Guard {
            operand: Operand::Step(0),
            condition,
        });
    }),
    ("a step is for nothing", |p, _| {
        let operation = Operation::Neg(Operand::Input { array: 0, index: 0 });
        p.steps.push(Step {
            operation,
            name: None,
            scope: String::new(),
        });
    }),
    ("two inputs have one name", |p, _| {
        p.inputs[1].name = p.inputs[0].name.clone()
    }),
];

#[test]
fn damaged_programs_fail_verification() {
    for seed in 0..20 {
        let sound = program(seed);
        assert_eq!(sound.verify(), Ok(()));
        let mut stream = Stream::new(seed);
        for (what, damage) in DAMAGES {
            let mut damaged = sound.clone();
            damage(&mut damaged, stream.below(sound.steps.len()));
            assert!(damaged.verify().is_err(), "function {seed}: {what}");
        }
    }
}

#[test]
fn damaged_graphs_fail_verification() {
    let mut damages = 0;
    for seed in 0..20 {
        let Built { dag: sound, .. } = build(&function(seed), Start::Arena);
        for node in (0..sound.len()).filter(|&node| sound.is_open(node)) {
            // A wrong sign, and a replaced operand.
            let mut is_first = true;
            let wrong_sign = sound
                .definition(node)
                .with_edges(|edge| edge.times(std::mem::replace(&mut is_first, false)));
            let wrong_operand = sound.definition(node).with_edges(|_| Edge::to(0));
            let wrong = [wrong_sign, wrong_operand, Definition::Root(Edge::to(node))];
            for definition in wrong.into_iter().filter(|&d| d != sound.definition(node)) {
                let mut damaged = sound.clone();
                damaged.redefine(node, definition);
                if !definition.operands().any(|operand| operand == node) {
                    damaged.measure_depths();
                }
                assert!(
                    damaged.verify().is_err(),
                    "function {seed}: {definition:?} for node {node}"
                );
                damages += 1;
            }
        }
    }
    assert!(damages > 500, "{damages} damages");
}
