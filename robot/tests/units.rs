//! Logs in other units than described: the fit does not change, and only physical scales contradict
//! it.

use overact_identification::{Check, CheckKind, Grade, Identification, Log};
use overact_robot::{Identifier, Robot};

const ARM: &str = include_str!("../../cli/templates/serial-2r.toml");
const AXIS: &str = include_str!("../../robots/emps.toml");

/// Signals of a log.
struct Signals {
    frequency: f64,
    positions: Vec<f64>,
    torques: Vec<f64>,
}

/// Identification with a description from its virtual runs with changed signals.
fn identified(description: &str, change: impl Fn(&mut Signals)) -> Identification {
    let robot = Robot::from_text("robot.toml", description).expect("a description");
    let mut experiment = robot.experiment().expect("an experiment");
    for run in &mut experiment.plan_mut().runs {
        run.duration_s = run.duration_s.map(|duration| duration.min(10.0));
    }
    let runs = experiment
        .runs(&robot.held_out(), &|_, _| {})
        .expect("runs");
    let changed = |log: &Log| {
        let (positions, torques) = log.load().expect("numbers");
        let mut signals = Signals {
            frequency: log.sampling_frequency(),
            positions,
            torques,
        };
        change(&mut signals);
        let Signals {
            frequency,
            positions,
            torques,
        } = signals;
        Log::new(
            log.name(),
            frequency,
            log.actuators(),
            positions,
            torques,
            false,
        )
        .expect("a log")
    };
    let logs: Vec<Log> = runs.identified.iter().map(changed).collect();
    Identifier::new(&robot).runs(&logs).run().expect("a result")
}

/// Failed checks of units.
fn of_units(result: &Identification) -> Vec<&Check> {
    let is_own = |one: &&Check| one.kind == CheckKind::Unit && !one.passed;
    result.checks.iter().filter(is_own).collect()
}

/// Signal, factor and drive of the only failed check of units, of a result that must not be used.
fn unit_error(result: &Identification) -> (&str, f64, Option<&str>) {
    assert_eq!(result.grade(), Grade::DoNotUse);
    let checks = of_units(result);
    let [check] = checks[..] else {
        panic!("one check of units: {checks:?}");
    };
    let reasons = &result.verdicts[0].reasons;
    let is_reason = |reason: &String| reason.ends_with(&check.words);
    assert!(reasons.iter().any(is_reason), "{reasons:?}");
    let (signal, factor) = (
        check.signal.expect("a signal"),
        check.factor.expect("a factor"),
    );
    (signal, factor, check.actuator.as_deref())
}

#[test]
fn correct_units_raise_no_unit_check() {
    for description in [ARM, AXIS] {
        assert!(of_units(&identified(description, |_| ())).is_empty());
    }
}

#[test]
fn time_in_milliseconds_or_microseconds_is_detected() {
    for factor in [1e3, 1e6] {
        let result = identified(ARM, |signals| signals.frequency /= factor);
        assert_eq!(unit_error(&result), ("time", factor, None));
    }
}

#[test]
fn time_in_milliseconds_is_reported_in_the_json_result() {
    let result = identified(ARM, |signals| signals.frequency /= 1e3);
    let document = serde_json::to_value(&result).expect("a document");
    let checks = document["checks"].as_array().expect("checks");
    let own = checks
        .iter()
        .find(|check| check["kind"] == "unit")
        .expect("its check");
    assert_eq!(own["signal"], "time");
    assert_eq!(own["factor"], 1000.0);
    assert_eq!(own["grade"], "no");
}

#[test]
fn a_linear_axis_in_millimetres_is_detected() {
    let described = AXIS.replace("instruments = \"simulated\"", "instruments = \"none\"");
    assert_ne!(described, AXIS);
    let result = identified(&described, |signals| {
        signals.positions.iter_mut().for_each(|q| *q *= 1e3);
    });
    assert_eq!(unit_error(&result), ("positions", 1e3, None));
}

#[test]
fn milliradians_of_one_drive_are_detected_with_the_drive() {
    let result = identified(ARM, |signals| {
        signals
            .positions
            .iter_mut()
            .skip(1)
            .step_by(2)
            .for_each(|q| *q *= 1e3);
    });
    assert_eq!(unit_error(&result), ("positions", 1e3, Some("2")));
}

#[test]
fn a_filter_above_the_sampling_frequency_suggests_a_time_unit() {
    let text = ARM.replacen(
        "[identification]",
        "[identification]\nfilter_cutoff = \"50 Hz\"",
        1,
    );
    let robot = Robot::from_text("robot.toml", &text).expect("a description");
    let runs = robot
        .experiment()
        .expect("an experiment")
        .runs(&[], &|_, _| {})
        .expect("runs");
    let log = &runs.identified[0];
    let (positions, torques) = log.load().expect("numbers");
    let log = Log::new("slow", 1e-3, 2, positions, torques, false).expect("a log");
    let error = Identifier::new(&robot)
        .runs(&[log])
        .run()
        .expect_err("no filter");
    let text = error.render(false);
    assert!(text.contains("is the time in microseconds?"), "{text}");
}

#[test]
fn units_are_among_the_assumptions() {
    let result = identified(ARM, |_| ());
    let assumed = |what: &str| result.assumptions.iter().any(|one| one.contains(what));
    assert!(assumed("time is in seconds") && assumed("positions are in rad and m"));
}
