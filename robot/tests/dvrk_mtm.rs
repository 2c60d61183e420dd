//! Measured master arm of the dVRK, with a parallelogram, a tendon, a spring and a known cable
//! torque.
//!
//! The errors are compared with the published identification. Processing is the same, except that
//! the columns pass the torques' low-pass filter, too.

use overact_identification::Stage;
use overact_robot::{Identifier, Robot};
use overact_tier::is_full;
use std::path::{Path, PathBuf};

/// Published errors of the test run by weighted least squares, percent, by joint.
const PUBLISHED: [f64; 7] = [8.2, 16.3, 19.1, 20.9, 26.3, 23.5, 34.0];
/// Their published mean.
const MEAN: f64 = 21.2;
/// The published mean of physically consistent parameters.
const CONSISTENT_MEAN: f64 = 21.0;
/// The smaller of both for each joint.
const BEST_PUBLISHED: [f64; 7] = [7.7, 14.9, 17.0, 20.9, 26.3, 23.4, 34.0];
/// Tolerance factor on the smaller one: joint 5 is a tenth of a percent above.
const TOLERANCE_FACTOR: f64 = 1.01;
/// Number of base parameters, with the spring and the rotor of motor 4.
const BASE: usize = 73;

/// Training and test run in the folder of reference data: `OVERACT_SHARED`, or `shared` next to the
/// repository.
fn files() -> Option<[PathBuf; 2]> {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let files = ["one", "two"].map(|run| folder.join(format!("data/dvrk_mtm/{run}_results.csv")));
    if files.iter().all(|file| file.exists()) {
        return Some(files);
    }
    eprintln!("skipped: the dVRK MTM data are not here; set OVERACT_SHARED to their folder");
    None
}

#[test]
fn the_test_run_is_predicted_as_published() {
    // All samples of two runs with 73 unknowns take seconds.
    if !is_full() {
        eprintln!("skipped: a test of the full tier");
        return;
    }
    let Some([training, test]) = files() else {
        return;
    };
    let toml = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/dvrk_mtm.toml");
    let robot = Robot::from_toml(toml).expect("a robot");
    let logs = robot
        .read_logs(&[(&training, false), (&test, false)], &|_| {})
        .expect("two logs");
    let (runs, held_out) = logs.split_at(1);
    let identifier = Identifier::new(&robot).runs(runs).validation(held_out);
    let result = identifier.run().expect("a result");
    let base = &result.estimates[0];
    assert_eq!((base.stage, base.parameters.len()), (Stage::Base, BASE));
    let mut parameters = base.parameters.iter();
    let stiffness = parameters.find(|one| one.name == "k_5").expect("a spring");
    assert_eq!(stiffness.unit, "N/m");
    // The published bounds.
    assert!((250.0..300.0).contains(&stiffness.value), "{stiffness:?}");
    let held_out = |stage: Stage| {
        let mut all = result.cross_validation.iter();
        let output = all.find(|one| one.stage == stage);
        &output.expect("a cross-validation").torques
    };
    let errors = |stage: Stage| -> Vec<f64> {
        let torques = held_out(stage).iter();
        torques.map(|one| one.relative_error_percent).collect()
    };
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    let own = errors(Stage::Base);
    for (error, published) in own.iter().zip(PUBLISHED) {
        assert!(*error < 1.15 * published, "{own:?}");
    }
    assert!(mean(&own) <= MEAN, "{own:?}");
    let counted = held_out(Stage::Base).iter().map(|one| one.equations);
    assert_eq!(counted.collect::<Vec<_>>(), [2000; 7]);
    // Physically consistent parameters predict at least as well.
    let consistent = errors(Stage::Consistent);
    assert!(mean(&consistent) <= CONSISTENT_MEAN, "{consistent:?}");
    let both = own.iter().zip(&consistent).zip(BEST_PUBLISHED);
    for ((own, consistent), published) in both {
        assert!(
            own.min(*consistent) < TOLERANCE_FACTOR * published,
            "{published}"
        );
    }
    println!(
        "{own:.1?} {:.2}, {consistent:.1?} {:.2}",
        mean(&own),
        mean(&consistent)
    );
    let bodies = result.consistent[0].bodies.iter();
    assert!(bodies.clone().count() == 9 && bodies.clone().all(|body| body.definiteness > 0.0));
}
