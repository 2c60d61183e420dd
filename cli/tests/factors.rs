//! `factor`, `merge` and `identify --factors`: results equal those from logs, and invalid input is
//! rejected.

mod common;

use common::{Bench, number, robot};
use serde_json::Value;
use std::fs;

/// A five-bar robot with two short runs as logs.
fn five_bar() -> Bench {
    let bench = Bench::new();
    let text = fs::read_to_string(robot("five_bar.toml")).expect("a robot of the library");
    let short = text.replace("duration = \"10 s\"", "duration = \"2 s\"");
    bench.write("my.toml", &short);
    for seed in ["1", "2"] {
        bench.good(&[
            "simulate",
            "my.toml",
            "--run",
            "circle-like",
            "--seed",
            seed,
            "-o",
            &log(seed),
        ]);
    }
    bench
}

fn log(seed: &str) -> String {
    format!("log_{seed}.csv")
}

/// Creates a factor file for each run.
fn factored(bench: &Bench, more: &[&str]) {
    for seed in ["1", "2"] {
        let (log, file) = (log(seed), format!("{seed}.parquet"));
        let own = [
            "factor",
            "my.toml",
            &log,
            "--serial",
            "A7",
            "--time",
            "2026-03-02",
            "-o",
            &file,
        ];
        bench.good(&[&own, more].concat());
    }
}

/// Least-squares estimates of a document: values with a key, or a pointer such as `/key/0`, in order.
fn values(document: &Value, key: &str) -> Vec<f64> {
    let estimates = document["estimates"].as_array().expect("estimates");
    let own = estimates
        .iter()
        .filter(|one| one["estimator"] == "least_squares" || one["estimator"] == "least-squares");
    own.flat_map(|one| one["parameters"].as_array().expect("parameters"))
        .map(|parameter| number(parameter.pointer(key).unwrap_or(&parameter[key])))
        .collect()
}

fn assert_same(a: &[f64], b: &[f64], tolerance: f64) {
    assert!(
        a.len() > 10 && a.len() == b.len(),
        "{} and {} numbers",
        a.len(),
        b.len()
    );
    for (a, b) in a.iter().zip(b) {
        assert!(
            (a - b).abs() <= tolerance * a.abs().max(1e-12),
            "{a} and {b}"
        );
    }
}

#[test]
fn sessions_widen_intervals_equally_for_factors_and_logs() {
    let bench = five_bar();
    for (seed, session) in [("1", "monday"), ("2", "tuesday")] {
        let (log, file) = (log(seed), format!("{seed}.parquet"));
        let session = ["--sessions", session, "--equations", "-o", &file];
        bench.good(&[&["factor", "my.toml", &log][..], &session].concat());
    }
    let factors = ["identify", "my.toml", "--factors", "1.parquet", "2.parquet"];
    let data = ["identify", "my.toml", "--data", "log_1.csv", "log_2.csv"];
    let days = ["--sessions", "monday", "tuesday"];
    let merged = bench.json(&factors);
    let logs = bench.json(&[&data[..], &days].concat());
    let key = "correlated_standard_deviation";
    assert_same(&values(&logs, key), &values(&merged, key), 1e-12);
    let widths = |document: &Value| -> Vec<f64> {
        let bounds = |place: &str| values(document, &format!("/interval_95/{place}"));
        let pairs = bounds("1").into_iter().zip(bounds("0"));
        pairs.map(|(high, low)| high - low).collect()
    };
    assert_same(&widths(&logs), &widths(&merged), 1e-9);
    // Without sessions, the intervals are others.
    let one = bench.json(&data);
    assert_ne!(widths(&one), widths(&merged));
}

#[test]
fn factor_files_give_the_estimates_of_their_logs() {
    let bench = five_bar();
    let logs = bench.json(&["identify", "my.toml", "--data", "log_1.csv", "log_2.csv"]);
    factored(&bench, &[]);
    bench.good(&["merge", "1.parquet", "2.parquet", "-o", "both.parquet"]);
    let merged = bench.json(&["identify", "my.toml", "--factors", "both.parquet"]);
    for key in ["value", "standard_deviation"] {
        assert_same(&values(&logs, key), &values(&merged, key), 1e-12);
    }
    assert_eq!(merged["deviations"], "parts");
    // From another estimator, but of the same size.
    let own = values(&logs, "correlated_standard_deviation");
    let parts = values(&merged, "correlated_standard_deviation");
    let ratios = own.iter().zip(&parts).map(|(own, parts)| parts / own);
    assert!(
        ratios.clone().all(|ratio| (0.2..5.0).contains(&ratio)),
        "{:?}",
        ratios.collect::<Vec<_>>()
    );

    factored(&bench, &["--equations"]);
    let whole = bench.json(&["identify", "my.toml", "--factors", "1.parquet", "2.parquet"]);
    assert_eq!(whole["deviations"], "equations");
    for key in [
        "value",
        "standard_deviation",
        "correlated_standard_deviation",
    ] {
        assert_same(&values(&logs, key), &values(&whole, key), 1e-12);
    }
}

#[test]
fn duplicate_and_damaged_factor_files_are_left_out() {
    let bench = five_bar();
    factored(&bench, &[]);
    let copy = |from: &str, to: &str, edit: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = fs::read(bench.path(from)).expect("a factor file");
        edit(&mut bytes);
        fs::write(bench.path(to), bytes).expect("a copy");
    };
    copy("1.parquet", "late.parquet", &|_| ());
    copy("2.parquet", "cut.parquet", &|bytes| {
        bytes.truncate(bytes.len() / 2)
    });
    let text = bench.read("my.toml");
    bench.write(
        "other.toml",
        &text.replace("decimation = 12", "decimation = 10"),
    );
    bench.good(&["factor", "other.toml", "log_2.csv", "-o", "other.parquet"]);

    let good = bench.json(&["identify", "my.toml", "--factors", "1.parquet", "2.parquet"]);
    let files = [
        "1.parquet",
        "late.parquet",
        "cut.parquet",
        "other.parquet",
        "2.parquet",
        "my.toml",
    ];
    let identify = [&["identify", "my.toml", "--factors"], &files[..]].concat();
    let refused = bench.run(&identify);
    assert_eq!(refused.code, Some(1), "{}", refused.err);
    for word in [
        "cut.parquet",
        "other.parquet",
        "my.toml",
        "another description",
        "--skip-bad",
    ] {
        assert!(refused.err.contains(word), "{word} in {}", refused.err);
    }
    let skipped = bench.json(&[&identify[..], &["--skip-bad"]].concat());
    assert_eq!(
        values(&good, "value"),
        values(&skipped, "value"),
        "to the last bit"
    );
    let left_out = skipped["left_out"].as_array().expect("a list");
    let reason = |file: &str| {
        let own = left_out.iter().find(|one| one["file"] == file);
        own.map(|one| one["reason"].clone())
    };
    assert_eq!(left_out.len(), 4, "{left_out:?}");
    assert_eq!(reason("late.parquet"), Some("twice".into()));
    assert_eq!(reason("cut.parquet"), Some("unreadable".into()));
    assert_eq!(reason("other.parquet"), Some("unlike".into()));

    let alone = bench.run(&["merge", "cut.parquet", "--skip-bad", "-o", "none.parquet"]);
    assert_eq!(alone.code, Some(1));
    assert!(!bench.path("none.parquet").exists(), "nothing is written");
    let over = bench.run(&["merge", "1.parquet", "-o", "1.parquet"]);
    assert_eq!(over.code, Some(2), "an input is not replaced");
}

#[test]
fn a_corrupted_factor_file_never_changes_estimates() {
    let bench = five_bar();
    bench.good(&["factor", "my.toml", "log_1.csv", "-o", "1.parquet"]);
    let good = values(
        &bench.json(&["identify", "my.toml", "--factors", "1.parquet"]),
        "value",
    );
    let bytes = fs::read(bench.path("1.parquet")).expect("a factor file");
    let mut refused = 0;
    for part in 1..8 {
        let mut wrong = bytes.clone();
        wrong[bytes.len() * part / 8] ^= 0x10;
        fs::write(bench.path("wrong.parquet"), wrong).expect("a copy");
        let run = bench.run(&[
            "--json",
            "identify",
            "my.toml",
            "--factors",
            "wrong.parquet",
        ]);
        match run.code {
            Some(0) => {
                let found: Value = serde_json::from_str(&run.out).expect("a document");
                assert_eq!(values(&found, "value"), good);
            }
            code => {
                assert_eq!(code, Some(1), "{}", run.err);
                refused += 1;
            }
        }
    }
    assert!(refused > 0);
}

#[test]
fn options_unavailable_for_factors_are_rejected() {
    let bench = five_bar();
    bench.good(&["factor", "my.toml", "log_1.csv", "-o", "1.parquet"]);
    for option in [
        &["--report", "report.html"][..],
        &["--strict"],
        &["--tables"],
        &["--all"],
    ] {
        let identify = ["identify", "my.toml", "--factors", "1.parquet"];
        let run = bench.run(&[&identify[..], option].concat());
        assert_eq!(run.code, Some(2), "{option:?}: {}", run.err);
        assert!(run.err.contains(option[0]), "{}", run.err);
    }
    assert!(!bench.path("report.html").exists());
}

/// Values and standard deviations by parameter name.
fn by_name(document: &Value) -> Vec<(String, f64, f64)> {
    let estimates = document["estimates"].as_array().expect("estimates");
    let squares = |one: &&Value| {
        one["estimator"]
            .as_str()
            .is_some_and(|own| own.starts_with("least"))
    };
    let own = estimates
        .iter()
        .filter(|one| one["stage"] == "base")
        .filter(squares);
    own.flat_map(|one| one["parameters"].as_array().expect("parameters"))
        .map(|one| {
            let name = one["name"].as_str().expect("a name").to_owned();
            (
                name,
                number(&one["value"]),
                number(&one["standard_deviation"]),
            )
        })
        .collect()
}

#[test]
fn factors_of_payload_runs_identify_the_payload() {
    let bench = Bench::with("planar-3rrr", |text| {
        text.replace("duration = \"10 s\"", "duration = \"2 s\"")
    });
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let empty = "log_unloaded__fast.csv";
    let logs = bench.json(&[
        "identify",
        "my.toml",
        "--data",
        empty,
        "--payload-data",
        "log_loaded.csv",
    ]);
    bench.good(&["factor", "my.toml", empty, "-o", "empty.parquet"]);
    let loaded = ["--payload-data", "log_loaded.csv", "-o", "loaded.parquet"];
    bench.good(&[&["factor", "my.toml"][..], &loaded].concat());
    bench.good(&[
        "merge",
        "empty.parquet",
        "loaded.parquet",
        "-o",
        "both.parquet",
    ]);
    let both = bench.json(&["identify", "my.toml", "--factors", "both.parquet"]);
    let runs = both["runs"].as_array().expect("runs");
    let carried: Vec<bool> = runs
        .iter()
        .filter_map(|run| run["payload"].as_bool())
        .collect();
    assert_eq!(carried, [false, true]);
    let (logs, both) = (by_name(&logs), by_name(&both));
    assert!(logs.iter().any(|(name, ..)| name == "m_payload") && logs.len() == both.len());
    for ((name, value, deviation), (other, factored, _)) in logs.iter().zip(&both) {
        let size = value.abs().max(*deviation);
        assert!(
            name == other && (value - factored).abs() <= 1e-11 * size,
            "{name} {value} and {other} {factored}"
        );
    }
    // A loaded run labelled as unloaded would change the estimate, so the label matters.
    bench.good(&["factor", "my.toml", "log_loaded.csv", "-o", "wrong.parquet"]);
    let wrong = bench.json(&[
        "identify",
        "my.toml",
        "--factors",
        "empty.parquet",
        "wrong.parquet",
    ]);
    assert!(by_name(&wrong).iter().all(|(name, ..)| name != "m_payload"));
}

/// Logs with one payload each and with both distinguish two payloads, also from R factors.
#[test]
fn factors_of_runs_with_two_payloads_are_those_of_their_logs() {
    let text = fs::read_to_string(robot("planar_3rrr.toml")).expect("a robot of the library");
    let named = text
        .replace("duration = \"10 s\"", "duration = \"2 s\"")
        .replace(
            "name = \"Planar3Rrr\"",
            "name = \"Two\"\npayloads = [\"A\", \"B\"]",
        )
        .replace("_payload = ", "_payload_A = ")
        .replace(
            "m_payload_A = 1.0",
            "m_payload_A = 1.0\nm_payload_B = 0.5\nzz_payload_B = 0.001",
        );
    let bench = Bench::new();
    let mut logs = Vec::new();
    for (label, payload) in [("A", "\"A\""), ("B", "\"B\""), ("A+B", "[\"A\", \"B\"]")] {
        let run = format!("payload = {payload}");
        bench.write("my.toml", &named.replace("payload = true", &run));
        let log = format!("{}.csv", label.replace('+', "_and_"));
        bench.good(&["simulate", "my.toml", "--run", "loaded", "-o", &log]);
        logs.push(format!("{label}={log}"));
    }
    let given: Vec<&str> = logs.iter().map(String::as_str).collect();
    let identify = ["identify", "my.toml", "--payload-data"];
    let of_logs = by_name(&bench.json(&[&identify[..], &given].concat()));
    let mass = |name: &str| {
        let own = of_logs.iter().find(|(own, ..)| own == name);
        own.map(|(_, value, deviation)| (*value, *deviation))
            .expect(name)
    };
    for (name, truth) in [("m_payload_A", 1.0), ("m_payload_B", 0.5)] {
        let (value, deviation) = mass(name);
        assert!(
            (value - truth).abs() < 4.0 * deviation + 0.02,
            "{name}: {value}"
        );
    }
    let mut files = Vec::new();
    for (number, log) in given.iter().enumerate() {
        let file = format!("{number}.parquet");
        bench.good(&["factor", "my.toml", "--payload-data", log, "-o", &file]);
        files.push(file);
    }
    let factors: Vec<&str> = files.iter().map(String::as_str).collect();
    let identify = ["identify", "my.toml", "--factors"];
    let of_factors = by_name(&bench.json(&[&identify[..], &factors].concat()));
    assert_eq!(of_logs.len(), of_factors.len());
    for ((name, value, deviation), (other, factored, _)) in of_logs.iter().zip(&of_factors) {
        let size = value.abs().max(*deviation);
        assert!(
            name == other && (value - factored).abs() <= 1e-11 * size,
            "{name} {value} and {other} {factored}"
        );
    }
    let refused =
        |given: &[&str]| bench.bad(&[&["identify", "my.toml", "--payload-data"], given].concat());
    assert!(refused(&["A+A=A.csv"]).contains("the payload `A` is named twice"));
    assert!(refused(&["A+C=A.csv"]).contains("there is no payload `C`"));
    assert!(refused(&["A+B=A_and_B.csv"]).contains("do not distinguish the payloads A, B"));
}

#[test]
fn factors_of_another_description_are_reported_with_differences() {
    let bench = five_bar();
    bench.good(&["factor", "my.toml", "log_1.csv", "-o", "1.parquet"]);
    let text = bench.read("my.toml");
    bench.write("commented.toml", &format!("{text}# Looked through.\n"));
    bench.good(&["factor", "commented.toml", "log_2.csv", "-o", "2.parquet"]);
    let output = bench.bad(&["identify", "my.toml", "--factors", "1.parquet", "2.parquet"]);
    assert!(output.contains("a comment suffices"), "{output}");
    bench.write(
        "renamed.toml",
        &text.replace("name = \"FiveBar\"", "name = \"Other\""),
    );
    bench.good(&["factor", "renamed.toml", "log_2.csv", "-o", "3.parquet"]);
    let output = bench.bad(&["identify", "my.toml", "--factors", "1.parquet", "3.parquet"]);
    assert!(
        output.contains("the robot `Other`, the others of `FiveBar`"),
        "{output}"
    );
    bench.write(
        "slower.toml",
        &text.replace("sampling = \"2 kHz\"", "sampling = \"1 kHz\""),
    );
    bench.good(&[
        "simulate",
        "slower.toml",
        "--run",
        "fast",
        "-o",
        "slower.csv",
    ]);
    bench.good(&["factor", "my.toml", "slower.csv", "-o", "4.parquet"]);
    let output = bench.bad(&["merge", "1.parquet", "4.parquet", "-o", "both.parquet"]);
    assert!(
        output.contains("sampled at 1000 Hz, the others at 2000 Hz"),
        "{output}"
    );
}
