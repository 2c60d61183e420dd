//! Reasons of a verdict name the cause, not what resembles it.

use overact_identification::{Grade, Identification, Log};
use overact_robot::{Identifier, Robot};

/// A SCARA arm whose quill travels 45 mm.
const SCARA: &str = r#"
name = "Scara"
gravity = [0, 0, "-9.81 m/s^2"]

[leg.arm]

[[leg.arm.joint]]
type = "revolute"
actuated = true

[[leg.arm.joint]]
type = "revolute"
d = "0.3 m"
actuated = true

[[leg.arm.joint]]
name = "quill"
type = "prismatic"
d = "0.25 m"
actuated = true

[[leg.arm.joint]]
name = "wrist"
type = "revolute"
actuated = true

[[place]]
name = "arm"
shape = "arm"
"#;

/// Its virtual experiment, which a description for a measured log lacks.
const EXPERIMENT: &str = r#"
[experiment]
sampling = "1 kHz"
duration = "10 s"
bandwidth = "20 Hz"
encoder = [1e-5, 1e-5, 1e-6, 2e-5]
torque_noise = [0.1, 0.05, 0.3, 0.01]

[experiment.parameters]
zz_1 = 0.4
zz_2 = 0.15
mx_2 = 0.6
m_quill = 2.5
mx_wrist = 0.01
zz_wrist = 0.004
m_wrist = 0.5
fv_1 = 1.2
fs_1 = 1.5
fv_2 = 0.6
fs_2 = 0.8
fv_quill = 20
fs_quill = 4
fv_wrist = 0.02
fs_wrist = 0.05

[[experiment.run]]
name = "a"
fundamental = "0.2 Hz"
terms = [
  { coordinate = "1", harmonic = 2, amplitude = 0.6 },
  { coordinate = "1", harmonic = 5, amplitude = 0.2, phase = 1 },
  { coordinate = "2", harmonic = 3, amplitude = 0.6, phase = 2 },
  { coordinate = "2", harmonic = 4, amplitude = 0.3 },
  { coordinate = "quill", harmonic = 4, amplitude = "15 mm" },
  { coordinate = "quill", harmonic = 7, amplitude = "7.5 mm", phase = 1 },
  { coordinate = "wrist", harmonic = 3, amplitude = 0.8, phase = 1 },
  { coordinate = "wrist", harmonic = 7, amplitude = 0.4 },
]
"#;

/// Identification without the experiment's table, from a run with other positions and torques.
fn identified(change: impl Fn(usize, &mut f64, &mut f64)) -> Identification {
    let whole = Robot::from_text("scara.toml", &format!("{SCARA}{EXPERIMENT}"));
    let whole = whole.expect("a robot");
    let runs = whole
        .experiment()
        .expect("an experiment")
        .runs(&[], &|_, _| {});
    let run = runs.expect("runs").identified.remove(0);
    let n = run.actuators();
    let (mut positions, mut torques) = run.load().expect("numbers");
    for (place, (position, torque)) in positions.iter_mut().zip(&mut torques).enumerate() {
        change(place % n, position, torque);
    }
    let frequency = run.sampling_frequency();
    let log = Log::new("a.csv", frequency, n, positions, torques, false).expect("a run");
    let robot = Robot::from_text("scara.toml", SCARA).expect("a robot");
    Identifier::new(&robot)
        .runs(&[log])
        .run()
        .expect("a result")
}

#[test]
fn a_prismatic_joint_in_millimetres_is_detected() {
    let clean = identified(|_, _, _| {});
    assert_eq!(clean.grade(), Grade::Use);
    let result = identified(|drive, position, _| {
        if drive == 2 {
            *position *= 1000.0;
        }
    });
    assert_eq!(result.grade(), Grade::DoNotUse);
    let reasons = result.verdicts[0].reasons.join("\n");
    assert!(reasons.contains("are the positions in mm?"), "{reasons}");
}

#[test]
fn a_torque_in_millinewton_metres_is_not_called_crosstalk() {
    let result = identified(|drive, _, torque| {
        if drive == 1 {
            *torque *= 1000.0;
        }
    });
    let reasons = result.verdicts[0].reasons.join("\n");
    assert!(reasons.contains("about 0.001 times as large"), "{reasons}");
    assert!(!reasons.contains("contains up to"), "{reasons}");
}

#[test]
fn two_dead_encoders_are_not_reported_as_duplicate_columns() {
    let result = identified(|drive, position, _| {
        if drive == 1 || drive == 3 {
            *position = 0.0;
        }
    });
    let reasons = result.verdicts[0].reasons.join("\n");
    assert!(reasons.contains("its encoder is dead"), "{reasons}");
    assert!(!reasons.contains("used twice"), "{reasons}");
}

/// Reasons of the verdict on a short run of the five-bar with other positions and torques.
fn reasons_of_five_bar(change: impl Fn(usize, &mut f64, &mut f64)) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/five_bar.toml");
    let text = std::fs::read_to_string(path).expect("the library");
    let text = text.replacen("duration = \"10 s\"", "duration = \"3 s\"", 1);
    let robot = Robot::from_text("five_bar.toml", &text).expect("a robot");
    let runs = robot.experiment().expect("an experiment");
    let runs = runs.runs(&[], &|_, _| {}).expect("runs").identified;
    let changed = runs.into_iter().map(|run| {
        let n = run.actuators();
        let (mut positions, mut torques) = run.load().expect("numbers");
        for (place, (position, torque)) in positions.iter_mut().zip(&mut torques).enumerate() {
            change(place % n, position, torque);
        }
        let (name, frequency) = (run.name(), run.sampling_frequency());
        Log::new(name, frequency, n, positions, torques, false).expect("a run")
    });
    let logs: Vec<Log> = changed.collect();
    let result = Identifier::new(&robot).runs(&logs).run().expect("a result");
    assert_eq!(result.grade(), Grade::DoNotUse);
    result.verdicts[0].reasons.join("\n")
}

/// The residual is the same with the other drive reversed, but friction would then drive the joints.
#[test]
fn the_reversed_drive_of_two_is_detected() {
    for (drive, name) in ["left", "right"].into_iter().enumerate() {
        let reasons = reasons_of_five_bar(|place, _, torque| {
            if place == drive {
                *torque = -*torque;
            }
        });
        let expected = format!("the torque of `{name}` looks reversed");
        assert!(reasons.contains(&expected), "{reasons}");
    }
}

#[test]
fn a_factor_between_two_drives_is_reported_for_both() {
    let reasons = reasons_of_five_bar(|place, _, torque| {
        if place == 0 {
            *torque *= 1e-3;
        }
    });
    assert!(reasons.contains("1000 times"), "{reasons}");
    assert!(reasons.contains("or that of"), "{reasons}");
    assert!(
        ["`left`", "`right`"]
            .iter()
            .all(|name| reasons.contains(name)),
        "{reasons}"
    );
}

#[test]
fn positions_of_one_drive_in_turns_are_detected() {
    let reasons = reasons_of_five_bar(|place, position, _| {
        if place == 0 {
            *position /= std::f64::consts::TAU;
        }
    });
    assert!(reasons.contains("`left`"), "{reasons}");
    assert!(reasons.contains("turns"), "{reasons}");
}
