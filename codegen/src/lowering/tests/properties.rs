//! Invariants of every pass on random functions: values of all outputs, invariants of the graph,
//! divisors, and no higher cost.

use super::build::{Built, Start, build};
use super::random::function;
use crate::cas::Stream;
use crate::cas::calculus::angle_of;
use crate::cas::field::canonical;
use crate::lowering::SearchLimits;
use crate::lowering::dag::digits::evaluate;
use crate::lowering::dag::{Angle, Dag, Definition, Edge};
use crate::lowering::passes::{PARTS, PASSES};
use crate::lowering::program::{Operand, Operation, Program};
use crate::lowering::schedule::schedule;
use crate::lowering::schedule_min_live;
use std::collections::BTreeSet;

const FUNCTIONS: u64 = 60;

fn built(seed: u64) -> Built {
    let start = if seed.is_multiple_of(3) {
        Start::Nodes
    } else {
        Start::Arena
    };
    let mut built = build(&function(seed), start);
    built.measure();
    built
}

/// The values of a DAG's symbols at a random point.
fn point(dag: &Dag, seed: u64) -> Vec<f64> {
    let mut stream = Stream::new(seed);
    let context = dag.context();
    context
        .symbols
        .iter()
        .map(|_| 1.5 + stream.number())
        .collect()
}

/// The outputs of a DAG, node by node.
fn outputs(dag: &Dag, symbols: &[f64]) -> Vec<f64> {
    let context = dag.context();
    let angle = |turn: u32| {
        let direction = &context.turns[turn as usize].direction;
        angle_of(direction, &|symbol| symbols[symbol.number()])
    };
    let mut values = vec![f64::NAN; dag.len()];
    for node in dag.operands_first() {
        values[node] = match dag.definition(node) {
            Definition::Constant(constant) => constant.value(),
            Definition::Symbol(symbol) => symbols[symbol as usize],
            Definition::Cosine(Angle::Unplanned(turn)) => angle(turn).cos(),
            Definition::Sine(Angle::Unplanned(turn)) => angle(turn).sin(),
            definition => evaluate(definition, &values),
        };
    }
    let of = |edge: &Edge| {
        if edge.is_negative() {
            -values[edge.node()]
        } else {
            values[edge.node()]
        }
    };
    dag.entries().iter().map(of).collect()
}

fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (at, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs();
        assert!(
            error <= 1e-9 * (1.0 + expected.abs()),
            "{what}: output {at} is {found}, not {expected}"
        );
    }
}

/// Outputs of a program by the meaning of its operations; backends are in a higher layer than this
/// folder.
fn results(program: &Program, input: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    let fetch = |operand: Operand, values: &[f64]| match operand {
        Operand::Constant(value) => value,
        Operand::Input { array, .. } => input(array),
        Operand::Step(at) => values[at],
    };
    for step in &program.steps {
        let of = |operand| fetch(operand, &values);
        let value = match step.operation {
            Operation::Add(a, b) => of(a) + of(b),
            Operation::Sub(a, b) => of(a) - of(b),
            Operation::Mul(a, b) => of(a) * of(b),
            Operation::Div(a, b) => of(a) / of(b),
            Operation::Neg(a) => -of(a),
            Operation::Sqrt(a) => of(a).sqrt(),
            Operation::Sine(a) => of(a).sin(),
            Operation::Cosine(a) => of(a).cos(),
            Operation::Sign(a) => of(a).signum(),
            Operation::Signed(a, b) => of(a) * of(b).signum(),
            Operation::Atan2(y, x) => of(y).atan2(of(x)),
        };
        values.push(value);
    }
    let entries = program.entries.iter();
    let signed = |negative: bool, value: f64| if negative { -value } else { value };
    entries
        .map(|entry| signed(entry.negative, fetch(entry.operand, &values)))
        .collect()
}

/// The divisors of a DAG, regardless of sign.
fn divisors(dag: &Dag) -> BTreeSet<crate::cas::field::Element> {
    let value = |node: usize| canonical([dag.value(Edge::to(node))]).0[0];
    dag.divisors().into_iter().map(value).collect()
}

#[test]
fn passes_keep_outputs_and_divisors_and_never_add_cost() {
    for seed in 0..FUNCTIONS {
        let Built { mut dag, .. } = built(seed);
        let symbols = point(&dag, seed);
        let expected = outputs(&dag, &symbols);
        let limits = if seed.is_multiple_of(2) {
            SearchLimits::QUICK
        } else {
            SearchLimits::THOROUGH
        };
        for pass in PARTS.into_iter().chain(PASSES) {
            let what = format!("function {seed} after `{}`", pass.name);
            let (cost, divided) = (dag.total(), divisors(&dag));
            (pass.run)(&mut dag, &limits);
            dag.verify()
                .unwrap_or_else(|broken| panic!("{what}: {broken}"));
            assert_close(&outputs(&dag, &symbols), &expected, &what);
            assert!(divisors(&dag).is_subset(&divided), "{what}: a new divisor");
            // Angles, repairs and conditions may add operations, for evaluation, for accuracy, and
            // for errors that name the right leg.
            if !["angles", "repair", "conditions"].contains(&pass.name) {
                assert!(dag.total() <= cost, "{what}: {} after {cost}", dag.total());
            }
        }
    }
}

/// Large functions are searched in pieces; with small limits, small ones are, too.
#[test]
fn search_in_pieces_saves_operations_and_keeps_outputs() {
    let limits = SearchLimits {
        piece_nodes: 12,
        whole_nodes: 0,
        ..SearchLimits::QUICK
    };
    let (mut single, mut with_pieces, mut split) = (0, 0, 0);
    for seed in 0..FUNCTIONS {
        let Built { mut dag, .. } = built(seed);
        let symbols = point(&dag, seed);
        let expected = outputs(&dag, &symbols);
        let mut other = built(seed).dag;
        let run = |dag: &mut Dag, limits: &SearchLimits| {
            crate::lowering::passes::run(dag, limits).expect("sound passes");
        };
        run(&mut dag, &limits);
        run(&mut other, &SearchLimits::SINGLE_REPLACEMENTS);
        assert_close(
            &outputs(&dag, &symbols),
            &expected,
            &format!("function {seed}"),
        );
        single += other.total();
        with_pieces += dag.total();
        split += usize::from(dag.pieces() > 1);
        assert_eq!(other.pieces(), 0);
    }
    assert!(split > 10, "{split} functions are split");
    assert!(with_pieces < single, "{with_pieces} after {single}");
}

#[test]
fn programs_compute_the_values_of_their_expressions() {
    for seed in 0..FUNCTIONS {
        let Built {
            mut dag,
            inputs,
            output,
            ..
        } = built(seed);
        let symbols = point(&dag, seed);
        let expected = outputs(&dag, &symbols);
        let elements: Vec<_> = dag.context().symbols.iter().map(|s| s.element).collect();
        crate::lowering::passes::run(&mut dag, &SearchLimits::QUICK).expect("sound passes");
        let program = schedule(&dag, &inputs, &output).expect("a program");
        program
            .verify()
            .unwrap_or_else(|broken| panic!("function {seed}: {broken}"));
        let input = |array: usize| {
            let name = &inputs[array].name;
            let at = elements
                .iter()
                .position(|e| e.is_some_and(|e| e.array == name));
            at.map_or(f64::NAN, |at| symbols[at])
        };
        let found = results(&program, &input);
        assert_close(&found, &expected, &format!("function {seed}"));
        let ordered = schedule_min_live(&program);
        ordered
            .verify()
            .unwrap_or_else(|broken| panic!("function {seed}, in order: {broken}"));
        let again = results(&ordered, &input);
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again), bits(&found), "function {seed}, in order");
    }
}
