//! Stribeck velocities from logs of virtual robots whose descriptions start from other velocities.

use overact_identification::{Identification, Log, StribeckVelocity};
use overact_robot::{Identifier, Robot};
use overact_tier::{by_tier, drawn};

/// A vertical arm of two joints that move slowly and reverse often.
const ARM: &str = r#"
name = "Arm"
gravity = [0, "-9.81 m/s^2", 0]

[leg.arm]

[[leg.arm.joint]]
name = "shoulder"
type = "revolute"
actuated = true
stribeck = "SHOULDER rad/s"
parameters = ["inertia", "ia", "fv", "fs", "off"]

[[leg.arm.joint]]
name = "elbow"
type = "revolute"
d = "0.4 m"
actuated = true
stribeck = "ELBOW rad/s"
parameters = ["inertia", "ia", "fv", "fs", "off"]

[[place]]
name = "arm"
shape = "arm"

[experiment]
sampling = "1 kHz"
duration = "20 s"
bandwidth = "20 Hz"
encoder = 1e-6
torque_noise = [0.1, 0.05]

[experiment.parameters]
zz_shoulder = 0.9
mx_shoulder = 2.4
m_elbow = 3
mx_elbow = 0.6
zz_elbow = 0.15
ia_shoulder = 0.3
ia_elbow = 0.1
fv_shoulder = 2
fs_shoulder = 1.5
fst_shoulder = 1.2
fv_elbow = 0.5
fs_elbow = 0.6
fst_elbow = 0.5

[[experiment.run]]
name = "training"
fundamental = "0.1 Hz"
terms = [
  { coordinate = "shoulder", harmonic = 1, amplitude = 0.8 },
  { coordinate = "shoulder", harmonic = 4, amplitude = 0.3, phase = 1 },
  { coordinate = "elbow", harmonic = 2, amplitude = 0.9, phase = 2 },
  { coordinate = "elbow", harmonic = 5, amplitude = 0.3 },
]
"#;

/// Velocities of the virtual arm, rad/s.
const TRUTH: [f64; 2] = [0.12, 0.3];

/// The arm with these velocities and this seed of its noise.
fn arm(velocities: [f64; 2], seed: u64) -> Robot {
    let text = ARM.replace("[experiment]\n", &format!("[experiment]\nseed = {seed}\n"));
    let text = text.replace("SHOULDER", &velocities[0].to_string());
    let text = text.replace("ELBOW", &velocities[1].to_string());
    Robot::from_text("arm.toml", &text).expect("a robot")
}

fn runs(robot: &Robot) -> Vec<Log> {
    let experiment = robot.experiment().expect("an experiment");
    experiment.runs(&[], &|_, _| {}).expect("runs").identified
}

fn identified(robot: &Robot, logs: &[Log]) -> Identification {
    let identifier = Identifier::new(robot).runs(logs).stribeck_velocity(true);
    identifier.run().expect("a result")
}

fn interval(result: &Identification, parameter: &str) -> [f64; 2] {
    let mut all = result.estimates[0].parameters.iter();
    let own = all.find(|one| one.name == parameter).expect(parameter);
    own.interval_95
}

fn contains([low, high]: [f64; 2], value: f64) -> bool {
    low <= value && value <= high
}

#[test]
fn intervals_of_velocities_and_friction_cover_the_truth() {
    let (mut inside, mut all) = ([0; 2], [0; 2]);
    for seed in 1..=drawn([2, 10, 50]) {
        let logs = runs(&arm(TRUTH, seed));
        let result = identified(&arm([0.05, 0.7], 0), &logs);
        for (joint, truth) in result.stribeck_velocities.iter().zip(TRUTH) {
            let found = joint.estimate.expect("a determined velocity");
            assert!((found.value / truth - 1.0).abs() < 0.2, "{joint:?}");
            assert_eq!(joint.unit, "rad/s");
            inside[0] += usize::from(contains(found.interval_95, truth));
            all[0] += 1;
        }
        let friction = [
            ("fs_shoulder", 1.5),
            ("fst_shoulder", 1.2),
            ("fs_elbow", 0.6),
            ("fst_elbow", 0.5),
        ];
        for (parameter, truth) in friction {
            inside[1] += usize::from(contains(interval(&result, parameter), truth));
            all[1] += 1;
        }
    }
    println!("{inside:?} of {all:?} intervals contain the true velocity or friction");
    for (inside, all) in inside.iter().zip(all) {
        assert!(inside * 10 >= all * by_tier([5, 8]), "{inside} of {all}");
    }
}

#[test]
fn friction_is_wrong_with_a_wrong_velocity_alone() {
    let logs = runs(&arm(TRUTH, 1));
    let robot = arm([0.05, 0.7], 0);
    let plain = Identifier::new(&robot).runs(&logs).run().expect("a result");
    assert!(!contains(interval(&plain, "fst_elbow"), 0.5));
    let found = identified(&robot, &logs);
    let errors = [&found, &plain].map(|one| one.estimates[0].relative_error_percent);
    assert!(errors[0] < errors[1], "{errors:?}");
}

#[test]
fn velocities_without_effect_are_not_determined() {
    let text = ARM
        .replace("fst_shoulder = 1.2\n", "")
        .replace("fst_elbow = 0.5\n", "");
    let text = text.replace("SHOULDER", "0.1").replace("ELBOW", "0.1");
    let robot = Robot::from_text("arm.toml", &text).expect("a robot");
    let result = identified(&robot, &runs(&robot));
    let is_open = |joint: &StribeckVelocity| joint.estimate.is_none() && joint.described == 0.1;
    let velocities = &result.stribeck_velocities;
    assert!(velocities.iter().all(is_open), "{velocities:?}");
    let warning = "the Stribeck velocity of `fst_shoulder` is not determined and stays 0.1";
    assert!(
        result.warnings[0].starts_with(warning),
        "{:?}",
        result.warnings
    );
}

#[test]
fn stribeck_velocities_need_stribeck_friction_and_no_other_correction() {
    let refused = |text: &str, words: &str| {
        let error = Robot::from_text("arm.toml", text).expect_err(words);
        assert!(error.to_string().contains(words), "{error}");
    };
    let with = |more: &str| {
        let text = ARM.replace("SHOULDER", "0.1").replace("ELBOW", "0.1");
        format!("{text}\n[identification]\nstribeck_velocity = true\n{more}")
    };
    refused(
        &with("gear_friction = true\n"),
        "Stribeck velocities are not identified together with",
    );
    let without = ["SHOULDER", "ELBOW"]
        .iter()
        .fold(ARM.to_owned(), |text, joint| {
            text.replace(&format!("stribeck = \"{joint} rad/s\"\n"), "")
        });
    let without = without
        .replace("fst_shoulder = 1.2\n", "")
        .replace("fst_elbow = 0.5\n", "");
    let plain = Robot::from_text("arm.toml", &without).expect("a robot");
    let text = format!("{without}\n[identification]\nstribeck_velocity = true\n");
    refused(&text, "no joint or motor has Stribeck friction");
    let error = Identifier::new(&plain).stribeck_velocity(true).run();
    let error = error.expect_err("an identification without Stribeck friction");
    assert!(error.to_string().contains("no joint or motor"), "{error}");
    assert!(Robot::from_text("arm.toml", &with("")).is_ok());
}
