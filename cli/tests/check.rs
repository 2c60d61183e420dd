//! `check` reports what simulation and identification would reject, with lines and keys, and
//! accepts long chains.

mod common;

use common::Bench;
use std::{fmt::Write, time::Instant};

/// A template with changed lines; each change must have an effect.
fn changed(template: &str, changes: &[(&str, &str)]) -> Bench {
    Bench::with(template, |text| {
        changes.iter().fold(text.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        })
    })
}

/// Line number of a text, counted from 1.
fn line(bench: &Bench, part: &str) -> usize {
    let text = bench.read("my.toml");
    let before = text.split(part).next().expect("a part");
    assert!(before.len() < text.len(), "{part}");
    before.matches('\n').count() + 1
}

/// `check` and `simulate` must give the same error for a description.
fn check_message(bench: &Bench) -> String {
    let check_message = bench.bad(&["check", "my.toml"]);
    let run = [
        "simulate",
        "my.toml",
        "--run",
        "identification",
        "-o",
        "log.csv",
    ];
    assert_eq!(bench.bad(&run), check_message);
    assert_eq!(bench.files(), ["my.toml"]);
    check_message
}

#[test]
fn check_rejects_experiments_that_simulation_would_reject() {
    let bench = changed(
        "serial-2r",
        &[
            ("bandwidth = ", "bandwidth = \"900 Hz\" # "),
            (
                "encoder = ",
                "encoder_delay = \"1 s\"\ntorque_limit = \"0 N m\"\nencoder = ",
            ),
            ("harmonic = 1,", "harmonic = 100000,"),
        ],
    );
    let check_message = check_message(&bench);
    let expected = [
        (
            "`bandwidth` makes the controlled robot unstable; lower `bandwidth`, or raise `sampling`, `derivative_cutoff` or `damping`",
            "bandwidth = \"900",
        ),
        (
            "`encoder_delay` is 1; give 0 to 0.1 seconds",
            "encoder_delay",
        ),
        (
            "`torque_limit[0]` is 0; give a positive number",
            "torque_limit = \"0",
        ),
        ("stay below half of `sampling`", "harmonic = 100000"),
    ];
    for (message, key) in expected {
        assert!(
            check_message.contains(message),
            "{message}\nin\n{check_message}"
        );
        let place = format!("my.toml:{}:", line(&bench, key));
        assert!(
            check_message.contains(&place),
            "{place} in\n{check_message}"
        );
    }
    for name in ["_hz", "_s`", "runs[", "trajectory"] {
        assert!(
            !check_message.contains(name),
            "{name} is no key:\n{check_message}"
        );
    }
}

#[test]
fn check_rejects_runs_too_short_for_identification() {
    let bench = changed(
        "serial-2r",
        &[("[identification]", "[identification]\nskip_start = 1000000")],
    );
    let check_message = bench.bad(&["check", "my.toml"]);
    assert!(
        check_message.contains("the run `identification` has"),
        "{check_message}"
    );
    assert!(
        check_message.contains("the skipped samples of the identification need at least"),
        "{check_message}"
    );
}

/// A chain of revolute joints with all parameters.
fn chain(joints: usize) -> String {
    let mut text = String::from("name = \"Chain\"\nsummary = \"a chain\"\n\n[leg.arm]\n");
    for joint in 0..joints {
        let alpha = ["90 deg", "-90 deg", "0 deg"][joint % 3];
        let _ = writeln!(
            text,
            "\n[[leg.arm.joint]]\ntype = \"revolute\"\nalpha = \"{alpha}\"\nd = \"0.1 m\"\nactuated = true\nparameters = \"all\""
        );
    }
    text + "\n[[place]]\nname = \"arm\"\nshape = \"arm\"\nhome = {}\n"
}

#[test]
fn long_chains_are_checked_in_seconds_up_to_the_joint_limit() {
    let bench = Bench::new();
    bench.write("my.toml", &chain(80));
    let start = Instant::now();
    assert!(bench.good(&["check", "my.toml"]).contains("80 joints"));
    // This takes less than a second of one core; deriving its model takes many minutes.
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
    bench.write("my.toml", &chain(201));
    let check_message = bench.bad(&["check", "my.toml"]);
    assert!(
        check_message.contains("the robot has 201 joints, more than 200"),
        "{check_message}"
    );
}

#[test]
fn unusable_filters_and_names_are_rejected_with_their_line() {
    let bench = Bench::new();
    let five_bar = std::fs::read_to_string(common::robot("five_bar.toml")).expect("a description");
    let check = |changes: &[(&str, &str)]| {
        let text = changes.iter().fold(five_bar.clone(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        bench.write("my.toml", &text);
        let check_message = bench.bad(&["check", "my.toml"]);
        (check_message, line(&bench, changes[0].1))
    };
    let cutoff = "filter_cutoff = \"100 Hz\"";
    for (changes, expected) in [
        (
            [(cutoff, "filter_order = 1000")],
            "a filter of order 1000 is not possible",
        ),
        (
            [(cutoff, "filter_cutoff = \"1e-9 Hz\"")],
            "is below one period in the longest run",
        ),
        (
            [(
                "name = \"circle-like\"",
                &*format!("name = \"{}\"", "a".repeat(300)),
            )],
            "the name of the run has 300 characters, more than 60",
        ),
        (
            [(
                "gravity = [0, \"-9.81 m/s^2\", 0]",
                "gravity = [0, 1e308, 0]",
            )],
            "the value is too large",
        ),
    ] {
        let (check_message, line) = check(&changes);
        assert!(check_message.contains(expected), "{check_message}");
        assert!(
            check_message.contains(&format!("my.toml:{line}:")),
            "{line} in {check_message}"
        );
    }
}

#[test]
fn check_and_identify_reject_impossible_prior_bodies_alike() {
    let bench = Bench::with("serial-2r", |text| {
        format!(
            "{text}\n[prior.values]\nm_1 = \"1 kg\"\nmx_1 = \"5 kg m\"\nzz_1 = \"0.001 kg m^2\"\n"
        )
    });
    let check_message = bench.bad(&["check", "my.toml"]);
    assert!(
        check_message.contains("no body has the prior parameters of `m_1`"),
        "{check_message}"
    );
    let known = [
        line(&bench, "m_1 = \"1"),
        line(&bench, "mx_1 = \"5"),
        line(&bench, "zz_1 = \"0"),
    ];
    let at = known.map(|line| check_message.contains(&format!("my.toml:{line}:")));
    assert!(at.contains(&true), "{check_message}");
    let refused = bench.bad(&["identify", "my.toml", "-o", "result.json"]);
    assert_eq!(refused, check_message);
    assert_eq!(bench.files(), ["my.toml"]);
}

#[test]
fn suspicious_values_are_noted_with_their_line() {
    let bench = changed(
        "serial-6r",
        &[
            ("alpha = \"90 deg\"", "alpha = 90"),
            ("d3 = \"0.45 m\"", "d3 = 450"),
        ],
    );
    let outcome = bench.run(&["check", "my.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    for (part, expected) in [
        ("alpha = 90", "90 rad are more than a turn: 90 deg?"),
        ("d = \"d3\"", "is 450 m long"),
    ] {
        let line = line(&bench, part);
        let note = outcome.err.lines().find(|output| output.contains(expected));
        let note = note.unwrap_or_else(|| panic!("{expected}: {}", outcome.err));
        assert!(
            note.starts_with(&format!("note: my.toml: line {line}: ")),
            "{note}"
        );
    }
    let missing = bench.bad(&["check", "nothing.toml"]);
    assert!(
        missing.contains("`overact new` lists templates"),
        "{missing}"
    );
}

#[test]
fn a_seed_is_rejected_for_measured_logs() {
    let bench = Bench::with("serial-2r", str::to_owned);
    bench.write("log.csv", "time,q_1,q_2,tau_1,tau_2\n0,0,0,0,0\n");
    let outcome = bench.run(&["identify", "my.toml", "--data", "log.csv", "--seed", "3"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.err);
    assert!(
        outcome
            .err
            .contains("`--seed` sets the noise of the virtual experiment"),
        "{}",
        outcome.err
    );
}

#[test]
fn missing_log_columns_are_reported_with_their_description_line() {
    let bench = Bench::with("serial-2r", |text| {
        let names = "positions = [\"q1\", \"q2\"]\ntorques = [\"left\",\n\"right\"]\n";
        format!("{text}\n[data]\nsampling = \"1 kHz\"\n{names}")
    });
    bench.write("log.csv", "q1,q2,left,rigth\n0,0,0,0\n1,1,1,1\n");
    let check_message = bench.bad(&["identify", "my.toml", "--data", "log.csv"]);
    let line = line(&bench, "\"right\"]");
    let expected = format!(
        "did you mean `rigth` for `right`? The names are in the table [data], my.toml:{line}"
    );
    assert!(check_message.contains(&expected), "{check_message}");
}

/// A planar five-bar of two arms; the first turns about an axis with a given `alpha`.
fn five_bar(alpha: &str) -> String {
    let pin = |leg: &str, name: &str, more: &str| {
        format!("[[leg.{leg}.joint]]\nname = \"{name}\"\ntype = \"revolute\"\n{more}\n")
    };
    let driven = |alpha: &str| format!("alpha = \"{alpha}\"\nactuated = true");
    [
        "name = \"Arms\"\n".to_owned(),
        pin("left", "l1", &driven(alpha)),
        pin("left", "l2", "d = 0.3"),
        "[leg.right]\nbase = { at = [0.4, 0, 0] }\n".to_owned(),
        pin("right", "r1", &driven("90 deg")),
        pin("right", "r2", "d = 0.3"),
        "[[leg.right.joint]]\nname = \"tip\"\ntype = \"fixed\"\nd = 0.35\nparameters = []\n"
            .to_owned(),
        "[leg.right.end]\ntype = \"point\"\nbody = \"l2\"\nat = [0.35, 0, 0]\n".to_owned(),
        "[[place]]\nname = \"left\"\nshape = \"left\"\nhome = { l1 = 2.0, l2 = -1.2 }\n".to_owned(),
        "[[place]]\nname = \"right\"\nshape = \"right\"\nhome = { r1 = 1.1, r2 = 1.2 }\n"
            .to_owned(),
    ]
    .concat()
}

#[test]
fn misfits_from_rounded_angles_are_printed_with_enough_digits() {
    let bench = Bench::new();
    bench.write("my.toml", &five_bar("90 deg"));
    bench.good(&["check", "my.toml"]);
    for alpha in ["1.5708 rad", "1.570796 rad"] {
        bench.write("my.toml", &five_bar(alpha));
        let check_message = bench.bad(&["check", "my.toml"]);
        assert!(
            check_message.contains("misses its place")
                && check_message.contains("write angles exactly"),
            "{check_message}"
        );
        assert!(!check_message.contains("0.000 mm"), "{check_message}");
    }
}
