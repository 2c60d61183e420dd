//! Logs that stay in their files have the same numbers as in memory.

mod common;

use std::{fmt::Write as _, fs, path::Path};

use common::EMPS;
use overact::Model;
use overact_identification::{Dataset, Identification, Log, Mapping, Settings, identify};
use overact_tier::is_full;

const SAMPLES: usize = 530_000;
const FREQUENCY: f64 = 1000.0;

/// Position and force at a sample, rounded as written.
fn sample(k: usize) -> (f64, f64) {
    let t = k as f64 / FREQUENCY;
    let position = 0.1 * (2.0 * t).sin() + 0.02 * (7.3 * t + 1.0).sin();
    let force = 3.0 * (2.1 * t).cos() + (0.37 * k as f64).sin();
    let round = |x: f64| (x * 1e6).round() / 1e6;
    (round(position), round(force))
}

fn text() -> String {
    let mut text = String::from("# a long run\ntime,q_1,tau_1\n");
    for k in 0..SAMPLES {
        let (position, force) = sample(k);
        let _ = writeln!(text, "{:.3},{position},{force}", k as f64 / FREQUENCY);
    }
    text
}

fn identified(log: &Log, validation: &[Log]) -> Identification {
    let settings = Settings::for_bandwidth(5.0, FREQUENCY, &EMPS.info());
    let dataset = Dataset {
        runs: std::slice::from_ref(log),
        validation,
        true_values: None,
        variants: &[],
        scales: None,
    };
    identify(&EMPS, &dataset, &settings, &|_| {}).expect("an identification")
}

fn read(path: &Path) -> Log {
    overact_logs::read(path, &Mapping::for_robot(&EMPS.info()), false).expect("a log")
}

#[test]
fn a_long_file_is_identified_block_by_block() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("long.csv");
    let text = text();
    fs::write(&path, &text).expect("written");
    let log = read(&path);
    assert!(!log.in_memory());
    assert_eq!(log.samples(), SAMPLES);
    let (positions, torques) = log.load().expect("numbers");
    assert_eq!((positions[12_345], torques[12_345]), sample(12_345));

    let (positions, torques) = (0..SAMPLES).map(sample).unzip();
    let whole = Log::new(
        "long",
        log.sampling_frequency(),
        1,
        positions,
        torques,
        false,
    );
    let streamed = identified(&log, std::slice::from_ref(&log));
    let whole = whole.expect("a log");
    let held_out = std::slice::from_ref(&whole);
    let whole = identified(&whole, if is_full() { held_out } else { &[] });
    assert_eq!(streamed.runs[0].samples, whole.runs[0].samples);
    for (a, b) in streamed.estimates.iter().zip(&whole.estimates) {
        assert_eq!(a.parameters, b.parameters);
        assert_eq!(a.relative_error_percent, b.relative_error_percent);
    }
    // The run is its own validation run.
    let (own, other) = (&streamed.estimates[0], &streamed.cross_validation[0]);
    assert!((own.residual_norm / other.residual_norm - 1.0).abs() < 1e-9);
    let series = &streamed.figures.predictions[0].lines[0];
    assert!(series.time.len() <= 1000 && series.time.len() > 500);

    // Truncated after it was read: its numbers are cached.
    let before = log.load().expect("numbers");
    fs::write(&path, &text[..text.len() / 2]).expect("written");
    assert!(log.load().expect("numbers") == before);
}

#[test]
fn nonuniform_time_deep_inside_a_long_file_is_located() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gap.csv");
    let mut text = String::from("time,q_1,tau_1\n");
    for k in 0..9000 {
        let missing = usize::from(k >= 8000);
        let _ = writeln!(text, "{},0,0", (k + missing) as f64 / FREQUENCY);
    }
    fs::write(&path, text).expect("written");
    let error =
        overact_logs::read(&path, &Mapping::for_robot(&EMPS.info()), false).expect_err("a gap");
    assert_eq!(error.problems[0].line, Some(8002));
    assert!(error.to_string().contains("between samples 7999 and 8000"));
}
