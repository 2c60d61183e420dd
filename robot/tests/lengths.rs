//! Torques of a serial robot reveal a wrong length, although it closes no loop.

use overact_identification::{Check, CheckKind, Identification};
use overact_robot::{Identifier, Robot};

const TEMPLATE: &str = include_str!("../../cli/templates/serial-2r.toml");

/// Identification with the description from the motion of a robot with another upper arm.
fn identified(upper_arm: &str) -> Identification {
    let built = TEMPLATE.replacen("upper_arm = \"0.30 m\"", upper_arm, 1);
    let built = Robot::from_text("built.toml", &built).expect("the robot that is built");
    let robot = Robot::from_text("described.toml", TEMPLATE).expect("the robot as described");
    let experiment = built.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    Identifier::new(&robot).data(&runs).run().expect("a result")
}

#[test]
fn a_wrong_length_of_a_serial_robot_is_detected_with_its_size() {
    let result = identified("upper_arm = \"0.31 m\"");
    for check in &result.checks {
        println!("{:?} {}", check.kind, check.words);
    }
    let of_lengths = |one: &&Check| one.kind == CheckKind::Length;
    let check = result.checks.iter().find(of_lengths).expect("a check");
    assert!(
        !check.passed && check.words.contains("`d_2_arm` is described 0.0"),
        "{}",
        check.words
    );
    assert!(check.words.contains("too small"), "{}", check.words);
}

#[test]
fn a_correct_length_passes() {
    let result = identified("upper_arm = \"0.30 m\"");
    let mut check_words = result.checks.iter().map(|check| check.words.as_str());
    assert!(
        check_words.any(|words| words.contains("no wrong length") && words.contains("`d_2_arm`"))
    );
    assert!(
        result
            .checks
            .iter()
            .all(|check| check.kind != CheckKind::Length)
    );
}
