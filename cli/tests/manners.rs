//! Behaviour of the command line towards shells and programs: streams, signals, quiet mode, exit
//! codes.

mod common;

use common::{Bench, robot};
use std::{
    fs,
    io::Write,
    process::{Command, Output, Stdio},
};

fn overact(bench: &Bench, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_overact"));
    command.args(arguments).current_dir(bench.path("."));
    command
}

/// Runs a command with a text on its standard input.
fn piped(bench: &Bench, arguments: &[&str], input: &[u8]) -> Output {
    let mut child = overact(bench, arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program");
    let mut stdin = child.stdin.take().expect("a pipe");
    // A program that rejects its arguments does not read its input.
    let _ = stdin.write_all(input);
    drop(stdin);
    child.wait_with_output().expect("its output")
}

fn out(output: &Output) -> String {
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{err}");
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

#[test]
fn a_dash_means_standard_input_or_output() {
    let bench = Bench::new();
    let emps = robot("emps.toml");
    let text = fs::read(&emps).expect("the robot");
    let checked = out(&piped(&bench, &["check", "-"], &text));
    assert!(checked.starts_with("-: Emps, "), "{checked}");
    let named = bench.good(&["generate", &emps]);
    let streamed = out(&piped(&bench, &["generate", "-", "-o", "-"], &text));
    // The first line names the description.
    let code = |text: &str| text.split_once('\n').map(|(_, code)| code.to_owned());
    assert_eq!(code(&streamed), code(&named));
    let named = bench.good(&["inspect", &emps]);
    let streamed = out(&piped(&bench, &["inspect", "-", "-o", "-"], &text));
    assert_eq!(
        streamed.replace("(-)", ""),
        named.replace(&format!("({emps})"), "")
    );
    let template = bench.good(&["new", "serial-2r", "-"]);
    bench.good(&["new", "serial-2r", "my.toml"]);
    assert_eq!(template, bench.read("my.toml"));
    // A piped log gives the estimates of the same log in a file.
    let run = ["simulate", "my.toml", "--run", "identification", "-o"];
    let to_stdout = bench.good(&[&run[..], &["-"]].concat());
    bench.good(&[&run[..], &["log.csv"]].concat());
    assert_eq!(to_stdout, bench.read("log.csv"));
    let identify = |log| vec!["identify", "my.toml", "--json", "--data", log];
    let streamed = out(&piped(&bench, &identify("-"), to_stdout.as_bytes()));
    let read = bench.good(&identify("log.csv"));
    let estimates = |text: &str| {
        let document: serde_json::Value = serde_json::from_str(text).expect("JSON");
        document["estimates"].to_string()
    };
    assert!(streamed.contains("\"name\": \"-\""));
    let renamed = streamed.replace("\"-\"", "\"log.csv\"");
    assert!(estimates(&renamed) == estimates(&read), "other estimates");
    assert_eq!(bench.files(), ["log.csv", "my.toml"]);
    let broken = piped(&bench, &["identify", "my.toml", "--data", "-"], b"\0\x01");
    let err = String::from_utf8_lossy(&broken.stderr).into_owned();
    assert!(
        err.contains("error[OA302]") && err.contains(" --> -\n"),
        "{err}"
    );
    // Standard input can be read once, and standard output takes one result.
    let twice = piped(&bench, &["identify", "-", "--data", "-"], &text);
    let err = String::from_utf8_lossy(&twice.stderr).into_owned();
    assert_eq!(twice.status.code(), Some(2), "{err}");
    assert!(err.contains("can be read once"), "{err}");
    let both = bench.run(&["identify", &emps, "--parameters", "-"]);
    assert_eq!(both.code, Some(2), "{}", both.err);
    assert!(both.err.contains("write `./-`"), "{}", both.err);
}

#[test]
fn error_codes_are_printed_and_explained() {
    let bench = Bench::with("planar-4rrr", |text| {
        text.replacen("actuated", "actuatd", 1)
    });
    let err = bench.bad(&["check", "my.toml"]);
    assert!(
        err.starts_with("error[OA102]: unknown key `actuatd`"),
        "{err}"
    );
    assert!(
        err.contains("cause and remedy: overact explain OA102"),
        "{err}"
    );
    let shown_output = bench.good(&["explain", "oa102", "101"]);
    for part in ["OA102: an unknown key", "OA101: ", "Cause\n", "Remedy\n"] {
        assert!(shown_output.contains(part), "{part} in {shown_output}");
    }
    assert!(shown_output.lines().all(|line| line.chars().count() <= 100));
    let all = bench.good(&["explain"]);
    let document = bench.json(&["explain"]);
    let codes = document["codes"].as_array().expect("codes");
    assert_eq!(all.lines().count(), codes.len());
    assert!(codes.len() > 60, "{}", codes.len());
    let unknown = bench.run(&["explain", "OA999", "102"]);
    assert_eq!(unknown.code, Some(2));
    assert!(
        unknown.err.contains("`OA999` is not an error code"),
        "{}",
        unknown.err
    );
    // Also for argument errors, as text and JSON; nothing goes to standard output.
    for wrong in [
        &["frobnicate"][..],
        &["check"],
        &["check", "--frob", "my.toml"],
        &["explain", "x"],
    ] {
        let shown_output = bench.run(wrong);
        assert_eq!(
            (shown_output.code, shown_output.out.as_str()),
            (Some(2), ""),
            "{wrong:?}"
        );
        assert!(
            shown_output.err.starts_with("error[OA601]: "),
            "{}",
            shown_output.err
        );
        let shown_output = bench.run(&[&["--json"], wrong].concat());
        let document: serde_json::Value = serde_json::from_str(&shown_output.err).expect("JSON");
        assert_eq!(document["errors"][0]["code"], "OA601", "{wrong:?}");
        assert_eq!(
            (shown_output.code, shown_output.out.as_str()),
            (Some(2), ""),
            "{wrong:?}"
        );
    }
}

#[test]
fn quiet_suppresses_notes_but_not_errors() {
    let redundant = |text: &str| {
        let lines = text.lines().filter(|line| !line.starts_with("redundancy"));
        lines.map(|line| format!("{line}\n")).collect()
    };
    let bench = Bench::with("planar-4rrr", redundant);
    let shown_output = bench.run(&["check", "my.toml"]);
    assert!(
        shown_output.err.starts_with("note: my.toml: "),
        "{}",
        shown_output.err
    );
    for quiet in ["-q", "--quiet"] {
        let still = bench.run(&[quiet, "check", "my.toml"]);
        assert_eq!((still.err.as_str(), &still.out), ("", &shown_output.out));
        let failed = bench.run(&[quiet, "check", "none.toml"]);
        assert!(failed.err.starts_with("error[OA114]"), "{}", failed.err);
    }
}

#[test]
fn completions_and_manual_pages_are_generated() {
    let bench = Bench::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = bench.good(&["completions", shell]);
        for word in ["identify", "excite", "--calibrated-robot"] {
            let word = if shell == "fish" {
                word.trim_start_matches('-')
            } else {
                word
            };
            assert!(text.contains(word), "{word} for {shell}");
        }
    }
    let first = bench.good(&["manual"]);
    assert!(first.starts_with(".ie"), "{first}");
    assert_eq!(bench.good(&["manual", "-o", "-"]), first);
    let written = bench.good(&["manual", "-o", "man"]);
    assert_eq!(
        fs::read_to_string(bench.path("man/overact.1")).expect("a page"),
        first
    );
    let identify = fs::read_to_string(bench.path("man/overact-identify.1")).expect("a page");
    assert!(identify.contains("calibrated\\-robot"), "{identify}");
    assert!(written.lines().count() > 9, "{written}");
    bench.write("taken", "");
    let none = bench.bad(&["manual", "-o", "taken/man"]);
    assert!(none.contains("error[OA602]"), "{none}");
}

#[cfg(unix)]
#[test]
fn a_log_is_read_from_a_named_pipe() {
    let bench = Bench::new();
    bench.good(&["new", "serial-2r", "my.toml"]);
    let run = ["simulate", "my.toml", "--run", "identification", "-o"];
    bench.good(&[&run[..], &["log.csv"]].concat());
    let made = Command::new("mkfifo").arg(bench.path("pipe.csv")).status();
    assert!(made.expect("mkfifo").success());
    let (log, pipe) = (bench.read("log.csv"), bench.path("pipe.csv"));
    let writer = std::thread::spawn(move || fs::write(pipe, log));
    let identify = |log| vec!["identify", "my.toml", "--json", "--data", log];
    let streamed = bench.good(&identify("pipe.csv"));
    writer.join().expect("a thread").expect("a log in the pipe");
    let read = bench.good(&identify("log.csv"));
    let estimates = |text: &str| {
        let document: serde_json::Value = serde_json::from_str(text).expect("JSON");
        document["estimates"].to_string()
    };
    let renamed = streamed.replace("pipe.csv", "log.csv");
    assert!(estimates(&renamed) == estimates(&read), "other estimates");
}

/// An unread pipe keeps the command waiting between temporary files and their final names.
#[cfg(unix)]
#[test]
fn signals_remove_temporary_files() {
    use std::{os::unix::process::ExitStatusExt, thread::sleep, time::Duration};
    for (name, number) in [("HUP", 1), ("INT", 2), ("TERM", 15)] {
        let bench = Bench::new();
        let made = Command::new("mkfifo").arg(bench.path("pipe.svg")).status();
        assert!(made.expect("mkfifo").success());
        bench.write("out.txt", "old");
        let arguments = [
            "inspect",
            &robot("emps.toml"),
            "--svg",
            "pipe.svg",
            "-o",
            "out.txt",
        ];
        let mut child = overact(&bench, &arguments).spawn().expect("the program");
        let staged = || {
            bench
                .files()
                .iter()
                .any(|file| file.starts_with(".overact-"))
        };
        let mut patience = 1000;
        while !staged() && patience > 0 {
            sleep(Duration::from_millis(10));
            patience -= 1;
        }
        assert!(staged(), "no temporary file came");
        let kill = Command::new("kill")
            .args(["-s", name, &child.id().to_string()])
            .status();
        assert!(kill.expect("kill").success());
        let status = child.wait().expect("its end");
        assert_eq!(status.signal(), Some(number), "{status}");
        assert_eq!(bench.files(), ["out.txt", "pipe.svg"], "{name}");
        assert_eq!(bench.read("out.txt"), "old");
    }
}

#[test]
fn warnings_go_to_stderr_if_results_go_to_a_file() {
    let bench = Bench::with("serial-2r", str::to_owned);
    bench.good(&[
        "simulate",
        "my.toml",
        "--run",
        "identification",
        "-o",
        "log.csv",
    ]);
    let log = bench.read("log.csv");
    let reversed = log.lines().map(|line| match line.rsplit_once(',') {
        Some((rest, torque)) if torque.parse::<f64>().is_ok() => format!("{rest},-{torque}\n"),
        _ => format!("{line}\n"),
    });
    let reversed: String = reversed.collect();
    bench.write("faulty.csv", &reversed.replace("--", ""));
    let sound = bench.run(&[
        "identify",
        "my.toml",
        "--data",
        "log.csv",
        "-o",
        "result.txt",
    ]);
    assert_eq!((sound.code, sound.err.as_str()), (Some(0), ""));
    let run = [
        "identify",
        "my.toml",
        "--data",
        "faulty.csv",
        "-o",
        "result.txt",
    ];
    let shown_output = bench.run(&run);
    assert_eq!(shown_output.code, Some(0), "{}", shown_output.err);
    assert!(
        shown_output.err.starts_with("warning: joint model: "),
        "{}",
        shown_output.err
    );
    let mut lines: Vec<&str> = shown_output.err.lines().collect();
    lines.sort_unstable();
    lines.dedup();
    assert_eq!(
        lines.len(),
        shown_output.err.lines().count(),
        "{}",
        shown_output.err
    );
    let still = bench.run(&[&run[..], &["--quiet"]].concat());
    assert_eq!(still.err, "");
    let strict = bench.run(&[&run[..], &["--strict"]].concat());
    assert_eq!(strict.code, Some(3), "{}", strict.err);
    let refused = "error[OA412]: the result is not to be used";
    assert!(strict.err.contains(refused), "{}", strict.err);
}
