//! `overact export --serial`: files, report, states, and refusals.

mod common;

use common::{Bench, robot};
use std::fs;

/// A bench with a description of the library.
fn bench_of(file: &str) -> Bench {
    let bench = Bench::new();
    let text = fs::read_to_string(robot(file)).expect("a description");
    bench.write(file, &text);
    bench
}

#[test]
fn a_skeleton_is_exported_as_a_serial_robot() {
    let bench = bench_of("ankle.toml");
    let arguments = [
        "export",
        "--serial",
        "mjcf",
        "ankle.toml",
        "-o",
        "ankle.xml",
    ];
    let report = bench.good(&[&arguments[..], &["--states", "states.csv"]].concat());
    for words in [
        "inertia matrix",
        "torque of gravity",
        "1000 states",
        "friction",
    ] {
        assert!(report.contains(words), "{report}");
    }
    let text = bench.read("ankle.xml");
    assert!(
        text.contains("<motor name=\"roll\" joint=\"roll\"/>"),
        "{text}"
    );
    // The states are read again, and the file is a robot.
    let states = bench.read("states.csv");
    assert_eq!(states.lines().count(), 1001);
    assert!(states.starts_with("pose[0],pose[1],twist[0],twist[1]\n"));
    bench.good(&[
        "evaluate",
        "ankle.toml",
        "inverse_jacobian",
        "--states",
        "states.csv",
    ]);
    bench.good(&["import", "ankle.xml", "-o", "serial.toml"]);
    // The same command gives the same file, and the report as a document.
    let document = bench.json(&arguments);
    assert_eq!(bench.read("ankle.xml"), text);
    assert_eq!(document["state_count"], 1000);
    assert!(
        document["inertia_matrix"]["rms"]
            .as_f64()
            .is_some_and(|rms| rms < 0.1)
    );
    // Without a file the robot goes to the standard output.
    let outcome = bench.run(&["export", "--serial", "urdf", "ankle.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    assert!(
        outcome.out.starts_with("<robot name=\"Ankle\">"),
        "{}",
        outcome.out
    );
    assert!(outcome.err.contains("inertia matrix"), "{}", outcome.err);
}

#[test]
fn robots_and_arguments_without_a_serial_form_are_refused() {
    let bench = bench_of("five_bar.toml");
    let error = bench.bad(&[
        "export",
        "--serial",
        "mjcf",
        "five_bar.toml",
        "-o",
        "five_bar.xml",
    ]);
    assert!(
        error.contains("platform on legs") && error.contains("help"),
        "{error}"
    );
    assert_eq!(bench.files(), ["five_bar.toml"]);
    for arguments in [
        &["export", "--serial", "mjcf"][..],
        &["export", "--serial", "sdf", "five_bar.toml"],
        &["export", "--serial", "mjcf", "five_bar.toml", "--fix-base"],
        &[
            "export",
            "--serial",
            "mjcf",
            "five_bar.toml",
            "-o",
            "five_bar.toml",
        ],
        &["export", "five_bar.toml", "--parameters", "p.toml"],
    ] {
        let outcome = bench.run(arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.err);
    }
}
