//! For finite inputs of any size, functions give finite numbers or an error.
//!
//! Compiled and interpreted robots give the same error.

use super::contract::is_same_error;
use overact::{Error, Function, Model, SampleError};
use overact_robot::InterpretedRobot;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample};
use overact_tier::by_tier;

overact_tests::library!(check);

fn check(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let count = by_tier([24, 400]);
    let all = samples(&expected.mechanism, &expected.parameters(), 4, 77, false)?;
    let interpreted = InterpretedRobot::new(model.clone());
    let mut dice = Dice(1);
    let (mut refused, mut answered) = (0, 0);
    for function in Function::ALL {
        for number in 0..count {
            let inputs = inputs(function, &all[number % all.len()], number, &mut dice)?;
            let [of_compiled, of_interpreted] = [compiled, &interpreted as &dyn Model]
                .map(|backend| ask(backend, function, &inputs));
            let case = format!("{stem}: {function:?} of {inputs:?}");
            match (&of_compiled, &of_interpreted) {
                (Err(one), Err(other)) => {
                    let at_limit = is_at_limit(&one.error) && is_at_limit(&other.error);
                    assert!(
                        at_limit || is_same_error(one, other),
                        "{case}: {one:?}, {other:?}"
                    );
                    refused += 1;
                }
                (Ok(one), Ok(other)) => {
                    let mut numbers = one.iter().chain(other);
                    assert!(numbers.all(|x| x.is_finite()), "{case}: {one:?}, {other:?}");
                    answered += 1;
                }
                // Rounding differs, so a guard at its limit may hold for one only.
                (Ok(numbers), Err(error)) | (Err(error), Ok(numbers))
                    if is_at_limit(&error.error) =>
                {
                    assert!(numbers.iter().all(|x| x.is_finite()), "{case}: {numbers:?}");
                }
                // Guards on sizes are placed on other values where legs run side by side.
                (Ok(numbers), Err(error)) | (Err(error), Ok(numbers))
                    if error.error == Error::Overflow =>
                {
                    let mut all = inputs.iter().flatten().chain(numbers);
                    assert!(all.any(is_extreme), "{case}: {numbers:?}");
                    assert!(numbers.iter().all(|x| x.is_finite()), "{case}: {numbers:?}");
                }
                _ => panic!("{case}: compiled {of_compiled:?}, interpreted {of_interpreted:?}"),
            }
        }
    }
    assert!(refused > 0 && answered > 0, "{stem}: {refused} {answered}");
    forward_kinematics(stem, [compiled, &interpreted], &mut dice)
}

fn ask(
    model: &dyn Model,
    function: Function,
    inputs: &[Vec<f64>],
) -> Result<Vec<f64>, SampleError> {
    let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let (rows, columns) = function.shape(&model.info().sizes);
    let mut output = vec![0.0; rows * columns];
    model.evaluate(function, &inputs, &mut output)?;
    Ok(output)
}

/// Inputs of a function at a regular state with one of another size; in every third case all are
/// random numbers of any size.
fn inputs(
    function: Function,
    sample: &Sample,
    number: usize,
    dice: &mut Dice,
) -> Result<Vec<Vec<f64>>, Failure> {
    let kinds = function.inputs();
    let changed = number / 3 % kinds.len();
    let mut inputs = Vec::new();
    for (at, kind) in kinds.iter().enumerate() {
        let mut values = sample.argument(function, kind.name())?.to_vec();
        if number.is_multiple_of(3) {
            values.fill_with(|| dice.number());
        } else if at == changed {
            let scale = dice.number();
            let scale = if number % 3 == 1 {
                scale
            } else {
                scale.abs().powf(0.05)
            };
            values
                .iter_mut()
                .for_each(|x| *x = (*x * scale).clamp(-f64::MAX, f64::MAX));
        }
        inputs.push(values);
    }
    Ok(inputs)
}

/// Actuators and starts of any size.
fn forward_kinematics(
    stem: &str,
    backends: [&dyn Model; 2],
    dice: &mut Dice,
) -> Result<(), Failure> {
    let info = backends[0].info();
    for number in 0..by_tier([10_usize, 100]) {
        let mut actuators = vec![0.0; info.sizes.actuators];
        actuators.fill_with(|| dice.number());
        let mut start = info.home_pose.to_vec();
        if number.is_multiple_of(2) {
            start.fill_with(|| dice.number());
        }
        let [one, other] = backends.map(|backend| {
            let mut pose = start.clone();
            backend
                .pose_from_actuators(&actuators, &mut pose)
                .map(|()| pose)
        });
        let case = format!("{stem}: pose of {actuators:?} from {start:?}: {one:?}, {other:?}");
        let with_sample = |error: &Error| SampleError {
            sample: 0,
            error: *error,
        };
        match (&one, &other) {
            (Err(one), Err(other)) => {
                let is_same = is_same_error(&with_sample(one), &with_sample(other));
                assert!(is_same || is_at_limit(one) && is_at_limit(other), "{case}");
            }
            (Ok(one), Ok(other)) => {
                assert!(one.iter().chain(other).all(|x| x.is_finite()), "{case}");
            }
            _ => panic!("{case}"),
        }
    }
    Ok(())
}

/// Whether the error is that of a guard whose limit depends on rounding.
fn is_at_limit(error: &Error) -> bool {
    matches!(
        error,
        Error::SingularLeg { .. } | Error::SingularPlatform { .. } | Error::OutOfReach { .. }
    )
}

/// Whether a number is far from all physical values, so that others may be beyond the bound of a guard.
fn is_extreme(number: &f64) -> bool {
    let magnitude = number.abs();
    magnitude > 1e20 || (magnitude > 0.0 && magnitude < 1e-20)
}

/// Reproducible random numbers.
struct Dice(u64);

impl Dice {
    /// Between 0 and 1.
    fn fraction(&mut self) -> f64 {
        let multiplier = 6_364_136_223_846_793_005;
        self.0 = self
            .0
            .wrapping_mul(multiplier)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Magnitude between 1e-300 and 1e308, either sign; every other one below 1e20.
    fn number(&mut self) -> f64 {
        let largest = if self.fraction() < 0.5 { 20.0 } else { 308.0 };
        let magnitude = 10.0_f64.powf(-300.0 + (300.0 + largest) * self.fraction());
        if self.fraction() < 0.5 {
            -magnitude
        } else {
            magnitude
        }
    }
}
