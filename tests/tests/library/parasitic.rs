//! Platforms with parasitic motion: blocked directions, poses off the closures, and the return to
//! them.

use nalgebra::DMatrix;
use overact::{Error, Function, Model};
use overact_tests::reference::Motion;
use overact_tests::support::Failure;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;

/// Step of the finite differences, m and rad.
const STEP: f64 = 1e-5;

overact_tests::library!(check);

fn check(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    if !model.mechanism.is_parasitic() {
        return Ok(());
    }
    let sizes = compiled.info().sizes;
    let ask = |function: Function, pose: &[f64]| -> Result<DMatrix<f64>, Error> {
        let (rows, columns) = function.shape(&sizes);
        let mut output = vec![0.0; rows * columns];
        let done = compiled.evaluate(function, &[pose], &mut output);
        done.map_err(|error| error.error)?;
        Ok(DMatrix::from_row_slice(rows, columns, &output))
    };
    for sample in samples(&expected.mechanism, &expected.parameters(), 4, 5, false)? {
        let pose = &sample.state.pose;
        let blocked = ask(Function::BlockedJacobian, pose)?;
        let allowed = ask(Function::PlatformJacobian, pose)?;
        let left = (&blocked * &allowed).amax();
        assert!(left < 1e-12, "{stem}: A D = {left:e}");
        for at in 0..6 {
            let side = |sign: f64| {
                let mut step = nalgebra::DVector::zeros(6);
                step[at] = sign * STEP;
                ask(
                    Function::BlockedError,
                    &Motion::Spatial.displace(pose, &step),
                )
            };
            let slope = (side(1.0)? - side(-1.0)?) / (2.0 * STEP);
            let off = (slope - blocked.column(at)).amax();
            assert!(off < 1e-8, "{stem}: column {at} of A is off by {off:e}");
        }
        refused(stem, compiled, pose)?;
        check_recovered_pose(stem, compiled, &sample.start, &sample.actuators, pose)?;
    }
    Ok(())
}

/// A pose with a changed dependent coordinate is rejected with the name of the leg.
fn refused(stem: &str, robot: &dyn Model, pose: &[f64]) -> Result<(), Failure> {
    let independent = robot.info().coordinates;
    let names = ["x", "y", "z", "rx", "ry", "rz"];
    let others = names
        .iter()
        .enumerate()
        .filter(|(_, name)| !independent.contains(name));
    for (at, name) in others {
        let mut step = nalgebra::DVector::zeros(6);
        step[at] = 0.05;
        let off = Motion::Spatial.displace(pose, &step);
        let sizes = robot.info().sizes;
        let mut output = vec![0.0; sizes.actuators * sizes.dof];
        let error = robot.evaluate(Function::InverseJacobian, &[&off], &mut output);
        let error = error.expect_err("a pose that the legs do not allow").error;
        let Error::NotClosed { leg, gap } = error else {
            return Err(format!("{stem}: {name}: {error}").into());
        };
        assert!(robot.info().legs.contains(&leg), "{stem}: {leg}");
        assert!(gap > 1e-3 && gap < 0.2, "{stem}: {name}: {gap}");
    }
    Ok(())
}

/// From a near pose off the closures, forward kinematics finds that of the actuators.
fn check_recovered_pose(
    stem: &str,
    robot: &dyn Model,
    start: &[f64],
    actuators: &[f64],
    pose: &[f64],
) -> Result<(), Failure> {
    let mut found = start.to_vec();
    robot.displace(&mut found, &vec![0.0; robot.info().sizes.dof]);
    let mut missed = vec![0.0; robot.info().sizes.blocked()];
    let at = [found.as_slice()];
    robot
        .evaluate(Function::BlockedError, &at, &mut missed)
        .map_err(|e| e.error)?;
    let gap = missed.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
    assert!(gap < 1e-12, "{stem}: {gap:e} after a displacement");
    let mut found = start.to_vec();
    robot.pose_from_actuators(actuators, &mut found)?;
    let off = Motion::Spatial.displacement(&found, pose).amax();
    assert!(off < 1e-10, "{stem}: the pose is off by {off:e}");
    Ok(())
}
