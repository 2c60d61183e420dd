//! Blocks against single samples, on a program of every operation in every fused form.

use super::{BLOCK, Rows, Workspace};
use crate::lowering::{Array, Condition, Entry, Guard, Operation, Program, Source, Step};

fn array(name: &str, len: usize) -> Array {
    Array {
        name: name.to_owned(),
        shape: vec![len],
    }
}

const fn input(array: usize, index: usize) -> Source {
    Source::Input { array, index }
}

/// A program of two inputs, the second shared, whose outputs hold every kind of number.
fn program() -> Program {
    use Operation::{Add, Atan2, Cosine, Div, Mul, Neg, Sign, Signed, Sine, Sqrt, Sub};
    let at = Source::Step;
    let (x, y, p) = (input(0, 0), input(0, 1), input(1, 0));
    let mut operations = vec![
        Sine(x),
        Cosine(x),
        Cosine(y),
        Neg(at(0)),
        Sqrt(Source::Constant(2.0)),
        Sign(y),
        Signed(x, y),
        Atan2(y, x),
        Div(p, at(1)),
        Mul(at(0), at(0)),
        Signed(p, y),
        Signed(at(0), y),
    ];
    let mut outputs: Vec<usize> = (1..operations.len()).collect();
    // Every pair of fused operations, on either side and on both.
    let two = |kind: usize, a: Source, b: Source| [Add(a, b), Sub(a, b), Mul(a, b)][kind];
    for (first, middle) in (0..9).map(|k| (k / 3, k % 3)) {
        let inner = operations.len();
        operations.push(two(first, at(0), x));
        operations.push(two(middle, at(inner), p));
        operations.push(two(first, at(1), y));
        operations.push(two(middle, p, at(inner + 2)));
        outputs.extend([inner + 1, inner + 3]);
        for last in 0..3 {
            let inner = operations.len();
            operations.push(two(first, at(0), y));
            operations.push(two(last, x, Source::Constant(0.75)));
            operations.push(two(middle, at(inner), at(inner + 1)));
            outputs.push(inner + 2);
        }
    }
    let sources = outputs.iter().map(|&o| at(o));
    let plain = sources.chain([x, p, Source::Constant(3.0), Source::Constant(0.0)]);
    let entries: Vec<Entry> = plain
        .enumerate()
        .map(|(k, source)| Entry {
            source,
            negative: k % 3 == 1,
        })
        .collect();
    Program {
        inputs: vec![array("state", 2), array("parameters", 1)],
        output: array("all", entries.len()),
        entries,
        steps: operations
            .into_iter()
            .map(|operation| Step {
                operation,
                name: None,
                scope: String::new(),
            })
            .collect(),
        guards: vec![Guard {
            source: at(1),
            condition: Condition::Leg {
                leg: "leg".to_owned(),
                home: 1.0,
            },
        }],
    }
}

fn states(samples: usize) -> Vec<f64> {
    let state = |k: usize| [0.3 + 0.1 * k as f64, 1.0 - 0.07 * k as f64];
    (0..samples).flat_map(state).collect()
}

fn rows(values: &[f64], shared: bool) -> Rows<'_> {
    Rows { values, shared }
}

#[test]
fn blocks_give_what_single_samples_give() {
    let program = program();
    let width = program.entries.len();
    let mut workspace = Workspace::default();
    for samples in [2, 3, BLOCK, BLOCK + 1, 3 * BLOCK + 7] {
        let states = states(samples);
        let inputs = [rows(&states, false), rows(&[1.7], true)];
        let mut together = vec![f64::NAN; samples * width];
        let done = program.evaluate(samples, &inputs, &mut together, &mut workspace);
        assert_eq!(done, Ok(()));
        for (state, found) in states.chunks(2).zip(together.chunks(width)) {
            let inputs = [rows(state, false), rows(&[1.7], true)];
            let mut alone = vec![f64::NAN; width];
            let done = program.evaluate(1, &inputs, &mut alone, &mut Workspace::default());
            assert_eq!(done, Ok(()));
            for (column, (a, b)) in found.iter().zip(&alone).enumerate() {
                let close = (a - b).abs() <= 1e-13 * b.abs().max(1.0);
                assert!(close, "{samples} samples, number {column}: {a} for {b}");
            }
        }
    }
}

#[test]
fn a_workspace_serves_another_program() {
    let (first, mut second) = (program(), program());
    second.entries.reverse();
    let width = first.entries.len();
    let states = states(5);
    let inputs = [rows(&states, false), rows(&[1.7], true)];
    let mut workspace = Workspace::default();
    let mut outputs = [&first, &second].map(|program| {
        let mut output = vec![0.0; 5 * width];
        let done = program.evaluate(5, &inputs, &mut output, &mut workspace);
        assert_eq!(done, Ok(()));
        output
    });
    outputs[1].chunks_mut(width).for_each(<[f64]>::reverse);
    assert_eq!(outputs[0], outputs[1]);
}

#[test]
fn the_first_sample_that_fails_is_named() {
    let program = program();
    let mut states = states(2 * BLOCK + 3);
    for sample in [BLOCK + 5, BLOCK + 9] {
        // The cosine that the guard sees vanishes.
        states[2 * sample] = std::f64::consts::FRAC_PI_2;
    }
    let inputs = [rows(&states, false), rows(&[1.7], true)];
    let mut output = vec![0.0; states.len() / 2 * program.entries.len()];
    let samples = states.len() / 2;
    let done = program.evaluate(samples, &inputs, &mut output, &mut Workspace::default());
    assert!(
        matches!(&done, Err(failed) if failed.sample == BLOCK + 5),
        "{done:?}"
    );
}
