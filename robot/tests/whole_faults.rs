//! Global faults that no single column or drive reveals; the torques do.
//!
//! They are swapped joints, inverted gravity and one column used for two signals.

use overact_identification::{Check, CheckKind, Grade, Identification, Log};
use overact_robot::{Identifier, Robot};
use std::cell::Cell;

const TEMPLATE: &str = include_str!("../../cli/templates/serial-2r.toml");

/// Identification with the description from changed runs of the robot that was built.
fn identified(built: &str, change: impl Fn(&mut [f64], &mut [f64])) -> Identification {
    let built = Robot::from_text("built.toml", built).expect("the robot that is built");
    let robot = Robot::from_text("described.toml", TEMPLATE).expect("the robot as described");
    let experiment = built.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let changed = |log: &Log| {
        let (mut positions, mut torques) = log.load().expect("numbers");
        for row in positions
            .chunks_exact_mut(2)
            .zip(torques.chunks_exact_mut(2))
        {
            change(row.0, row.1);
        }
        let (name, frequency) = (log.name(), log.sampling_frequency());
        Log::new(name, frequency, 2, positions, torques, false).expect("a log")
    };
    let logs: Vec<Log> = runs.identified.iter().map(changed).collect();
    Identifier::new(&robot).runs(&logs).run().expect("a result")
}

/// Messages of the failed checks of a kind, of a result that must not be used.
fn refused(result: &Identification, kind: CheckKind) -> Vec<&str> {
    assert_eq!(result.grade(), Grade::DoNotUse);
    let own = |one: &&Check| one.kind == kind && !one.passed;
    let own = result.checks.iter().filter(own);
    own.map(|one| one.words.as_str()).collect()
}

#[test]
fn exchanged_joints_and_torques_are_detected() {
    let result = identified(TEMPLATE, |positions, torques| {
        positions.swap(0, 1);
        torques.swap(0, 1);
    });
    let words = refused(&result, CheckKind::SwappedColumns).join("\n");
    assert!(words.contains("positions and torques alike"), "{words}");
}

#[test]
fn reversed_gravity_is_detected() {
    let built = TEMPLATE.replacen("\"-9.81 m/s^2\"", "\"9.81 m/s^2\"", 1);
    assert_ne!(built, TEMPLATE);
    let result = identified(&built, |_, _| ());
    let words = refused(&result, CheckKind::WrongSign).join("\n");
    assert!(words.contains("gravity looks reversed"), "{words}");
}

#[test]
fn a_position_column_used_for_two_joints_is_detected() {
    let result = identified(TEMPLATE, |positions, _| {
        positions[1] = 0.1 - positions[0] * 32.0 / 45.0;
    });
    let words = refused(&result, CheckKind::DuplicateColumns).join("\n");
    assert!(words.contains("one column was used twice"), "{words}");
}

#[test]
fn a_torque_in_another_unit_is_detected() {
    let result = identified(TEMPLATE, |_, torques| torques[0] *= 1e3);
    let words = refused(&result, CheckKind::WrongGain).join("\n");
    assert!(words.contains("about 0.001 times as large"), "{words}");
}

/// Failed check of a kind.
fn failed_check(result: &Identification, kind: CheckKind) -> &Check {
    let mut own = result.checks.iter().filter(|one| !one.passed);
    let output = || format!("{:?}", result.warnings);
    own.find(|one| one.kind == kind)
        .unwrap_or_else(|| panic!("{}", output()))
}

#[test]
fn a_gain_that_depends_on_the_torque_sign_is_detected() {
    let result = identified(TEMPLATE, |_, torques| torques[0] += 0.03 * torques[0].abs());
    let check = failed_check(&result, CheckKind::MissingParameter);
    assert!(
        check.grade > Grade::Use && check.words.contains("differs by its sign"),
        "{check:?}"
    );
}

#[test]
fn a_fault_of_all_drives_spoils_parameters_of_each_drive() {
    let result = identified(TEMPLATE, |positions, torques| {
        for (position, torque) in positions.iter().zip(torques) {
            *torque += 0.05 * (3.0 * position).sin();
        }
    });
    let check = failed_check(&result, CheckKind::MissingParameter);
    // Torques that depend on the drives' own positions have a potential.
    assert!(check.words.contains("a further potential"), "{check:?}");
    for drive in ["1", "2"] {
        let own = |name: &String| name.ends_with(drive) || name.ends_with(&format!("{drive}R"));
        assert!(check.spoiled.iter().any(own), "{check:?}");
    }
}

#[test]
fn a_filter_of_all_signals_is_detected_by_dry_friction() {
    // First-order lag of 10 ms at 1 kHz.
    let last = Cell::new(None::<[f64; 4]>);
    let result = identified(TEMPLATE, |positions, torques| {
        let now = [positions[0], positions[1], torques[0], torques[1]];
        let before = last.get().unwrap_or(now);
        let lagged: [f64; 4] = std::array::from_fn(|i| before[i] + (now[i] - before[i]) / 11.0);
        positions.copy_from_slice(&lagged[..2]);
        torques.copy_from_slice(&lagged[2..]);
        last.set(Some(lagged));
    });
    let check = failed_check(&result, CheckKind::Reversals);
    let fs = |name: &&String| name.starts_with("fs_");
    assert!(check.spoiled.iter().any(|name| fs(&name)), "{check:?}");
}

#[test]
fn an_experiment_without_training_runs_is_rejected() {
    let robot = Robot::from_text("described.toml", TEMPLATE).expect("the robot");
    let experiment = robot.experiment().expect("an experiment");
    let all: Vec<String> = experiment
        .plan()
        .runs
        .iter()
        .map(|run| run.name.clone())
        .collect();
    let error = experiment
        .runs(&all, &|_, _| {})
        .expect_err("no run is left");
    assert!(
        error.to_string().contains("there are no training data"),
        "{error}"
    );
}

#[test]
fn the_faultless_robot_passes() {
    let result = identified(TEMPLATE, |_, _| ());
    assert_eq!(result.grade(), Grade::Use, "{:?}", result.warnings);
}

/// Inverse dynamics of base parameters, whose columns minimise operations, from estimates of other
/// sums.
#[test]
fn identified_base_parameters_fit_the_generated_functions() {
    use overact::{Function, Model};
    // One period of its run, without elimination: only base parameters are compared.
    let text = include_str!("../../robots/rx90.toml")
        .replace("duration = \"20 s\"", "duration = \"5 s\"")
        .replace("decimation = 10", "decimation = 10\nessential = false");
    assert!(text.contains("\"5 s\"") && text.contains("essential = false"));
    let robot = Robot::from_text("rx90.toml", &text).expect("the RX90");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let result = Identifier::new(&robot).data(&runs).run().expect("a result");
    let values: Vec<f64> = result.functions_base.iter().map(|one| one.value).collect();
    let sizes = robot.model().info().sizes;
    assert_eq!(values.len(), sizes.base_parameters);
    let estimated = |name: &str| {
        let own = result.estimates[0].parameters.iter();
        own.clone()
            .find(|one| one.name == name)
            .map(|one| one.value)
    };
    // W χ with the estimate's columns equals the functions' result.
    let (q, v, a) = (
        [0.3, -0.4, 0.5, -0.6, 0.7, -0.8],
        [0.1, 0.2, -0.3, 0.4, -0.5, 0.6],
        [1.0; 6],
    );
    let columns = sizes.parameters;
    let mut regressor = vec![0.0; 6 * columns];
    let function = Function::IdmRedPlatform(overact::Columns::Standard);
    robot
        .model()
        .evaluate(function, &[&q, &v, &a], &mut regressor)
        .expect("a regressor");
    let mut expected = [0.0; 6];
    for parameter in &result.base_parameters {
        let names = robot.model().info().parameters;
        let at = names.iter().position(|one| one.name == parameter.parameter);
        let (at, value) = (
            at.expect("a column"),
            estimated(&parameter.name).expect("a value"),
        );
        for (row, torque) in expected.iter_mut().enumerate() {
            *torque += regressor[row * columns + at] * value;
        }
    }
    // A base column is that of the kept parameter.
    let model = robot.model().model();
    let mut torques = [0.0; 6];
    for (base, value) in model.base.iter().zip(&values) {
        let kept = model.parameter_name(base.parameter);
        let names = robot.model().info().parameters;
        let at = names.iter().position(|one| one.name == kept);
        let at = at.expect("a column");
        for (row, torque) in torques.iter_mut().enumerate() {
            *torque += regressor[row * columns + at] * value;
        }
    }
    for (torque, expected) in torques.iter().zip(expected) {
        assert!(
            (torque - expected).abs() < 1e-9 * expected.abs().max(1.0),
            "{torque} {expected}"
        );
    }
}
