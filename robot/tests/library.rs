//! A robot in the hands of a Rust user: read, simulated, identified; errors are reported at once.

use overact_identification::{Estimator, ModelKind, Stage};
use overact_robot::{Error, Identifier, Robot, Runs, tracking};
use std::path::{Path, PathBuf};

/// Path of a description in `robots/`.
fn description(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../robots")
        .join(name)
}

fn emps() -> Robot {
    Robot::from_toml(description("emps.toml")).expect("a robot")
}

fn messages(error: &Error) -> Vec<String> {
    error
        .problems()
        .into_iter()
        .map(|one| one.message)
        .collect()
}

#[test]
fn disabled_elimination_gives_base_parameters_only() {
    let robot = emps();
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&["validation".to_owned()], &|_, _| {});
    let runs = runs.expect("runs");
    assert_eq!((runs.identified.len(), runs.validation.len()), (1, 1));
    let result = Identifier::new(&robot).data(&runs).run().expect("a result");
    let stages: Vec<_> = result
        .estimates
        .iter()
        .map(|e| (e.model, e.stage, e.estimator))
        .collect();
    let base = |estimator| (ModelKind::Joints, Stage::Base, estimator);
    let both = [
        base(Estimator::LeastSquares),
        base(Estimator::InstrumentalVariables),
    ];
    assert_eq!(stages, both);
    assert!(
        result
            .cross_validation
            .iter()
            .all(|one| matches!(one.stage, Stage::Base | Stage::Consistent))
    );
    // The reported settings are the requested ones, not those that disabled the elimination.
    assert_eq!(result.settings, robot.settings(runs.sampling_frequency()));
    for parameter in &result.estimates[0].parameters {
        let error = parameter.error_percent.expect("a known value");
        assert!(error.abs() < 2.0, "{}: {error} %", parameter.name);
    }
    let errors = tracking(&robot, &result, &|_, _| {}).expect("tracked");
    let controllers: Vec<&str> = errors.iter().map(|one| one.controller.as_str()).collect();
    assert_eq!(controllers, ["pd", "computed torque"]);
    assert!(errors[1].largest[0] < 0.5 * errors[0].largest[0]);
}

#[test]
fn the_noise_follows_the_seed_of_the_plan() {
    let robot = emps();
    let positions = |seed| {
        let mut experiment = robot.experiment().expect("an experiment");
        experiment.plan_mut().seed = seed;
        experiment.plan_mut().duration_s = 1.0;
        let records = experiment.records(&|_, _| {}).expect("records");
        records[0].torques.clone()
    };
    assert_eq!(positions(1), positions(1));
    assert_ne!(positions(1), positions(2));
}

#[test]
fn all_errors_are_reported_together() {
    let text = "name = \"A\"\nnonsense = 1\n[[joint]]\nkind = \"sliding\"\n";
    let error = Robot::from_text("a.toml", text).expect_err("two errors");
    assert!(error.problems().len() > 1, "{error}");
    assert!(
        error
            .problems()
            .iter()
            .all(|one| one.file.as_deref() == Some("a.toml"))
    );

    let error = Robot::from_toml("nowhere.toml").expect_err("no file");
    assert!(messages(&error)[0].starts_with("the file can't be read"));

    let robot = emps();
    let files = [(Path::new("no.csv"), false), (Path::new("none.csv"), false)];
    let error = robot.read_logs(&files, &|_| {}).expect_err("no files");
    assert_eq!(error.problems().len(), 2, "{error}");

    let experiment = robot.experiment().expect("an experiment");
    let names = ["identificatoin", "b"].map(str::to_owned);
    let error = experiment.check_runs(&names).expect_err("no such runs");
    let help = error.problems().into_iter().filter_map(|one| one.help);
    let help: Vec<String> = help.collect();
    assert!(
        help[0].contains("identification") && help.len() == 2,
        "{help:?}"
    );

    let error = Identifier::new(&robot).data(&Runs::default()).run();
    let error = error.expect_err("nothing to identify from");
    assert_eq!(messages(&error), ["there is no training run"]);
}
