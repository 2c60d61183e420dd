//! Payloads on bodies of a robot with loops, from description to identification.

use overact_identification::{Estimator, Stage};
use overact_robot::{Identifier, Robot};
use std::path::Path;

/// The five-bar with a weight on each arm, each in one of two more runs.
fn bar() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/five_bar.toml");
    let text = std::fs::read_to_string(path).expect("the description");
    let runs: Vec<&str> = text.split("[[experiment.run]]").collect();
    let [head, first, second] = runs[..] else {
        panic!("two runs")
    };
    let head = head.replace(
        "[experiment.parameters]\n",
        "[experiment.parameters]\nm_payload_weight = 0.4\nzz_payload_plate = 0.003\n\
         mx_payload_plate = 0.02\nm_payload_plate = 0.25\n",
    );
    let loaded = |name: &str, run: &str, payload: &str| {
        let run = run.replacen("name = \"", &format!("name = \"{name} "), 1);
        format!("[[experiment.run]]\npayload = \"{payload}\"{run}")
    };
    [
        head,
        "[payload.weight]\nbody = \"left.1\"\nat = [\"0.2 m\", 0, 0]\nparameters = [\"m\"]\n\
         [payload.plate]\nbody = \"right.2\"\nat = [\"0.1 m\", \"0.02 m\", 0]\n\
         rotation = [0, 0, \"30 deg\"]\nparameters = [\"zz\", \"mx\", \"m\"]\n"
            .to_owned(),
        format!("[[experiment.run]]{first}[[experiment.run]]{second}"),
        loaded("weight", first, "weight"),
        loaded("plate", second, "plate"),
    ]
    .concat()
}

#[test]
fn payloads_on_two_bodies_are_identified() {
    let text = bar();
    let robot = Robot::from_text("bar.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let result = Identifier::new(&robot).data(&runs).run();
    let result = result.unwrap_or_else(|error| panic!("{error}"));
    let mut estimates = result.estimates.iter();
    let base = estimates
        .find(|one| one.estimator == Estimator::LeastSquares && one.stage == Stage::Base)
        .expect("an estimate");
    let mut seen = 0;
    for own in &base.parameters {
        let truth = own.true_value.expect("a true value");
        let off = (own.value - truth).abs() / own.correlated_standard_deviation;
        println!(
            "{:18} {:9.5}, true {truth:9.5}: {off:.1}",
            own.name, own.value
        );
        assert!(off < 4.5, "{}: {off:.1} standard deviations", own.name);
        seen += usize::from(own.name.contains("_payload_"));
    }
    // The weight's mass, and three parameters of the plate.
    assert_eq!(seen, 4, "{:?}", base.parameters);
}
