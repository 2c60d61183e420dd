//! No command overwrites its input, writes two results to one file or replaces a read-only file.
//!
//! It reports this before any work, and all files stay unchanged.

mod common;

use common::Bench;
use std::fs;

/// A robot with a log, states and published results.
fn bench() -> Bench {
    let bench = Bench::with("serial-2r", str::to_owned);
    bench.write("log.csv", "time,q_1,q_2,tau_1,tau_2\n0,0,0,0,0\n");
    bench.write("states.csv", "joints[0],joints[1]\n0,0\n");
    bench.write("published.toml", "");
    bench.write("log_validation.toml", &bench.read("my.toml"));
    bench
}

/// The command must be rejected as incompatible arguments and change nothing.
fn refused(bench: &Bench, arguments: &[&str], words: &str) {
    let contents = || -> Vec<(String, Vec<u8>)> {
        let read = |name: String| {
            let bytes = fs::read(bench.path(&name)).unwrap_or_default();
            (name, bytes)
        };
        bench.files().into_iter().map(read).collect()
    };
    let before = contents();
    let outcome = bench.run(arguments);
    assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.err);
    assert!(
        outcome.err.contains(words),
        "{arguments:?}: {}",
        outcome.err
    );
    assert_eq!(outcome.out, "", "{arguments:?}");
    assert_eq!(contents(), before, "{arguments:?}");
}

#[test]
fn outputs_that_are_inputs_are_rejected() {
    let bench = bench();
    let cases: [&[&str]; 18] = [
        &["excite", "my.toml", "-o", "my.toml"],
        &[
            "identify",
            "my.toml",
            "--data",
            "log.csv",
            "--calibrate",
            "--calibrated-robot",
            "my.toml",
        ],
        &["identify", "my.toml", "--data", "log.csv", "-o", "log.csv"],
        &[
            "identify", "my.toml", "--data", "log.csv", "--report", "log.csv",
        ],
        &[
            "identify",
            "my.toml",
            "--data",
            "log.csv",
            "-o",
            "./log.csv",
        ],
        &[
            "identify",
            "my.toml",
            "--payload-data",
            "log.csv",
            "-o",
            "log.csv",
        ],
        &[
            "identify",
            "my.toml",
            "--data",
            "a.csv",
            "--cross-validate",
            "log.csv",
            "-o",
            "log.csv",
        ],
        &[
            "identify",
            "my.toml",
            "--published",
            "published.toml",
            "-o",
            "published.toml",
        ],
        &["identify", "my.toml", "-o", "my.toml"],
        &[
            "partitions",
            "my.toml",
            "--data",
            "log.csv",
            "-o",
            "log.csv",
        ],
        &["partitions", "my.toml", "-o", "my.toml"],
        &["generate", "my.toml", "-o", "my.toml"],
        &["inspect", "my.toml", "-o", "my.toml"],
        &["inspect", "my.toml", "--svg", "my.toml"],
        &["simulate", "log_validation.toml", "-o", "log.toml"],
        &[
            "simulate",
            "my.toml",
            "--run",
            "identification",
            "-o",
            "my.toml",
        ],
        &[
            "evaluate",
            "my.toml",
            "joints",
            "--states",
            "states.csv",
            "-o",
            "states.csv",
        ],
        &[
            "evaluate",
            "my.toml",
            "joints",
            "--states",
            "states.csv",
            "-o",
            "my.toml",
        ],
    ];
    for arguments in cases {
        refused(
            &bench,
            arguments,
            "which the command reads: choose another name",
        );
    }
}

#[cfg(unix)]
#[test]
fn outputs_that_link_to_inputs_are_rejected() {
    use std::os::unix::fs::symlink;
    let bench = bench();
    symlink("log.csv", bench.path("link.csv")).expect("a link");
    symlink("my.toml", bench.path("my.rs")).expect("a link");
    fs::hard_link(bench.path("log.csv"), bench.path("hard.csv")).expect("a hard link");
    fs::create_dir(bench.path("modules")).expect("a folder");
    symlink("../my.toml", bench.path("modules/my.rs")).expect("a link");
    let cases: [&[&str]; 5] = [
        &["identify", "my.toml", "--data", "log.csv", "-o", "link.csv"],
        &["identify", "my.toml", "--data", "link.csv", "-o", "log.csv"],
        &["identify", "my.toml", "--data", "hard.csv", "-o", "log.csv"],
        &["generate", "my.toml", "-o", "my.rs"],
        &["generate", "my.toml", "-o", "modules"],
    ];
    for arguments in cases {
        refused(&bench, arguments, "which the command reads");
    }
}

#[test]
fn two_results_in_one_file_are_rejected() {
    let bench = bench();
    let cases: [&[&str]; 4] = [
        &[
            "identify", "my.toml", "-o", "new.json", "--report", "new.json",
        ],
        &[
            "identify",
            "my.toml",
            "--report",
            "new.csv",
            "--report",
            "./new.csv",
        ],
        &["inspect", "my.toml", "-o", "new", "--svg", "./new"],
        &[
            "inspect",
            "my.toml",
            "-o",
            "states.csv",
            "--svg",
            "states.csv",
        ],
    ];
    for arguments in cases {
        refused(&bench, arguments, "two results would be written to");
    }
}

#[test]
fn a_read_only_file_is_not_replaced() {
    let bench = bench();
    bench.write("kept", "kept");
    let mut permissions = fs::metadata(bench.path("kept"))
        .expect("a file")
        .permissions();
    permissions.set_readonly(true);
    fs::set_permissions(bench.path("kept"), permissions).expect("permissions");
    for arguments in [
        &["inspect", "my.toml", "-o", "kept"][..],
        &["inspect", "my.toml", "--svg", "kept"],
        &["generate", "my.toml", "-o", "kept"],
        &[
            "simulate",
            "my.toml",
            "-o",
            "kept",
            "--run",
            "identification",
        ],
        &[
            "evaluate",
            "my.toml",
            "joints",
            "--states",
            "states.csv",
            "-o",
            "kept",
        ],
        &["identify", "my.toml", "--data", "log.csv", "-o", "kept"],
    ] {
        let message = bench.bad(arguments);
        assert!(
            message.contains("the file can't be written: it is read-only"),
            "{message}"
        );
        assert_eq!(bench.read("kept"), "kept");
    }
}
