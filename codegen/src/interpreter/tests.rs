//! Compares blocks with single samples, on a program of every operation in every fused form.

use super::{BLOCK, Evaluator, Rows};
use crate::lowering::{Array, Condition, Entry, Guard, Operand, Operation, Program, Step};

fn array(name: &str, len: usize) -> Array {
    Array {
        name: name.to_owned(),
        shape: vec![len],
    }
}

const fn input(array: usize, index: usize) -> Operand {
    Operand::Input { array, index }
}

/// A program of two inputs, the second shared, whose outputs contain every kind of number.
fn program() -> Program {
    use Operation::{Add, Atan2, Cosine, Div, Mul, Neg, Sign, Signed, Sine, Sqrt, Sub};
    let at = Operand::Step;
    let (x, y, p) = (input(0, 0), input(0, 1), input(1, 0));
    let mut operations = vec![
        Sine(x),
        Cosine(x),
        Cosine(y),
        Neg(at(0)),
        Sqrt(Operand::Constant(2.0)),
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
    let two = |kind: usize, a: Operand, b: Operand| [Add(a, b), Sub(a, b), Mul(a, b)][kind];
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
            operations.push(two(last, x, Operand::Constant(0.75)));
            operations.push(two(middle, at(inner), at(inner + 1)));
            outputs.push(inner + 2);
            // Three in a row, with the second and third step on either side.
            for sides in 0..4 {
                let chain = operations.len();
                let on = |side: bool, a: Operand, b: Operand| if side { (a, b) } else { (b, a) };
                operations.push(two(first, at(0), y));
                let (a, b) = on(sides & 1 == 0, at(chain), x);
                operations.push(two(middle, a, b));
                let (a, b) = on(sides & 2 == 0, at(chain + 1), p);
                operations.push(two(last, a, b));
                outputs.push(chain + 2);
            }
        }
    }
    let operands = outputs.iter().map(|&o| at(o));
    let plain = operands.chain([x, p, Operand::Constant(3.0), Operand::Constant(0.0)]);
    let entries: Vec<Entry> = plain
        .enumerate()
        .map(|(k, operand)| Entry {
            operand,
            negative: k % 3 == 1,
        })
        .collect();
    Program {
        least_torques: Vec::new(),
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
            operand: at(1),
            condition: Condition::Leg {
                leg: "leg".to_owned(),
                home: 1.0,
            },
        }],
        pieces: 0,
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
fn blocks_and_single_samples_give_equal_results() {
    let program = program();
    let width = program.entries.len();
    let mut evaluator = Evaluator::new(&program);
    for samples in [2, 3, BLOCK, BLOCK + 1, 3 * BLOCK + 7] {
        let states = states(samples);
        let inputs = [rows(&states, false), rows(&[1.7], true)];
        let mut together = vec![f64::NAN; samples * width];
        let done = evaluator.evaluate(samples, &inputs, &mut together);
        assert_eq!(done, Ok(()));
        for (state, found) in states.chunks(2).zip(together.chunks(width)) {
            let inputs = [rows(state, false), rows(&[1.7], true)];
            let mut alone = vec![f64::NAN; width];
            let done = program.evaluate(1, &inputs, &mut alone);
            assert_eq!(done, Ok(()));
            for (column, (a, b)) in found.iter().zip(&alone).enumerate() {
                let close = (a - b).abs() <= 1e-13 * b.abs().max(1.0);
                assert!(close, "{samples} samples, number {column}: {a} for {b}");
            }
        }
    }
}

#[test]
fn prepared_programs_give_the_results_of_unprepared_ones() {
    let program = program();
    let width = program.entries.len();
    let mut evaluator = Evaluator::new(&program);
    let mut states = states(BLOCK);
    // The guard fails between states at which it holds.
    states[2 * 7] = std::f64::consts::FRAC_PI_2;
    for (number, state) in states.chunks(2).enumerate() {
        let inputs = [rows(state, false), rows(&[1.7], true)];
        let (mut once, mut ready) = (vec![f64::NAN; width], vec![f64::NAN; width]);
        let done = program.evaluate(1, &inputs, &mut once);
        assert_eq!(evaluator.evaluate(1, &inputs, &mut ready), done);
        assert_eq!(done.is_err(), number == 7);
        for (column, (a, b)) in once.iter().zip(&ready).enumerate() {
            let close = (a - b).abs() <= 1e-15 * a.abs().max(1.0);
            assert!(close || done.is_err(), "number {column}: {b} for {a}");
        }
    }
}

#[test]
fn large_angles_in_a_block_are_evaluated_by_the_library() {
    let program = program();
    let width = program.entries.len();
    for large in [1e300, -2e5, f64::INFINITY, f64::NAN] {
        let mut states = states(BLOCK);
        states[2 * 5 + 1] = large;
        let inputs = [rows(&states, false), rows(&[1.7], true)];
        let mut found = vec![f64::NAN; BLOCK * width];
        let done = program.evaluate(BLOCK, &inputs, &mut found);
        assert_eq!(done, Ok(()));
        // The second output is the negative cosine of the second input.
        let cosine = -found[5 * width + 1];
        let exact = large.cos();
        assert!(cosine.to_bits() == exact.to_bits() || cosine.is_nan() && exact.is_nan());
    }
}

#[test]
fn streamed_numbers_occur_once_and_equal_the_rows() {
    let program = program();
    let width = program.entries.len();
    let mut evaluator = Evaluator::new(&program);
    for samples in [1, 5, BLOCK, 2 * BLOCK + 3] {
        let states = states(samples);
        let inputs = [rows(&states, false), rows(&[1.7], true)];
        let mut expected = vec![f64::NAN; samples * width];
        // At least two samples: a single one uses sines and cosines of another library.
        let twice = [states.as_slice(), &states].concat();
        let more = [rows(&twice, false), rows(&[1.7], true)];
        expected.resize(2 * samples * width, f64::NAN);
        let done = evaluator.evaluate(2 * samples, &more, &mut expected);
        assert_eq!(done, Ok(()));
        let mut found = vec![f64::NAN; samples * width];
        let done = evaluator.evaluate_numbers(samples, &inputs, |number| {
            for (k, value) in number.values.iter().enumerate() {
                let place = &mut found[(number.first + k) * width + number.index];
                assert!(place.is_nan(), "handed out twice");
                *place = number.sign * value;
            }
        });
        assert_eq!(done, Ok(()));
        assert_eq!(found, expected[..samples * width]);
    }
}

#[test]
fn the_first_failing_sample_is_reported() {
    let program = program();
    let mut states = states(2 * BLOCK + 3);
    for sample in [BLOCK + 5, BLOCK + 9] {
        // The guarded cosine vanishes.
        states[2 * sample] = std::f64::consts::FRAC_PI_2;
    }
    let inputs = [rows(&states, false), rows(&[1.7], true)];
    let mut output = vec![0.0; states.len() / 2 * program.entries.len()];
    let samples = states.len() / 2;
    let done = program.evaluate(samples, &inputs, &mut output);
    assert!(
        matches!(&done, Err(failed) if failed.sample == BLOCK + 5),
        "{done:?}"
    );
}
