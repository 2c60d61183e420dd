//! Inputs of any size: generated C gives finite numbers or the error of the interpreted robot.

use crate::driver::{Driver, Failure, Question, UNTOUCHED};
use crate::expected::{Dice, Inputs, output};
use overact_robot::InterpretedRobot;

/// Whether errors of the C must equal those of the 64-bit programs.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Errors {
    Compared,
    /// 32-bit numbers overflow earlier.
    Any,
}

/// States of which one input, in every third state all, has another size: up to ten to the power
/// `largest`.
pub(crate) fn extremes(near: &[Inputs], largest: f64) -> Vec<Inputs> {
    let mut dice = Dice::new(5);
    let mut extremes = Vec::new();
    for (number, state) in near.iter().enumerate() {
        let mut state = state.clone();
        let count = state.len();
        for (at, values) in state.values_mut().enumerate() {
            let is_changed = number % 3 == 0 || at == number / 3 % count;
            for value in values.iter_mut().filter(|_| is_changed) {
                *value = dice.of_any_size(largest);
            }
        }
        extremes.push(state);
    }
    extremes
}

/// Checks all functions at some states.
pub(crate) fn check(
    robot: &InterpretedRobot,
    driver: &Driver,
    arguments: &[Vec<String>],
    states: &[Inputs],
    errors: Errors,
) -> Result<(), Failure> {
    let mut questions = Vec::new();
    for state in states {
        for (call, names) in arguments.iter().enumerate() {
            let inputs = names.iter().flat_map(|name| state[name.as_str()].clone());
            questions.push(Question {
                call,
                inputs: inputs.collect(),
            });
        }
    }
    let texts = driver.texts()?;
    let (mut refused, mut answered) = (0, 0);
    let answers = driver.answers(&questions)?;
    for ((at, question), (error, found)) in questions.iter().enumerate().zip(answers) {
        let state = &states[at / arguments.len()];
        let text = texts.get(error).ok_or("an error without a text")?;
        let case = format!("call {}: {text}: {found:?} of {state:?}", question.call);
        if error == 0 {
            assert!(found.iter().all(|x| x.is_finite()), "{case}");
            answered += 1;
        } else {
            assert!(found.iter().all(|&x| x == UNTOUCHED), "{case}");
            refused += 1;
        }
        if errors == Errors::Compared {
            match output(robot, question.call, state) {
                Ok(_) => assert_eq!(error, 0, "{case}"),
                Err(wanted) => {
                    let wanted = wanted.to_string();
                    assert!(error != 0 && wanted.starts_with(text), "{case}: {wanted}");
                }
            }
        }
    }
    assert!(refused > 0 && answered > 0, "{refused} {answered}");
    Ok(())
}
