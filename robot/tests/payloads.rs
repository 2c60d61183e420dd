//! Several named payloads: each has its own parameters, and known masses determine the drive gains.

use overact_identification::{Estimator, Identification, ParameterEstimate, Stage};
use overact_robot::{Excitation, ExcitationEffort, Identifier, Robot, Runs};
use overact_tier::by_tier;
use std::{path::Path, time::Duration};

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    std::fs::read_to_string(path.join(name)).expect("a description")
}

fn robot(text: &str) -> Robot {
    Robot::from_text("robot.toml", text).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

fn replaced(text: &str, pairs: &[(&str, &str)]) -> String {
    pairs.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    })
}

const PAYLOADS: &str = "payloads = [\"heavy\", \"light\"]\n\n[constants]";

/// The RX90 with two payloads in turn; `unloaded` runs have none.
fn rx90(unloaded: bool) -> String {
    let mut runs = vec![HEAVY, LIGHT];
    if unloaded {
        runs.insert(0, UNLOADED);
    }
    rx90_with(&runs)
}

const UNLOADED: &str = "false";
const HEAVY: &str = "\"heavy\"";
const LIGHT: &str = "\"light\"";
const BOTH: &str = "[\"heavy\", \"light\"]";

/// The RX90 with runs that carry these payloads.
fn rx90_with(payloads: &[&str]) -> String {
    let text = text("rx90.toml");
    let runs: Vec<usize> = text
        .match_indices("[[experiment.run]]")
        .map(|(at, _)| at)
        .collect();
    let own = &text[runs[0]..runs[1]];
    let carrying = |(number, payload): (usize, &&str)| {
        let run = format!("\"run {number}\"\npayload = {payload}");
        replaced(own, &[("\"identification\"", &run)]) + "\n"
    };
    let carrying: String = payloads.iter().enumerate().map(carrying).collect();
    let values = "[experiment.parameters]\nm_payload_heavy = 5\nmx_payload_heavy = 0.25\nmz_payload_heavy = 0.9\n\
                  xx_payload_heavy = 0.18\nyy_payload_heavy = 0.2\nzz_payload_heavy = 0.03\n\
                  m_payload_light = 2\nmy_payload_light = -0.1\nmz_payload_light = 0.3\n\
                  xx_payload_light = 0.06\nyy_payload_light = 0.05\nzz_payload_light = 0.02\n";
    let body = "[[leg.arm.joint]]\nname = \"payload\"\ntype = \"fixed\"\n\n[[place]]";
    let text = text[..runs[0]].to_owned() + &carrying + &text[runs[1]..];
    replaced(
        &text,
        &[
            ("[constants]", PAYLOADS),
            ("[[place]]", body),
            ("[experiment.parameters]\n", values),
            (
                "torque_noise = [1.0, 1.0, 0.5, 0.2, 0.2, 0.1]",
                "torque_noise = [0.2, 0.2, 0.1, 0.05, 0.05, 0.02]",
            ),
            ("decimation = 10", "decimation = 10\nessential = false"),
            (
                "duration = \"20 s\"",
                by_tier(["duration = \"5 s\"", "duration = \"20 s\""]),
            ),
        ],
    )
}

fn runs(robot: &Robot, held_out: &[String]) -> Runs {
    let experiment = robot.experiment().expect("an experiment");
    assert_eq!(experiment.without_effect(), Vec::<String>::new().as_slice());
    experiment.runs(held_out, &|_, _| {}).expect("runs")
}

fn identified(robot: &Robot, runs: &Runs) -> Identification {
    let result = Identifier::new(robot).data(runs).run();
    result.unwrap_or_else(|error| panic!("{}", error.render(false)))
}

fn base(result: &Identification) -> &[ParameterEstimate] {
    let mut all = result.estimates.iter();
    let base = all.find(|one| one.stage == Stage::Base && one.estimator == Estimator::LeastSquares);
    &base.expect("base parameters").parameters
}

/// Asserts that estimates with these name endings are right within their standard deviations.
fn check(result: &Identification, endings: [&str; 2]) {
    for ending in endings {
        let own = base(result).iter();
        let own = own.filter(|one| one.name.trim_end_matches('R').ends_with(ending));
        let own: Vec<&ParameterEstimate> = own.collect();
        assert!(own.len() >= 4, "{ending}: {own:?}");
        for one in own {
            let truth = one.true_value.expect("a true value");
            let miss = (one.value - truth) / one.correlated_standard_deviation;
            println!(
                "{}: {:.4} ± {:.4}, {truth}",
                one.name, one.value, one.correlated_standard_deviation
            );
            assert!(miss.abs() < 3.5, "{one:?}");
        }
    }
}

#[test]
fn two_payloads_of_a_serial_robot_are_distinguished() {
    let robot = robot(&rx90(true));
    let runs = runs(&robot, &[String::from("validation")]);
    let names: Vec<Option<&str>> = runs
        .identified
        .iter()
        .map(|log| log.payload_name())
        .collect();
    assert_eq!(names, [None, Some("heavy"), Some("light")]);
    let result = identified(&robot, &runs);
    check(&result, ["_heavy", "_light"]);
    for (name, mass) in [("m_payload_heavy", 5.0), ("m_payload_light", 2.0)] {
        let own = base(&result).iter().find(|one| one.name == name);
        assert!((own.expect(name).value / mass - 1.0).abs() < 0.02);
    }
    // Each payload is a body of its own for physical consistency.
    let consistent = result.consistent.first().expect("a consistent estimate");
    for name in ["m_payload_heavy", "m_payload_light"] {
        let body = consistent.bodies.iter().find(|one| one.mass == name);
        let body = body.expect(name);
        println!("{name}: {} kg, {}", body.mass_kg, body.definiteness);
        assert!(body.definiteness > 0.0);
    }
    let output = &result.runs[1];
    assert_eq!(
        (output.payload, output.payload_name.as_deref()),
        (true, Some("heavy"))
    );
}

#[test]
fn without_an_unloaded_run_payload_differences_are_identified() {
    let robot = robot(&rx90(false));
    let runs = runs(&robot, &[String::from("validation")]);
    let result = identified(&robot, &runs);
    let own = base(&result)
        .iter()
        .find(|one| one.name == "m_payload_heavyR");
    let own = own.expect("the mass of one less that of the other");
    assert_eq!(own.true_value, Some(3.0));
    let miss = (own.value - 3.0) / own.correlated_standard_deviation;
    assert!(
        miss.abs() < 3.5 && (own.value / 3.0 - 1.0).abs() < 0.03,
        "{own:?}"
    );
    assert!(base(&result).iter().all(|one| !one.name.contains("_light")));
    assert!(
        result
            .warnings
            .iter()
            .any(|one| one.contains("are differences from it")),
        "{:?}",
        result.warnings
    );
}

/// A run with both payloads and one with each alone distinguish them from the robot.
#[test]
fn a_run_with_two_payloads_replaces_the_one_without() {
    let robot = robot(&rx90_with(&[HEAVY, LIGHT, BOTH]));
    let runs = runs(&robot, &[String::from("validation")]);
    let label = runs.identified[2].payload_name();
    assert_eq!(label, Some("heavy+light"));
    let result = identified(&robot, &runs);
    check(&result, ["_heavy", "_light"]);
    for (name, mass) in [("m_payload_heavy", 5.0), ("m_payload_light", 2.0)] {
        let own = base(&result).iter().find(|one| one.name == name);
        assert!(
            (own.expect(name).value / mass - 1.0).abs() < 0.03,
            "{own:?}"
        );
    }
    let warned = |text: &str| result.warnings.iter().any(|one| one.contains(text));
    assert!(
        !warned("are differences from it") && !warned("predicted without"),
        "{:?}",
        result.warnings
    );
}

#[test]
fn payloads_that_are_only_carried_together_are_rejected() {
    for payloads in [[UNLOADED, BOTH], [HEAVY, BOTH], [BOTH, BOTH]] {
        let robot = robot(&rx90_with(&payloads));
        let runs = runs(&robot, &[String::from("validation")]);
        let result = Identifier::new(&robot).data(&runs).run();
        let error = result.expect_err("no distinction").render(false);
        assert!(
            error.contains("do not distinguish the payloads heavy, light"),
            "{error}"
        );
    }
}

/// The DualV with two payloads.
fn dualv(more: &str) -> String {
    replaced(
        &text("dualv.toml"),
        &[
            ("[constants]", PAYLOADS),
            ("[identification]\n", &format!("[identification]\n{more}\n")),
            (
                "zz_payload = 0.0161\nmx_payload = -0.127\nm_payload = 5.42",
                "zz_payload_heavy = 0.0161\nmx_payload_heavy = -0.127\nm_payload_heavy = 5.42\nzz_payload_light = 0.006\nmy_payload_light = 0.05\nm_payload_light = 2",
            ),
            ("payload = true", "payload = \"heavy\""),
            ("payload = true", "payload = \"light\""),
            ("payload = true", "payload = \"heavy\""),
            ("sampling = \"5 kHz\"", "sampling = \"1 kHz\""),
            ("decimation = 50", "decimation = 10"),
            (
                "duration = \"10 s\"",
                by_tier(["duration = \"2 s\"", "duration = \"10 s\""]),
            ),
        ],
    )
}

#[test]
fn two_known_payload_masses_determine_gains_of_a_parallel_robot() {
    let gains = [1.12, 0.83, 1.33, 0.72];
    let known =
        "gains = true\nknown = { m_payload_heavy = \"5.42 kg\", m_payload_light = \"2 kg\" }";
    let robot = robot(&dualv(known));
    let mut runs = runs(&robot, &robot.held_out());
    let inverse = gains.map(|gain: f64| 1.0 / gain);
    for logs in [&mut runs.identified, &mut runs.validation] {
        *logs = logs
            .iter()
            .map(|log| log.clone().with_torque_factors(&inverse))
            .collect();
    }
    let result = identified(&robot, &runs);
    for (own, truth) in result.gains.iter().zip(gains) {
        println!("{own:?}, {truth}");
        assert!(
            (own.factor - truth).abs() < 3.0 * own.deviation,
            "{own:?}, {truth}"
        );
        assert!(own.deviation < 0.05 * truth);
    }
    check(&result, ["_heavy", "_light"]);
}

#[test]
fn known_masses_of_payloads_that_no_run_carries_are_located() {
    let refused = |known: &str| {
        let robot = robot(&dualv(&format!("gains = true\nknown = {{ {known} = 2 }}")));
        let mut runs = runs(&robot, &[]).identified;
        runs.retain(|log| log.payload_name() != Some("light"));
        let refused = Identifier::new(&robot).runs(&runs).gains(true).run();
        refused.expect_err("no gains").render(false)
    };
    let error = refused("m_payload_light");
    assert!(error.contains("no run carries"), "{error}");
}

#[test]
fn known_masses_without_gains_are_warned_about() {
    let robot = robot(&dualv("known = { m_payload_heavy = \"5.42 kg\" }"));
    let runs = runs(&robot, &robot.held_out());
    let warned = |gains: bool| {
        let result = Identifier::new(&robot).data(&runs).gains(gains).run();
        let result = result.unwrap_or_else(|error| panic!("{}", error.render(false)));
        let mut warnings = result.warnings.iter();
        warnings.any(|one| one.contains("[identification.known] has no effect"))
    };
    assert!(warned(false) && !warned(true));
}

/// Runs with and without payload determine the direction of gravity and the payload together.
#[test]
fn gravity_is_identified_from_runs_with_different_payloads() {
    let robot = robot(&rx90_with(&[UNLOADED, HEAVY, BOTH]));
    let runs = runs(&robot, &[String::from("validation")]);
    let identifier = Identifier::new(&robot).data(&runs).gravity_direction(true);
    let result = identifier
        .run()
        .unwrap_or_else(|error| panic!("{}", error.render(false)));
    let gravity = result.gravity.as_ref().expect("a direction");
    println!("{gravity:?}");
    check(&result, ["_heavy", "_light"]);
    // The described direction is the true one.
    assert!(!gravity.significant, "{gravity:?}");
    assert!(gravity.tilt.to_degrees() < 0.3, "{gravity:?}");
}

/// The order of the names does not matter.
/// More or fewer runs than described carry the described payloads in turn.
#[test]
fn exciting_runs_carry_the_described_payloads() {
    let robot = robot(&rx90_with(&[UNLOADED, HEAVY, BOTH]));
    let found = |runs: usize| {
        let effort = ExcitationEffort {
            runs: Some(runs),
            seed: 1,
            generations: 1,
            time: Some(Duration::from_secs(1)),
        };
        robot.excite(&effort, &|_, _| ()).expect("exciting runs")
    };
    let own = |found: &Excitation| -> Vec<String> {
        let lines = found.tables.lines();
        let payloads = lines.filter(|line| line.starts_with("payload"));
        payloads.map(str::to_owned).collect()
    };
    let carried = ["payload = \"heavy\"", "payload = [\"heavy\", \"light\"]"];
    let five = found(5);
    assert_eq!(own(&five), [carried[0], carried[1], carried[0]]);
    let two = found(2);
    assert_eq!(own(&two), [carried[0]]);
    // The second payload has ten inertial parameters more.
    assert_eq!(five.base_parameters, two.base_parameters + 10);
}

#[test]
fn payload_labels_have_one_order() {
    let log = overact_identification::Log::new("own", 1000.0, 1, vec![0.0; 9], vec![0.0; 9], true);
    let log = log.expect("a run").with_payload_name("light+heavy");
    assert_eq!(log.payload_name(), Some("heavy+light"));
}

#[test]
fn named_and_unnamed_payload_runs_are_not_mixed() {
    let robot = robot(&dualv(""));
    let mut runs = runs(&robot, &robot.held_out());
    let log = &runs.identified[3];
    let (positions, torques) = log.load().expect("a run");
    let own = overact_identification::Log::new("own", 1000.0, 4, positions, torques, true);
    runs.identified[3] = own.expect("a run");
    let error = Identifier::new(&robot)
        .data(&runs)
        .run()
        .expect_err("no names");
    let error = error.render(false);
    assert!(
        error.contains("a payload without a name") && error.contains("own"),
        "{error}"
    );
}

#[test]
fn invalid_payload_names_are_located() {
    let output = |pairs: &[(&str, &str)], place: &str| {
        let own = replaced(&dualv(""), pairs);
        let error = Robot::from_text("robot.toml", &own).expect_err("a wrong name");
        let line = own
            .lines()
            .position(|line| line.contains(place))
            .expect(place);
        let output = error.render(false);
        assert!(
            output.contains(&format!("robot.toml:{}:", line + 1)),
            "{output}"
        );
        output
    };
    let error = output(
        &[("payload = \"light\"", "payload = \"lihgt\"")],
        "\"lihgt\"",
    );
    assert!(
        error.contains("no payload `lihgt`") && error.contains("`light`"),
        "{error}"
    );
    let error = output(
        &[("payload = \"light\"", "payload = true")],
        "payload = true",
    );
    assert!(error.contains("must name one"), "{error}");
    let list = |names: &str| {
        let run = format!("payload = [{names}]");
        output(&[("payload = \"light\"", &run)], &run)
    };
    assert!(list("\"light\", \"light\"").contains("listed twice"));
    assert!(list("\"light\", \"haevy\"").contains("no payload `haevy`"));
    let error = output(
        &[("payload = \"light\"", "payload = \"heavy+light\"")],
        "\"heavy+light\"",
    );
    assert!(error.contains("as a list"), "{error}");
    let error = output(&[("payload = \"light\"", "payload = 3")], "payload = 3");
    assert!(error.contains("true or false"), "{error}");
    let twice = [(
        "[\"heavy\", \"light\"]",
        "[\"heavy\", \"light\", \"heavy\"]",
    )];
    assert!(output(&twice, "payloads").contains("listed twice"));
    let word = [("[\"heavy\", \"light\"]", "[\"heavy\", \"light\", \"a b\"]")];
    assert!(output(&word, "payloads").contains("cannot be the name"));
    let none = [(PAYLOADS, "payloads = []\n\n[constants]")];
    assert!(output(&none, "payloads = []").contains("has 0 names"));
    let one = [(PAYLOADS, "payloads = \"heavy\"\n\n[constants]")];
    assert!(output(&one, "payloads = \"heavy\"").contains("list"));
    let error = output(&[("m_payload_light", "m_payload_lite")], "m_payload_lite");
    assert!(error.contains("m_payload_light"), "{error}");
    let error = output(&[("[platform.payload]", "[platform.burden]")], "payloads");
    assert!(error.contains("the robot has no payload"), "{error}");
}
