//! `simulate --fleet`: logs and factor files of many robots, and rejected arguments.

mod common;

use common::{Bench, robot};
use std::fs;

/// A five-bar robot with short runs at 200 Hz.
fn five_bar() -> Bench {
    let bench = Bench::new();
    let text = fs::read_to_string(robot("five_bar.toml")).expect("a robot of the library");
    let changed = [
        ("duration = \"10 s\"", "duration = \"2 s\""),
        ("sampling = \"2 kHz\"", "sampling = \"200 Hz\""),
        ("filter_cutoff = \"100 Hz\"", "filter_cutoff = \"20 Hz\""),
        ("bandwidth = \"30 Hz\"", "bandwidth = \"6 Hz\""),
        ("decimation = 12", "decimation = 4"),
    ];
    let text = changed
        .iter()
        .fold(text, |text, (from, to)| text.replace(from, to));
    bench.write("my.toml", &text);
    bench
}

#[test]
fn fleet_logs_and_factors_describe_the_same_runs() {
    let bench = five_bar();
    let fleet = [
        "simulate", "my.toml", "--fleet", "3", "--days", "2", "--faults", "25",
    ];
    let shown_output = bench.json(&[&fleet[..], &["-o", "logs"]].concat());
    assert_eq!(
        (
            &shown_output["runs"],
            &shown_output["files"],
            &shown_output["left_out"]
        ),
        (&6.into(), &6.into(), &0.into())
    );
    bench.good(&[&fleet[..], &["--factors", "-o", "factors"]].concat());
    let truth = bench.read("logs/truth.csv");
    assert_eq!(truth.lines().count(), 4, "{truth}");
    assert_eq!(truth, bench.read("factors/truth.csv"));
    let parameters = bench.read("logs/parameters.csv");
    let of = |serial: &str| {
        parameters
            .lines()
            .filter(|line| line.starts_with(serial))
            .count()
    };
    assert!(of("R00000") > 20 && of("R00000") == of("R00002"));

    // A log and the factor of the same robot and day are equivalent.
    let log = "logs/serial=R00001/day=2026-03-03/fast.parquet";
    bench.good(&["factor", "my.toml", log, "-o", "own.parquet"]);
    let files = ["factors/day=2026-03-03/robots-00000.parquet", "own.parquet"];
    let shown_output = bench.json(&[&["identify", "my.toml", "--factors"], &files[..]].concat());
    let left_out = shown_output["left_out"].as_array().expect("a list");
    assert_eq!(left_out.len(), 1, "{left_out:?}");
    assert_eq!(left_out[0]["reason"], "twice");
    assert_eq!(shown_output["runs"].as_array().map(Vec::len), Some(3));
}

#[test]
fn fleet_files_depend_on_the_seed_only() {
    let bench = five_bar();
    let made = |folder: &str, more: &[&str]| {
        let own = [
            "simulate",
            "my.toml",
            "--fleet",
            "2",
            "--days",
            "1",
            "--factors",
            "-o",
            folder,
        ];
        bench.good(&[&own, more].concat());
        let file = format!("{folder}/day=2026-03-02/robots-00000.parquet");
        fs::read(bench.path(&file)).expect("a factor file")
    };
    let first = made("a", &[]);
    assert_eq!(first, made("b", &[]));
    assert_ne!(first, made("c", &["--seed", "7"]));
}

#[test]
fn invalid_fleet_arguments_are_rejected_before_writing() {
    let bench = five_bar();
    fs::create_dir(bench.path("full")).expect("a folder");
    bench.write("full/something", "");
    let refused = |arguments: &[&str], code: i32, word: &str| {
        let run = bench.run(&[&["simulate", "my.toml"], arguments].concat());
        assert_eq!(run.code, Some(code), "{}", run.err);
        assert!(run.err.contains(word), "{word} in {}", run.err);
    };
    refused(&["--fleet", "2", "-o", "full"], 1, "not empty");
    refused(&["--fleet", "0", "-o", "new"], 2, "1 to 1000000");
    refused(&["--fleet", "2", "--days", "0", "-o", "new"], 2, "3660");
    refused(
        &["--fleet", "2", "--faults", "30", "-o", "new"],
        2,
        "25 percent",
    );
    refused(
        &["--fleet", "2", "--moment-drift", "nan", "-o", "new"],
        2,
        "100 percent",
    );
    refused(
        &["--fleet", "2", "--begin", "yesterday", "-o", "new"],
        1,
        "not a time",
    );
    refused(&["--fleet", "2"], 2, "--output");
    refused(&["--days", "2"], 2, "--fleet");
    assert!(!bench.path("new").exists());
}
