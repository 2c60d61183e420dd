//! Calibration from the command line: a robot with an encoder offset is calibrated once and then
//! correct.

mod common;

use common::{Bench, NINE, list, number, robot};
use overact_tier::{is_full, is_night};
use serde_json::Value;
use std::fs;

/// Offset of leg 3's encoder, degrees.
const OFFSET: f64 = 0.2;

/// Logs of the runs of the DualV.
const LOGS: [&str; 6] = [
    "log_unloaded_1.csv",
    "log_unloaded_2.csv",
    "log_loaded_1.csv",
    "log_loaded_2.csv",
    "log_trajectory_1.csv",
    "log_trajectory_2.csv",
];

/// A log with the offset of leg 3's encoder.
fn shifted(log: &str) -> String {
    let mut lines = log.lines();
    let header = lines.next().expect("a header");
    let mut columns = header.split(',');
    let place = columns.position(|name| name == "q_leg3").expect("leg 3");
    let mut text = format!("{header}\n");
    for line in lines {
        let cells = line.split(',').enumerate().map(|(column, cell)| {
            if column != place {
                return cell.to_owned();
            }
            let position: f64 = cell.parse().expect("a number");
            (position + OFFSET.to_radians()).to_string()
        });
        text.push_str(&cells.collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// Output of `identify` for the logs with a description.
fn identified(bench: &Bench, description: &str, more: &[&str]) -> Value {
    let [a, b, c, d, e, f] = LOGS;
    let runs = [
        "identify",
        description,
        "--data",
        a,
        b,
        "--payload-data",
        c,
        d,
        "--cross-validate",
        e,
        "--cross-validate-payload",
        f,
    ];
    bench.json(&[&runs, more].concat())
}

/// Number of failed checks of the closure.
fn open_loops(document: &Value) -> usize {
    let checks = list(&document["checks"]).iter();
    let closure = checks.filter(|check| check["kind"] == "closure");
    let failed: Vec<bool> = closure.map(|check| check["passed"] == false).collect();
    assert!(!failed.is_empty(), "{document}");
    failed.into_iter().filter(|failed| *failed).count()
}

#[test]
fn an_encoder_offset_is_calibrated_and_stays_corrected() {
    if !is_full() {
        return;
    }
    let bench = Bench::new();
    let text = fs::read_to_string(robot("dualv.toml")).expect("the description");
    bench.write("my.toml", &text.replace("10 s", "4 s"));
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    for log in LOGS {
        bench.write(log, &shifted(&bench.read(log)));
    }
    assert!(open_loops(&identified(&bench, "my.toml", &[])) > 0);

    let options = [
        "--calibrate",
        "--calibrated-robot",
        "right.toml",
        "--report",
        "report.html",
    ];
    let document = identified(&bench, "my.toml", &options);
    let changed = list(&document["calibration"]["estimated"]);
    assert_eq!(changed.len(), 1, "{changed:?}");
    assert_eq!(changed[0]["name"], "offset_leg3");
    let miss = number(&changed[0]["change"]) - OFFSET.to_radians();
    assert!(miss.abs() < 3.0 * number(&changed[0]["standard_deviation"]));
    assert_eq!(open_loops(&document), 0);

    let page = bench.read("report.html");
    for words in [
        "Closure residual",
        "offset_leg3",
        "Least squares and instruments agree",
        "total least squares",
    ] {
        assert!(page.contains(words), "{words}");
    }

    let document = identified(&bench, "right.toml", &[]);
    assert_eq!(document["calibration"], Value::Null);
    assert_eq!(open_loops(&document), 0, "{}", document["checks"]);
    let estimates = list(&document["estimates"]).iter();
    let essential = estimates.filter(|one| one["stage"] == "essential");
    let mut cases = 0;
    for case in essential {
        cases += 1;
        let parameters = list(&case["parameters"]);
        let names: Vec<&Value> = parameters.iter().map(|one| &one["name"]).collect();
        assert_eq!(names, NINE.map(|(name, _)| name), "{}", case["model"]);
        for (parameter, (name, truth)) in parameters.iter().zip(NINE) {
            let error = 100.0 * (number(&parameter["value"]) / truth - 1.0).abs();
            assert!(error < 2.0, "{} {name}: {error} %", case["model"]);
        }
    }
    assert_eq!(cases, 2);
}

/// Every optional identification and the search for exciting runs end with a result or an input
/// error.
///
/// The default tier tests the four-bar, the full tier one robot in twelve, the nightly tier all.
#[test]
fn optional_identifications_of_library_robots_never_fail_internally() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let mut files: Vec<_> = fs::read_dir(folder)
        .expect("the library")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    if !is_full() {
        files.retain(|path| path.ends_with("four_bar.toml"));
    } else if !is_night() {
        files = files.into_iter().step_by(12).collect();
    }
    assert!(!files.is_empty());
    let bench = Bench::new();
    for file in &files {
        let file = file.to_str().expect("UTF-8");
        for words in [
            &["identify", file, "--calibrate"][..],
            &["identify", file, "--calibrate=offsets"],
            &["identify", file, "--calibrate=all"],
            &["identify", file, "--gains"],
            &["identify", file, "--gravity-direction"],
            &["excite", file, "--time", "1"],
        ] {
            let outcome = bench.run(words);
            assert!(
                matches!(outcome.code, Some(0 | 1 | 3)),
                "{words:?}: {}",
                outcome.err
            );
        }
    }
}
