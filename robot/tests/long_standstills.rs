//! Runs with long standstills, at which dry friction takes any value.

use overact_identification::{Identification, Log, Settings};
use overact_robot::{Identifier, Robot, Runs};
use std::path::Path;

/// The RX90 with a run of 4 s, and one for validation.
fn arm() -> (Robot, Runs) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/rx90.toml");
    let text = std::fs::read_to_string(file).expect("a description");
    let text = text.replace("duration = \"20 s\"", "duration = \"4 s\"");
    let robot = Robot::from_text("rx90.toml", &text).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&robot.held_out(), &|_, _| {});
    let runs = runs.expect("runs");
    (robot, runs)
}

/// A run with `before` and `after` s of standstill, at which friction turns the torques off.
fn with_rests(run: &Log, before: f64, after: f64) -> Log {
    let n = run.actuators();
    let (positions, torques) = run.load().expect("numbers");
    let count = |seconds: f64| (seconds * run.sampling_frequency()) as usize;
    let held = |from: &[f64], count: usize| -> Vec<f64> { from.repeat(count) };
    let around = |values: &[f64], factor: f64| {
        let scaled = |row: &[f64]| -> Vec<f64> { row.iter().map(|one| factor * one).collect() };
        [
            held(&scaled(&values[..n]), count(before)),
            values.to_vec(),
            held(&scaled(&values[values.len() - n..]), count(after)),
        ]
        .concat()
    };
    let (positions, torques) = (around(&positions, 1.0), around(&torques, 0.5));
    let (name, frequency) = (run.name(), run.sampling_frequency());
    Log::new(name, frequency, n, positions, torques, false).expect("a run")
}

fn identified(robot: &Robot, runs: &[Log], validation: &[Log]) -> Identification {
    let identifier = Identifier::new(robot).runs(runs).validation(validation);
    identifier.run().expect("a result")
}

#[test]
fn long_standstills_are_left_out_of_all_runs() {
    let (robot, runs) = arm();
    let clean = identified(&robot, &runs.identified, &runs.validation);
    let rested =
        |logs: &[Log]| -> Vec<Log> { logs.iter().map(|log| with_rests(log, 1.5, 3.0)).collect() };
    let (training, validation) = (rested(&runs.identified), rested(&runs.validation));
    let result = identified(&robot, &training, &validation);
    let logs = training.len() + validation.len();
    let notes = result
        .warnings
        .iter()
        .filter(|text| text.contains("all joints stand still for long"));
    assert_eq!(notes.count(), logs, "{:?}", result.warnings);
    // The samples that the filters skip come from the standstills.
    let skipped = 2 * result.settings.skip_start;
    for (own, other) in result.runs.iter().zip(&clean.runs) {
        let more = own.samples as f64 - other.samples as f64 - skipped as f64;
        assert!(
            more.abs() < 0.3 * own.sampling_frequency,
            "{}: {more} samples",
            own.name
        );
    }
    // Velocities of standstill of the description replace the rule.
    let settings = Settings {
        standstill_velocity: vec![0.0; training[0].actuators()],
        ..robot.settings(training[0].sampling_frequency())
    };
    let kept = Identifier::new(&robot).runs(&training).settings(settings);
    let kept = kept.run().expect("a result");
    assert!(
        !kept
            .warnings
            .iter()
            .any(|text| text.contains("stand still"))
    );
    let equations = |one: &Identification| one.estimates[0].equations;
    assert!(equations(&kept) as f64 > 1.5 * equations(&result) as f64);
}

#[test]
fn a_standstill_in_the_middle_splits_the_run() {
    let (robot, runs) = arm();
    let run = &runs.identified[0];
    let n = run.actuators();
    let (positions, torques) = run.load().expect("numbers");
    let half = positions.len() / n / 2 * n;
    let rest = (2.5 * run.sampling_frequency()) as usize;
    let halved = |values: &[f64]| {
        [
            &values[..half],
            &values[half - n..half].repeat(rest)[..],
            &values[half..],
        ]
        .concat()
    };
    let frequency = run.sampling_frequency();
    let log = Log::new(
        "a.csv",
        frequency,
        n,
        halved(&positions),
        halved(&torques),
        false,
    );
    let result = identified(&robot, &[log.expect("a run")], &[]);
    let names: Vec<&str> = result.runs.iter().map(|run| run.name.as_str()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(
        names[0].starts_with("a.csv[:") && names[1].ends_with(":]"),
        "{names:?}"
    );
}

#[test]
fn static_postures_keep_their_samples() {
    let (robot, runs) = arm();
    let run = &runs.identified[0];
    let n = run.actuators();
    let (positions, torques) = run.load().expect("numbers");
    // Five postures on the way, at each of which the robot rests.
    let rest = (1.5 * run.sampling_frequency()) as usize;
    let samples = positions.len() / n;
    let stopped = |values: &[f64]| -> Vec<f64> {
        let row = |sample: usize| &values[sample * n..(sample + 1) * n];
        let stops = (0..samples).map(|sample| if sample % (samples / 6) == 1 { rest } else { 1 });
        stops
            .enumerate()
            .flat_map(|(sample, count)| row(sample).repeat(count))
            .collect()
    };
    let frequency = run.sampling_frequency();
    let log = Log::new(
        "a.csv",
        frequency,
        n,
        stopped(&positions),
        stopped(&torques),
        false,
    );
    let log = log.expect("a run");
    let rests = log.long_standstills().expect("numbers");
    assert!(rests.len() >= 5, "{rests:?}");
    let result = identified(&robot, &[log], &[]);
    assert_eq!(result.runs.len(), 1);
    assert!(
        !result
            .warnings
            .iter()
            .any(|text| text.contains("stand still"))
    );
}
