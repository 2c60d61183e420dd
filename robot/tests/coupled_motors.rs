//! Motors of a robot with loops that turn joints of several legs, from description to
//! identification.

use overact_identification::{Estimator, Identification, Stage};
use overact_robot::{Identifier, Robot};
use std::path::Path;

/// The five-bar of `robots/`, with these motors in place of its own.
fn bar(motors: &str, kept: &str, values: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/five_bar.toml");
    let text = std::fs::read_to_string(path).expect("the description");
    let text = text.replace("actuated = true", "actuated = false");
    let text = text.replace("kept_actuators = [\"left\", \"right\"]", kept);
    let heading = "[experiment.parameters]\n";
    assert_eq!(text.matches(heading).count(), 1);
    let text = text.replace(heading, &format!("{motors}\n{heading}{values}"));
    // Rotors belong to the motors now.
    let lines = text.lines().filter(|line| !line.starts_with("ia_1_"));
    lines.collect::<Vec<_>>().join("\n")
}

fn identified(text: &str) -> Identification {
    let robot = Robot::from_text("bar.toml", text).unwrap_or_else(|error| panic!("{error}"));
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let found = Identifier::new(&robot).data(&runs).run();
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// Names of the base parameters; all estimates are within a few standard deviations.
fn checked(result: &Identification) -> Vec<String> {
    let estimates = result.estimates.iter();
    let base = estimates
        .filter(|one| one.estimator == Estimator::LeastSquares && one.stage == Stage::Base);
    let mut names = Vec::new();
    for estimate in base {
        for own in &estimate.parameters {
            let truth = own.true_value.expect("a true value");
            let off = (own.value - truth).abs() / own.correlated_standard_deviation;
            println!(
                "{:18} {:9.5} ± {:.5}, true {truth:9.5}",
                own.name, own.value, own.correlated_standard_deviation
            );
            assert!(off < 4.5, "{}: {off:.1} standard deviations", own.name);
            names.push(own.name.clone());
        }
    }
    names
}

#[test]
fn a_differential_is_identified() {
    let motors = "[motor.sum]\nturns = \"(left.q1 + right.q1)/2\"\nratio = 30\n\
                  [motor.difference]\nturns = \"(left.q1 - right.q1)/2\"\nratio = -20\n\
                  parameters = [\"ia\", \"fs\"]\n";
    let text = bar(
        motors,
        "kept_actuators = [\"sum\", \"difference\"]",
        "ia_sum = 0.01\nfv_sum = 0.05\nfs_sum = 0.3\nia_difference = 0.006\nfs_difference = 0.2\n",
    );
    let result = identified(&text);
    let names = checked(&result);
    // Coulomb friction of both motors and of both joints has four different rates.
    for name in ["fs_sum", "fs_difference", "fs_1_left", "fs_1_right"] {
        assert!(names.iter().any(|one| one == name), "{names:?}");
    }
    // Motor-side values, for a gear of the ratio -20.
    let mut parameters = result.estimates[0].parameters.iter();
    let of_gear = parameters.find(|one| one.name == "fs_difference");
    let mut motors = result.motors.iter();
    let of_motor = motors.find(|one| one.name == "fs_difference");
    let (of_gear, of_motor) = (of_gear.expect("a motor"), of_motor.expect("a motor"));
    assert_eq!(of_motor.motor, "difference");
    assert_eq!(of_motor.value, of_gear.value / 20.0);
}

/// Three motors for two degrees of freedom, one of them over the passive elbow.
#[test]
fn a_redundant_belt_is_identified_by_both_projections() {
    let motors = "[motor.left]\nturns = \"left.q1\"\nparameters = [\"ia\"]\n\
                  [motor.right]\nturns = \"right.q1\"\nparameters = [\"ia\"]\n\
                  [motor.belt]\nturns = \"left.q1 + left.q2\"\n";
    let text = bar(
        motors,
        "kept_actuators = [\"belt\", \"right\"]",
        "ia_left = 0.004\nia_right = 0.004\nia_belt = 0.003\nfv_belt = 0.03\nfs_belt = 0.15\n",
    );
    let result = identified(&text);
    let names = checked(&result);
    assert!(
        names.iter().filter(|one| *one == "fs_belt").count() >= 2,
        "{names:?}"
    );
}
