//! Runs in which a coordinate does not move.
//!
//! Only encoder quantisation then distinguishes some columns, which would give wrong parameters
//! with small standard deviations.

use overact_identification::{Check, CheckKind, Grade, Identification};
use overact_robot::{Identifier, Robot};
use std::path::Path;

/// Identification from the shortened virtual experiment of a library robot with one coordinate at
/// rest.
fn identified(name: &str, still: Option<&str>) -> Identification {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let text = std::fs::read_to_string(folder.join(name)).expect("a description");
    let moves = |line: &&str| {
        still.is_none_or(|still| !line.contains(&format!("coordinate = \"{still}\"")))
    };
    let lines: Vec<&str> = text.lines().filter(moves).collect();
    let text = lines
        .join("\n")
        .replace("duration = \"10 s\"", "duration = \"4 s\"");
    let robot = Robot::from_text(name, &text).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&robot.held_out(), &|_, _| {});
    let runs = runs.expect("runs");
    Identifier::new(&robot).data(&runs).run().expect("a result")
}

fn excitation(result: &Identification) -> &Check {
    let mut all = result.checks.iter();
    all.find(|one| one.kind == CheckKind::Excitation)
        .expect("a check of the excitation")
}

#[test]
fn unexcited_coordinates_are_reported_and_affect_no_usable_parameter() {
    for (name, still) in [
        ("five_bar.toml", "x"),
        ("five_bar.toml", "y"),
        ("ankle.toml", "roll"),
    ] {
        let result = identified(name, Some(still));
        let check = excitation(&result);
        assert!(!check.passed, "{name} {still}: {}", check.words);
        let named = format!("`{still}` hardly moves");
        assert!(check.words.contains(&named), "{name}: {}", check.words);
        assert_ne!(result.grade(), Grade::Use);
        let verdict = &result.verdicts[0];
        let estimates = result.estimates.iter();
        let mut own = estimates.filter(|one| one.stage == verdict.stage);
        let estimate = own.next().expect("an estimate");
        for one in &estimate.parameters {
            if !verdict.listed.contains(&one.name) {
                continue;
            }
            let error = (one.value - one.true_value.expect("a virtual robot")).abs();
            let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
            assert!(
                error < 3.5 * half / 1.96,
                "{name} {still}: {} is off by {error}",
                one.name
            );
        }
    }
}

#[test]
fn motion_of_all_coordinates_passes_the_excitation_check() {
    let result = identified("five_bar.toml", None);
    let check = excitation(&result);
    assert!(check.passed, "{}", check.words);
    assert!(check.statistic < 0.1, "{}", check.statistic);
}
