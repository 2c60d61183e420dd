//! Encoder offsets and lengths found from the closure of redundant loops.

use overact::{Function, Model};
use overact_identification::{Calibration, CalibrationScope, Log, ParameterKind};
use overact_robot::Robot;
use std::path::Path;

/// The text of a description of `robots/`.
fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../robots")
        .join(name);
    std::fs::read_to_string(path).expect("a description")
}

fn robot(text: &str) -> Robot {
    Robot::from_text("robot.toml", text).expect("a robot")
}

/// How a run is read: samples, resolution of the encoders and what each shows too much (rad).
#[derive(Debug, Clone, Copy)]
struct Reading {
    samples: usize,
    resolution: f64,
    offsets: [f64; 4],
    seed: u64,
}

const CLEAN: Reading = Reading {
    samples: 800,
    resolution: 1e-5,
    offsets: [0.0; 4],
    seed: 1,
};

/// A run of a robot as its encoders see it: every coordinate of the pose moves about home.
fn run(robot: &Robot, of: Reading) -> Log {
    let model = robot.model();
    let info = model.info();
    let n = info.sizes.actuators;
    let size = [0.05, 0.08, 0.3];
    let mut positions = vec![0.0; of.samples * n];
    for (sample, row) in positions.chunks_exact_mut(n).enumerate() {
        let time = sample as f64 / of.samples as f64;
        let mut pose = info.home_pose.to_vec();
        for (k, (coordinate, size)) in pose.iter_mut().zip(size).enumerate() {
            let wave = |harmonic: usize| {
                let turns = (harmonic * (k + 1)) as f64 * time + 0.3 * (of.seed as f64 + k as f64);
                (std::f64::consts::TAU * turns).sin() / harmonic as f64
            };
            *coordinate += 0.5 * size * (wave(1) + wave(2));
        }
        model
            .evaluate(Function::ActuatorPositions, &[&pose], row)
            .expect("a pose that the robot reaches");
        for (position, offset) in row.iter_mut().zip(of.offsets) {
            *position = ((*position + offset) / of.resolution).round() * of.resolution;
        }
    }
    let torques = vec![0.0; positions.len()];
    Log::new("run", 100.0, n, positions, torques, false).expect("a log")
}

fn calibrated(text: &str, log: Log, scope: CalibrationScope) -> Calibration {
    let robot = robot(text);
    robot.calibrate(&[log], scope).expect("a calibration")
}

/// The names of what is changed, and that each change is within three deviations of the truth.
fn check(found: &Calibration, truth: &[(&str, f64)]) {
    let names: Vec<&str> = found
        .estimated
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let wanted: Vec<&str> = truth.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, wanted, "{found:?}");
    for (one, (name, change)) in found.estimated.iter().zip(truth) {
        let miss = (one.change - change) / one.standard_deviation;
        assert!(
            miss.abs() < 3.0,
            "{name}: {} is off by {miss} σ",
            one.change
        );
        assert!(one.standard_deviation < 0.01 * change.abs(), "{one:?}");
    }
    assert!(
        (0.9..1.1).contains(&found.misfit_after),
        "{}",
        found.misfit_after
    );
}

#[test]
fn a_dualv_tells_an_encoder_offset_and_a_long_link() {
    let described = text("dualv.toml");
    let long = described
        .replace(r#""at", "turn"]"#, r#""at", "turn", "more"]"#)
        .replace(r#"d = "l_ab""#, r#"d = "l_ab + more""#)
        .replace(r#"shape = "arm""#, "shape = \"arm\"\nmore = \"0 m\"")
        .replace(
            "name = \"leg2\"\nshape = \"arm\"\nmore = \"0 m\"",
            "name = \"leg2\"\nshape = \"arm\"\nmore = \"2.8 mm\"",
        );
    let offset = 0.2_f64.to_radians();
    let log = Reading {
        offsets: [0.0, 0.0, offset, 0.0],
        ..CLEAN
    };
    let found = calibrated(
        &described,
        run(&robot(&long), log),
        CalibrationScope::Smallest,
    );
    check(&found, &[("offset_leg3", offset), ("d_2_leg2", 2.8e-3)]);
    assert!(found.misfit_before > 100.0);
    assert_eq!(found.offsets()[..2], [0.0, 0.0]);
    assert_eq!(found.lengths().count(), 1);
    // The calibrated description keeps the author's words and leaves nothing to calibrate.
    let right = robot(&described).calibrated(&found).expect("a description");
    let own = &right.source().text;
    assert!(own.contains("d = \"l_ab + d_2_change\"\n"), "{own}");
    assert!(own.contains("# Table 1. Legs 1, 2 and 3, 4 meet the platform at the same points."));
    assert_eq!(right.mapping().position_offset[..2], [0.0, 0.0]);
    let again = run(&robot(&long), log).without_offsets(&right.mapping().position_offset);
    let again = right.calibrate(&[again], CalibrationScope::Smallest);
    check(&again.expect("a calibration"), &[]);
    // What does not lie in the plane has no effect; a factor of all lengths goes unseen.
    let out_of_plane = found.held.iter().find(|one| one.name == "base_z_leg1");
    let reason = out_of_plane.and_then(|one| one.reason.as_deref());
    assert_eq!(reason, Some("it has no effect on the sensors"));
    assert!(
        found
            .remarks
            .iter()
            .any(|remark| remark.contains("no scale"))
    );
    // A description that is right stays as it is.
    let found = calibrated(
        &described,
        run(&robot(&described), CLEAN),
        CalibrationScope::Smallest,
    );
    check(&found, &[]);
    let offset =
        |one: &&overact_identification::HeldParameter| one.kind == ParameterKind::EncoderOffset;
    assert_eq!(found.held.iter().filter(offset).count(), 4);
}
