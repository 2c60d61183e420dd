//! Runs the commands of the README, of the tutorials and of the page on rejected results, and
//! compares their output.
//!
//! Other blocks are files: TOML is appended to the page's TOML file, XML and Rust are written to
//! theirs. Commands of a console block run in a shell in the same folder; their further lines begin
//! with `> `. A line `…` matches any
//! lines, and numbers may differ in their last digits between machines.
#![cfg(unix)]

mod common;

use common::Bench;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// A fenced block: its language and its lines.
struct Block<'t> {
    language: &'t str,
    lines: Vec<&'t str>,
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut blocks: Vec<Block<'_>> = Vec::new();
    let mut is_open = false;
    for line in text.lines() {
        match (line.strip_prefix("```"), is_open) {
            (Some(language), false) => blocks.push(Block {
                language,
                lines: Vec::new(),
            }),
            (Some(_), true) | (None, false) => {}
            (None, true) => blocks.last_mut().expect("an open block").lines.push(line),
        }
        is_open ^= line.starts_with("```");
    }
    assert!(!is_open, "the last block is not closed");
    blocks
}

/// Output of a command in a shell, including errors.
fn run(bench: &Bench, command: &str) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_overact"));
    let folder = program.parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let output = Command::new("sh")
        .args(["-c", &format!("{command} 2>&1")])
        .current_dir(bench.path("."))
        .env("PATH", format!("{}:{path}", folder.display()))
        .env("CARGO_NET_OFFLINE", "true")
        .env_remove("CARGO_TARGET_DIR")
        .output()
        .expect("a shell");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Whether a printed line equals the shown one: word by word, numbers to two digits. Lines below
/// headings are as long as the widest row, which may be a row that is not shown.
fn is_same(shown: &str, printed: &str) -> bool {
    fn words(line: &str) -> Vec<&str> {
        let words = line.split(|c: char| c.is_whitespace() || c == ',');
        words.filter(|word| !word.is_empty()).collect()
    }
    fn is_rule(word: &str) -> bool {
        word.len() > 2 && word.bytes().all(|byte| byte == b'-')
    }
    let (shown, printed) = (words(shown), words(printed));
    let near = |(a, b): (&&str, &&str)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.02 * a.abs().max(b.abs()),
        _ => a == b || is_rule(a) && is_rule(b),
    };
    shown.len() == printed.len() && shown.iter().zip(&printed).all(near)
}

/// Whether the printed lines match the shown ones, in which `…` matches any lines.
fn matches(shown: &[&str], printed: &[&str]) -> bool {
    match (shown, printed) {
        ([], rest) => rest.is_empty(),
        (["…", shown @ ..], _) => {
            (0..=printed.len()).any(|skip| matches(shown, &printed[skip..]))
        }
        ([first, shown @ ..], [line, printed @ ..]) => {
            is_same(first, line) && matches(shown, printed)
        }
        (_, []) => false,
    }
}

/// Names of the files that the blocks of a page are written to.
#[derive(Default)]
struct Files<'n> {
    /// TOML blocks are appended.
    toml: &'n str,
    xml: &'n str,
    rust: &'n str,
}

/// Command, with its continuation lines, and the shown output.
///
/// A continuation line begins with `> `, as in a shell.
fn command_and_output(text: &str) -> (String, Vec<&str>) {
    let mut lines = text.trim_end().lines().peekable();
    let mut command = lines.next().unwrap_or_default().to_owned();
    while let Some(more) = lines.next_if(|line| line.starts_with("> ")) {
        command.push('\n');
        command.push_str(&more[2..]);
    }
    (command, lines.collect())
}

/// Runs the blocks of a document; returns the number of commands.
fn follow(bench: &Bench, text: &str, files: &Files<'_>) -> usize {
    let mut commands = 0;
    for block in blocks(text) {
        let content = block.lines.join("\n") + "\n";
        match block.language {
            "toml" => {
                let before = fs::read_to_string(bench.path(files.toml)).unwrap_or_default();
                bench.write(files.toml, &(before + &content));
            }
            "xml" => bench.write(files.xml, &content),
            "rust" if !files.rust.is_empty() => bench.write(files.rust, &content),
            "console" => {
                for part in block.lines.join("\n").split("$ ").skip(1) {
                    let (command, shown) = command_and_output(part);
                    let printed = run(bench, &command);
                    let lines: Vec<&str> = printed.trim_end().lines().collect();
                    assert!(
                        matches(&shown, &lines),
                        "$ {command}\n{printed}\nis not\n{}",
                        shown.join("\n")
                    );
                    commands += 1;
                }
            }
            _ => {}
        }
    }
    commands
}

#[test]
fn the_untrusted_results_page_shows_the_actual_output() {
    let text = fs::read_to_string(docs().join("untrusted.md")).expect("the page");
    let files = Files {
        toml: "rrr.toml",
        ..Files::default()
    };
    assert_eq!(follow(&Bench::new(), &text, &files), 9);
}

#[test]
fn the_parallel_robot_tutorial_shows_the_actual_output() {
    // Its robot is derived and identified several times.
    if !overact_tier::is_full() {
        return;
    }
    let text = fs::read_to_string(docs().join("tutorial.md")).expect("the tutorial");
    let bench = Bench::new();
    let files = Files {
        toml: "rrr.toml",
        ..Files::default()
    };
    let commands = follow(&bench, &text, &files);
    assert!(commands > 10, "{commands} commands");
    let drawing = fs::read_to_string(docs().join("tutorial.svg")).unwrap_or_default();
    assert!(
        drawing == bench.read("rrr.svg"),
        "renew docs/tutorial.svg with what the tutorial's `inspect` draws"
    );
    // Not shown: the whole robot generates.
    bench.good(&["generate", "--effort", "none", "rrr.toml", "-o", "all.rs"]);
    assert!(bench.read("all.rs").contains("pub struct Rrr"));
}

#[test]
fn the_ankle_tutorial_shows_the_actual_output() {
    // It is identified four times.
    if !overact_tier::is_full() {
        return;
    }
    let text = fs::read_to_string(docs().join("tutorial-ankle.md")).expect("the page");
    let files = Files {
        xml: "ankle.xml",
        ..Files::default()
    };
    assert_eq!(follow(&Bench::new(), &text, &files), 15);
}

#[test]
fn the_counterbalance_tutorial_shows_the_actual_output() {
    // The arm is identified twice.
    if !overact_tier::is_full() {
        return;
    }
    let text = fs::read_to_string(docs().join("tutorial-counterbalance.md")).expect("the page");
    let files = Files {
        toml: "arm.toml",
        ..Files::default()
    };
    assert_eq!(follow(&Bench::new(), &text, &files), 8);
}

#[test]
fn the_arm_tutorial_shows_the_actual_output() {
    // It is identified three times.
    if !overact_tier::is_full() {
        return;
    }
    let (simulated, _) = serial_tutorial();
    let files = Files {
        toml: "arm.toml",
        xml: "arm.urdf",
        ..Files::default()
    };
    assert_eq!(follow(&Bench::new(), &simulated, &files), 12);
}

/// The tutorial of serial arms: the parts with a simulated and with a measured log.
fn serial_tutorial() -> (String, String) {
    let text = fs::read_to_string(docs().join("tutorial-serial.md")).expect("the page");
    let (simulated, measured) = text
        .split_once("## A measured arm")
        .expect("both parts of the page");
    (simulated.to_owned(), measured.to_owned())
}

/// A log of the UR10e in the folder of reference data: `OVERACT_SHARED`, or `shared` next to the
/// repository.
fn ur10e_log(name: &str) -> PathBuf {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    folder.join("data/ur10e").join(name)
}

#[test]
fn the_measured_arm_tutorial_shows_the_actual_output() {
    // It is identified twice.
    if !overact_tier::is_full() {
        return;
    }
    let logs = [
        ("empty.csv", "14harm_unloaded.csv"),
        ("loaded.csv", "14harm_loaded.csv"),
        ("other.csv", "15harm_unloaded.csv"),
    ];
    let bench = Bench::new();
    for (name, file) in logs {
        let log = ur10e_log(file);
        if !log.exists() {
            eprintln!("skipped: the UR10e data are not here; set OVERACT_SHARED to their folder");
            return;
        }
        std::os::unix::fs::symlink(log, bench.path(name)).expect("a link");
    }
    let (_, measured) = serial_tutorial();
    let files = Files {
        toml: "ur10e.toml",
        ..Files::default()
    };
    assert_eq!(follow(&bench, &measured, &files), 3);
}

#[test]
fn the_controller_tutorial_shows_the_actual_output() {
    // It is identified, generated and compiled.
    if !overact_tier::is_full() {
        return;
    }
    let text = fs::read_to_string(docs().join("tutorial-controller.md")).expect("the page");
    let bench = Bench::new();
    std::os::unix::fs::symlink(docs().join(".."), bench.path("overact")).expect("a link");
    let files = Files {
        toml: "controller/Cargo.toml",
        rust: "controller/src/main.rs",
        ..Files::default()
    };
    assert_eq!(follow(&bench, &text, &files), 8);
}

#[test]
fn readme_commands_run_with_the_described_results() {
    // The first one simulates and identifies.
    if !overact_tier::is_full() {
        return;
    }
    let text = fs::read_to_string(docs().join("../README.md")).expect("the README");
    let bench = Bench::new();
    std::os::unix::fs::symlink(docs().join("../robots"), bench.path("robots")).expect("a link");
    let commands = text
        .lines()
        .filter_map(|line| line.strip_prefix("$ cargo run --release -- "));
    let printed: Vec<String> = commands
        .map(|command| run(&bench, &format!("overact {command}")))
        .collect();
    assert_eq!(printed.len(), 2);
    assert_eq!(
        printed[0].matches(": USE IT\n").count(),
        2,
        "{}",
        printed[0]
    );
    assert!(
        printed[1].contains("Base parameters: 49 of 64"),
        "{}",
        printed[1]
    );
}

#[test]
fn continuation_lines_belong_to_their_command() {
    let (command, shown) = command_and_output("echo 'a\n> b'\na\nb\n");
    assert_eq!((command.as_str(), shown), ("echo 'a\nb'", vec!["a", "b"]));
}

#[test]
fn shown_lines_are_compared_to_their_printed_precision() {
    assert!(is_same("a 1.00, b", "a  1.001, b") && !is_same("a 1.0", "a 1.1"));
    assert!(!is_same("a 1.0 m", "a 1.0"));
    assert!(matches(&["a", "…", "d"], &["a", "b", "c", "d"]));
    assert!(!matches(&["a", "…", "d"], &["a", "d", "c"]));
    assert!(!matches(&["a"], &["a", "b"]));
}
