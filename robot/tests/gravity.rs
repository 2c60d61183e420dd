//! Robots with tilted bases: the gravity direction is identified together with the parameters.

use overact_identification::{Estimator, Identification, Stage};
use overact_robot::{Identifier, Robot, Runs};
use overact_tier::by_tier;
use std::path::Path;

/// Gravity rotated by 2° about y, then by 2° about x, m/s².
fn tilted_gravity() -> [f64; 3] {
    let (sine, cosine) = 2.0_f64.to_radians().sin_cos();
    let [x, z] = [-9.81 * sine, -9.81 * cosine];
    [x, -z * sine, z * cosine]
}

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    std::fs::read_to_string(path.join(name)).expect("a description")
}

fn robot(text: &str) -> Robot {
    Robot::from_text("robot.toml", text).expect("a robot")
}

fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

const GRAVITY_LINE: &str = "gravity = [0, 0, \"-9.81 m/s^2\"]";

/// Runs of a library robot with some gravity and duration (s), and the robot as described.
fn runs(name: &str, gravity: [f64; 3], duration: f64) -> (Robot, Runs) {
    // Only base parameters are compared, so nothing is eliminated.
    let identification = "[identification]\n";
    let base_only = format!("{identification}essential = false\n");
    let described = replaced(&text(name), identification, &base_only);
    let own = replaced(&described, GRAVITY_LINE, &format!("gravity = {gravity:?}"));
    let moved = robot(&own);
    let mut experiment = moved.experiment().expect("an experiment");
    experiment.plan_mut().duration_s = duration;
    let mut held_out = moved.held_out();
    if name == "rx90.toml" {
        held_out = vec![String::from("validation")];
    }
    let runs = experiment.runs(&held_out, &|_, _| {}).expect("runs");
    (robot(&described), runs)
}

fn identified(robot: &Robot, runs: &Runs, direction: bool) -> Identification {
    let identifier = Identifier::new(robot).data(runs);
    let found = identifier.gravity_direction(direction).run();
    found.unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Largest validation error of the base parameters, percent.
fn held_out_error(result: &Identification) -> f64 {
    let own = result.cross_validation.iter();
    let own = own.filter(|one| one.stage == Stage::Base);
    own.map(|one| one.relative_error_percent)
        .fold(0.0, f64::max)
}

/// Asserts that direction and base parameters are right within their standard deviations.
fn check(result: &Identification, gravity: [f64; 3]) {
    let found = result.gravity.as_ref().expect("a direction");
    println!("{found:?}");
    assert!(found.significant);
    assert!(found.tilt_deviation < 0.5_f64.to_radians());
    for ((own, deviation), truth) in found.estimated.iter().zip(found.deviations).zip(gravity) {
        assert!(
            (own - truth).abs() < 3.0 * deviation,
            "{own} ± {deviation}, {truth}"
        );
    }
    let mut estimates = result.estimates.iter();
    let base = estimates
        .find(|one| one.stage == Stage::Base && one.estimator == Estimator::LeastSquares)
        .expect("base parameters");
    let miss = |one: &overact_identification::ParameterEstimate| {
        let truth = one.true_value.expect("a true value");
        ((one.value - truth) / one.correlated_standard_deviation).abs()
    };
    let misses: Vec<f64> = base.parameters.iter().map(miss).collect();
    let far = misses.iter().filter(|own| **own > 3.0).count();
    println!(
        "{} parameters, {far} beyond three deviations, {misses:.1?}",
        misses.len()
    );
    assert!(far * 20 <= misses.len(), "{misses:?}");
    assert!(misses.iter().all(|own| *own < 5.0), "{misses:?}");
}

#[test]
fn the_tilt_of_a_serial_robot_is_identified() {
    let (robot, runs) = runs("rx90.toml", tilted_gravity(), by_tier([5.0, 20.0]));
    let result = identified(&robot, &runs, true);
    check(&result, tilted_gravity());
    // Parameters that rotate with the first joint have an effect only with tilted gravity.
    let has = |name: &str| {
        let mut all = result.base_parameters.iter();
        all.any(|one| one.parameter == name)
    };
    assert!(has("mx_1") && has("my_1"));
    let described = identified(&robot, &runs, false);
    assert!(described.gravity.is_none());
    let errors = [&result, &described].map(held_out_error);
    println!("held out: {errors:?} %");
    assert!(errors[0] < 0.9 * errors[1], "{errors:?}");
    assert!(
        result
            .warnings
            .iter()
            .any(|one| one.contains("gravity = ["))
    );
}

/// For robots with loops, drive offsets and leg masses absorb most of a tilt.
///
/// The direction would be biased by several standard deviations, so it is not identified.
#[test]
fn gravity_direction_of_closed_loop_robots_is_rejected() {
    for name in ["delta.toml", "planar_4prr.toml", "palletiser.toml"] {
        let robot = robot(&text(name));
        let mut runs = robot.experiment().expect("an experiment");
        runs.plan_mut().duration_s = 1.0;
        let runs = runs.runs(&[], &|_, _| {}).expect("runs");
        let found = Identifier::new(&robot).data(&runs).gravity_direction(true);
        let error = found.run().expect_err("loops").render(false);
        assert!(
            error.contains("not supported for robots with loops"),
            "{error}"
        );
    }
}

#[test]
fn an_upright_robot_keeps_its_described_gravity() {
    let (robot, runs) = runs("rx90.toml", [0.0, 0.0, -9.81], 5.0);
    let result = identified(&robot, &runs, true);
    let found = result.gravity.as_ref().expect("a direction");
    println!("{found:?}");
    assert!(!found.significant);
    assert_eq!(found.used(), [0.0, 0.0, -9.81]);
    // Parameters are less certain than with a known direction.
    let known = identified(&robot, &runs, false);
    let deviations = |one: &Identification| -> Vec<f64> {
        let own = one.estimates[0].parameters.iter();
        own.map(|own| own.correlated_standard_deviation).collect()
    };
    let pairs: Vec<(f64, f64)> = deviations(&known)
        .into_iter()
        .zip(deviations(&result))
        .collect();
    assert!(
        pairs
            .iter()
            .all(|(known, own)| own >= &(known * (1.0 - 1e-9)))
    );
    assert!(
        pairs.iter().any(|(known, own)| *own > 1.01 * known),
        "{pairs:?}"
    );
}

#[test]
fn a_gravity_direction_without_information_is_rejected() {
    let robot = robot(&text("emps.toml"));
    let mut experiment = robot.experiment().expect("an experiment");
    experiment.plan_mut().duration_s = 5.0;
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let identifier = Identifier::new(&robot).data(&runs).gravity_direction(true);
    let error = identifier.run().expect_err("no direction").render(false);
    assert!(
        error.contains("is not determined: for any direction"),
        "{error}"
    );
    let both = Identifier::new(&robot)
        .data(&runs)
        .gravity_direction(true)
        .gains(true);
    let error = both.run().expect_err("both").render(false);
    assert!(error.contains("not identified together"), "{error}");
}

#[test]
fn invalid_gravity_keys_are_located() {
    let emps = text("emps.toml");
    let output = |key: &str, more: [&str; 2]| {
        let own = replaced(
            &emps,
            "[identification]\n",
            &format!("[identification]\n{key}\n"),
        );
        let own = own.replace(more[0], more[1]);
        let error = Robot::from_text("robot.toml", &own).expect_err("a wrong key");
        let line = own
            .lines()
            .position(|line| line.contains("gravity_direction"));
        let place = format!("robot.toml:{}:", line.expect("the key") + 1);
        let output = error.render(false);
        assert!(output.contains(&place), "{output}");
        output
    };
    let none = ["", ""];
    let error = output("gravity_direction = \"x\"", none);
    assert!(error.contains("true or false"), "{error}");
    let error = output("gravity_direction = [0, 0]", none);
    assert!(error.contains("true or false"), "{error}");
    let error = output(
        "gravity_direction = true",
        [GRAVITY_LINE, "gravity = [0, 0, 0]"],
    );
    assert!(error.contains("gravity is zero"), "{error}");
    let both = "gravity_direction = true\ngains = true\nknown = { m_1 = 100 }";
    let error = output(both, none);
    assert!(error.contains("not identified together"), "{error}");
    assert_eq!(error.matches("error[").count(), 1, "{error}");
    let error = output("gravity_directions = true", none);
    assert!(error.contains("gravity_direction"), "{error}");
}
