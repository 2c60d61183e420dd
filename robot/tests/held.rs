//! Held parameters: bodies that keep their prior values while the others are identified.

use overact_identification::{Estimate, Estimator, Identification, Log, Stage};
use overact_robot::{Identifier, Robot};
use std::collections::BTreeMap;

/// A vertical arm of two joints.
const ARM: &str = r#"
name = "Arm"
gravity = [0, "-9.81 m/s^2", 0]

[[leg.arm.joint]]
name = "shoulder"
type = "revolute"
actuated = true
parameters = ["inertia", "ia", "fv", "fs"]

[[leg.arm.joint]]
name = "elbow"
type = "revolute"
d = "0.4 m"
actuated = true
parameters = ["zz", "mx", "my", "m", "ia", "fv", "fs"]

[[place]]
name = "arm"
shape = "arm"

[experiment]
sampling = "1 kHz"
duration = "10 s"
bandwidth = "20 Hz"
encoder = 1e-5
torque_noise = [0.3, 0.1]

[experiment.parameters]
zz_shoulder = 0.9
mx_shoulder = 2.4
ia_shoulder = 0.3
fv_shoulder = 2
fs_shoulder = 1.5
m_elbow = 3
mx_elbow = 0.6
zz_elbow = 0.15
ia_elbow = 0.1
fv_elbow = 0.5
fs_elbow = 0.6

[[experiment.run]]
name = "training"
fundamental = "0.2 Hz"
terms = [
  { coordinate = "shoulder", harmonic = 1, amplitude = 0.8 },
  { coordinate = "shoulder", harmonic = 4, amplitude = 0.3, phase = 1 },
  { coordinate = "elbow", harmonic = 2, amplitude = 0.9, phase = 2 },
  { coordinate = "elbow", harmonic = 5, amplitude = 0.3 },
]

[[experiment.run]]
name = "validation"
validation = true
fundamental = "0.3 Hz"
terms = [
  { coordinate = "shoulder", harmonic = 1, amplitude = 0.6 },
  { coordinate = "elbow", harmonic = 2, amplitude = 0.7, phase = 2 },
]
"#;

/// The elbow's body and rotor with their true values.
const ELBOW: &str = r#"
[prior]
held = ["elbow", "ia_elbow"]

[prior.values]
zz_elbow = 0.15
mx_elbow = 0.6
my_elbow = 0
m_elbow = 3
ia_elbow = 0.1
"#;

fn robot(text: &str) -> Robot {
    Robot::from_text("arm.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs of the arm with free parameters: training and validation.
fn logs() -> (Vec<Log>, Vec<Log>) {
    let robot = robot(ARM);
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    (runs.identified, runs.validation)
}

fn identified(text: &str) -> Identification {
    let robot = robot(text);
    let (runs, validation) = logs();
    let identifier = Identifier::new(&robot).runs(&runs).validation(&validation);
    identifier.run().unwrap_or_else(|error| panic!("{error}"))
}

fn base(found: &Identification) -> &Estimate {
    let is_base =
        |one: &&Estimate| one.estimator == Estimator::LeastSquares && one.stage == Stage::Base;
    found.estimates.iter().find(is_base).expect("an estimate")
}

#[test]
fn held_parameters_are_kept_and_the_others_identified() {
    let found = identified(&(ARM.to_owned() + ELBOW));
    let truth: BTreeMap<&str, f64> = [
        // Only sums with the rotor act, and the elbow is known.
        ("zz_shoulderR", 0.9 + 0.3),
        ("mx_shoulder", 2.4),
        ("my_shoulder", 0.0),
        ("fv_shoulder", 2.0),
        ("fs_shoulder", 1.5),
        ("fv_elbow", 0.5),
        ("fs_elbow", 0.6),
    ]
    .into();
    let estimate = base(&found);
    let names: Vec<&str> = estimate
        .parameters
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    assert_eq!(estimate.parameters.len(), truth.len(), "{names:?}");
    for one in &estimate.parameters {
        let expected = truth[one.name.as_str()];
        let scale = 4.0 * one.correlated_standard_deviation + 1e-3;
        let error = (one.value - expected).abs();
        assert!(
            error < scale,
            "{}: {} {expected} ± {scale}",
            one.name,
            one.value
        );
    }
    let whole = &found.consistent[0];
    for (name, value) in [("m_elbow", 3.0), ("mx_elbow", 0.6), ("ia_elbow", 0.1)] {
        let own = whole.parameters.iter().find(|one| one.name == name);
        assert_eq!(own.map(|own| own.value), Some(value), "{name}");
    }
    assert!(
        found
            .assumptions
            .iter()
            .any(|one| one.contains("5 parameters are held"))
    );
}

#[test]
fn residuals_refer_to_the_measured_torques() {
    let free = identified(ARM);
    let held = identified(&(ARM.to_owned() + ELBOW));
    for (a, b) in base(&free).lines.iter().zip(&base(&held).lines) {
        assert!(
            (a.measured_norm / b.measured_norm - 1.0).abs() < 1e-9,
            "{a:?} {b:?}"
        );
        assert!(b.relative_error_percent < 1.05 * a.relative_error_percent + 0.1);
    }
    for (a, b) in free.cross_validation.iter().zip(&held.cross_validation) {
        for (a, b) in a
            .lines
            .iter()
            .chain(&a.torques)
            .zip(b.lines.iter().chain(&b.torques))
        {
            assert!(
                (a.measured_norm / b.measured_norm - 1.0).abs() < 1e-9,
                "{a:?} {b:?}"
            );
        }
    }
}

#[test]
fn a_wrong_held_value_increases_the_residual() {
    let wrong = (ARM.to_owned() + ELBOW).replace("mx_elbow = 0.6\nmy", "mx_elbow = 1.2\nmy");
    let (right, wrong) = (identified(&(ARM.to_owned() + ELBOW)), identified(&wrong));
    let [right, wrong] = [right, wrong].map(|one| base(&one).relative_error_percent);
    assert!(wrong > 5.0 * right, "{right} {wrong}");
}

#[test]
fn invalid_lists_of_held_parameters_are_rejected() {
    let refused = |held: &str, values: &str, words: &str| {
        let text = format!("{ARM}\n[prior]\nheld = {held}\n[prior.values]\n{values}\n");
        let error = Robot::from_text("arm.toml", &text).err();
        let text = error.map(|error| error.to_string()).unwrap_or_default();
        assert!(text.contains(words), "no `{words}` in\n{text}");
    };
    refused("[\"elbov\"]", "", "no body or parameter `elbov`");
    refused(
        "[\"elbow\"]",
        "m_elbow = 1",
        "lacks `zz_elbow`, `mx_elbow`, `my_elbow`",
    );
    refused("[\"ia_elbow\"]", "", "`ia_elbow` is held, but has no value");
    refused("[\"fs_elbow\"]", "fs_elbow = 1", "friction");
    refused(
        "[\"m_elbow\"]",
        "m_elbow = 1",
        "one of the parameters of a body",
    );
    refused("[\"ia_elbow\", \"ia_elbow\"]", "ia_elbow = 1", "held twice");
    refused("\"elbow\"", "", "list");
    let robot = robot(&(ARM.to_owned() + ELBOW));
    let (runs, _) = logs();
    let gears = Identifier::new(&robot)
        .runs(&runs)
        .gear_friction(true)
        .run();
    let text = gears.expect_err("refused").to_string();
    assert!(text.contains("parameters are not held if"), "{text}");
}
