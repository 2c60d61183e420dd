//! Actuator projection for any kept actuators: the C compared with Rust's runtime.
//!
//! The kept actuators include singular and non-existent ones.

use crate::driver::{Call, Driver, Failure, Question};
use crate::expected::Inputs;
use overact::partition::Partition;
use overact::{Error, Function, Model};
use overact_robot::InterpretedRobot;

/// Columns of the projected matrix.
const COLUMNS: usize = 3;

/// Call of the driver: J_p^inv, kept actuators and matrix; condition number and matrix.
pub(crate) fn call(robot: &InterpretedRobot) -> Call {
    let sizes = robot.info().sizes;
    let (n, r) = (sizes.actuators, sizes.dof);
    Call {
        name: "partition".to_owned(),
        arguments: vec![n * r, r, r * COLUMNS],
        output: 1 + r * COLUMNS,
    }
}

/// The call as a function of the driver.
pub(crate) fn wrapper(stem: &str, call: &Call) -> String {
    let [jacobian, r, _] = call.arguments[..] else {
        return String::new();
    };
    let matrix = jacobian + r;
    let numbers = call.output - 1;
    format!(
        "static int partition(void)\n{{\n    \
             int kept[{r}];\n    \
             {stem}_partition found;\n    \
             int error = 0;\n    \
             for (int i = 0; i < {r}; i++) {{\n        kept[i] = (int)in[{jacobian} + i];\n    }}\n    \
             error = (int){stem}_partition_of(in, kept, &found);\n    \
             if (error == 0) {{\n        \
                 out[0] = found.condition;\n        \
                 for (int i = 0; i < {numbers}; i++) {{\n            out[1 + i] = in[{matrix} + i];\n        }}\n        \
                 {stem}_partition_project(&found, &out[1], {COLUMNS});\n    \
             }}\n    \
             return error;\n\
         }}\n\n"
    )
}

/// Compares all partitions at some states; returns the largest relative difference and the number
/// of values.
pub(crate) fn compare(
    robot: &InterpretedRobot,
    driver: &Driver,
    index: usize,
    states: &[Inputs],
) -> Result<(f64, usize), Failure> {
    let sizes = robot.info().sizes;
    let (n, r) = (sizes.actuators, sizes.dof);
    let mut questions = Vec::new();
    let mut wanted = Vec::new();
    for state in states {
        let mut jacobian = vec![0.0; n * r];
        robot.evaluate(Function::InverseJacobian, &[&state["pose"]], &mut jacobian)?;
        let matrix: Vec<f64> = (0..r * COLUMNS).map(|i| 1.0 + (i as f64).sin()).collect();
        for kept in choices(n, r) {
            let numbers = kept.iter().map(|&at| at as f64);
            let inputs = jacobian
                .iter()
                .copied()
                .chain(numbers)
                .chain(matrix.iter().copied());
            questions.push(Question {
                call: index,
                inputs: inputs.collect(),
            });
            wanted.push(by_rust(&jacobian, &kept, &matrix));
        }
    }
    let texts = driver.texts()?;
    let (mut worst, mut values) = (0.0_f64, 0);
    for (wanted, (error, found)) in wanted.into_iter().zip(driver.answers(&questions)?) {
        match wanted {
            Ok(wanted) => {
                assert_eq!(error, 0, "{}", texts[error]);
                let condition = wanted[0];
                // Rounding errors are proportional to the condition number.
                worst = worst.max(crate::difference(&found, &wanted) / condition);
                values += 1;
            }
            Err(Error::SingularPartition { .. }) => {
                assert!(
                    texts[error].starts_with("the given kept actuators do not"),
                    "{}",
                    texts[error]
                );
            }
            Err(Error::NoActuator { .. }) => {
                assert_eq!(texts[error], "there is no actuator of this number")
            }
            Err(other) => return Err(other.into()),
        }
    }
    Ok((worst, values))
}

/// All sets of r of n actuators, one with a repeated actuator, and one with a non-existent one.
fn choices(n: usize, r: usize) -> Vec<Vec<usize>> {
    let sets = (0_u32..1 << n).filter(|bits| bits.count_ones() as usize == r);
    let mut all: Vec<Vec<usize>> = sets
        .map(|bits| (0..n).filter(|at| bits >> at & 1 == 1).collect())
        .collect();
    let first = all[0].clone();
    let mut strange = first.clone();
    strange[r - 1] = n;
    all.push(strange);
    if r > 1 {
        let mut twice = first;
        twice[r - 1] = twice[0];
        all.push(twice);
    }
    all
}

fn by_rust(jacobian: &[f64], kept: &[usize], matrix: &[f64]) -> Result<Vec<f64>, Error> {
    match kept.len() {
        1 => sized::<1>(jacobian, kept, matrix),
        2 => sized::<2>(jacobian, kept, matrix),
        3 => sized::<3>(jacobian, kept, matrix),
        4 => sized::<4>(jacobian, kept, matrix),
        5 => sized::<5>(jacobian, kept, matrix),
        6 => sized::<6>(jacobian, kept, matrix),
        more => panic!("no robot of these tests keeps {more} actuators"),
    }
}

fn sized<const R: usize>(
    jacobian: &[f64],
    kept: &[usize],
    matrix: &[f64],
) -> Result<Vec<f64>, Error> {
    let rows = jacobian.as_chunks::<R>().0;
    let partition = Partition::new(rows, &std::array::from_fn(|at| kept[at]))?;
    let mut output = vec![partition.condition()];
    output.extend(matrix);
    partition.project(&mut output[1..])?;
    Ok(output)
}
