//! Springs and known forces on joints of a loop and between points, from description to
//! identification.

use overact_identification::{Estimator, Identification, Stage};
use overact_robot::{Identifier, Robot};
use std::fs;

/// The five-bar with a spring on the passive joints, and a known torque on all joints.
fn sprung() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/five_bar.toml");
    let text = fs::read_to_string(path).expect("the five-bar");
    let edit = |text: String, from: &str, to: &str| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    };
    let text = edit(
        text,
        "actuated = true\n",
        "actuated = true\nknown = \"1.5 N m * cos(q)\"\n",
    );
    let text = edit(
        text,
        "d = \"l_1\"\n",
        "d = \"l_1\"\nspring = \"q - 20 deg\"\nknown = \"0.4 N m * sin(q) + 0.2 N m\"\n",
    );
    edit(
        text,
        "[experiment.parameters]\n",
        "[experiment.parameters]\nk_2_left = 0.8\nk_2_right = 0.5\n",
    )
}

fn identified(robot: &Robot, runs_of: &Robot) -> Identification {
    let experiment = runs_of.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let found = Identifier::new(robot).data(&runs).run();
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// Largest error of a base parameter in standard deviations, and the stiffnesses.
fn errors(result: &Identification) -> (f64, Vec<f64>) {
    let mut estimates = result.estimates.iter();
    let estimate = estimates
        .find(|one| one.estimator == Estimator::LeastSquares && one.stage == Stage::Base)
        .expect("an estimate");
    let (mut worst, mut stiffnesses) = (0.0_f64, Vec::new());
    for own in &estimate.parameters {
        let truth = own.true_value.expect("a true value");
        println!(
            "{:12} {:9.5} ± {:.5}, true {truth:9.5}",
            own.name, own.value, own.correlated_standard_deviation
        );
        worst = worst.max((own.value - truth).abs() / own.correlated_standard_deviation);
        if own.name.starts_with("k_") {
            stiffnesses.push(own.value);
        }
    }
    (worst, stiffnesses)
}

#[test]
fn springs_of_passive_joints_are_identified_with_known_torques() {
    let robot =
        Robot::from_text("sprung.toml", &sprung()).unwrap_or_else(|error| panic!("{error}"));
    let (worst, stiffnesses) = errors(&identified(&robot, &robot));
    assert!(worst < 4.5, "{worst:.1} deviations");
    assert_eq!(stiffnesses.len(), 2);
    for (found, truth) in stiffnesses.iter().zip([0.8, 0.5]) {
        assert!((found - truth).abs() < 0.02, "{found} for {truth}");
    }
}

/// Without the known torques in the description, the same runs give wrong parameters.
#[test]
fn omitted_known_torques_bias_parameters() {
    let text = sprung();
    let known = |line: &&str| !line.starts_with("known");
    let without: Vec<&str> = text.lines().filter(known).collect();
    let [runs_of, robot] = [text.clone(), without.join("\n")].map(|text| {
        Robot::from_text("sprung.toml", &text).unwrap_or_else(|error| panic!("{error}"))
    });
    let (worst, _) = errors(&identified(&robot, &runs_of));
    assert!(worst > 20.0, "{worst:.1} deviations");
}

/// A gas spring of known force and unknown stiffness, and an unknown damper at the tool.
#[test]
fn springs_between_points_are_identified() {
    let springs = "\n[[spring]]\nname = \"gas\"\n\
                   from = { body = \"ground\", at = [\"-0.25 m\", \"0.05 m\", 0] }\n\
                   to = { body = \"left.1\", at = [\"0.12 m\", \"0.01 m\", 0] }\n\
                   force = \"l - 0.12 m\"\nknown = \"15 N\"\n\
                   [[spring]]\nname = \"damper\"\n\
                   from = { body = \"right.1\", at = [\"0.05 m\", \"0.03 m\", 0] }\n\
                   to = { body = \"platform\" }\nforce = \"dl\"\n";
    let values = "[experiment.parameters]\nk_gas = 60\nk_damper = 5\n";
    let text = sprung().replace("[experiment.parameters]\n", values) + springs;
    let robot = Robot::from_text("sprung.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let (worst, found) = errors(&identified(&robot, &robot));
    assert!(worst < 4.5, "{worst:.1} deviations");
    assert_eq!(found.len(), 4);
    let has = |truth: f64| found.iter().any(|one| (one - truth).abs() < 0.05 * truth);
    for truth in [0.8, 0.5, 60.0, 5.0] {
        assert!(has(truth), "{truth} in {found:?}");
    }
}

/// Errors of the five-bar with another table.
fn refused(table: &str) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/five_bar.toml");
    let text = fs::read_to_string(path).expect("the five-bar");
    match Robot::from_text("five_bar.toml", &format!("{text}\n{table}")) {
        Ok(_) => panic!("accepted:\n{table}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_spring_force_undefined_at_home_is_rejected() {
    let text = "[[spring]]\nname = \"root\"\nfrom = { body = \"ground\", at = [\"0.1 m\", \"1 m\", 0] }\nto = { body = \"left.2\", at = [\"0.1 m\", 0, 0] }\nforce = \"sqrt(l^2 - (100 m)^2)\"\n";
    let error = refused(text);
    assert!(
        error.contains("the force of the spring `root` has no value"),
        "{error}"
    );
}

#[test]
fn constants_may_not_shadow_the_length_of_a_spring() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/rx90.toml");
    let text = fs::read_to_string(path).expect("the arm");
    assert_eq!(text.matches("[constants]").count(), 1);
    let text = text.replace("[constants]", "[constants]\nl = \"3 m\"");
    let spring = "[[spring]]\nname = \"s\"\nfrom = { body = \"ground\", at = [\"0.3 m\", 0, 0] }\nto = { body = \"3\", at = [\"0.1 m\", 0, 0] }\nforce = \"l\"\n";
    let error = Robot::from_text("rx90.toml", &format!("{text}\n{spring}")).expect_err("an error");
    let error = error.to_string();
    assert!(
        error.contains("the constant `l` has the name of the length of springs"),
        "{error}"
    );
}
