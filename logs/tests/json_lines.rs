//! Runs in JSON Lines.

mod common;
#[path = "common/drive.rs"]
mod drive;

use std::fmt::Write;

use common::shared;
use drive::{numbers, run, timed};
use overact_logs::{Mapping, Time, read};

/// Objects with nested positions; the torque of sample 5 is `special`.
fn lines(count: usize, special: &str) -> String {
    let mut text = String::new();
    for k in 0..count {
        let torque = if k == 5 {
            special.to_owned()
        } else {
            k.to_string()
        };
        let _ = writeln!(
            text,
            "{{\"t\": {}, \"position\": [0.5, {k}], \"drive\": {{\"tau\": {torque}}}}}",
            k as f64 / 100.0
        );
    }
    text
}

#[test]
fn nested_columns_can_be_used_in_expressions() {
    let text = lines(20, "5");
    let files = [("a.jsonl", text.as_bytes())];
    let plain = timed("position[1]", "drive.tau");
    let (positions, torques, frequency) = numbers(run("a.jsonl", &files, &plain));
    assert_eq!((positions[7], torques[19]), (7.0, 19.0));
    assert!((frequency - 100.0).abs() < 1e-9, "{frequency}");
    let computed = timed("2*position[1] - position[0]", "drive.tau / 2");
    let (positions, torques, _) = numbers(run("a.jsonl", &files, &computed));
    assert_eq!((positions[7], torques[19]), (13.5, 9.5));
}

#[test]
fn dates_and_times_of_day_become_seconds() {
    for time in ["2026-03-01T23:59:59.9", "23:59:59.9"] {
        let (date, _) = time.split_once("23:").expect("a time");
        let next = date.replace("-01T", "-02T");
        let row = |k: usize| match k {
            0..10 => format!("{{\"t\": \"{time}{k}\", \"q\": {k}, \"tau\": 1}}\n"),
            _ => format!(
                "{{\"t\": \"{next}00:00:00.0{}\", \"q\": {k}, \"tau\": 1}}\n",
                k - 10
            ),
        };
        let text: String = (0..20).map(row).collect();
        let files = [("a.jsonl", text.as_bytes())];
        let (positions, _, frequency) = numbers(run("a.jsonl", &files, &timed("q", "tau")));
        assert_eq!(positions[19], 19.0);
        assert!((frequency - 100.0).abs() < 1e-6, "{frequency}");
    }
    // A time in a column of numbers is no number.
    let text = lines(20, "\"10:00:00.5\"");
    let files = [("a.jsonl", text.as_bytes())];
    let message = run("a.jsonl", &files, &timed("position[1]", "drive.tau"));
    let message = message.expect_err("a text");
    assert!(message.contains("is the text \"10:00:00.5\""), "{message}");
}

#[test]
fn json_files_are_joined_with_text_files() {
    let text = lines(3, "5");
    let files = [
        ("a.json", text.as_bytes()),
        ("b.csv", &b"tau\n4\n5\n6\n"[..]),
    ];
    let mapping = timed("position[1]", "tau");
    let (positions, torques, _) = numbers(run("a.json+b.csv", &files, &mapping));
    assert_eq!(
        (positions, torques),
        (vec![0.0, 1.0, 2.0], vec![4.0, 5.0, 6.0])
    );
}

#[test]
fn errors_are_located_by_line() {
    let message = |text: &str, torque: &str| {
        let mapping = timed("position[1]", torque);
        run("a.jsonl", &[("a.jsonl", text.as_bytes())], &mapping).expect_err("refused")
    };
    let null = message(&lines(20, "null"), "drive.tau");
    assert!(
        null.starts_with("a.jsonl:6: `drive.tau` is null, not a number"),
        "{null}"
    );
    let missing = message(&lines(20, "5"), "drive.torque");
    assert!(
        missing.contains("there is no key `drive.torque`; the file has `t`, `position[0]`, `position[1]`, `drive.tau`"),
        "{missing}"
    );
    let late = lines(20, "5").replace("\"t\": 0.07,", "\"t\": 0.071,");
    let late = message(&late, "drive.tau");
    assert!(
        late.starts_with("a.jsonl:8: the time is not uniform"),
        "{late}"
    );
}

#[test]
fn large_files_are_read_block_by_block() {
    let text = lines(300_000, "5");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.jsonl");
    std::fs::write(&path, text).expect("written");
    let mapping = Mapping {
        time: Time::Frequency(100.0),
        ..timed("position[1]", "drive.tau")
    };
    // Two values per sample are kept in memory up to a million.
    let log = read(&path, &mapping, false).expect("read");
    assert_eq!(log.samples(), 300_000);
    let (positions, _) = log.load().expect("numbers");
    assert_eq!(positions[299_999], 299_999.0);
}

#[test]
fn a_published_json_log_is_read() {
    let Some(path) = shared("cases/logs/jsonl.jsonl") else {
        return;
    };
    let mapping = Mapping {
        time: Time::Column(String::from("time")),
        ..timed("q1", "t1")
    };
    let log = read(&path, &mapping, false).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log.samples(), 30);
}
