//! Continuously rotating joints: angles over many turns, and angles logged within one turn.

use overact_identification::{CheckKind, Grade, Identification, Log};
use overact_logs::Array;
use overact_robot::{Identifier, Robot};
use std::f64::consts::{PI, TAU};

/// A motor that rotates an unbalanced arm; rows of [data] are added.
const ARM: &str = r#"
name = "Pendulum"
summary = "a motor that turns an unbalanced arm"
[[leg.arm.joint]]
name = "motor"
type = "revolute"
alpha = "90 deg"
actuated = true
[[place]]
name = "arm"
shape = "arm"
[data]
time = "time"
positions = ["q"]
torques = ["tau"]
"#;

const FREQUENCY: f64 = 500.0;
const SAMPLES: usize = 5000;

/// Angle, velocity and acceleration of the arm: more than ten turns with an oscillation.
fn motion(time: f64) -> [f64; 3] {
    let (w, v) = (2.5, 6.3);
    [
        TAU * time + 1.5 * (w * time).sin() + 0.8 * (v * time).sin(),
        TAU + 1.5 * w * (w * time).cos() + 0.8 * v * (v * time).cos(),
        -1.5 * w * w * (w * time).sin() - 0.8 * v * v * (v * time).sin(),
    ]
}

/// Run whose angle is converted by `logged`.
fn log(robot: &Robot, logged: impl Fn(f64) -> f64) -> Result<Log, overact_robot::Error> {
    let mut state = 1_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let (mut time, mut q, mut tau) = (Vec::new(), Vec::new(), Vec::new());
    for sample in 0..SAMPLES {
        let at = sample as f64 / FREQUENCY;
        let [angle, velocity, acceleration] = motion(at);
        time.push(at);
        q.push(logged(angle));
        tau.push(
            0.05 * acceleration
                + 9.81 * 0.12 * angle.cos()
                + 0.02 * velocity
                + 0.3 * velocity.signum()
                + 0.02 * noise(),
        );
    }
    let arrays = [("time", &time), ("q", &q), ("tau", &tau)];
    let arrays = arrays.map(|(name, values)| Array {
        name,
        shape: (SAMPLES, 1),
        values,
    });
    robot.log_of_arrays("run", &arrays, false)
}

fn robot(rows: &str) -> Robot {
    Robot::from_text("arm.toml", &format!("{ARM}{rows}\n")).expect("a robot")
}

fn identified(robot: &Robot, log: Log) -> Identification {
    let identifier = Identifier::new(robot);
    let logs = [log];
    identifier.runs(&logs).run().expect("a result")
}

/// Estimated inertia of a result with the verdict to use it.
fn inertia(result: &Identification) -> f64 {
    assert_eq!(result.grade(), Grade::Use, "{:?}", result.warnings);
    let all = result.estimates[0].parameters.iter();
    let mut own = all.filter(|one| one.name.starts_with("zz"));
    own.next().expect("an inertia").value
}

#[test]
fn continuous_and_wrapped_angles_give_the_same_parameters() {
    let rounded = |angle: f64| (angle * 1e5).round() / 1e5;
    let plain = robot("");
    let counted = identified(&plain, log(&plain, rounded).expect("a log"));
    assert!((inertia(&counted) - 0.05).abs() < 5e-4);
    let wrapped = |angle: f64, turn: f64| angle.rem_euclid(turn);
    // Around zero, in degrees, in turns, of a motor with a gear and of its encoder.
    let gear = "position_scale = 9.587379924285257e-6";
    let cases: [(&str, &dyn Fn(f64) -> f64); 5] = [
        ("", &|angle| rounded(wrapped(angle + PI, TAU) - PI)),
        ("position_scale = \"1 deg\"", &|angle| {
            rounded(wrapped(angle.to_degrees(), 360.0))
        }),
        ("position_scale = 6.283185307179586", &|angle| {
            wrapped(angle / TAU, 1.0)
        }),
        ("position_scale = 0.1", &|angle| {
            rounded(wrapped(10.0 * angle, TAU))
        }),
        (gear, &|angle| {
            wrapped((angle * 10.0 * 65536.0 / TAU).round(), 65536.0)
        }),
    ];
    for (rows, logged) in cases {
        let robot = robot(rows);
        let log = log(&robot, logged).expect(rows);
        assert!(log.is_unwrapped(), "{rows}");
        let note = log.note().expect("a note").to_owned();
        assert!(note.contains("`q` was logged within one turn"), "{note}");
        let found = inertia(&identified(&robot, log));
        assert!((found - 0.05).abs() < 5e-4, "{rows}: {found}");
    }
}

#[test]
fn degrees_read_as_radians_are_not_unwrapped() {
    let plain = robot("");
    let log = log(&plain, f64::to_degrees).expect("a log");
    let result = identified(&plain, log);
    assert_eq!(result.grade(), Grade::DoNotUse);
    let found = |kind| {
        let mut checks = result.checks.iter();
        checks.any(|one| one.kind == kind && !one.passed)
    };
    assert!(found(CheckKind::Degrees), "{:?}", result.warnings);
}

#[test]
fn prismatic_positions_are_not_unwrapped() {
    let slide = ARM.replace("type = \"revolute\"", "type = \"prismatic\"");
    let slide = Robot::from_text("slide.toml", &slide).expect("a robot");
    let log = log(&slide, |angle| angle.rem_euclid(TAU)).expect("a log");
    assert!(!log.is_unwrapped());
}

#[test]
fn half_a_turn_between_two_samples_is_rejected() {
    let plain = robot("");
    // A hundred times as fast: nearly half a turn between some samples.
    let fast = |angle: f64| (100.0 * angle).rem_euclid(TAU);
    let error = log(&plain, fast).expect_err("a direction that is not known");
    let error = &error.problems()[0].message;
    assert!(error.contains("its direction is unknown"), "{error}");
}
