//! The interpreted robot compared with finite differences, and its forward kinematics.

use overact::{Body, Columns, Error, Function, Model, StandardParameter};
use overact_codegen::Request;
use overact_robot::{CompiledFile, InterpretedRobot, Robot};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Path of a description in `robots/`.
fn description(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../robots")
        .join(name)
}

fn robot(name: &str) -> InterpretedRobot {
    match CompiledFile::read(&description(name), &Request::default()) {
        Ok(robot) => InterpretedRobot::new(robot.model),
        Err(failure) => panic!("{}", failure.render(false)),
    }
}

/// The DualV, compiled once for all tests.
static DUALV: LazyLock<InterpretedRobot> = LazyLock::new(|| robot("dualv.toml"));

const POSE: [f64; 3] = [0.03, -0.02, 0.15];
const TWIST: [f64; 3] = [0.4, -0.3, 1.1];
const ACCELERATION: [f64; 3] = [2.0, 5.0, -7.0];

fn evaluate(
    robot: &InterpretedRobot,
    function: Function,
    inputs: &[&[f64]],
    length: usize,
) -> Vec<f64> {
    let mut output = vec![0.0; length];
    robot
        .evaluate(function, inputs, &mut output)
        .expect("a value");
    output
}

/// B_p of the DualV is diagonal, -d2 d3 sin(q2) of each leg; also if only the model's functions are
/// compiled.
#[test]
fn the_closure_jacobian_is_evaluated_from_joints() {
    let loaded =
        Robot::from_toml(description("dualv.toml")).map_err(|failure| failure.render(false));
    let lean = loaded.expect("a robot");
    for robot in [&*DUALV, lean.model()] {
        let joints = evaluate(robot, Function::Joints, &[&POSE], 12);
        let closure = evaluate(
            robot,
            Function::ClosureActuatorJacobian,
            &[&POSE, &joints],
            16,
        );
        for (at, value) in closure.iter().enumerate() {
            let (row, column) = (at / 4, at % 4);
            let expected = if row == column {
                -0.28 * 0.28 * joints[3 * row + 1].sin()
            } else {
                0.0
            };
            assert!((value - expected).abs() < 1e-14, "{value} {expected}");
        }
    }
}

/// Pose at a time near zero, on a motion with these rates.
fn moved(time: f64) -> [f64; 3] {
    std::array::from_fn(|i| POSE[i] + TWIST[i] * time + 0.5 * ACCELERATION[i] * time * time)
}

#[test]
fn rates_are_derivatives_of_positions() {
    let robot = &*DUALV;
    let h = 1e-4;
    let joints = |time: f64| evaluate(robot, Function::Joints, &[&moved(time)], 12);
    let (before, now, after) = (joints(-h), joints(0.0), joints(h));
    let inputs: [&[f64]; 3] = [&POSE, &TWIST, &ACCELERATION];
    let velocities = evaluate(robot, Function::JointVelocities, &inputs[..2], 12);
    let accelerations = evaluate(robot, Function::JointAccelerations, &inputs, 12);
    let jacobian = evaluate(robot, Function::InverseJacobian, &[&POSE], 12);
    for i in 0..12 {
        let velocity = (after[i] - before[i]) / (2.0 * h);
        let acceleration = (after[i] - 2.0 * now[i] + before[i]) / (h * h);
        // Central differences have the error h²/6 times the third derivative.
        assert!(
            (velocity - velocities[i]).abs() < 1e-5,
            "{velocity} {}",
            velocities[i]
        );
        assert!((acceleration - accelerations[i]).abs() < 1e-4 * (1.0 + acceleration.abs()));
    }
    let actuators = evaluate(robot, Function::ActuatorPositions, &[&POSE], 4);
    for (k, &i) in robot.info().actuated_joints.iter().enumerate() {
        let row = &jacobian[3 * k..3 * k + 3];
        let velocity: f64 = row.iter().zip(&TWIST).map(|(j, v)| j * v).sum();
        assert!((velocity - velocities[i]).abs() < 1e-13);
        assert_eq!(actuators[k], now[i]);
    }
}

#[test]
fn forward_kinematics_recovers_the_pose() {
    let robot = &*DUALV;
    let actuators = evaluate(robot, Function::ActuatorPositions, &[&POSE], 4);
    let mut pose = robot.info().home_pose.to_vec();
    robot
        .pose_from_actuators(&actuators, &mut pose)
        .expect("a pose");
    assert!(
        pose.iter()
            .zip(&POSE)
            .all(|(found, wanted)| (found - wanted).abs() < 1e-12)
    );
    let before = pose.clone();
    let far = [9.0, -9.0, 9.0, -9.0];
    assert!(robot.pose_from_actuators(&far, &mut pose).is_err());
    assert_eq!(pose, before, "unchanged on error");
    let nan = [f64::NAN, 0.0, 0.0, 0.0];
    assert_eq!(
        robot.pose_from_actuators(&nan, &mut pose),
        Err(Error::NotFinite { input: "actuators" })
    );
}

#[test]
fn regressor_times_parameters_equals_the_torques() {
    let robot = &*DUALV;
    let info = robot.info();
    let (own, payload) = (info.sizes.parameters, info.sizes.payload_parameters);
    let values: Vec<f64> = (0..own + payload)
        .map(|i| 0.1 + (i as f64 * 0.7).sin().abs())
        .collect();
    let inputs: [&[f64]; 3] = [&POSE, &TWIST, &ACCELERATION];
    let columns = evaluate(
        robot,
        Function::IdmRedPlatform(Columns::Standard),
        &inputs,
        3 * own,
    );
    let loaded = evaluate(robot, Function::IdmRedPayload, &inputs, 3 * payload);
    let inputs: [&[f64]; 4] = [&POSE, &TWIST, &ACCELERATION, &values];
    let torques = evaluate(
        robot,
        Function::InverseDynamics(Columns::Standard),
        &inputs,
        4,
    );
    let projected = evaluate(robot, Function::ProjectPlatform, &[&POSE, &torques], 3);
    for r in 0..3 {
        let row = columns[r * own..(r + 1) * own]
            .iter()
            .chain(&loaded[r * payload..(r + 1) * payload]);
        let sum: f64 = row.zip(&values).map(|(w, x)| w * x).sum();
        assert!(
            (sum - projected[r]).abs() < 1e-11 * sum.abs().max(1.0),
            "{sum} {}",
            projected[r]
        );
    }
    // The least-norm torques have no internal part.
    let same = evaluate(robot, Function::ProjectTorques, &[&POSE, &torques], 4);
    assert!(
        same.iter()
            .zip(&torques)
            .all(|(a, b)| (a - b).abs() < 1e-11)
    );
}

#[test]
fn failing_samples_are_reported_by_index() {
    let robot = &*DUALV;
    let mut output = vec![0.0; 24];
    let mut poses = [POSE, POSE].concat();
    poses[3] = f64::INFINITY;
    let error = robot
        .evaluate(Function::InverseJacobian, &[&poses], &mut output)
        .expect_err("infinite");
    assert_eq!(
        (error.sample, error.error),
        (1, Error::NotFinite { input: "pose" })
    );
    poses[3] = 3.0;
    let error = robot
        .evaluate(Function::InverseJacobian, &[&poses], &mut output)
        .expect_err("far");
    assert_eq!(error.sample, 1);
    assert!(matches!(error.error, Error::OutOfReach { leg } if leg.starts_with("leg")));
    let short = robot.evaluate(Function::InverseJacobian, &[&poses[..5]], &mut output);
    let length = Error::Length {
        expected: 6,
        found: 5,
    };
    assert_eq!(short.expect_err("short").error, length);
}

#[test]
fn robot_info_describes_the_dualv() {
    let robot = &*DUALV;
    let info = robot.info();
    assert_eq!(
        (info.name, info.coordinates),
        ("DualV", &["x", "y", "phi"][..])
    );
    assert_eq!(info.actuators, ["leg1", "leg2", "leg3", "leg4"]);
    assert_eq!(info.actuated_joints, [0, 3, 6, 9]);
    assert_eq!(
        (info.sizes.parameters, info.sizes.payload_parameters),
        (64, 4)
    );
    let zz = info
        .parameters
        .iter()
        .find(|p| p.name == "zz_2_leg3")
        .expect("a parameter");
    assert_eq!(
        (zz.symbol, zz.body),
        (
            StandardParameter::Zz,
            Body::Leg {
                leg: 2,
                index: 1,
                shape: 0
            }
        )
    );
    assert!(
        info.payload_parameters
            .iter()
            .all(|p| p.body == Body::Payload)
    );
}

#[test]
fn serial_robots_have_joints_as_pose() {
    let robot = &robot("emps.toml");
    let mut pose = [0.0];
    robot
        .pose_from_actuators(&[0.3], &mut pose)
        .expect("a pose");
    assert_eq!(pose, [0.3]);
    let velocity = evaluate(robot, Function::JointVelocities, &[&[0.3], &[2.0]], 1);
    assert_eq!(velocity, [2.0]);
    // There are no internal torques, and neither a null space nor a payload.
    assert_eq!(
        evaluate(robot, Function::ProjectTorques, &[&[0.3], &[5.0]], 1),
        [5.0]
    );
    let states: [&[f64]; 3] = [&[0.3], &[2.0], &[1.0]];
    for function in [Function::NullSpace, Function::IdmRedPayload] {
        let inputs = &states[..function.inputs().len()];
        let found = robot.evaluate(function, inputs, &mut []);
        let name = function.name();
        let expected = Error::NotOffered { function: name };
        assert_eq!(found.expect_err("not offered").error, expected);
    }
}
