//! Parameters that the verdict permits to use are right, whatever fault the data have.
//!
//! A mean over draws of the noise has the bias of the fault alone.

use overact_tier::{by_tiers, is_full};
use overact_trust::{
    Subject,
    faults::{Draws, FaultRow, rows},
};
use std::path::Path;

/// Fraction of each run's duration, as in `docs/traps.md`.
const PART: f64 = 0.25;

/// Largest mean error of a usable parameter, in standard deviations.
const LARGEST_MEAN: f64 = 2.0;

/// Robots and faults whose fit by one drive alone left wrong parameters in the list.
const CASES: [(&str, &[&str]); 3] = [
    ("five_bar", &["torque constants of all", "coordinate y"]),
    ("ankle", &["crosstalk of 4 % between", "coordinate roll"]),
    (
        "dualv",
        &["torque constant", "crosstalk", "ripple", "all gains fall"],
    ),
];

/// Rows of the faults of a robot whose names contain one of these words.
fn of_robot(name: &str, words: &[&str]) -> Vec<FaultRow> {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let path = robots.join(format!("{name}.toml"));
    let mut subject = Subject::load(&path).expect("a robot");
    subject.shorten(PART);
    let wanted = |fault: &str| words.iter().any(|word| fault.contains(word));
    let draws = Draws {
        part: PART,
        count: by_tiers([2, 2, 5]),
    };
    let rows = rows(&path, &subject, draws, &wanted, &|row| println!("{row}"));
    rows.expect("rows")
}

#[test]
fn usable_parameters_have_small_mean_errors_under_every_fault() {
    let count = if is_full() { CASES.len() } else { 1 };
    for (robot, words) in &CASES[..count] {
        let rows = of_robot(robot, words);
        assert!(rows.len() >= words.len());
        for row in rows {
            let mean = row.mean.as_ref().map_or(0.0, |(size, _)| *size);
            assert!(mean <= LARGEST_MEAN, "{row}");
        }
    }
}

#[test]
fn faultless_data_are_accepted() {
    for robot in by_tiers([
        &["five_bar"][..],
        &["five_bar", "dualv"],
        &["five_bar", "ankle", "dualv"],
    ]) {
        for row in of_robot(robot, &["none"]) {
            assert_eq!(row.unusable + row.listed + row.refused, 0, "{row}");
        }
    }
}

#[test]
fn a_collision_is_not_mistaken_for_positions_in_another_unit() {
    // Positions in turns would be near a singularity, whose large inputs any model explains.
    for row in of_robot("five_bar", &["collision"]) {
        assert_eq!(row.unusable + row.listed + row.refused, 0, "{row}");
        assert!(row.checks.is_empty(), "{row}");
    }
}
