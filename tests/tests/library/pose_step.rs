//! A step of forward kinematics is (J_p^inv)⁺ times the actuators' residual, for any residual.
//!
//! Full turns of an angle do not count.

use nalgebra::{DMatrix, DVector};
use overact::{Function, Model, SampleError, math::wrap_angle};
use overact_tests::support::Failure;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tier::by_tier;
use std::f64::consts::TAU;

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
        let is_revolute = compiled.info().actuator_is_revolute.iter().enumerate();
        let turns = is_revolute.map(|(k, is)| if *is { TAU * (k as f64 - 1.0) } else { 0.0 });
        let turned = measured + DVector::from_iterator(sizes.actuators, turns);
        let same = ask(Function::PoseStep, &[pose, turned.as_slice()])?;
        let off = (&same - &wanted).amax() / wanted.amax();
        assert!(off < TOLERANCE, "{stem}: {same} for {wanted} behind turns");
    }
    let is_square = sizes.actuators == sizes.dof;
    if is_square && sizes.dof > 3 {
        assert_steps_past_singular_blocks(stem, compiled)?;
    }
    if is_square && model.served(Function::PoseInClosedForm).is_none() {
        assert_exact_or_error_out_of_reach(stem, compiled)?;
    }
    Ok(())
}

/// For unreachable actuator positions, forward kinematics finds a pose that has them, or an error.
fn assert_exact_or_error_out_of_reach(stem: &str, robot: &dyn Model) -> Result<(), Failure> {
    let info = robot.info();
    let mut home = vec![0.0; info.sizes.actuators];
    robot
        .evaluate(Function::ActuatorPositions, &[info.home_pose], &mut home)
        .map_err(|error| error.error)?;
    let mut positions = home.clone();
    for case in 0..by_tier([1000, 30_000]) {
        let away = |k: usize| (f64::from(case) * 7.3 + k as f64 * 1.7).sin();
        let wanted: Vec<f64> = (home.iter().enumerate())
            .map(|(k, q)| q + away(k))
            .collect();
        let mut pose = info.home_pose.to_vec();
        if robot.pose_from_actuators(&wanted, &mut pose).is_err() {
            continue;
        }
        robot
            .evaluate(Function::ActuatorPositions, &[&pose], &mut positions)
            .map_err(|error| error.error)?;
        let pairs = positions.iter().zip(&wanted).zip(info.actuator_is_revolute);
        for ((found, wanted), is_revolute) in pairs {
            let missed = if *is_revolute {
                wrap_angle(found - wanted)
            } else {
                found - wanted
            };
            assert!(missed.abs() < 1e-8, "{stem}: {pose:?} of {wanted:?}");
        }
    }
    Ok(())
}

/// Forward kinematics succeeds at poses where a 2 × 2 block of J_p^inv is singular.
///
/// Two actuators' rows are parallel in the first two coordinates, by which the step may divide,
/// while J_p^inv is regular.
fn assert_steps_past_singular_blocks(stem: &str, robot: &dyn Model) -> Result<(), Failure> {
    let sizes = robot.info().sizes;
    let home = robot.info().home_pose.to_vec();
    let on_circle = |radius: f64, along: f64| {
        let mut pose = home.clone();
        pose[0] += radius * along.cos();
        pose[1] += radius * along.sin();
        pose
    };
    let radius = [0.3, 0.1, 0.03, 0.01].into_iter().find(|&radius| {
        let mut along = (0..60).map(|k| f64::from(k) * 0.1);
        along.all(|along| is_reached(robot, &on_circle(radius, along)))
    });
    let radius = radius.ok_or("no circle is within reach")?;
    let at = |along: f64| on_circle(radius, along);
    let mut rows = vec![0.0; sizes.actuators * sizes.dof];
    let mut found = 0;
    for (first, second) in (0..sizes.dof).flat_map(|j| (0..j).map(move |i| (i, j))) {
        let mut cross = |along: f64| -> Result<f64, Failure> {
            let done = robot.evaluate(Function::InverseJacobian, &[&at(along)], &mut rows);
            done.map_err(|error| error.error)?;
            let entry = |row: usize, column: usize| rows[row * sizes.dof + column];
            Ok(entry(first, 0) * entry(second, 1) - entry(first, 1) * entry(second, 0))
        };
        for start in (0..60).map(|k| f64::from(k) * 0.1) {
            let (mut low, mut high) = (start, start + 0.1);
            if cross(low)? * cross(high)? > 0.0 {
                continue;
            }
            while high - low > 1e-15 {
                let middle = f64::midpoint(low, high);
                if middle <= low || middle >= high {
                    break;
                }
                if cross(low)? * cross(middle)? > 0.0 {
                    low = middle
                } else {
                    high = middle
                }
            }
            for offset in [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4] {
                assert_exact_step_or_error(stem, robot, &at(low + offset))?;
                assert_pose_is_recovered(stem, robot, &at(low + offset))?;
            }
            found += 1;
        }
    }
    assert!(found > 5, "{stem}: {found} poses");
    Ok(())
}

fn is_reached(robot: &dyn Model, pose: &[f64]) -> bool {
    let mut positions = vec![0.0; robot.info().sizes.actuators];
    let done = robot.evaluate(Function::ActuatorPositions, &[pose], &mut positions);
    done.is_ok()
}

/// The step is right or an error, after which forward kinematics uses normal equations.
fn assert_exact_step_or_error(stem: &str, robot: &dyn Model, pose: &[f64]) -> Result<(), Failure> {
    let (n, r) = (robot.info().sizes.actuators, robot.info().sizes.dof);
    let (mut actuators, mut rows) = (vec![0.0; n], vec![0.0; n * r]);
    for (function, output) in [
        (Function::ActuatorPositions, &mut actuators),
        (Function::InverseJacobian, &mut rows),
    ] {
        let done = robot.evaluate(function, &[pose], output);
        done.map_err(|error| error.error)?;
    }
    let missed = DVector::from_fn(n, |row, _| if row % 2 == 0 { 1e-3 } else { -5e-4 });
    let measured = DVector::from_vec(actuators) + &missed;
    let mut step = vec![0.0; r];
    if robot
        .evaluate(Function::PoseStep, &[pose, measured.as_slice()], &mut step)
        .is_ok()
    {
        let wanted = DMatrix::from_row_slice(n, r, &rows).pseudo_inverse(1e-12)? * missed;
        let off = (DVector::from_vec(step) - &wanted).amax() / wanted.amax();
        assert!(off < 1e-3, "{stem}: off by {off:e} at {pose:?}");
    }
    Ok(())
}

/// Forward kinematics from near a pose finds it.
fn assert_pose_is_recovered(stem: &str, robot: &dyn Model, pose: &[f64]) -> Result<(), Failure> {
    let mut actuators = vec![0.0; robot.info().sizes.actuators];
    let done = robot.evaluate(Function::ActuatorPositions, &[pose], &mut actuators);
    done.map_err(|error| error.error)?;
    let mut reached = pose.to_vec();
    reached[0] += 1e-3;
    reached[2] -= 1e-3;
    robot.pose_from_actuators(&actuators, &mut reached)?;
    let pairs = reached.iter().zip(pose);
    let off = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    assert!(off < 1e-9, "{stem}: {reached:?} for {pose:?}");
    Ok(())
}
