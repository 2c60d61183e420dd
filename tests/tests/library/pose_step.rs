//! The step of forward kinematics is (J_p^inv)⁺ times what the actuators miss, for any difference and not only for
//! those of poses that exist.

use nalgebra::{DMatrix, DVector};
use overact::{Function, Model, SampleError};
use overact_tests::support::Failure;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;

/// Largest difference, relative to the largest number of the step.
const TOLERANCE: f64 = 1e-10;

overact_tests::library!(check);

fn check(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    if model.served(Function::PoseStep).is_none() {
        return Ok(());
    }
    let sizes = compiled.info().sizes;
    let ask = |function: Function, inputs: &[&[f64]]| -> Result<DMatrix<f64>, SampleError> {
        let (rows, columns) = function.shape(&sizes);
        let mut output = vec![0.0; rows * columns];
        compiled.evaluate(function, inputs, &mut output)?;
        Ok(DMatrix::from_row_slice(rows, columns, &output))
    };
    for sample in samples(&expected.mechanism, &expected.parameters(), 4, 5, false)? {
        let pose = &sample.state.pose;
        let missed = DVector::from_column_slice(&sample.torques).normalize() * 0.01;
        let measured = DVector::from_column_slice(&sample.actuators) + &missed;
        let step = ask(Function::PoseStep, &[pose, measured.as_slice()])?;
        let jacobian = ask(Function::InverseJacobian, &[pose])?;
        let wanted = jacobian.pseudo_inverse(1e-12)? * missed;
        let off = (&step - &wanted).amax() / wanted.amax();
        assert!(
            off < TOLERANCE,
            "{stem}: {step} for {wanted}, off by {off:e}"
        );
    }
    Ok(())
}
