//! A payload of unknown mass on the last body of a serial robot.

use overact_identification::{Estimator, Stage};
use overact_robot::{Identifier, Robot};
use overact_tier::by_tier;
use std::path::Path;

/// Noise of the torques, as assumed for the measured TX40, N m.
const NOISE: &str = "torque_noise = [0.2, 0.2, 0.1, 0.05, 0.05, 0.02]";

/// Mass of the payload, kg.
const MASS: f64 = 5.0;

/// The RX90 with a payload on its last body, and a second run with the payload.
fn rx90(seed: u64) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/rx90.toml");
    let text = std::fs::read_to_string(path).expect("a description");
    let run = |text: &str| {
        text.match_indices("[[experiment.run]]")
            .map(|(at, _)| at)
            .collect()
    };
    let runs: Vec<usize> = run(&text);
    let loaded = text[runs[0]..runs[1]].replace("\"identification\"", "\"loaded\"\npayload = true");
    let values = format!(
        "[experiment.parameters]\nm_payload = {MASS}\nmx_payload = 0.25\nmy_payload = -0.1\nmz_payload = 0.9\n\
         xx_payload = 0.18\nyy_payload = 0.2\nzz_payload = 0.03\n"
    );
    let payload = "[[leg.arm.joint]]\nname = \"payload\"\ntype = \"fixed\"\n\n[[place]]";
    let replaced = [
        ("[[place]]", payload),
        ("[experiment.parameters]\n", values.as_str()),
        ("torque_noise = [1.0, 1.0, 0.5, 0.2, 0.2, 0.1]", NOISE),
        ("seed = 1", &format!("seed = {seed}")),
        ("decimation = 10", "decimation = 10\nessential = false"),
        // One period of the run, or four.
        (
            "duration = \"20 s\"",
            by_tier(["duration = \"5 s\"", "duration = \"20 s\""]),
        ),
    ];
    let text = replaced.into_iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    text + "\n" + &loaded
}

#[test]
fn payload_mass_of_a_serial_robot_is_identified_within_2_percent() {
    for seed in 1..=by_tier([1, 5]) {
        let robot = Robot::from_text("rx90.toml", &rx90(seed)).expect("a robot");
        let experiment = robot.experiment().expect("an experiment");
        let runs = experiment.runs(&["validation".to_owned()], &|_, _| {});
        let runs = runs.expect("runs");
        let result = Identifier::new(&robot).data(&runs).run().expect("a result");
        let mut base = result
            .estimates
            .iter()
            .filter(|one| one.stage == Stage::Base);
        let estimate = base.find(|one| one.estimator == Estimator::LeastSquares);
        let estimate = estimate.expect("base parameters");
        let mass = estimate.parameters.iter();
        let mass = { mass }
            .find(|one| one.name == "m_payload")
            .expect("the mass by itself");
        println!(
            "seed {seed}: {} ± {} kg",
            mass.value, mass.correlated_standard_deviation
        );
        assert_eq!(mass.true_value, Some(MASS));
        assert!((mass.value / MASS - 1.0).abs() < 0.02, "{mass:?}");
        assert!(mass.correlated_standard_deviation < 0.01 * MASS, "{mass:?}");
    }
}
