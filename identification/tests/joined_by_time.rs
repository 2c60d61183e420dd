//! Files of one run with separate clocks: one is interpolated to the times of the other.

mod common;
#[path = "../../logs/tests/common/drive.rs"]
mod drive;

use common::EMPS;
use drive::{joined, loaded};
use overact::Model;
use overact_identification::{Dataset, Log, Settings, identify};

/// A text of times and values.
fn text(name: &str, rows: impl Iterator<Item = (f64, f64)>) -> String {
    let rows = rows.map(|(time, value)| format!("{time},{value}\n"));
    format!("t,{name}\n{}", rows.collect::<String>())
}

/// Fails unless torques are 3 t - 1, with the times as positions.
fn is_line(log: &Log) {
    let (times, torques) = loaded(log);
    for (time, torque) in times.iter().zip(&torques) {
        assert!(
            (torque - (3.0 * time - 1.0)).abs() < 1e-12,
            "{torque} at {time}"
        );
    }
}

#[test]
fn a_slower_file_is_interpolated_onto_the_times_of_the_first() {
    let positions = text(
        "q",
        (0..1001).map(|k| (f64::from(k) / 1000.0, f64::from(k) / 1000.0)),
    );
    // 240 Hz from 0.0105 s to 0.9605 s.
    let times = (0..229).map(|k| 0.0105 + f64::from(k) / 240.0);
    let torques = text("tau", times.clone().map(|t| (t, 3.0 * t - 1.0)));
    let log = joined(
        ("q.csv", positions.as_bytes()),
        ("i.csv", torques.as_bytes()),
    );
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    // From 0.011 s to 0.960 s.
    assert_eq!(log.samples(), 950);
    assert!((log.sampling_frequency() - 1000.0).abs() < 1e-6);
    assert_eq!(loaded(&log).0[0], 0.011);
    is_line(&log);
    let note = log.note().expect("a note");
    assert!(
        note.contains("i.csv was interpolated onto the times of "),
        "{note}"
    );
    assert!(
        note.ends_with("51 of its 1001 samples, outside the times of the others, are skipped"),
        "{note}"
    );
}

#[test]
fn a_faster_file_with_an_uneven_clock_is_interpolated() {
    let positions = text(
        "q",
        (0..200).map(|k| (f64::from(k) / 100.0, f64::from(k) / 100.0)),
    );
    let times = (0..5000).map(|k| f64::from(k) / 2000.0 + 0.0002 * f64::from(k).sin() - 0.2);
    let torques = text("tau", times.map(|t| (t, 3.0 * t - 1.0)));
    let log = joined(
        ("q.csv", positions.as_bytes()),
        ("i.csv", torques.as_bytes()),
    );
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log.samples(), 200);
    is_line(&log);
    let note = log.note().expect("a note");
    // The torques have twenty times the rate.
    assert!(
        note.contains(", after a low-pass filter at 40 Hz, since the clocks differ"),
        "{note}"
    );
}

#[test]
fn files_with_one_clock_are_joined_sample_by_sample() {
    let row = |k: i32| (f64::from(k) / 100.0, f64::from(k * k));
    let positions = text("q", (0..50).map(row));
    let torques = text("tau", (0..50).map(|k| (row(k).0 + 1e-5, row(k).1)));
    let log = joined(
        ("q.csv", positions.as_bytes()),
        ("i.csv", torques.as_bytes()),
    );
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log.note(), None);
    let (positions, torques) = loaded(&log);
    assert_eq!(positions, torques);
}

#[test]
fn files_without_overlap_or_with_time_jumps_are_rejected() {
    let row = |k: i32| (f64::from(k) / 10.0, f64::from(k));
    let positions = text("q", (100..150).map(row));
    let output = |rows: &mut dyn Iterator<Item = (f64, f64)>| {
        let torques = text("tau", rows);
        let log = joined(
            ("q.csv", positions.as_bytes()),
            ("i.csv", torques.as_bytes()),
        );
        log.expect_err("an error")
    };
    let remedy = "files are joined by time: check that they are of one run and that their clocks have the same origin";
    assert_eq!(
        output(&mut (0..50).map(row)),
        format!("i.csv: the file ends at 4.9 s, before q.csv begins at 10 s\n  help: {remedy}")
    );
    assert_eq!(
        output(&mut (200..250).map(row)),
        format!("i.csv: the file begins at 20 s, when q.csv has ended at 14.9 s\n  help: {remedy}")
    );
    let grow =
        "the clock starts anew there, or a stamp is wrong: write each recording to its own file";
    assert_eq!(
        output(&mut (90..160).filter(|k| !(120..130).contains(k)).map(row)),
        "i.csv: the time steps from 11.9 s to 13 s\n  help: samples are missing for too long to be interpolated: cut the run there into two"
    );
    assert_eq!(
        output(&mut (90..160).map(|k| row(if k == 130 { 110 } else { k }))),
        format!("i.csv: the time steps from 12.9 s to 11 s\n  help: {grow}")
    );
    let empty = joined(("q.csv", positions.as_bytes()), ("i.csv", b"t,tau\n"));
    assert!(empty.expect_err("empty").contains("the run is empty"));
    let broken = joined(
        ("q.csv", positions.as_bytes()),
        ("i.csv", b"t,tau\n9,1\n10.5,x\n12,3\n"),
    );
    assert_eq!(
        broken.expect_err("no number"),
        "i.csv:3: column `tau`: `x` is not a number\n  help: cut the log before or after this line, or fill the gap"
    );
}

#[test]
fn the_result_reports_the_interpolation() {
    // A mass of 2 kg with viscous friction of 3 N s/m, moved by two sines.
    let motion = |t: f64| {
        let sines = [(0.1, 3.0), (0.05, 7.0)].map(|(size, rate)| {
            let (sine, cosine) = f64::sin_cos(rate * t);
            [
                size * sine,
                size * rate * cosine,
                -size * rate * rate * sine,
            ]
        });
        [0, 1, 2].map(|order| sines[0][order] + sines[1][order])
    };
    let positions = text(
        "q",
        (0..20_000)
            .map(|k| f64::from(k) / 1000.0)
            .map(|t| (t, motion(t)[0])),
    );
    let torques = (0..20_400).map(|k| f64::from(k) / 1013.0).map(|t| {
        let [_, velocity, acceleration] = motion(t);
        (t, 2.0 * acceleration + 3.0 * velocity)
    });
    let torques = text("tau", torques);
    let log = joined(
        ("q.csv", positions.as_bytes()),
        ("i.csv", torques.as_bytes()),
    );
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    let mut settings = Settings::for_sampling_frequency(1000.0, &EMPS.info());
    settings.decimation = 20;
    let dataset = Dataset {
        runs: std::slice::from_ref(&log),
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    let result =
        identify(&EMPS, &dataset, &settings, &|_| {}).unwrap_or_else(|error| panic!("{error}"));
    let output = result
        .warnings
        .iter()
        .find(|warning| warning.contains("i.csv was interpolated onto"));
    assert!(
        output.is_some_and(|output| output.starts_with(log.name())),
        "{:?}",
        result.warnings
    );
    let viscous = &result.estimates[0]
        .parameters
        .iter()
        .find(|own| own.name.starts_with("fv"));
    let viscous = viscous.expect("viscous friction").value;
    assert!((viscous - 3.0).abs() < 0.01, "{viscous}");
}
