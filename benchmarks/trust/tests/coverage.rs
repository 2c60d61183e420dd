//! A sample of the table in `docs/trust.md`: coverage of 95 % intervals.
//!
//! It takes dozens of identifications, so only the full tier runs it.

use overact_identification::Stage;
use overact_tier::{by_tiers, is_full};
use overact_trust::{Cell, Noise, Subject, Tally, measure};
use std::path::Path;

/// Nominal coverage, percent.
const NOMINAL: f64 = 95.0;

/// Coverage with the paper's rule, which omits existing friction, percent.
const ESSENTIAL: f64 = 93.0;

/// Largest width relative to the base model's intervals.
const WIDEST: f64 = 3.0;

/// Cells of a robot with a number of draws of shortened runs.
fn cells(robot: &str, draws: u64, part: f64) -> Vec<Cell> {
    let file = format!("../../robots/{robot}.toml");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let mut subject = Subject::load(&path).expect("a robot of the library");
    subject.shorten(part);
    let mut tally = Tally::default();
    for draw in 1..=draws {
        tally.add(measure(&subject, draw, &[Noise::PLAIN]).expect("an identification"));
    }
    tally.cells(subject.info().name)
}

#[test]
fn intervals_have_their_nominal_coverage() {
    if !is_full() {
        return;
    }
    for (robot, draws, part) in [
        ("five_bar", by_tiers([0, 30, 60]), 0.5),
        ("dualv", by_tiers([0, 8, 16]), 0.25),
    ] {
        let cells = cells(robot, draws, part);
        assert!(cells.len() >= 3);
        for cell in cells {
            let [low, high] = cell.coverage_interval_percent;
            let wanted = match cell.stage {
                Stage::Essential => ESSENTIAL,
                _ => NOMINAL,
            };
            assert!(high >= wanted, "{cell:#?}");
            assert!(
                low <= NOMINAL || cell.stage == Stage::Essential,
                "{cell:#?}"
            );
            assert!(cell.relative_width <= WIDEST, "{cell:#?}");
        }
    }
}
