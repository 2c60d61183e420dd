//! The EMPS benchmark, simulated in closed loop with its known controller.

use overact_identification::{Estimator, Stage};
use overact_robot::{Identifier, Robot};
use std::path::{Path, PathBuf};

/// The benchmark's file in the folder of reference data: `OVERACT_SHARED`, or `shared` next to the
/// repository.
fn file() -> Option<PathBuf> {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let file = folder.join("data/emps/DATA_EMPS.mat");
    if file.exists() {
        return Some(file);
    }
    eprintln!("skipped: the EMPS data are not here; set OVERACT_SHARED to their folder");
    None
}

#[test]
fn simulated_instruments_agree_with_least_squares() {
    let Some(file) = file() else {
        return;
    };
    let toml = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/emps.toml");
    let robot = Robot::from_toml(toml).expect("a robot");
    let logs = robot.read_logs(&[(&file, false)], &|_| {}).expect("a log");
    let result = Identifier::new(&robot).runs(&logs).run().expect("a result");
    let output = &result.errors_in_regressor[0];
    println!("{output:#?}");
    // Published: 5.848 %.
    let error = output.simulated[0].torque_error_percent;
    assert!((5.0..6.0).contains(&error), "{error}");
    let agreement = output.agreement.as_ref().expect("a test");
    assert!(agreement.weakest > 1e4, "{agreement:?}");
    let [least, instruments] =
        [Estimator::LeastSquares, Estimator::InstrumentalVariables].map(|how| {
            let mut all = result.estimates.iter();
            let own = all.find(|one| one.stage == Stage::Base && one.estimator == how);
            own.expect("an estimate")
        });
    // Least squares as without instruments; instrumental variables within one percent, as
    // published.
    let printed: Vec<String> = least
        .parameters
        .iter()
        .map(|one| format!("{:.4}", one.value))
        .collect();
    assert_eq!(printed, ["95.1089", "203.5034", "20.3935", "-3.1648"]);
    for (a, b) in least.parameters.iter().zip(&instruments.parameters) {
        assert_eq!(a.name, b.name);
        let half = 0.5 * (a.interval_95[1] - a.interval_95[0]);
        assert!((a.value - b.value).abs() < half, "{a:?} {b:?}");
    }
}
