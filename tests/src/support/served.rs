//! Compiled robots through [`overact::Model`], and the actuator projection for any kept actuators
//! by the runtime.

use super::{Backend, Failure, Sample};
use nalgebra::DMatrix;
use overact::partition::Partition;
use overact::{Error, Function, Input, Model};
use overact_codegen::derivation::{MotionInput, function_name};

/// A robot behind [`overact::Model`].
#[derive(Clone, Copy)]
pub struct Served<'a>(pub &'a dyn Model);

impl Served<'_> {
    /// A function's output at a sample.
    ///
    /// # Errors
    ///
    /// The model's own.
    pub fn evaluate(&self, function: Function, sample: &Sample) -> Result<DMatrix<f64>, Failure> {
        let (rows, columns) = function.shape(&self.0.info().sizes);
        let inputs = function.inputs().iter();
        let inputs = inputs.map(|input| sample.argument(function, input.name()));
        let inputs = inputs.collect::<Result<Vec<_>, Failure>>()?;
        // NaN reveals entries that a function does not write.
        let mut output = vec![f64::NAN; rows * columns];
        self.0.evaluate(function, &inputs, &mut output)?;
        Ok(DMatrix::from_row_slice(rows, columns, &output))
    }
}

impl Backend for Served<'_> {
    fn label(&self) -> &'static str {
        "compiled"
    }

    fn call(&self, function: &str, sample: &Sample) -> Result<DMatrix<f64>, Failure> {
        // A model offers functions from the pose, and those with joint inputs from joints.
        let is_called = |known: &&Function| {
            let from = if known.inputs().contains(&Input::Joints) {
                MotionInput::Joints
            } else {
                MotionInput::Pose
            };
            function_name(**known, from, false) == function
        };
        let found = Function::ALL.iter().find(is_called);
        let found = found.ok_or_else(|| format!("no function `{function}`"))?;
        self.evaluate(*found, sample)
    }
}

/// Γ² of the kept actuators from J_p^inv and Γ¹, or the regressors of both, by the runtime.
///
/// Also returns the condition number of the partition.
///
/// # Errors
///
/// [`Error::SingularPartition`].
///
/// # Panics
///
/// If the robot has more than seven degrees of freedom.
pub fn project(
    inverse_jacobian: &DMatrix<f64>,
    kept: &[usize],
    inputs: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, f64), Error> {
    match kept.len() {
        1 => sized::<1>(inverse_jacobian, kept, inputs),
        2 => sized::<2>(inverse_jacobian, kept, inputs),
        3 => sized::<3>(inverse_jacobian, kept, inputs),
        4 => sized::<4>(inverse_jacobian, kept, inputs),
        5 => sized::<5>(inverse_jacobian, kept, inputs),
        6 => sized::<6>(inverse_jacobian, kept, inputs),
        7 => sized::<7>(inverse_jacobian, kept, inputs),
        more => panic!("no test has {more} degrees of freedom"),
    }
}

fn sized<const R: usize>(
    inverse_jacobian: &DMatrix<f64>,
    kept: &[usize],
    inputs: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, f64), Error> {
    let row_major = inverse_jacobian.transpose();
    let rows = row_major.as_slice().as_chunks::<R>().0;
    let kept = std::array::from_fn(|at| kept[at]);
    let partition = Partition::new(rows, &kept)?;
    let mut projected = inputs.transpose();
    partition.project(projected.as_mut_slice())?;
    Ok((projected.transpose(), partition.condition()))
}

/// Every choice of r of n actuators, in lexicographic order.
#[must_use]
pub fn partitions(actuators: usize, dof: usize) -> Vec<Vec<usize>> {
    let mut all = Vec::new();
    let mut chosen: Vec<usize> = (0..dof).collect();
    loop {
        all.push(chosen.clone());
        // Advance the last position that can still move, and place all later ones right after it.
        let Some(at) = (0..dof).rev().find(|&at| chosen[at] < actuators - dof + at) else {
            return all;
        };
        chosen[at] += 1;
        for next in at + 1..dof {
            chosen[next] = chosen[next - 1] + 1;
        }
    }
}
